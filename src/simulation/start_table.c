/* start_table.c - reads starts of runs from tables of states and springs. */
#include "simulation/body.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/fracture.h"
#include "model/plasticity.h"

enum { MAX_COLUMNS = 7 };

/* The rows of a step and a run in a table that is being read.  The first line
 * has the names of the columns; wanted columns are found by name, others are
 * skipped.  The second wanted column numbers the rows of a step from 0. */
typedef struct TableReader {
    const char *option_name;  /* name of the option that gives the path */
    const char *path;         /* name of the file */
    const char *element_name; /* "node" or "spring" */
    const char *column_names[MAX_COLUMNS]; /* wanted columns, up to NULL */
    int rows_per_run; /* number of nodes or springs of a run */
    int run;          /* index of the run that is read */
    FILE *file;
    char *line_text;      /* line that was read last, then cut into fields */
    size_t text_capacity; /* allocated size of line_text, bytes */
    long line_number;     /* number of the line in line_text, from 1 */
    int columns;          /* number of columns of the table */
    int column_index[MAX_COLUMNS]; /* column number of each name; -1: missing */
    bool has_panes;                /* the table has a column "pane" */
    char failure[200];             /* why the table cannot be read, or "" */
} TableReader;

/* Stores why the table cannot be read. */
#define explain(reader, ...)                                                   \
    snprintf((reader)->failure, sizeof(reader)->failure, __VA_ARGS__)

/* Numbers of the wanted columns in one row. */
typedef double TableRow[MAX_COLUMNS];

/* Reads the next line, without LF or CR LF, and without the byte order mark
 * that some programs write before UTF-8.  Returns false at the end. */
static bool read_next_line(TableReader *reader)
{
    static const char mark[] = "\xef\xbb\xbf";
    if (getline(&reader->line_text, &reader->text_capacity, reader->file) < 0)
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
static char *take_next_field(char **rest)
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

static void read_column_names(TableReader *reader)
{
    char shown[40];
    if (!read_next_line(reader)) {
        explain(reader, "it is empty");
        return;
    }
    snprintf(shown, sizeof shown, "%s", reader->line_text);
    for (int k = 0; reader->column_names[k]; k++)
        reader->column_index[k] = -1;
    char *rest = reader->line_text;
    for (char *name; (name = take_next_field(&rest)); reader->columns++) {
        reader->has_panes = reader->has_panes || !strcmp(name, "pane");
        for (int k = 0; reader->column_names[k]; k++)
            if (strcmp(name, reader->column_names[k]) == 0)
                reader->column_index[k] = reader->columns;
    }
    for (int k = 0; reader->column_names[k] && !reader->failure[0]; k++)
        if (reader->column_index[k] < 0)
            explain(reader,
                    "its first line, '%s', has no column '%s'; --states and "
                    "--springs write such tables",
                    shown, reader->column_names[k]);
}

/* Reads the next row.  Returns false at the end, or with a `failure`. */
static bool read_next_row(TableReader *reader, TableRow row)
{
    int fields = 0;
    do
        if (reader->failure[0] || !read_next_line(reader))
            return false;
    while (reader->line_text[0] == '\0');
    char *rest = reader->line_text, *end;
    for (char *field; (field = take_next_field(&rest)); fields++)
        for (int k = 0; reader->column_names[k]; k++) {
            if (reader->column_index[k] != fields)
                continue;
            row[k] = strtod(field, &end);
            if (end == field || *end || !isfinite(row[k]))
                explain(reader, "line %ld: %s is '%.40s', not a number",
                        reader->line_number, reader->column_names[k], field);
        }
    if (fields != reader->columns)
        explain(reader, "line %ld has %d columns, the first line %d%s",
                reader->line_number, fields, reader->columns,
                fields > reader->columns
                    ? "; a number has a point, a comma ends it"
                    : "");
    return !reader->failure[0];
}

/* Reads the rows of one run at the step options->state_step; -1: at the last
 * step.  If the table has a step twice, the later rows are used.
 *   row  [reader->rows] out */
static void read_run_rows(TableReader *reader, const Options *options,
                          TableRow *row)
{
    const double step = options->state_step;
    const char *element = reader->element_name;
    double last = -1;
    int count = 0, rows = reader->rows_per_run;
    int runs = (int)fmax(options->scene->body.runs, 1);
    TableRow next = {0};
    while (read_next_row(reader, next)) {
        bool goes_on = next[0] == last && next[1] != 0;
        last = next[0];
        if (step >= 0 && last != step)
            continue;
        count = goes_on ? count : 0;
        int i = count - reader->run * rows;
        if (next[1] != count)
            explain(reader, "line %ld has %s %g where %s %d is missing",
                    reader->line_number, element, next[1], element, count);
        if (i >= 0 && i < rows)
            memcpy(row[i], next, sizeof next);
        count++;
    }
    if (reader->failure[0])
        return;
    if (step >= 0 && count == 0)
        explain(reader, "step %.0f is not in it", step);
    else if (count == 0)
        explain(reader, "it has no row below the names of its columns");
    else if (count % rows != 0 || (!reader->has_panes && count > runs * rows))
        explain(reader,
                "its %sstep has %d %ss, the body %d; --segments may differ",
                step < 0 ? "last " : "", count, element, rows);
    else if (reader->run >= count / rows)
        explain(reader, "body %d of the scene is not in it", reader->run + 1);
}

/* Reads the rows of a run.
 *   reader  in/out; the caller sets the members up to `run`
 *   row     out, [reader->rows], to be freed by the caller in any case
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
static Status read_table(TableReader *reader, const Options *options,
                         TableRow **row, Message message)
{
    reader->file = fopen(reader->path, "r");
    errno = reader->file ? 0 : errno;
    *row = malloc((size_t)reader->rows_per_run * sizeof **row);
    if (reader->file && *row) {
        read_column_names(reader);
        read_run_rows(reader, options, *row);
    }
    if (!reader->file || ferror(reader->file))
        explain(reader, "%s", strerror(errno));
    free(reader->line_text);
    if (reader->file)
        fclose(reader->file);
    if (reader->failure[0])
        return refuse(message, "--%s '%.60s': %s", reader->option_name,
                      reader->path, reader->failure);
    return *row ? STATUS_OK : STATUS_OUT_OF_MEMORY;
}

Status start_table_read(const Options *options, int run, int nodes, double *x,
                        double *v, Message message)
{
    TableReader reader = {
        .option_name = "state",
        .path = options->state,
        .element_name = "node",
        .column_names = {"step", "node", "x", "y", "vx", "vy"},
        .rows_per_run = nodes,
        .run = run};
    TableRow *row;
    Status status = read_table(&reader, options, &row, message);
    for (int i = 0; i < nodes && !status; i++) {
        memcpy(x + 2 * i, row[i] + 2, 2 * sizeof *x);
        memcpy(v + 2 * i, row[i] + 4, 2 * sizeof *v);
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

Status start_table_read_springs(const Options *options, int run, System *system,
                                Message message)
{
    TableReader reader = {
        .option_name = "state-springs",
        .path = options->state_springs,
        .element_name = "spring",
        .column_names = {"step", "spring", "whole", "plastic", "flowed"},
        .rows_per_run = system->springs,
        .run = run};
    TableRow *row;
    Status status = read_table(&reader, options, &row, message);
    for (int s = 0; s < system->springs && !status; s++) {
        const char *why = restore_spring(options, system, s, row[s]);
        if (why)
            status = refuse(message, "--state-springs '%.60s': spring %d %s",
                            options->state_springs, s, why);
    }
    free(row);
    system_mark_changed(system, false);
    return status;
}
