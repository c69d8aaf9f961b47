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

/* Opens it; CSV has its line of names then.
 * Returns OK, OUT_OF_MEMORY, FILE_FAILED (errno tells why). */
Status table_open(const char *name, Table *table);

/* One row, value [columns]; whether it could be written table_check says. */
void table_add(Table *table, const double *value);

/* FILE_FAILED if something could not be written so far, else OK. */
Status table_check(const Table *table);

/* Takes back the rows of later steps; below 0: of all.  From a pipe nothing can
 * be taken back, and new rows follow.  Returns OK, FILE_FAILED. */
Status table_cut(Table *table, long last);

/* Writes all rows that are left; table_check says whether it could. */
void table_end(Table *table);

/* Behind its end: gives the file its name (output_close), or leaves it as
 * NAME.part, or takes it away; OK too if it is not open. */
typedef enum Keep { KEEP_WHOLE, KEEP_PART, KEEP_NOTHING } Keep;
Status table_close(Table *table, Keep keep);

/* Goes through the rows of a table with a format: row [columns] out, from the
 * first one after `rewind(table->rows)`.  Returns false behind the last. */
bool table_next(const Table *table, double *row);

#endif
