/* output.h - files that get their name when they are whole, and tables in them.
 *
 *   "-", /dev/stdout          standard output
 *   a file, or nothing yet    NAME.part beside it takes its place at the end
 *   a pipe, a device          is written as it comes
 * A run that failed, or was killed, leaves NAME.part; the next run writes over
 * it.
 */
#ifndef ELASTO_OUTPUT_H
#define ELASTO_OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

#include "base/status.h"

enum {
    OUTPUT_NAME = 4096 + 64,          /* bytes of a path */
    OUTPUT_MESSAGE = OUTPUT_NAME + 64 /* bytes of a path and a reason */
};

/* A zeroed one is not open. */
typedef struct Output {
    FILE *file;                  /* NULL: not open */
    char name[OUTPUT_NAME];      /* as it was given, for messages */
    char temporary[OUTPUT_NAME]; /* NAME.part, or "": written directly */
    char *message; /* [OUTPUT_MESSAGE] out, not owned: "NAME: why" of the first
                   failure; or NULL */
} Output;

/* How a file ends: it gets its name and replaces the old file, stays NAME.part,
 * or is removed. */
typedef enum Keep { KEEP_WHOLE, KEEP_PART, KEEP_NOTHING } Keep;

/* Opens it.  Returns OK, FILE_FAILED (message, and errno tells why). */
Status output_open(const char *name, char *message, Output *output);

/* Flushes and closes a file if it is open; output->name stays.  Returns OK, or
 * FILE_FAILED and leaves NAME.part. */
Status output_close(Output *output, Keep keep);

/* Write "NAME: why" into `message` if it is empty.
 *   why  NULL: the text of the status, after FILE_FAILED of errno
 * Return the status; the second one FILE_FAILED. */
Status output_report(char *message, const char *name, Status status,
                     const char *why);
Status output_report_failure(const Output *output, const char *why);

/* The text of a status; of FILE_FAILED that of errno. */
const char *output_reason(Status status);

/* Whether this name means standard output. */
bool output_is_standard(const char *name);

/* ---- tables -------------------------------------------------------------- */

/* Rows of numbers as CSV: a line of names, then a line for each row.  A number
 * has 17 digits, so that a reader gets the same double. */
enum { TABLE_COLUMNS = 32, TABLE_LETTERS = 16 }; /* at most */

typedef struct Table {
    Output output;
    int columns;
    struct {
        char name[TABLE_LETTERS];
        char kind; /* 'w'hole, 't'ext; 0: a number */
    } column[TABLE_COLUMNS];
    /* Gives the text of a column of kind 't' for the number `place`. */
    const char *(*text)(const char *column, int place);
} Table;

/* Adds columns: names with commas between them, or NULL; a name that is there
 * stays as it is.  A name may end in :whole (a whole number, nothing is written
 * where it is below 0) or :text (the number is the place of a text). */
void table_columns(Table *table, const char *names);

/* Opens it, and writes the line of names.  Returns as output_open. */
Status table_open(const char *name, char *message, Table *table);

/* Adds a row, value [columns]; table_check reports failures. */
void table_add(Table *table, const double *value);

/* Returns FILE_FAILED (message) if a write has failed; OK also if the table is
 * not open. */
Status table_check(const Table *table);

#endif
