/* output.h - files that get their name when they are whole, and CSV tables.
 *
 *   "-", /dev/stdout         standard output
 *   a regular or new file    NAME.part is written, and renamed at the end
 *   a pipe, a device         is written directly
 * A run that fails or is killed leaves NAME.part, which the next overwrites. */
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "base/status.h"

enum {
    PATH_BYTES = 4096 + 64,         /* bytes of a path */
    MESSAGE_BYTES = PATH_BYTES + 64 /* bytes of a path and a reason */
};

/* A file that is written; zeroed: not open. */
typedef struct OutputFile {
    FILE *file;                      /* stream; NULL: the output is not open */
    char name[PATH_BYTES];           /* name as given, for messages */
    char part_file_name[PATH_BYTES]; /* NAME.part; "": the file has none */
    char *message; /* [MESSAGE_BYTES] or NULL: "NAME: why" of a failure */
} OutputFile;

/* Part of a file that output_close keeps. */
typedef enum CloseAction {
    KEEP_FILE,      /* the file gets its name and replaces an old one */
    KEEP_PART_FILE, /* NAME.part stays */
    KEEP_NOTHING    /* NAME.part is removed */
} CloseAction;

/* Opens a file.  Returns OK, FILE_FAILED (message and errno say why). */
Status output_open(const char *name, char *message, OutputFile *output);

/* Closes an open file.  Returns OK, or FILE_FAILED and leaves NAME.part. */
Status output_close(OutputFile *output, CloseAction keep);

/* Writes "NAME: why" into the message unless the message has a text.  If `why`
 * is NULL, output_reason gives the reason.  Returns `status`. */
Status output_fill_message(char *message, const char *name, Status status,
                           const char *why);

/* Reports FILE_FAILED of an output, and returns it. */
Status output_report_failure(const OutputFile *output, const char *why);

/* Returns the text of a status; for FILE_FAILED the text of errno. */
const char *output_reason(Status status);

/* Prints a formatted text as one line (replace_control_characters). */
void print_line(FILE *file, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Whether a name means standard output. */
bool output_is_stdout(const char *name);

/* ---- tables -------------------------------------------------------------- */

enum {
    TABLE_MAX_COLUMNS = 32, /* columns at most */
    TABLE_NAME_SIZE = 16    /* bytes of the name of a column */
};

/* A CSV file: a line of names, then a line for each row of numbers.  Numbers
 * have 17 digits: a reader gets the same double. */
typedef struct CsvTable {
    OutputFile output;
    int column_count; /* number of columns */
    struct {
        char name[TABLE_NAME_SIZE];
        char kind; /* 'w': whole number, 't': text, 0: number */
    } column[TABLE_MAX_COLUMNS];
    /* Returns the text that a number stands for in a column of kind 't'. */
    const char *(*get_text)(const char *column, int number);
} CsvTable;

/* Adds columns that are new.
 *   names  in, separated by commas, or NULL.  "name:whole": whole numbers,
 *          and empty fields for negative numbers; "name:text": texts */
void table_add_columns(CsvTable *table, const char *names);

/* Opens a table, and writes the line of names.  Returns as output_open. */
Status table_open(const char *name, char *message, CsvTable *table);

/* Adds a row, value [columns].  table_status reports whether this failed. */
void table_add_row(CsvTable *table, const double *value);

/* Returns FILE_FAILED (message) if a write to an open table has failed. */
Status table_status(const CsvTable *table);
