/* nearest.h - which name was meant.
 *
 * A table here is an array of any struct whose first member is its name; a row
 * whose name is NULL ends it.
 */
#ifndef ELASTO_NEAREST_H
#define ELASTO_NEAREST_H

#include <stddef.h>

#include <stdbool.h>

/* The row with exactly this name, or NULL.
 *   table   in, of rows of `stride` bytes */
const void *named_row(const void *table, size_t stride, const char *name);

/* The row whose name is most like the text, or NULL where none is like it: at
 * most a third of its letters are wrong, missing, too many or swapped, or one
 * of the two begins or ends with the other.  Capitals, '_' and '-' count as
 * what they mean. */
const void *nearest_row(const void *table, size_t stride, const char *text);

/* Whether a text is one of these words, which are separated by blanks. */
bool is_one_of(const char *words, const char *text);

#endif
