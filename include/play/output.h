/* output.h - files that appear under their name only when they are whole; and
 * tables in them.
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

enum {
    OUTPUT_NAME = 4096 + 64,       /* bytes: the longest path and a bit more */
    OUTPUT_TOLD = OUTPUT_NAME + 64 /* and why it failed */
};

/* A zeroed one is not open. */
typedef struct Output {
    FILE *file;                  /* NULL: not open */
    char name[OUTPUT_NAME];      /* as it was given, for messages */
    char target[OUTPUT_NAME];    /* where it shall stand, no link */
    char temporary[OUTPUT_NAME]; /* where it is written; "": directly */
    char *told; /* [OUTPUT_TOLD] out, not owned: "NAME: why", if it is "" when
                   something fails; or NULL */
} Output;

/* What becomes of a file at its end: it gets its name, stays NAME.part as far
 * as it got, or goes.  What stood under the name stays but for the first. */
typedef enum Keep { KEEP_WHOLE, KEEP_PART, KEEP_NOTHING } Keep;

/* Opens it.  Returns OK, FILE_FAILED (told, and errno tells why). */
Status output_open(const char *name, char *told, Output *output);

/* Flushes and closes it, if it is open; its name can still be read.  Returns
 * OK, FILE_FAILED (it is NAME.part then). */
Status output_close(Output *output, Keep keep);

/* Tells of a failure, and why, or NULL: what the status says, of FILE_FAILED
 * errno.  Returns the status; output_fail: FILE_FAILED. */
Status output_tell(char *told, const char *name, Status status,
                   const char *why);
Status output_fail(const Output *output, const char *why);

/* Why something failed: after FILE_FAILED what errno means here. */
const char *output_reason(Status status);

/* Whether this name means standard output. */
bool output_is_standard(const char *name);

/* ---- tables -------------------------------------------------------------- */

/* Rows of numbers as a file.  The end of its name says how:
 *
 *   .npz    an array for each column, for numpy.load: where every step has as
 *           many rows [step, place], of time [step], of a node's number
 *           [place]; else [row]
 *   .pvd    the list of a folder's steps, for ParaView
 *   others  CSV: a line of names, then a line a row; 17 digits, so that who
 *           reads them has the same double
 * CSV is written as it comes, the others at the end, out of a file that has no
 * name.
 */
typedef struct Table Table;

enum { TABLE_COLUMNS = 32, TABLE_LETTERS = 16 }; /* at most */

/* Writes all rows of a table as a file of another kind. */
typedef void TableFormat(const Table *table, FILE *file);
TableFormat pvd_write; /* of recording.c */

struct Table {
    Output output;
    TableFormat *format; /* NULL: CSV */
    FILE *rows;          /* with a format: [columns] doubles each */
    long head;           /* where the names of CSV end, in a file */
    int columns;
    struct {
        char name[TABLE_LETTERS];
        char kind; /* 'w'hole, 'p'lace, 't'ext; 0: a number */
    } column[TABLE_COLUMNS];
    const char *(*text)(const char *column, int place); /* the texts */
};

/* Adds columns: names with commas between them, or NULL; one that is there
 * stays as it is.  Behind one there may be :whole (a whole number, below 0: CSV
 * has nothing there), :place (the same, of a node or a spring: alike in all
 * steps), :text (the place of a text).  The first column is the step, which
 * does not fall, the next one its time where there are places. */
void table_columns(Table *table, const char *names);

/* Opens it; CSV has its line of names then.  Returns as output_open. */
Status table_open(const char *name, char *told, Table *table);

/* One row, value [columns]; whether it could be written table_check says. */
void table_add(Table *table, const double *value);

/* Returns FILE_FAILED (told) if something could not be written so far, else OK;
 * OK too if it is not open, as all that follow. */
Status table_check(const Table *table);

/* Takes back the rows of later steps; below 0: of all.  From a pipe nothing can
 * be taken back, and new rows follow.  Returns as table_check. */
Status table_cut(Table *table, long last);

/* Writes all rows that are left.  Returns as table_check. */
Status table_end(Table *table);

/* Behind its end.  Returns as output_close. */
Status table_close(Table *table, Keep keep);

/* Goes through the rows of a table with a format: row [columns] out, from the
 * first one after `rewind(table->rows)`.  Returns false behind the last. */
bool table_next(const Table *table, double *row);

#endif
