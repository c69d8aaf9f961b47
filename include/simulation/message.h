/* message.h - buffers for messages of one line. */
#pragma once

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include "base/status.h"

/* Formats the variable arguments of the calling function as printf does.  The
 * caller's parameters end with (const char *format, ...).
 *   text  [size] out */
#define write_formatted(text, size, format)                                    \
    do {                                                                       \
        va_list arguments;                                                     \
        va_start(arguments, format);                                           \
        vsnprintf(text, size, format, arguments);                              \
        va_end(arguments);                                                     \
    } while (0)

/* Replaces control characters by '?', so that a text stays one line. */
void replace_control_characters(char *text);

/* Appends to a text, as far as it fits.
 *   text  [size] in/out */
void append(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Buffer for the message of a call that fails; {0}: no message is wanted. */
typedef struct Message {
    char *text;
    size_t size; /* bytes of text */
} Message;

/* Makes a Message of a char array. */
#define MESSAGE(array) ((Message){(array), sizeof(array)})

/* Writes a message as one line.  Returns INVALID_INPUT. */
Status refuse(Message message, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
