#include "play/recording.h"

#include <errno.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "model/area.h"
#include "model/mass_spring_energy.h"
#include "model/plasticity.h"

/* ---- kinds of tables ----------------------------------------------------- */

/* A run at a step: what the rows of a table are about. */
typedef struct Moment {
    const Simulation *simulation;
    const TimeIntegrator *run;
    double step, time;
    int number;               /* of the run in its simulation */
    int pane;                 /* from 1 */
    int runs, nodes, springs; /* before it, in panes before it, too */
} Moment;

static void add_states(Table *table, const Moment *at)
{
    for (int i = 0; i < at->run->system->nodes; i++) {
        const double *x = at->run->x + 2 * i, *v = at->run->v + 2 * i;
        const double row[] = {at->step, at->time, at->nodes + i, x[0],
                              x[1],     v[0],     v[1],          at->pane};
        table_add(table, row);
    }
}

static void add_springs(Table *table, const Moment *at)
{
    const System *system = at->run->system;
    const Plasticity *flow = system_data(system, &plastic_energy);
    double d[2];
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * s;
        double l2 = system->l2[s], strain = spring_strain(e, l2, at->run->x, d);
        double spring = at->springs + s, i = at->nodes + e[0];
        double j = at->nodes + e[1], whole = !spring_is_broken(system, s);
        double plastic = flow ? flow->ep[s] : 0;
        double flowed = flow ? flow->kappa[s] : 0;
        const double row[] = {at->step, at->time, spring,   i,
                              j,        whole,    sqrt(l2), strain,
                              plastic,  flowed,   at->pane};
        table_add(table, row);
    }
}

/* 0 where the run has no such row. */
static void add_energies(Table *table, const Moment *at)
{
    const Energies energies = simulation_energies(at->simulation, at->number);
    double row[TABLE_COLUMNS] = {at->step, at->time};
    for (int c = 2; c < table->columns; c++)
        for (int r = 0; r < energies.rows; r++)
            if (strcmp(energies.row[r].name, table->column[c].name) == 0)
                row[c] = energies.row[r].value;
    row[table->columns - 1] = at->runs;
    table_add(table, row);
}

/* ParaView's list has a line a step. */
static void add_step(Table *table, const Moment *at)
{
    const double row[] = {at->step, at->time};
    if (at->runs == 0)
        table_add(table, row);
}

/* The log's texts; what is known of a residual. */
static const char *log_text(const char *column, int place)
{
    static const char *const kinds[] = {"value", "estimate", "bound"};
    return strcmp(column, "status") == 0   ? status_name((Status)place)
           : strcmp(column, "solver") == 0 ? solver_name(place)
                                           : kinds[place];
}

/* In the order of enum RecordingTable. */
static const struct {
    size_t file; /* its name in the options; of steps, their folder's */
    const char *columns, *pane;
    void (*add)(Table *table, const Moment *at); /* NULL: the log */
} kinds[RECORDING_TABLES] = {
    {offsetof(Options, states), "step:whole,time,node:place,x,y,vx,vy",
     "pane:place", add_states},
    {offsetof(Options, log),
     "step:whole,iteration:whole,residual,alpha,trials:whole,slope,change,"
     "projected:whole,factorised:whole,shift,status:text,seconds,"
     "solver:text,kind:text",
     "pane:whole", NULL},
    {offsetof(Options, energies), "step:whole,time,total,kinetic,gravity", NULL,
     add_energies},
    {offsetof(Options, springs),
     "step:whole,time,spring:place,i:place,j:place,whole:whole,rest,strain,"
     "plastic,flowed",
     "pane:place", add_springs},
    {offsetof(Options, vtk), "step:whole,time", NULL, add_step},
};

/* ---- pictures ------------------------------------------------------------ */

/* libpng's simplified writer wants red, green and blue of each pixel; it leaves
 * errno of a failed write alone. */
Status png_write(FILE *file, const Canvas *canvas, bool small)
{
    size_t count = (size_t)canvas->width * (size_t)canvas->height;
    png_image image = {.version = PNG_IMAGE_VERSION,
                       .width = (png_uint_32)canvas->width,
                       .height = (png_uint_32)canvas->height,
                       .format = PNG_FORMAT_RGB,
                       .flags = small ? 0 : PNG_IMAGE_FLAG_FAST};
    uint8_t *bytes = malloc(3 * count);
    if (!bytes)
        return STATUS_OUT_OF_MEMORY;
    for (size_t i = 0; i < 3 * count; i++)
        bytes[i] = (uint8_t)(canvas->pixels[i / 3] >> (16 - i % 3 * 8));
    errno = 0;
    bool whole = png_image_write_to_stdio(&image, file, 0, bytes, 0, NULL);
    int reason = errno;
    png_image_free(&image);
    free(bytes);
    errno = reason ? reason : EIO;
    return whole             ? STATUS_OK
           : errno == ENOMEM ? STATUS_OUT_OF_MEMORY
                             : STATUS_FILE_FAILED;
}

Status png_file_write(const char *name, char *told, const Canvas *canvas)
{
    Output output;
    Status status = output_open(name, told, &output);
    if (status)
        return status;
    status = png_write(output.file, canvas, false);
    if (!status)
        return output_close(&output, KEEP_WHOLE);
    output_tell(told, name, status, NULL);
    output_close(&output, KEEP_PART);
    return status;
}

/* ---- ParaView ------------------------------------------------------------ */

/* A step is an unstructured grid in XML: points are the nodes of all runs, in
 * the order of the states, with velocity (m/s) and run; cells are the springs
 * that are whole and the triangles whose sides are (square_mesh_is_half), with
 * a strain: Green's |d|^2/l2 - 1, of a triangle what its area has grown by, as
 * a part.  17 digits: reading them gives the same double. */
/* A step's file in the folder. */
#define VTK_FILE "step_%06ld.vtu"

enum { PARTS = OPTIONS_MAX_PANES * SIMULATION_MAX_RUNS };

/* Nodes of a cell, and what VTK calls it. */
enum { LINE = 2, TRIANGLE = 3, VTK_LINE = 3, VTK_TRIANGLE = 5 };

/* A run. */
typedef struct Part {
    const SquareMesh *mesh;
    const TimeIntegrator *run;
    int first; /* the number of its node 0 */
} Part;

typedef enum Array {
    POSITION,
    VELOCITY,
    RUN,
    NODES, /* from here on of cells: springs and triangles */
    ENDS,  /* of a cell in the list of nodes */
    TYPES,
    STRAIN,
    ARRAYS /* none: cells are only counted */
} Array;

static const struct {
    const char *before, *type, *name;
    int components;
} arrays[ARRAYS] = {
    {"<Points>", "Float64", "position", 3},
    {"</Points>\n<PointData Vectors=\"velocity\">", "Float64", "velocity", 3},
    {"", "Int32", "run", 1},
    {"</PointData>\n<Cells>", "Int32", "connectivity", 1},
    {"", "Int32", "offsets", 1},
    {"", "UInt8", "types", 1},
    {"</Cells>\n<CellData Scalars=\"strain\">", "Float64", "strain", 1},
};

/* Spring i or, behind the springs, a triangle: its nodes and how it is
 * strained, out.  Returns how many nodes; 0 where a spring is broken, or the
 * mesh is not cut so. */
static int get_cell(const Part *part, int i, int node[3], double *strain)
{
    const System *system = part->run->system;
    const double *x = part->run->x;
    int triangle = i - system->springs, side[3];
    double d[2], e[2], spacing = part->mesh->spacing;
    if (triangle < 0) {
        memcpy(node, system->e + 2 * i, 2 * sizeof *node);
        *strain = spring_strain(node, system->l2[i], x, d);
        return spring_is_broken(system, i) ? 0 : LINE;
    }
    bool whole = square_mesh_is_half(part->mesh, triangle);
    square_mesh_triangle(part->mesh, triangle, node, side);
    for (int k = 0; k < 3; k++)
        whole = whole && !spring_is_broken(system, side[k]);
    for (int k = 0; k < 2; k++) {
        d[k] = x[2 * node[1] + k] - x[2 * node[0] + k];
        e[k] = x[2 * node[2] + k] - x[2 * node[0] + k];
    }
    *strain = cross(d, e) / (spacing * spacing) - 1;
    return whole ? TRIANGLE : 0;
}

/* The numbers of an array.  Returns of how many nodes or cells. */
static int put_numbers(FILE *file, const Part *part, int parts, Array array)
{
    int count = 0, end = 0, corners = 1, node[3];
    double strain;
    for (int p = 0; p < parts; p++) {
        const TimeIntegrator *run = part[p].run;
        const double *at = array == POSITION ? run->x : run->v;
        int all = array < NODES
                      ? run->system->nodes
                      : run->system->springs + 4 * part[p].mesh->cells;
        for (int i = 0; i < all; i++) {
            if (array >= NODES)
                corners = get_cell(&part[p], i, node, &strain);
            count += corners > 0;
            end += corners;
            if (array == POSITION || array == VELOCITY)
                fprintf(file, "%.17g %.17g 0\n", at[2 * i], at[2 * i + 1]);
            else if (array == STRAIN && corners > 0)
                fprintf(file, "%.17g\n", strain);
            else if (array == NODES)
                for (int k = 0; k < corners; k++)
                    fprintf(file, "%d\n", part[p].first + node[k]);
            else if (array != ARRAYS && corners > 0)
                fprintf(file, "%d\n",
                        array == RUN      ? p
                        : array == ENDS   ? end
                        : corners == LINE ? VTK_LINE
                                          : VTK_TRIANGLE);
        }
    }
    return count;
}

/* One step, `count` simulations as they are, whole or not at all. */
static Status vtk_write(const char *name, char *told,
                        const Simulation *const *simulation, int count)
{
    Part part[PARTS];
    Output output;
    int parts = 0, nodes = 0;
    Status status = output_open(name, told, &output);
    FILE *file = output.file;
    if (status)
        return status;
    for (int i = 0; i < count; i++)
        for (int r = 0; r < simulation[i]->runs; r++) {
            const TimeIntegrator *run = &simulation[i]->run[r];
            part[parts++] = (Part){&simulation[i]->mesh, run, nodes};
            nodes += run->system->nodes;
        }
    fprintf(file,
            "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\">\n"
            "<UnstructuredGrid>\n"
            "<Piece NumberOfPoints=\"%d\" NumberOfCells=\"%d\">\n",
            nodes, put_numbers(NULL, part, parts, ARRAYS));
    for (Array array = 0; array < ARRAYS; array++) {
        fprintf(file,
                "%s\n<DataArray type=\"%s\" Name=\"%s\" "
                "NumberOfComponents=\"%d\" format=\"ascii\">\n",
                arrays[array].before, arrays[array].type, arrays[array].name,
                arrays[array].components);
        put_numbers(file, part, parts, array);
        fputs("</DataArray>\n", file);
    }
    fputs("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n", file);
    return output_close(&output, KEEP_WHOLE);
}

void pvd_write(const Table *table, FILE *file)
{
    double row[TABLE_COLUMNS];
    fputs("<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n",
          file);
    rewind(table->rows);
    while (table_next(table, row))
        fprintf(file, "<DataSet timestep=\"%.17g\" file=\"" VTK_FILE "\"/>\n",
                row[1], (long)row[0]);
    fputs("</Collection>\n</VTKFile>\n", file);
}

/* ---- all together -------------------------------------------------------- */

/* Opens a table, if there is one; of a folder's steps it is their list.  The
 * ledger has all that a scene may have, and of several panes a row says which.
 */
static Status open_table(const Options *options, Recording *recording, int t)
{
    Table *table = &recording->table[t];
    const char *name = *(char *const *)((const char *)options + kinds[t].file);
    char list[OUTPUT_NAME];
    if (!name)
        return STATUS_OK;
    snprintf(list, sizeof list, "%s/steps.pvd", name);
    if (t == RECORDING_VTK)
        name = list;
    recording->standard = recording->standard || output_is_standard(name);
    recording->tables = true;
    table->text = log_text;
    table_columns(table, kinds[t].columns);
    for (const OptionRow *row = option_rows; row->name; row++)
        if (t == RECORDING_ENERGIES && row->term) {
            table_columns(table, row->term->energy);
            table_columns(table, row->term->loss);
        }
    if (t == RECORDING_ENERGIES)
        table_columns(table, "work,dissipated,run:place");
    else if (recording->panes > 1)
        table_columns(table, kinds[t].pane);
    return table_open(name, recording->message, table);
}

Status recording_open(const Options *options, int panes, Recording *recording)
{
    *recording = (Recording){
        .folder = options->frames, .vtk = options->vtk, .panes = panes};
    const char *const folder[] = {options->frames, options->vtk};
    char *told = recording->message;
    Status status = STATUS_OK;
    for (int i = 0; i < 2 && !status; i++) /* the first file shows if it is */
        if (folder[i] && mkdir(folder[i], 0777) && errno != EEXIST)
            status = output_tell(told, folder[i], STATUS_FILE_FAILED, NULL);
    if (!status && options->film)
        status = film_open(options->film, told, &recording->film);
    for (int t = 0; t < RECORDING_TABLES && !status; t++)
        status = open_table(options, recording, t);
    return status;
}

Status recording_frame(Recording *recording, const Canvas *canvas, long step,
                       int shown)
{
    Film *film = &recording->film;
    char name[OUTPUT_NAME];
    Status status = film_runs(film) ? film_add(film, canvas, shown) : STATUS_OK;
    if (status || !recording->folder)
        return status;
    snprintf(name, sizeof name, "%s/frame_%06ld.png", recording->folder, step);
    recording->frames++;
    return png_file_write(name, recording->message, canvas);
}

Status recording_states(Recording *recording,
                        const Simulation *const *simulation, int count,
                        long step)
{
    Moment at = {.step = (double)step};
    char name[OUTPUT_NAME];
    Status status = STATUS_OK;
    if (recording->vtk) {
        snprintf(name, sizeof name, "%s/" VTK_FILE, recording->vtk, step);
        status = vtk_write(name, recording->message, simulation, count);
    }
    for (int i = 0; i < count && !status; i++)
        for (int r = 0; r < simulation[i]->runs; r++) {
            at.simulation = simulation[i];
            at.run = &simulation[i]->run[r];
            at.time = simulation_time(simulation[i]);
            at.number = r;
            at.pane = i + 1;
            for (int t = 0; t < RECORDING_TABLES; t++)
                if (kinds[t].add && recording->table[t].output.file)
                    kinds[t].add(&recording->table[t], &at);
            at.runs++;
            at.nodes += at.run->system->nodes;
            at.springs += at.run->system->springs;
        }
    for (int t = 0; t < RECORDING_TABLES && !status; t++)
        status = table_check(&recording->table[t]);
    return status;
}

Status recording_update(Recording *recording, const NewtonRecord *record,
                        int pane)
{
    Table *log = &recording->table[RECORDING_LOG];
    double row[] = {(double)record->step, record->iteration, record->residual,
                    record->alpha,        record->trials,    record->slope,
                    record->change,       record->projected, record->factorised,
                    record->shift,        record->status,    record->seconds,
                    record->solver,       record->kind,      pane};
    if (log->output.file)
        table_add(log, row);
    return table_check(log);
}

Status recording_cut(Recording *recording, long step)
{
    Status status = STATUS_OK;
    for (int t = 0; t < RECORDING_TABLES && !status; t++)
        status = table_cut(&recording->table[t], step);
    return status;
}

/* All tables are ended before the first file is given its name. */
Status recording_close(Recording *recording, Keep keep)
{
    bool failed = recording->message[0];
    for (int t = 0; t < RECORDING_TABLES; t++)
        failed = table_end(&recording->table[t]) || failed;
    keep = failed && !keep ? KEEP_PART : keep;
    failed = film_close(&recording->film, keep) || failed;
    for (int t = 0; t < RECORDING_TABLES; t++) {
        keep = failed && !keep ? KEEP_PART : keep;
        failed = table_close(&recording->table[t], keep) || failed;
    }
    return failed ? STATUS_FILE_FAILED : STATUS_OK;
}
