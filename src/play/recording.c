/* recording.c - the tables, frames and films that a run writes. */
#include "play/recording.h"

#include <dirent.h>
#include <errno.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "model/plasticity.h"
#include "model/spring_law.h"

/* A run at a step, from which the rows of tables are written. */
typedef struct RunAtStep {
    const Simulation *simulation;
    const TimeIntegrator *run;
    double step, time;
    int run_index;   /* index of the run in its simulation */
    int pane_number; /* number of the pane, from 1 */
    /* Numbers in the tables: the run, its first node, its first spring. */
    int run_number, first_node, first_spring;
} RunAtStep;

static void add_state_rows(CsvTable *table, const RunAtStep *at)
{
    for (int i = 0; i < at->run->system->nodes; i++) {
        const double *x = at->run->x + 2 * i, *v = at->run->v + 2 * i;
        const double row[] = {at->step, at->time,       at->first_node + i,
                              x[0],     x[1],           v[0],
                              v[1],     at->pane_number};
        table_add_row(table, row);
    }
}

static void add_spring_rows(CsvTable *table, const RunAtStep *at)
{
    const System *system = at->run->system;
    const Plasticity *flow = system_term_data(system, &plastic_energy);
    double d[2];
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * s;
        double l2 = system->l2[s];
        double strain = spring_strain(spring_vector(e, at->run->x, d), l2);
        double spring = at->first_spring + s, i = at->first_node + e[0];
        double j = at->first_node + e[1], whole = !spring_is_broken(system, s);
        double plastic = flow ? flow->ep[s] : 0;
        double flowed = flow ? flow->kappa[s] : 0;
        const double row[] = {at->step, at->time, spring,         i,
                              j,        whole,    sqrt(l2),       strain,
                              plastic,  flowed,   at->pane_number};
        table_add_row(table, row);
    }
}

/* Writes the energies of a run.  An energy that the run does not have is 0. */
static void add_energy_rows(CsvTable *table, const RunAtStep *at)
{
    const Energies energies =
        simulation_get_energies(at->simulation, at->run_index);
    double row[TABLE_MAX_COLUMNS] = {at->step, at->time};
    for (int c = 2; c < table->column_count; c++)
        for (int r = 0; r < energies.count; r++)
            if (strcmp(energies.energy[r].name, table->column[c].name) == 0)
                row[c] = energies.energy[r].value;
    row[table->column_count - 1] = at->run_number;
    table_add_row(table, row);
}

/* Returns the name of a code in a column of the log: a status, a solver, ... */
static const char *get_log_code_name(const char *column, int number)
{
    static const char *const kinds[] = {"value", "estimate"};
    return strcmp(column, "status") == 0   ? status_name((Status)number)
           : strcmp(column, "solver") == 0 ? get_solver_name(number)
                                           : kinds[number];
}

/* The tables, in the order of RecordingTable. */
static const struct {
    size_t file_name_offset; /* offset of the file's name in Options */
    const char *columns;     /* names of columns, for table_add_columns */
    /* Writes a step's rows; NULL for the log, whose rows are iterations. */
    void (*write_rows)(CsvTable *table, const RunAtStep *at);
} kinds[RECORDING_TABLE_COUNT] = {
    {offsetof(Options, states), "step:whole,time,node:whole,x,y,vx,vy",
     add_state_rows},
    {offsetof(Options, log),
     "step:whole,iteration:whole,residual,alpha,trials:whole,slope,change,"
     "projected:whole,factorised:whole,shift,status:text,seconds,"
     "solver:text,kind:text",
     NULL},
    {offsetof(Options, energies), "step:whole,time,total,kinetic,gravity",
     add_energy_rows},
    {offsetof(Options, springs),
     "step:whole,time,spring:whole,i:whole,j:whole,whole:whole,rest,strain,"
     "plastic,flowed",
     add_spring_rows},
};

/* Writes a picture as PNG.  After FILE_FAILED errno of libpng says why. */
static Status png_write(FILE *file, const Canvas *canvas)
{
    size_t count = (size_t)canvas->width * (size_t)canvas->height;
    png_image image = {.version = PNG_IMAGE_VERSION,
                       .width = (png_uint_32)canvas->width,
                       .height = (png_uint_32)canvas->height,
                       .format = PNG_FORMAT_RGB,
                       .flags = PNG_IMAGE_FLAG_FAST};
    uint8_t *bytes = malloc(3 * count);
    if (!bytes)
        return STATUS_OUT_OF_MEMORY;
    for (size_t i = 0; i < 3 * count; i++)
        bytes[i] = (uint8_t)(canvas->pixels[i / 3] >> (16 - i % 3 * 8));
    errno = 0;
    bool whole = png_image_write_to_stdio(&image, file, 0, bytes, 0, NULL);
    free(bytes);
    return whole             ? STATUS_OK
           : errno == ENOMEM ? STATUS_OUT_OF_MEMORY
                             : STATUS_FILE_FAILED;
}

Status png_file_write(const char *name, char *message, const Canvas *canvas)
{
    OutputFile output;
    Status status = output_open(name, message, &output);
    if (status)
        return status;
    status = png_write(output.file, canvas);
    if (!status)
        return output_close(&output, KEEP_FILE);
    output_fill_message(message, name, status, NULL);
    output_close(&output, KEEP_PART_FILE);
    return status;
}

/* Finds the frames that an earlier run has left in the folder. */
static void find_old_frames(Recording *recording)
{
    DIR *folder = opendir(recording->folder);
    struct dirent *file;
    recording->is_old_frame = calloc(MAX_FRAMES, 1);
    while (folder && recording->is_old_frame && (file = readdir(folder))) {
        int end = 0, step = 0;
        if (sscanf(file->d_name, "frame_%6d.png%n", &step, &end) == 1 &&
            end == (int)strlen("frame_000000.png") && !file->d_name[end] &&
            step >= 0)
            recording->is_old_frame[step] = 1;
    }
    if (folder)
        closedir(folder);
}

/* Opens a table if the options name its file.  Energies have a column for each
 * energy of any scene; with several panes other tables have a column `pane`. */
static Status open_table(const Options *options, Recording *recording, int t)
{
    CsvTable *table = &recording->table[t];
    const char *name =
        *(char *const *)((const char *)options + kinds[t].file_name_offset);
    if (!name)
        return STATUS_OK;
    recording->uses_stdout = recording->uses_stdout || output_is_stdout(name);
    recording->has_tables = true;
    table->get_text = get_log_code_name;
    table_add_columns(table, kinds[t].columns);
    for (const OptionRow *row = option_rows; row->name; row++)
        if (t == ENERGIES_TABLE && row->term) {
            table_add_columns(table, row->term->energy_name);
            table_add_columns(table, row->term->loss_name);
        }
    if (t == ENERGIES_TABLE)
        table_add_columns(table, "work,dissipated,run:whole");
    else if (recording->pane_count > 1)
        table_add_columns(table, "pane:whole");
    return table_open(name, recording->message, table);
}

Status recording_open(const Options *options, Recording *recording)
{
    const char *folder = options->frames;
    *recording = (Recording){.folder = folder, .pane_count = options->panes};
    char *message = recording->message;
    Status status = STATUS_OK;
    if (folder && mkdir(folder, 0777) && errno != EEXIST)
        status = output_fill_message(message, folder, STATUS_FILE_FAILED, NULL);
    if (!status && folder)
        find_old_frames(recording);
    if (!status && options->film)
        status = film_open(options->film, message, &recording->film);
    for (int t = 0; t < RECORDING_TABLE_COUNT && !status; t++)
        status = open_table(options, recording, t);
    return status;
}

Status recording_write_frame(Recording *recording, const Canvas *canvas,
                             long step, int times)
{
    Film *film = &recording->film;
    char name[PATH_BYTES];
    Status status =
        film_is_open(film) ? film_add_frame(film, canvas, times) : STATUS_OK;
    if (status || !recording->folder)
        return status;
    snprintf(name, sizeof name, "%s/frame_%06ld.png", recording->folder, step);
    recording->frame_count++;
    if (recording->is_old_frame && step < MAX_FRAMES)
        recording->is_old_frame[step] = 0;
    return png_file_write(name, recording->message, canvas);
}

Status recording_write_states(Recording *recording, bool energies_only,
                              const Simulation *const *simulation, int count,
                              long step)
{
    RunAtStep at = {.step = (double)step};
    Status status = STATUS_OK;
    for (int i = 0; i < count; i++)
        for (int r = 0; r < simulation[i]->runs; r++) {
            at.simulation = simulation[i];
            at.run = &simulation[i]->run[r];
            at.time = simulation_get_time(simulation[i]);
            at.run_index = r;
            at.pane_number = i + 1;
            for (int t = 0; t < RECORDING_TABLE_COUNT; t++)
                if (kinds[t].write_rows && recording->table[t].output.file &&
                    (!energies_only || t == ENERGIES_TABLE))
                    kinds[t].write_rows(&recording->table[t], &at);
            at.run_number++;
            at.first_node += at.run->system->nodes;
            at.first_spring += at.run->system->springs;
        }
    for (int t = 0; t < RECORDING_TABLE_COUNT && !status; t++)
        status = table_status(&recording->table[t]);
    return status;
}

Status recording_write_iteration(Recording *recording, const NewtonRecord *at,
                                 int pane)
{
    CsvTable *log = &recording->table[LOG_TABLE];
    /* An iteration below 0 is the end of a step by a prescribed motion. */
    double iteration = at->iteration < 0 ? NAN : at->iteration;
    double step = (double)at->step_number;
    double row[] = {step,
                    iteration,
                    at->residual,
                    at->alpha,
                    at->trials,
                    at->slope,
                    at->energy_change,
                    at->projected_blocks,
                    at->has_new_factor,
                    at->shift,
                    at->status,
                    at->seconds,
                    at->solver,
                    at->residual_kind,
                    pane};
    if (log->output.file)
        table_add_row(log, row);
    return table_status(log);
}

/* Flushes all tables before the first file gets its name. */
Status recording_close(Recording *recording, CloseAction keep)
{
    bool failed = recording->message[0];
    for (int t = 0; t < RECORDING_TABLE_COUNT; t++) {
        FILE *file = recording->table[t].output.file;
        if (file)
            fflush(file);
        failed = table_status(&recording->table[t]) || failed;
    }
    keep = failed && !keep ? KEEP_PART_FILE : keep;
    failed = film_close(&recording->film, keep) || failed;
    for (int t = 0; t < RECORDING_TABLE_COUNT; t++) {
        keep = failed && !keep ? KEEP_PART_FILE : keep;
        failed = output_close(&recording->table[t].output, keep) || failed;
    }
    return failed ? STATUS_FILE_FAILED : STATUS_OK;
}
