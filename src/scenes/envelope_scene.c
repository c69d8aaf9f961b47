#include "scenes/small_scenes.h"

#include <math.h>
#include <stdlib.h>

#include "scenes/body.h"

double envelope_timestep(int column)
{
    return pow(10, 0.5 * column - 9);
}

double envelope_stiffness(int row)
{
    return pow(10, row - 6);
}

/* The column or row whose logarithm is nearest. */
static int nearest(double value, double first, double per_ten, int count)
{
    double place = round((log10(value) - first) * per_ten);
    return (int)fmin(fmax(place, 0), count - 1);
}

/* Makes the square of this cell, with its start as run 0. */
static Status open_cell(Simulation *simulation, int column, int row)
{
    const Options *options = &simulation->options;
    const NewtonSettings settings = {.h = envelope_timestep(column),
                                     .tolerance = options->tolerance,
                                     .solver = options->solver,
                                     .filter = options->filter,
                                     .search = options->line_search,
                                     .max_iterations = 10000};
    double k = envelope_stiffness(row);
    const double *rest = simulation->mesh.x;
    int nodes = simulation->system.nodes;
    double *x = malloc(2 * (size_t)nodes * sizeof *x);
    double *v = calloc(2 * (size_t)nodes, sizeof *v);
    Status status = x && v ? STATUS_OK : STATUS_OUT_OF_MEMORY;
    for (int i = 0; i < nodes && !status; i++) {
        x[2 * i] = options->stretch * rest[2 * i];
        x[2 * i + 1] = rest[2 * i + 1];
    }
    for (int s = 0; s < simulation->system.springs; s++)
        simulation->system.k[s] = k;
    time_integrator_free(&simulation->run[0]);
    simulation->run[0] = (TimeIntegrator){0};
    if (!status)
        status =
            time_integrator_create(&integrator_methods[0], &simulation->system,
                                   &settings, x, v, &simulation->run[0]);
    free(x);
    free(v);
    return status;
}

Status envelope_visit(Simulation *simulation, int column, int row)
{
    EnvelopeMap *map = &simulation->exhibit.map;
    EnvelopeCell *cell = &map->cell[row][column];
    TimeIntegrator *run = &simulation->run[0];
    Status status = open_cell(simulation, column, row), worst = STATUS_OK;
    if (status)
        return status;
    for (int i = 0; i < ENVELOPE_STEPS; i++) {
        status = time_integrator_step(run);
        if (status)
            worst = status;
        if (status && !status_is_unconverged(status))
            break;
    }
    *cell = (EnvelopeCell){.known = true,
                           .worst = worst,
                           .updates = (int)run->newton->counters.iterations};
    cell->undone =
        !worst && cell->updates == 0 && !simulation_rests(simulation);
    map->column = column;
    map->row = row;
    return worst == STATUS_OUT_OF_MEMORY ? worst : STATUS_OK;
}

Status create_envelope(Simulation *simulation, const NewtonSettings *settings)
{
    const Options *options = &simulation->options;
    Status status = create_square(simulation, settings);
    if (status)
        return status;
    return envelope_visit(simulation,
                          nearest(options->timestep, -9, 2, ENVELOPE_COLUMNS),
                          nearest(options->stiffness, -6, 1, ENVELOPE_ROWS));
}

/* The cell that was shown before is shown again after it. */
Status step_envelope(Simulation *simulation)
{
    const EnvelopeMap *map = &simulation->exhibit.map;
    int row = (int)simulation->steps, shown[2] = {map->column, map->row};
    Status status = STATUS_OK;
    for (int column = 0; column < ENVELOPE_COLUMNS && !status; column++)
        status = envelope_visit(simulation, column, row);
    if (!status)
        status = envelope_visit(simulation, shown[0], shown[1]);
    simulation->done = row + 1 >= ENVELOPE_ROWS;
    return status;
}
