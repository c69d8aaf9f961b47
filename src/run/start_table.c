/* start_table.c - reads the start of a run from CSV tables: a step of a table
 * of states, and its springs from a table of springs.
 */
#include "run/body.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/fracture.h"
#include "model/mass_spring_energy.h"
#include "model/plasticity.h"

/* ---- CSV ----------------------------------------------------------------- */

enum { MOST_COLUMNS = 8 };

/* A table that is being read.  The first line has the names of the columns;
 * wanted columns are found by name, others are skipped. */
typedef struct Reader {
    FILE *file;
    char *text;                      /* present line */
    size_t room;                     /* bytes of text */
    long line;                       /* number of the present line, from 1 */
    int columns;                     /* number of columns */
    const char *const *names;        /* names of wanted columns, up to NULL */
    const char *field[MOST_COLUMNS]; /* texts of wanted columns in the line */
    int place[MOST_COLUMNS];         /* index of each wanted column */
    bool has_panes;                  /* the table has a column "pane" */
    char why[200];                   /* why the table cannot be read, or "" */
} Reader;

/* Reads the next line, without LF or CR LF, and without the byte order mark
 * that some programs write before UTF-8.  Returns false at the end. */
static bool next_line(Reader *reader)
{
    static const char mark[] = "\xef\xbb\xbf";
    ssize_t length = getline(&reader->text, &reader->room, reader->file);
    if (length < 0)
        return false;
    reader->text[strcspn(reader->text, "\r\n")] = '\0';
    if (reader->line++ == 0 && strncmp(reader->text, mark, strlen(mark)) == 0)
        memmove(reader->text, reader->text + strlen(mark),
                strlen(reader->text + strlen(mark)) + 1);
    return true;
}

/* Cuts the next field out of a line, without the blanks and quotes around it.
 * NULL: the line has no more fields. */
static char *next_field(char **rest)
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

/* A hint why the first line lacks a column. */
static const char *hint_at_names(const char *line)
{
    return strchr("\xff\xfe", line[0]) && line[0] ? "; UTF-8 is wanted"
           : !strchr(line, ',') && strpbrk(line, ";\t")
               ? "; commas must be between the columns"
               : "; --states and --springs write such tables";
}

/* Finds the columns in the first line. */
static void read_names(Reader *reader)
{
    char shown[40], *rest;
    if (!next_line(reader)) {
        snprintf(reader->why, sizeof reader->why, "it is empty");
        return;
    }
    snprintf(shown, sizeof shown, "%s", reader->text);
    const char *hint = hint_at_names(reader->text);
    for (int k = 0; reader->names[k]; k++)
        reader->place[k] = -1;
    rest = reader->text;
    for (char *name; (name = next_field(&rest)); reader->columns++) {
        reader->has_panes = reader->has_panes || !strcmp(name, "pane");
        for (int k = 0; reader->names[k]; k++)
            if (strcmp(name, reader->names[k]) == 0)
                reader->place[k] = reader->columns;
    }
    for (int k = 0; reader->names[k] && !reader->why[0]; k++)
        if (reader->place[k] < 0)
            snprintf(reader->why, sizeof reader->why,
                     "its first line, '%s', has no column '%s'%s", shown,
                     reader->names[k], hint);
}

/* Reads a field that is a finite number. */
static bool read_number(const char *field, double *number)
{
    char *end;
    *number = strtod(field, &end);
    return end != field && *end == '\0' && isfinite(*number);
}

/* Reads the next row.
 *   value  out, a number for each wanted column
 * Returns false at the end, and if the row cannot be read; reader->why then
 * tells. */
static bool next_row(Reader *reader, double *value)
{
    int fields = 0;
    do
        if (reader->why[0] || !next_line(reader))
            return false;
    while (reader->text[0] == '\0');
    char *rest = reader->text;
    for (char *field; (field = next_field(&rest)); fields++)
        for (int k = 0; reader->names[k]; k++)
            if (reader->place[k] == fields)
                reader->field[k] = field;
    if (fields != reader->columns)
        snprintf(reader->why, sizeof reader->why,
                 "line %ld has %d columns, the first line %d%s", reader->line,
                 fields, reader->columns,
                 fields > reader->columns
                     ? "; a number has a point, a comma ends it"
                     : "");
    for (int k = 0; reader->names[k] && !reader->why[0]; k++)
        if (!read_number(reader->field[k], &value[k]))
            snprintf(reader->why, sizeof reader->why,
                     "line %ld: %s is '%.40s', not a number", reader->line,
                     reader->names[k], reader->field[k]);
    return !reader->why[0];
}

/* ---- a step of a table --------------------------------------------------- */

/* Part of a table: rows of one step, which the second column numbers from 0. */
typedef struct Part {
    const char *option;       /* option with the table, for messages */
    const char *name;         /* name of the file */
    const char *element_name; /* "node" or "spring" */
    double step;              /* below 0: the last step */
    int size;                 /* rows of a run */
    int run, runs;            /* the run that is read, and their number */
} Part;

/* Stores row i of a run.  Returns why it does not fit, or NULL. */
typedef const char *TakeRow(void *into, int i, const double *value);

/* Reads the rows of the step, or of all steps, of which the last one remains. A
 * table has a step several times if the user went back; the last one counts. */
static void read_rows(Reader *reader, const Part *part, TakeRow *take,
                      void *into)
{
    double value[MOST_COLUMNS], last = -1;
    int count = 0, bodies;
    while (next_row(reader, value)) {
        bool follows = value[0] == last && value[1] != 0;
        last = value[0];
        if (part->step >= 0 && value[0] != part->step)
            continue;
        count = follows ? count : 0;
        int i = count - part->run * part->size;
        const char *why =
            i >= 0 && i < part->size ? take(into, i, value) : NULL;
        if (value[1] != count)
            snprintf(reader->why, sizeof reader->why,
                     "line %ld has %s %g where %s %d is missing", reader->line,
                     part->element_name, value[1], part->element_name, count);
        else if (why)
            snprintf(reader->why, sizeof reader->why, "line %ld: %s",
                     reader->line, why);
        count++;
    }
    if (reader->why[0])
        return;
    bodies = count / part->size;
    if (part->step >= 0 && count == 0)
        snprintf(reader->why, sizeof reader->why, "step %.0f is not in it",
                 part->step);
    else if (count == 0 || count % part->size != 0 ||
             (!reader->has_panes && bodies > part->runs))
        snprintf(reader->why, sizeof reader->why,
                 "its %sstep has %d %ss, the body %d; --segments may differ",
                 part->step < 0 ? "last " : "", count, part->element_name,
                 part->size);
    else if (part->run >= bodies)
        snprintf(reader->why, sizeof reader->why,
                 "body %d of the scene is not in it", part->run + 1);
}

static Status read_part(const Part *part, const char *const *names,
                        TakeRow *take, void *into, Message message)
{
    Reader reader = {.file = fopen(part->name, "r"), .names = names};
    errno = reader.file ? 0 : errno;
    if (reader.file) {
        read_names(&reader);
        read_rows(&reader, part, take, into);
    }
    if (!reader.file || ferror(reader.file))
        snprintf(reader.why, sizeof reader.why, "%s", strerror(errno));
    free(reader.text);
    if (reader.file)
        fclose(reader.file);
    return reader.why[0] ? refuse(message, "--%s '%.60s': %s", part->option,
                                  part->name, reader.why)
                         : STATUS_OK;
}

/* ---- nodes --------------------------------------------------------------- */

static const char *read_node(void *into, int i, const double *value)
{
    double *const *xv = into;
    memcpy(xv[0] + 2 * i, value + 2, 2 * sizeof *value);
    memcpy(xv[1] + 2 * i, value + 4, 2 * sizeof *value);
    return NULL;
}

Status start_table_read(const char *name, double step, int nodes, int run,
                        int runs, double *x, double *v, Message message)
{
    static const char *const names[] = {"step", "node", "x", "y",
                                        "vx",   "vy",   NULL};
    const Part part = {"state", name, "node", step, nodes, run, runs};
    double *xv[] = {x, v};
    return read_part(&part, names, read_node, xv, message);
}

/* ---- springs ------------------------------------------------------------- */

/* The springs that a table describes. */
typedef struct Springs {
    System *system;
    double stiffness; /* J/m^2, of springs that are not broken */
} Springs;

/* Gives a spring the plastic strain of the table, and breaks it if it is broken
 * there. */
static const char *take_spring(void *into, int i, const double *value)
{
    const Springs *springs = into;
    System *system = springs->system;
    Plasticity *flow = system_term_data(system, &plastic_energy);
    const int *e = system->e + 2 * i;
    bool broken = value[4] == 0, breaks = system_find_term(system, &fracture);
    if (value[3] - value[2] != e[1] - e[0])
        return "this spring belongs to another square";
    if (broken && !spring_is_broken(system, i) && !breaks)
        return "this spring is broken; --tear is missing, which lets springs "
               "break";
    if (value[6] != 0 && !flow)
        return "this spring has yielded; --yield is missing, which lets "
               "springs yield";
    if (breaks)
        system->k[i] = broken ? 0 : springs->stiffness;
    if (flow) {
        flow->ep[i] = value[5];
        flow->kappa[i] = value[6];
    }
    return NULL;
}

Status start_springs_read(const Options *options, int run, int runs,
                          System *system, Message message)
{
    static const char *const names[] = {"step",  "spring",  "i",      "j",
                                        "whole", "plastic", "flowed", NULL};
    const Part part = {"state-springs",
                       options->state_springs,
                       "spring",
                       options->state_step,
                       system->springs,
                       run,
                       runs};
    Springs springs = {system, options->stiffness};
    Status status = read_part(&part, names, take_spring, &springs, message);
    system_mark_changed(system, false);
    return status;
}
