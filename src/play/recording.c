#include "play/recording.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "scenes/one_line.h"
#include "play/png_file.h"
#include "scenes/scene.h"

/* Remembers the first failure; returns status. */
static Status recording_note(Recording *recording, Status status,
                             const char *name)
{
    if (status && status != STATUS_INVALID_INPUT && recording->reason == 0) {
        recording->reason = status == STATUS_OUT_OF_MEMORY ? ENOMEM
                            : errno                        ? errno
                                                           : EIO;
        snprintf(recording->failed, sizeof recording->failed, "%s", name);
    }
    return status;
}

/* Makes the folder, or finds that it is there. */
static Status make_folder(const char *name)
{
    struct stat info;
    if (mkdir(name, 0777) == 0)
        return STATUS_OK;
    if (errno != EEXIST)
        return STATUS_FILE_FAILED;
    if (stat(name, &info) == 0 && S_ISDIR(info.st_mode))
        return STATUS_OK;
    errno = ENOTDIR;
    return STATUS_FILE_FAILED;
}

/* The lines above the columns. */
static Status write_headers(Recording *recording)
{
    if (recording->states.file &&
        fputs("step,time,node,x,y,vx,vy\n", recording->states.file) < 0)
        return recording_note(recording, STATUS_FILE_FAILED,
                              recording->states.name);
    if (!recording->log.file)
        return STATUS_OK;
    if (fputs("step,iteration,residual,alpha,trials,slope,change,projected,"
              "factorised,shift,status,seconds",
              recording->log.file) < 0)
        return recording_note(recording, STATUS_FILE_FAILED,
                              recording->log.name);
    if (recording->points)
        fputs(",from_x,from_y,to_x,to_y", recording->log.file);
    fputs(recording->panes > 1 ? ",solver,pane\n" : ",solver\n",
          recording->log.file);
    return recording_note(recording, output_check(&recording->log),
                          recording->log.name);
}

/* Opens one file of the two, if it has a name. */
static Status open_table(Recording *recording, const char *name, Output *output)
{
    if (!name)
        return STATUS_OK;
    return recording_note(recording, output_open(name, output), name);
}

/* Frames a second of films. */
static const double FILM_RATE = 60;

Status recording_film(Recording *recording, const char *name)
{
    return recording_note(recording,
                          film_open(name, FILM_RATE, &recording->film,
                                    recording->message,
                                    sizeof recording->message),
                          name);
}

Status recording_end_film(Recording *recording)
{
    char name[RECORDING_NAME_SIZE];
    const Film *film = &recording->film;
    snprintf(name, sizeof name, "%s",
             film->output.name ? film->output.name : "");
    long frames = film_runs(film) ? film->frames : 0;
    Status status =
        recording_note(recording, film_close(&recording->film), name);
    if (!status && frames > 0) {
        recording->films++;
        recording->film_frames = frames;
        memcpy(recording->film_name, name, sizeof name);
    }
    return status;
}

bool recording_wants_frames(const Recording *recording)
{
    return recording->folder || film_runs(&recording->film);
}

/* Folder, film, states, log. */
Status recording_open(const Options *options, int panes, Recording *recording)
{
    *recording = (Recording){
        .folder = options->frames, .last_frame = -1, .panes = panes};
    recording->points = !(options->scene->needs & NEEDS_TIME);
    Status status = STATUS_OK;
    if (recording->folder)
        status = recording_note(recording, make_folder(recording->folder),
                                recording->folder);
    if (!status && options->film)
        status = recording_film(recording, options->film);
    if (!status)
        status = open_table(recording, options->states, &recording->states);
    if (!status)
        status = open_table(recording, options->log, &recording->log);
    if (!status)
        status = write_headers(recording);
    if (status)
        recording_discard(recording); /* what stood there before stays */
    return status;
}

/* A copy of a text up to its end, without slashes there; NULL: no memory. */
static char *folder_name(const char *text, size_t length)
{
    while (length > 1 && text[length - 1] == '/')
        length--;
    return strndup(length > 0 ? text : ".", length > 0 ? length : 1);
}

/* Whether a table would have the name of a frame in this folder. */
static bool is_frame(const char *folder, const char *name)
{
    const char *slash = strrchr(name, '/'), *base = slash ? slash + 1 : name;
    if (strncmp(base, "frame_", strlen("frame_")) != 0)
        return false;
    char *one = folder_name(folder, strlen(folder));
    char *other = folder_name(name, slash ? (size_t)(slash + 1 - name) : 0);
    char *a = one ? output_target(one) : NULL;
    char *b = other ? output_target(other) : NULL;
    bool same = a && b && strcmp(a, b) == 0;
    free(one);
    free(other);
    free(a);
    free(b);
    return same;
}

/* Every two names. */
Status recording_check(const Options *options, char *message, size_t size)
{
    const char *states = options->states, *log = options->log;
    const char *frames = options->frames, *table = NULL;
    char shown[64], other[64];
    if (states && log && output_collides(states, log)) {
        one_line(states, shown, sizeof shown);
        one_line(log, other, sizeof other);
        snprintf(message, size,
                 "--states '%s' and --log '%s' would be written into one "
                 "another: two different files, at most one of them \"-\"",
                 shown, other);
        return STATUS_INVALID_INPUT;
    }
    if (frames && states && is_frame(frames, states))
        table = states;
    if (frames && log && is_frame(frames, log))
        table = log;
    if (!table)
        return STATUS_OK;
    one_line(table, shown, sizeof shown);
    one_line(frames, other, sizeof other);
    snprintf(message, size,
             "--%s '%s' would be a frame of --frames '%s': any name that does "
             "not begin with frame_",
             table == states ? "states" : "log", shown, other);
    return STATUS_INVALID_INPUT;
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
    return recording_note(recording, status, name);
}

Status recording_frame(Recording *recording, const Canvas *canvas, long step,
                       int shown)
{
    Film *film = &recording->film;
    Status status = STATUS_OK;
    int every = recording->film_every > 1 ? (int)recording->film_every : 1;
    if (film_runs(film) && step % every == 0)
        status =
            recording_note(recording, film_add(film, canvas, shown * every),
                           film->output.name);
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

/* Run by run. */
Status recording_states(Recording *recording,
                        const Simulation *const *simulation, int count,
                        long step)
{
    int first = 0;
    Output *states = &recording->states;
    if (!states->file)
        return STATUS_OK;
    errno = 0;
    for (int i = 0; i < count; i++)
        for (int r = 0; r < simulation[i]->runs; r++) {
            write_run(states->file, simulation[i], &simulation[i]->run[r], step,
                      first);
            first += simulation[i]->system.nodes;
        }
    return recording_note(recording, output_check(states), states->name);
}

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
    fprintf(log->file, ",%s", solver_name(record->solver));
    if (recording->panes > 1)
        fprintf(log->file, ",%d", pane);
    putc('\n', log->file);
    return recording_note(recording, output_check(log), log->name);
}

/* Empty tables with headers. */
Status recording_restart(Recording *recording, const Options *options)
{
    recording->points = !(options->scene->needs & NEEDS_TIME);
    recording->last_frame = -1;
    Status status =
        recording_note(recording, output_restart(&recording->states), "states");
    if (!status)
        status =
            recording_note(recording, output_restart(&recording->log), "log");
    return status ? status : write_headers(recording);
}

Status recording_cut(Recording *recording, long step)
{
    Status status = recording_note(
        recording, output_cut(&recording->states, step), "states");
    if (!status)
        status =
            recording_note(recording, output_cut(&recording->log, step), "log");
    return status;
}

/* Closes one table; after a failed write NAME.part keeps what there is. */
static Status close_table(Recording *recording, Output *output,
                          const char *name)
{
    char copy[RECORDING_NAME_SIZE];
    snprintf(copy, sizeof copy, "%s", output->name ? output->name : name);
    Status status = recording->aside ? output_set_aside(output)
                                     : output_close(output, true);
    return recording_note(recording, status, copy);
}

/* Film and both tables, also if one of them fails. */
Status recording_close(Recording *recording)
{
    Status film = recording_end_film(recording);
    Status states = close_table(recording, &recording->states, "states");
    Status log = close_table(recording, &recording->log, "log");
    return film ? film : states ? states : log;
}

void recording_discard(Recording *recording)
{
    film_discard(&recording->film);
    output_discard(&recording->states);
    output_discard(&recording->log);
}
