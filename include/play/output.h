/* output.h - files that appear under their name only when they are whole.
 *
 * What is written goes to NAME.part in the same folder, which is renamed to
 * NAME at the end.  "-" is standard output; what is no regular file (a pipe, a
 * device, a link) is written directly.
 */
#ifndef ELASTO_OUTPUT_H
#define ELASTO_OUTPUT_H

#include <stdio.h>

#include "base/status.h"

typedef struct Output {
    FILE *file;      /* NULL: not open */
    char *name;      /* where it shall stand, for messages too */
    char *temporary; /* where it is written, or NULL: directly */
} Output;

/* Opens it.  Returns OK, OUT_OF_MEMORY, FILE_FAILED (errno tells why). */
Status output_open(const char *name, Output *output);

/* FILE_FAILED if something could not be written so far, else OK. */
Status output_check(const Output *output);

/* Throws away what was written, where that is possible. */
Status output_restart(Output *output);

/* Flushes, closes, renames; OK too if it is not open.  After FILE_FAILED what
 * stood under the name before still does.
 *   keep  after a failure leave NAME.part as far as it got; else remove it */
Status output_close(Output *output, bool keep);

/* Closes and removes NAME.part.  errno stays. */
void output_discard(Output *output);

/* Whether this name means standard output. */
bool output_is_standard(const char *name);

#endif
