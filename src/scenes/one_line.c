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

/* Bytes of the character of UTF-8 at the beginning of a text; 0: it is none, or
 * may be a control: ASCII's, those before U+00C0, or of U+2000 ... U+2FFF,
 * where those are that turn the direction of writing. */
static int letter_bytes(const char *text)
{
    unsigned char first = (unsigned char)text[0];
    int size = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    if (first < 0x20 || (first >= 0x7F && first < 0xC3) || first == 0xE2 ||
        first > 0xF4)
        return 0;
    for (int i = 1; i < size; i++)
        if (!goes_on(text[i]))
            return 0;
    return size;
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
    for (const char *from = line; *from;) {
        int bytes = letter_bytes(from);
        if (bytes == 0) {
            *line++ = '?';
            from++;
        }
        while (bytes-- > 0)
            *line++ = *from++;
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
    if (told.size > 0)
        one_line(told.message, told.message, told.size);
    return STATUS_INVALID_INPUT;
}
