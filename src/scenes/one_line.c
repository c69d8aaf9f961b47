#include "scenes/one_line.h"

#include <stdbool.h>
#include <string.h>

static const char CUT[] = "...";

/* Whether a character of UTF-8 goes on with this byte. */
static bool goes_on(char byte)
{
    return ((unsigned char)byte & 0xC0) == 0x80;
}

/* Bytes 0 ... 31 and 127; U+0080 ... U+009F, which are C2 80 ... C2 9F. */
static void hide_controls(char *line)
{
    for (unsigned char *c = (unsigned char *)line; *c; c++)
        if (*c < 32 || *c == 127 || (*c == 0xC2 && c[1] >= 0x80 && c[1] < 0xA0))
            *c = '?';
        else if (c > (unsigned char *)line && c[-1] == '?' && *c >= 0x80 &&
                 *c < 0xA0)
            *c = '?';
}

void one_line(const char *text, char *line, size_t size)
{
    if (size == 0)
        return;
    if (!text)
        text = "";
    size_t length = strlen(text), room = size - 1;
    if (length <= room) {
        memmove(line, text, length + 1);
    } else if (room <= 2 * sizeof CUT) {
        memmove(line, text, room);
        line[room] = '\0';
    } else {
        /* Neither part begins or ends inside a character. */
        size_t left = (room - (sizeof CUT - 1)) / 2;
        size_t right = room - (sizeof CUT - 1) - left;
        while (left > 0 && goes_on(text[left]))
            left--;
        while (right > 0 && goes_on(text[length - right]))
            right--;
        const char *rest = text + length - right;
        memmove(line, text, left);
        memmove(line + left, CUT, sizeof CUT - 1);
        memmove(line + left + sizeof CUT - 1, rest, right + 1);
    }
    hide_controls(line);
}
