/* start_table.c - reads starts of runs from tables of states and springs. */
#include "run/body.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/fracture.h"
#include "model/plasticity.h"

enum { MAX_COLUMNS = 7 };

/* A table that is being read.  The first line has the names of the columns;
 * wanted columns are found by name, others are skipped. */
typedef struct TableReader {
    FILE *file;
    char *line_text;  /* line that was read last, then cut into fields */
    size_t capacity;  /* bytes that line_text has */
    long line_number; /* number of the line in line_text, from 1 */
    int columns;      /* number of columns of the table */
    const char *const *names; /* names of wanted columns, up to NULL */
    int column_index[MAX_COLUMNS]; /* [wanted column]; -1: missing */
    bool has_panes;           /* the table has a column "pane" */
    char failure[200];        /* why the table cannot be read, or "" */
} TableReader;

/* Stores why the table cannot be read. */
#define explain(reader, ...)                                                   \
    snprintf((reader)->failure, sizeof(reader)->failure, __VA_ARGS__)

/* Numbers of the wanted columns in one row. */
typedef struct TableRow {
    double value[MAX_COLUMNS];
} TableRow;

/* Reads the next line, without LF or CR LF, and without the byte order mark
 * that some programs write before UTF-8.  Returns false at the end. */
static bool read_next_line(TableReader *reader)
{
    static const char mark[] = "\xef\xbb\xbf";
    if (getline(&reader->line_text, &reader->capacity, reader->file) < 0)
        return false;
    reader->line_text[strcspn(reader->line_text, "\r\n")] = '\0';
    if (reader->line_number++ == 0 &&
        strncmp(reader->line_text, mark, strlen(mark)) == 0)
        memmove(reader->line_text, reader->line_text + strlen(mark),
                strlen(reader->line_text + strlen(mark)) + 1);
    return true;
}

/* Cuts the next field out of a line, without the blanks and quotes around the
 * field.  Returns NULL if the line has no more fields. */
static char *take_field(char **rest)
{
    char *field = strsep(rest, ",");
    if (!field)
        return NULL;
    field += strspn(field, " \t\"");
    size_t length = strlen(field);
    while (length > 0 && strchr(" \t\"", field[length - 1]))
        length--;
    field[length] = '\0';
    return field;
}

static void read_names(TableReader *reader)
{
    char shown[40];
    if (!read_next_line(reader)) {
        explain(reader, "it is empty");
        return;
    }
    snprintf(shown, sizeof shown, "%s", reader->line_text);
    for (int k = 0; reader->names[k]; k++)
        reader->column_index[k] = -1;
    char *rest = reader->line_text;
    for (char *name; (name = take_field(&rest)); reader->columns++) {
        reader->has_panes = reader->has_panes || !strcmp(name, "pane");
        for (int k = 0; reader->names[k]; k++)
            if (strcmp(name, reader->names[k]) == 0)
                reader->column_index[k] = reader->columns;
    }
    for (int k = 0; reader->names[k] && !reader->failure[0]; k++)
        if (reader->column_index[k] < 0)
            explain(reader,
                    "its first line, '%s', has no column '%s'; --states and "
                    "--springs write such tables",
                    shown, reader->names[k]);
}

/* Reads the next row.  Returns false at the end or after a `failure`. */
static bool read_next_row(TableReader *reader, TableRow *row)
{
    int fields = 0;
    do
        if (reader->failure[0] || !read_next_line(reader))
            return false;
    while (reader->line_text[0] == '\0');
    char *rest = reader->line_text, *end;
    for (char *field; (field = take_field(&rest)); fields++)
        for (int k = 0; reader->names[k]; k++) {
            if (reader->column_index[k] != fields)
                continue;
            row->value[k] = strtod(field, &end);
            if (end == field || *end || !isfinite(row->value[k]))
                explain(reader, "line %ld: %s is '%.40s', not a number",
                        reader->line_number, reader->names[k], field);
        }
    if (fields != reader->columns)
        explain(reader, "line %ld has %d columns, the first line %d%s",
                reader->line_number, fields, reader->columns,
                fields > reader->columns
                    ? "; a number has a point, a comma ends it"
                    : "");
    return !reader->failure[0];
}

/* The rows of a step and a run, which the second column numbers from 0. */
typedef struct TablePart {
    const char *option;             /* option with the table, for messages */
    const char *path;               /* name of the file */
    const char *element_name;       /* "node" or "spring" */
    const char *names[MAX_COLUMNS]; /* names of columns, up to NULL */
    int rows;                       /* number of nodes or springs of a run */
    int run;  /* index of the run that is read */
} TablePart;

/* Reads the rows of one run at the step options->state_step; -1: at the last
 * step.  If the user went back, the last rows of a step count.
 *   row  [part->size] out */
static void read_rows(TableReader *reader, const Options *options,
                      const TablePart *part, TableRow *row)
{
    const double step = options->state_step;
    const char *element = part->element_name;
    double last = -1;
    int count = 0, runs = (int)fmax(options->scene->body.runs, 1);
    TableRow next = {{0}};
    while (read_next_row(reader, &next)) {
        bool goes_on = next.value[0] == last && next.value[1] != 0;
        last = next.value[0];
        if (step >= 0 && last != step)
            continue;
        count = goes_on ? count : 0;
        int i = count - part->run * part->rows;
        if (next.value[1] != count)
            explain(reader, "line %ld has %s %g where %s %d is missing",
                    reader->line_number, element, next.value[1], element,
                    count);
        if (i >= 0 && i < part->rows)
            row[i] = next;
        count++;
    }
    int bodies = count / part->rows;
    if (reader->failure[0])
        return;
    if (step >= 0 && count == 0)
        explain(reader, "step %.0f is not in it", step);
    else if (count == 0)
        explain(reader, "it has no row below the names of its columns");
    else if (count % part->rows != 0 || (!reader->has_panes && bodies > runs))
        explain(reader,
                "its %sstep has %d %ss, the body %d; --segments may differ",
                step < 0 ? "last " : "", count, element, part->rows);
    else if (part->run >= bodies)
        explain(reader, "body %d of the scene is not in it", part->run + 1);
}

/* Reads a part of a table.
 *   row  out, [part->size], to be freed by the caller in any case
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
static Status read_table_part(const Options *options, const TablePart *part,
                              TableRow **row, Message message)
{
    TableReader reader = {.file = fopen(part->path, "r"), .names = part->names};
    errno = reader.file ? 0 : errno;
    *row = malloc((size_t)part->rows * sizeof **row);
    if (reader.file && *row) {
        read_names(&reader);
        read_rows(&reader, options, part, *row);
    }
    if (!reader.file || ferror(reader.file))
        explain(&reader, "%s", strerror(errno));
    free(reader.line_text);
    if (reader.file)
        fclose(reader.file);
    if (reader.failure[0])
        return refuse(message, "--%s '%.60s': %s", part->option, part->path,
                      reader.failure);
    return *row ? STATUS_OK : STATUS_OUT_OF_MEMORY;
}

Status start_table_read(const Options *options, int run, int nodes, double *x,
                        double *v, Message message)
{
    const TablePart part = {"state", options->state,
                            "node",  {"step", "node", "x", "y", "vx", "vy"},
                            nodes,   run};
    TableRow *row;
    Status status = read_table_part(options, &part, &row, message);
    for (int i = 0; i < nodes && !status; i++) {
        memcpy(x + 2 * i, row[i].value + 2, 2 * sizeof *x);
        memcpy(v + 2 * i, row[i].value + 4, 2 * sizeof *v);
    }
    free(row);
    return status;
}

/* Gives a spring the plastic strain of its row, and breaks the spring if the
 * row says that it is broken.  Returns why the row does not fit, or NULL. */
static const char *restore_spring(const Options *options, System *system,
                                  int spring, const double *value)
{
    Plasticity *flow = system_term_data(system, &plastic_energy);
    bool is_broken = value[2] == 0;
    bool can_break = system_find_term(system, &fracture);
    if (is_broken && !spring_is_broken(system, spring) && !can_break)
        return "is broken; --tear is missing, which lets springs break";
    if (value[4] != 0 && !flow)
        return "has yielded; --yield is missing, which lets springs yield";
    if (can_break)
        system->k[spring] = is_broken ? 0 : options->stiffness;
    if (flow) {
        flow->ep[spring] = value[3];
        flow->kappa[spring] = value[4];
    }
    return NULL;
}

Status start_springs_read(const Options *options, int run, System *system,
                          Message message)
{
    const TablePart part = {
        "state-springs", options->state_springs,
        "spring",        {"step", "spring", "whole", "plastic", "flowed"},
        system->springs, run};
    TableRow *row;
    Status status = read_table_part(options, &part, &row, message);
    for (int s = 0; s < system->springs && !status; s++) {
        const char *why = restore_spring(options, system, s, row[s].value);
        if (why)
            status = refuse(message, "--state-springs '%.60s': spring %d %s",
                            options->state_springs, s, why);
    }
    free(row);
    system_mark_changed(system, false);
    return status;
}
