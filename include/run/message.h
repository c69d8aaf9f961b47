/* message.h - buffers for messages of one line. */
#ifndef ELASTO_MESSAGE_H
#define ELASTO_MESSAGE_H

#include <stddef.h>

#include "base/status.h"

/* Replaces the control characters of ASCII by '?', so that a text from outside
 * stays one line. */
void make_one_line(char *text);

/* Appends to a text, as far as it fits.
 *   text  [size] in/out */
void append(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Buffer for the message of a call that fails.  A caller that wants no message
 * passes {0}. */
typedef struct Message {
    char *text;
    size_t size; /* bytes of text */
} Message;

/* Makes a Message of a char array. */
#define MESSAGE(array) ((Message){(array), sizeof(array)})

/* Writes a message as one line.  Returns INVALID_INPUT. */
Status refuse(Message message, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
