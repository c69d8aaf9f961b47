#include "play/recording.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "scenes/one_line.h"
#include "scenes/scene.h"

/* Tells of the first failure; returns status.
 *   why  it failed, if errno does not say it; or NULL */
static Status note(Recording *recording, Status status, const char *name,
                   const char *why)
{
    if (status && !recording->message[0]) {
        char shown[256];
        one_line(name, shown, sizeof shown);
        snprintf(recording->message, sizeof recording->message, "%s: %s", shown,
                 why                              ? why
                 : status == STATUS_OUT_OF_MEMORY ? output_reason(ENOMEM)
                                                  : output_reason(errno));
    }
    return status;
}

/* Makes the folder, or finds that it is there. */
static Status make_folder(const char *name)
{
    struct stat info;
    if (mkdir(name, 0777) == 0 ||
        (errno == EEXIST && stat(name, &info) == 0 && S_ISDIR(info.st_mode)))
        return STATUS_OK;
    errno = errno == EEXIST ? ENOTDIR : errno;
    return STATUS_FILE_FAILED;
}

/* What the terms of all options may add to a ledger stands between these. */
static const char *const first_energies[] = {
    "total", "kinetic", "elastic", "gravity", "contact", "hand", NULL};
static const char *const last_energies[] = {"friction", "work", "dissipated",
                                            NULL};
enum { ENERGY_COLUMNS = 32 };

/* Adds a name that is not there yet; returns how many there are then. */
static int add_name(const char *name, const char **names, int count)
{
    for (int i = 0; i < count; i++)
        if (!name || strcmp(names[i], name) == 0)
            return count;
    if (count < ENERGY_COLUMNS)
        names[count++] = name;
    return count;
}

/* The columns of energies, whatever the scene has; returns how many. */
static int list_energies(const char *names[ENERGY_COLUMNS])
{
    int count = 0;
    for (int i = 0; first_energies[i]; i++)
        count = add_name(first_energies[i], names, count);
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->term) {
            count = add_name(row->term->energy, names, count);
            count = add_name(row->term->loss, names, count);
        }
    for (int i = 0; last_energies[i]; i++)
        count = add_name(last_energies[i], names, count);
    return count;
}

/* Whether all of a table so far was written. */
static Status check_table(Recording *recording, const Output *output)
{
    return note(recording, output_check(output), output->name, NULL);
}

/* The lines above the columns. */
static Status write_headers(Recording *recording)
{
    const char *names[ENERGY_COLUMNS];
    FILE *states = recording->states.file, *log = recording->log.file;
    FILE *energies = recording->energies.file;
    Status status = STATUS_OK;
    if (states)
        fputs("step,time,node,x,y,vx,vy\n", states);
    if (log)
        fprintf(log,
                "step,iteration,residual,alpha,trials,slope,change,projected,"
                "factorised,shift,status,seconds%s,solver,kind%s\n",
                recording->points ? ",from_x,from_y,to_x,to_y" : "",
                recording->panes > 1 ? ",pane" : "");
    if (energies)
        fputs("step,time", energies);
    for (int i = 0, count = list_energies(names); energies && i < count; i++)
        fprintf(energies, ",%s", names[i]);
    if (energies)
        fputs(",run\n", energies);
    for (int t = 0; t < RECORDING_TABLES && !status; t++)
        status = check_table(recording, &recording->table[t]);
    return status;
}

Status recording_film(Recording *recording, const char *name)
{
    Film *film = &recording->film;
    recording->message[0] = '\0';
    Status status =
        film_open(name, film, recording->message, sizeof recording->message);
    return note(recording, status, name, film->reason);
}

Status recording_end_film(Recording *recording)
{
    char name[256], told[RECORDING_TOLD];
    Film *film = &recording->film;
    if (!film_runs(film))
        return STATUS_OK;
    one_line(film->output.name, name, sizeof name);
    snprintf(told, sizeof told, "%ld frames, in %s", film->frames, name);
    Status status = film_close(film);
    if (!status) {
        recording->films++;
        memcpy(recording->film_told, told, sizeof told);
    }
    return note(recording, status, name, film->reason);
}

/* Folder, film, tables. */
Status recording_open(const Options *options, int panes, Recording *recording)
{
    const char *names[RECORDING_TABLES] = {options->states, options->log,
                                           options->energies};
    *recording = (Recording){
        .folder = options->frames, .last_frame = -1, .panes = panes};
    recording->points = !(options->scene->needs & NEEDS_TIME);
    Status status = STATUS_OK;
    if (recording->folder)
        status = note(recording, make_folder(recording->folder),
                      recording->folder, NULL);
    if (!status && options->film)
        status = recording_film(recording, options->film);
    for (int t = 0; t < RECORDING_TABLES && !status; t++)
        if (names[t])
            status =
                note(recording, output_open(names[t], &recording->table[t]),
                     names[t], NULL);
    if (!status)
        status = write_headers(recording);
    if (status)
        recording_discard(recording); /* what stood there before stays */
    return status;
}

/* Whether a name ends in one of these, or in nothing that begins with a letter:
 * other endings promise other formats. */
static bool is_called(const char *name, const char *ends)
{
    const char *slash = strrchr(name, '/');
    const char *end = strrchr(slash ? slash + 1 : name, '.');
    if (!end || !isalpha((unsigned char)end[1]))
        return true;
    const char *found = strcasestr(ends, end);
    return found && !isalnum((unsigned char)found[strlen(end)]);
}

/* A name, and the file beside it in which it begins. */
static bool are_same(const char *one, const char *other)
{
    char part[RECORDING_NAME_SIZE];
    snprintf(part, sizeof part, "%s.part", one);
    return output_is_same(one, other) || output_is_same(part, other);
}

/* One name, then every two. */
Status recording_check(const Options *options, char *message, size_t size)
{
    static const char table[] = ".csv, .txt, .dat, .log";
    const struct {
        const char *option, *name, *ends; /* NULL: any */
    } file[] = {
        {"states", options->states, table},
        {"log", options->log, table},
        {"energies", options->energies, table},
        {"film", options->film, NULL},
        {"frames", options->frames, NULL},
        {"script", options->script, NULL},
        {"state", options->state, NULL},
        {"handout", options->handout, ".html, .htm"},
    };
    enum { FILES = sizeof file / sizeof *file };
    char shown[64], other[64];
    for (int i = 0; i < FILES; i++) {
        if (!file[i].name)
            continue;
        one_line(file[i].name, shown, sizeof shown);
        if (file[i].ends && !is_called(file[i].name, file[i].ends)) {
            snprintf(message, size,
                     "--%s '%s': it is %s, whose name ends in %s or has no "
                     "ending",
                     file[i].option, shown,
                     file[i].ends == table ? "a table in CSV"
                                           : "a page in HTML",
                     file[i].ends);
            return STATUS_INVALID_INPUT;
        }
        for (int k = 0; k < FILES; k++) {
            if (k == i || !file[k].name ||
                !are_same(file[i].name, file[k].name))
                continue;
            one_line(file[k].name, other, sizeof other);
            snprintf(message, size,
                     "--%s '%s' and --%s '%s' are one file: each needs a name "
                     "of its own",
                     file[i].option, shown, file[k].option, other);
            return STATUS_INVALID_INPUT;
        }
    }
    return STATUS_OK;
}

/* FOLDER/frame_000012.png */
static Status write_frame(Recording *recording, const Canvas *canvas, long step)
{
    char name[RECORDING_NAME_SIZE];
    int length = snprintf(name, sizeof name, "%s/frame_%06ld.png",
                          recording->folder, step);
    errno = ENAMETOOLONG;
    Status status = STATUS_FILE_FAILED;
    if (length > 0 && (size_t)length < sizeof name)
        status = png_file_write(name, canvas);
    if (!status && recording->last_frame != step)
        recording->frames++;
    recording->last_frame = step;
    return note(recording, status, name, NULL);
}

Status recording_frame(Recording *recording, const Canvas *canvas, long step,
                       int shown)
{
    Film *film = &recording->film;
    Status status = STATUS_OK;
    if (film_runs(film))
        status = note(recording, film_add(film, canvas, shown),
                      film->output.name, film->reason);
    if (!status && recording->folder)
        status = write_frame(recording, canvas, step);
    return status;
}

/* The rows of one run; its nodes are numbered from `first`. */
static void write_run(FILE *file, const Simulation *simulation,
                      const TimeIntegrator *run, long step, int first)
{
    double time = simulation_time(simulation);
    for (int i = 0; i < simulation->system.nodes && !ferror(file); i++) {
        const double *x = run->x + 2 * (size_t)i, *v = run->v + 2 * (size_t)i;
        fprintf(file, "%ld,%.17g,%d,%.17g,%.17g,%.17g,%.17g\n", step, time,
                first + i, x[0], x[1], v[0], v[1]);
    }
}

/* The ledger of one run; 0 where it has no such row. */
static void write_ledger(Recording *recording, const Simulation *simulation,
                         int run, long step, int number)
{
    const char *names[ENERGY_COLUMNS];
    const Energies energies = simulation_energies(simulation, run);
    FILE *file = recording->energies.file;
    int count = list_energies(names);
    fprintf(file, "%ld,%.17g", step, simulation_time(simulation));
    for (int i = 0; i < count; i++) {
        double value = 0;
        for (int r = 0; r < energies.rows; r++)
            if (strcmp(energies.row[r].name, names[i]) == 0)
                value = energies.row[r].value;
        fprintf(file, ",%.17g", value);
    }
    fprintf(file, ",%d\n", number);
}

/* Run by run. */
Status recording_states(Recording *recording,
                        const Simulation *const *simulation, int count,
                        long step)
{
    int first = 0, number = 0;
    Output *states = &recording->states, *energies = &recording->energies;
    errno = 0;
    for (int i = 0; i < count; i++)
        for (int r = 0; r < simulation[i]->runs; r++) {
            if (states->file)
                write_run(states->file, simulation[i], &simulation[i]->run[r],
                          step, first);
            if (energies->file)
                write_ledger(recording, simulation[i], r, step, number++);
            first += simulation[i]->system.nodes;
        }
    Status status = check_table(recording, states);
    return status ? status : check_table(recording, energies);
}

/* What is known of a residual. */
static const char *const kinds[] = {"value", "estimate", "bound"};

/* The numbers of the record, in the order of the header. */
Status recording_update(Recording *recording, const NewtonRecord *record,
                        int pane)
{
    Output *log = &recording->log;
    if (!log->file)
        return STATUS_OK;
    char iteration[16] = "";
    if (record->iteration >= 0)
        snprintf(iteration, sizeof iteration, "%d", record->iteration);
    errno = 0;
    fprintf(log->file, "%ld,%s,%.17g,%.17g,%d,%.17g,%.17g,%d,%d,%.17g,%s,%.17g",
            record->step, iteration, record->residual, record->alpha,
            record->trials, record->slope, record->change, record->projected,
            record->factorised, record->shift, status_name(record->status),
            record->seconds);
    if (recording->points)
        fprintf(log->file, ",%.17g,%.17g,%.17g,%.17g", record->from[0],
                record->from[1], record->to[0], record->to[1]);
    fprintf(log->file, ",%s,%s", solver_name(record->solver),
            kinds[record->kind]);
    if (recording->panes > 1)
        fprintf(log->file, ",%d", pane);
    putc('\n', log->file);
    return check_table(recording, log);
}

/* Empty tables with headers. */
Status recording_restart(Recording *recording, const Options *options)
{
    recording->points = !(options->scene->needs & NEEDS_TIME);
    recording->last_frame = -1;
    Status status = recording_cut(recording, -1);
    return status ? status : write_headers(recording);
}

Status recording_cut(Recording *recording, long step)
{
    Status status = STATUS_OK;
    for (int t = 0; t < RECORDING_TABLES && !status; t++) {
        Output *output = &recording->table[t];
        status = note(recording, output_cut(output, step), output->name, NULL);
    }
    return status;
}

bool recording_has_tables(const Recording *recording)
{
    for (int t = 0; t < RECORDING_TABLES; t++)
        if (recording->table[t].file)
            return true;
    return false;
}

/* Closes one table. */
static Status close_table(Recording *recording, Output *output)
{
    char name[RECORDING_NAME_SIZE];
    snprintf(name, sizeof name, "%s", output->name ? output->name : "");
    if (recording->aside)
        output_discard(output, true);
    return note(recording, output_close(output), name, NULL);
}

/* Film and all tables, also if one of them fails; the first failure counts. */
Status recording_close(Recording *recording)
{
    Status first = recording_end_film(recording);
    for (int t = 0; t < RECORDING_TABLES; t++) {
        Status status = close_table(recording, &recording->table[t]);
        first = first ? first : status;
    }
    return first;
}

void recording_discard(Recording *recording)
{
    film_discard(&recording->film);
    for (int t = 0; t < RECORDING_TABLES; t++)
        output_discard(&recording->table[t], false);
}
