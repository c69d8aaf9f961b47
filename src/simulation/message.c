/* message.c - writes messages as one line. */
#include "simulation/message.h"

#include <string.h>

void replace_control_characters(char *text)
{
    for (; *text; text++)
        if ((unsigned char)*text < ' ' || *text == '\177')
            *text = '?';
}

void append(char *text, size_t size, const char *format, ...)
{
    size_t used = strlen(text);
    write_formatted(text + used, size - used, format);
}

Status refuse(Message message, const char *format, ...)
{
    write_formatted(message.text, message.size, format);
    if (message.size > 0)
        replace_control_characters(message.text);
    return STATUS_INVALID_INPUT;
}
