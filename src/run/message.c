/* message.c - writes messages, and makes texts from outside safe to print in
 * one line.
 */
#include "run/message.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Whether a character moves the cursor, ends a line, or changes the direction
 * of writing (from U+2028 on), and so could hide a part of a message. */
static bool is_control_character(long letter)
{
    return letter < 0x20 || (letter >= 0x7F && letter < 0xA0) ||
           (letter >= 0x2028 && letter <= 0x202E) ||
           (letter >= 0x2066 && letter <= 0x2069);
}

/* Returns the number of bytes of the first character of a text, or 0 if the
 * text begins with a control character or is not valid UTF-8 there. */
static int count_bytes(const char *text)
{
    /* [bytes]: smallest character that needs this number of bytes */
    static const long least[] = {0, 0, 0x80, 0x800, 0x10000};
    unsigned char first = (unsigned char)text[0];
    int size = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    long letter = size == 1 ? first : first & (0x7F >> size);
    if ((first >= 0x80 && first < 0xC0) || first > 0xF4)
        return 0;
    for (int i = 1; i < size; i++) {
        if (((unsigned char)text[i] & 0xC0) != 0x80)
            return 0;
        letter = letter << 6 | (text[i] & 0x3F);
    }
    return letter < least[size] || is_control_character(letter) ? 0 : size;
}

void make_one_line(char *text)
{
    char *to = text;
    for (const char *from = text; *from;) {
        int bytes = count_bytes(from);
        if (bytes == 0) {
            *to++ = '?';
            from++;
        }
        while (bytes-- > 0)
            *to++ = *from++;
    }
    *to = '\0';
}

void append(char *text, size_t size, const char *format, ...)
{
    size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
}

Status refuse(Message message, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message.text, message.size, format, arguments);
    va_end(arguments);
    if (message.size > 0)
        make_one_line(message.text);
    return STATUS_INVALID_INPUT;
}
