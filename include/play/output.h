/* output.h - files that appear under their name only when they are whole.
 *
 * What a name stands for decides what happens:
 *   "-", or whatever standard output is    standard output
 *   a regular file, or nothing yet         a new file NAME.part in the same
 *                                          folder, which takes the name's
 *                                          place, with the old permissions, at
 *                                          the end
 *   a symbolic link                        the same where it leads; it stays
 *   a pipe, a character device             is written as it comes
 *   a folder, a block device, a socket     is refused
 * NAME.part is never a file that was there: the second one is NAME.part2.
 */
#ifndef ELASTO_OUTPUT_H
#define ELASTO_OUTPUT_H

#include <stdio.h>

#include "base/status.h"

typedef struct Output {
    FILE *file;      /* NULL: not open */
    char *name;      /* as it was given, for messages */
    char *target;    /* where it shall stand, no link; NULL: written directly */
    char *temporary; /* where it is written, with a target */
} Output;

/* Opens it.  Returns OK, OUT_OF_MEMORY, FILE_FAILED (errno tells why; ENOTSUP:
 * refused). */
Status output_open(const char *name, Output *output);

/* FILE_FAILED if something could not be written so far, else OK. */
Status output_check(const Output *output);

/* Throws away what was written, where that is possible. */
Status output_restart(Output *output);

/* Cuts off the lines that begin with a number above `last`, and all behind
 * them; headers stay.  Where nothing can be taken back the new text follows the
 * old.  Returns OK, FILE_FAILED. */
Status output_cut(Output *output, long last);

/* Flushes, closes, renames; OK too if it is not open.  After FILE_FAILED what
 * stood under the name before still does.
 *   keep  after a failure leave NAME.part as far as it got; else remove it */
Status output_close(Output *output, bool keep);

/* Closes; where something stands under the name it stays, and NAME.part too.
 * For tables of a run that made no step. */
Status output_set_aside(Output *output);

/* Closes and removes NAME.part.  errno stays. */
void output_discard(Output *output);

/* Whether this name means standard output. */
bool output_is_standard(const char *name);

/* Whether two outputs would write into one another: the same file, or one is
 * the other's NAME.part. */
bool output_collides(const char *one, const char *other);

/* The path a name leads to, links followed; what does not exist yet has its
 * folder's path.  In memory of its own; NULL: errno tells why. */
char *output_target(const char *name);

#endif
