/* one_line.h - texts from outside, made fit for a line of a message.
 */
#ifndef ELASTO_ONE_LINE_H
#define ELASTO_ONE_LINE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

/* Copies a text: each byte of a control character, of those that turn the
 * direction of writing, and that is no UTF-8 becomes '?', so that a message
 * stays one line, says what it seems to say, and a terminal obeys nothing.
 * A text that does not fit loses its middle: "abc...xyz".
 *   text  in, or NULL: ""
 *   line  [size] out, 12 at least; may be the text itself */
void one_line(const char *text, char *line, size_t size);

/* Whether a text is UTF-8 without any of those. */
bool is_one_line(const char *text);

/* Writes behind what the text has; what does not fit is cut off.
 *   text  [size] in/out */
void append(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Where the line goes that says why something is refused, [size]. */
typedef struct Refusal {
    char *message;
    size_t size;
} Refusal;

/* Writes it, as one line.  Returns INVALID_INPUT. */
Status refuse(Refusal told, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
