/* message.c - writes messages as one line. */
#include "run/message.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void make_one_line(char *text)
{
    for (; *text; text++)
        if ((unsigned char)*text < ' ' || *text == '\177')
            *text = '?';
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
