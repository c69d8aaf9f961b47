/* output.h - files that appear under their name only when they are whole.
 *
 *   "-", /dev/stdout               standard output
 *   a file, or nothing yet          NAME.part beside it takes its place at the
 *                                   end, with the old permissions
 *   a symbolic link to a file       the same where it leads; it stays
 *   a pipe, a terminal, a device    is written as it comes
 * Whoever writes NAME.part holds a lock on it: nobody else can open the same,
 * whatever it is called.
 * What a run that failed or was killed left there is written over by the next.
 */
#ifndef ELASTO_OUTPUT_H
#define ELASTO_OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

#include "base/status.h"

typedef struct Output {
    FILE *file;      /* NULL: not open */
    char *name;      /* as it was given, for messages */
    char *target;    /* where it shall stand, no link; NULL: written directly */
    char *temporary; /* where it is written, with a target */
} Output;

/* Opens it.  Returns OK, OUT_OF_MEMORY, FILE_FAILED (errno tells why). */
Status output_open(const char *name, Output *output);

/* Why something failed: after FILE_FAILED what errno means here. */
const char *output_reason(Status status);

/* Flushes, closes, renames; OK too if it is not open.  After FILE_FAILED, or
 * where this status is no OK, which it returns then, what stood under the name
 * before still does, and NAME.part as far as it got. */
Status output_close(Output *output, Status status);

/* Closes it, if it is open, and removes what was written. */
void output_discard(Output *output);

/* Whether this name means standard output. */
bool output_is_standard(const char *name);

#endif
