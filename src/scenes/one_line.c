#include "scenes/one_line.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const char CUT[] = "...";

/* Whether a character of UTF-8 goes on with this byte. */
static bool goes_on(char byte)
{
    return ((unsigned char)byte & 0xC0) == 0x80;
}

/* The character of UTF-8 at the beginning of a text.  Returns its bytes; 1 and
 * the code of a control for what is none. */
static size_t read_character(const unsigned char *text, unsigned *code)
{
    static const unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
    size_t size = text[0] < 0x80   ? 1
                  : text[0] < 0xE0 ? 2
                  : text[0] < 0xF0 ? 3
                                   : 4;
    *code = size == 1 ? text[0] : text[0] & (0xFFU >> (size + 1));
    for (size_t i = 1; i < size && *code != 127; i++)
        *code = goes_on((char)text[i]) ? *code << 6 | (text[i] & 0x3F) : 127;
    if (*code >= least[size] && text[0] < 0xF8 && *code != 127)
        return size;
    *code = 127;
    return 1;
}

/* What a terminal obeys, or what turns the order of its letters around. */
static bool is_control(unsigned code)
{
    return code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0x61C ||
           code == 0x200E || code == 0x200F ||
           (code >= 0x2028 && code <= 0x202E) ||
           (code >= 0x2066 && code <= 0x2069);
}

void one_line(const char *text, char *line, size_t size)
{
    if (!text)
        text = "";
    size_t length = strlen(text), room = size - 1;
    if (length <= room) {
        memmove(line, text, length + 1);
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
    /* Each control, and each byte that is no character, becomes '?'. */
    for (const char *from = line; *from;) {
        unsigned code;
        size_t bytes = read_character((const unsigned char *)from, &code);
        if (is_control(code))
            *line++ = '?';
        else
            for (size_t i = 0; i < bytes; i++)
                *line++ = from[i];
        from += bytes;
    }
    *line = '\0';
}

void append(char *text, size_t size, const char *format, ...)
{
    size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
}

Status refuse(Refusal told, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(told.message, told.size, format, arguments);
    va_end(arguments);
    return STATUS_INVALID_INPUT;
}
