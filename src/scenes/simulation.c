#include "scenes/simulation.h"

#include <math.h>
#include <stddef.h>

#include "scenes/scene.h"

/* More updates than any step needs that ends at all; 1024 segments need some
 * thousands. */
enum { MAX_NEWTON_ITERATIONS = 10000 };

Status simulation_create(const Options *options, NewtonObserver observer,
                         void *user, Simulation *simulation)
{
    *simulation = (Simulation){.scene = options->scene,
                               .options = *options,
                               .observer = observer,
                               .user = user};
    NewtonSettings settings = {
        .h = options->timestep,
        .tolerance = options->tolerance,
        .solver = options->solver,
        .filter = options->filter,
        .search = options->line_search,
        .max_iterations = MAX_NEWTON_ITERATIONS,
        .observer = observer,
        .user = user,
    };
    return options->scene->create(simulation, &settings);
}

void simulation_free(Simulation *simulation)
{
    if (!simulation)
        return;
    for (int i = 0; i < SIMULATION_MAX_RUNS; i++)
        time_integrator_free(&simulation->run[i]);
    system_free(&simulation->system);
    square_mesh_free(&simulation->mesh);
    *simulation = (Simulation){0};
}

/* A step in time of every run; the last status that is not OK counts. */
static Status step_runs(Simulation *simulation)
{
    Status worst = STATUS_OK;
    for (int i = 0; i < simulation->runs; i++) {
        Status status = time_integrator_step(&simulation->run[i]);
        if (status)
            worst = status;
        if (status && !status_is_unconverged(status))
            break;
    }
    return worst;
}

int simulation_point(const Simulation *simulation, double at[2])
{
    const TimeIntegrator *run = &simulation->run[0];
    bool single = simulation->system.nodes == 1 || simulation->scene->aim;
    bool scalar = simulation->descent.scalar.f.value;
    if (!single || !run->x)
        return 0;
    at[0] = run->x[0];
    at[1] = run->x[1];
    return scalar ? 1 : 2;
}

void simulation_predict(Simulation *simulation, double x, double y)
{
    double at[2];
    if (simulation->done || !simulation_point(simulation, at))
        return;
    simulation->prediction = (Prediction){.made = true, .at = {x, y}};
}

/* A guess that was made is held against where the step led; one that was
 * compared before is forgotten. */
static void compare_prediction(Simulation *simulation)
{
    Prediction *prediction = &simulation->prediction;
    if (prediction->shown)
        *prediction = (Prediction){0};
    if (!prediction->made)
        return;
    int count = simulation_point(simulation, prediction->came);
    double dx = prediction->came[0] - prediction->at[0];
    double dy = count > 1 ? prediction->came[1] - prediction->at[1] : 0;
    prediction->distance = hypot(dx, dy);
    prediction->shown = true;
}

Status simulation_step(Simulation *simulation)
{
    const struct Scene *scene = simulation->scene;
    if (simulation->done)
        return STATUS_OK;
    simulation->status =
        scene->step ? scene->step(simulation) : step_runs(simulation);
    if (simulation->status && !status_is_unconverged(simulation->status))
        return simulation->status;
    simulation->steps++;
    compare_prediction(simulation);
    if (simulation->status && simulation->unconverged++ == 0)
        simulation->first = simulation->status;
    return simulation->status;
}

bool simulation_record(Simulation *simulation, const NewtonRecord *record)
{
    Descent *descent = &simulation->descent;
    if (descent->count < DESCENT_MAX)
        descent->record[descent->count++] = *record;
    return !simulation->observer ||
           simulation->observer(simulation->user, record);
}

double simulation_time(const Simulation *simulation)
{
    if (!(simulation->scene->needs & NEEDS_TIME))
        return 0;
    return (double)simulation->steps * simulation->options.timestep;
}

Energies simulation_energies(const Simulation *simulation, int run)
{
    const TimeIntegrator *integrator = &simulation->run[run];
    Energies energies;
    energies.kinetic = system_kinetic(&simulation->system, integrator->v);
    energies.gravity =
        system_gravity_potential(integrator->system, integrator->x);
    energies.elastic = system_potential(integrator->system, integrator->x);
    energies.total = energies.kinetic + energies.elastic + energies.gravity;
    return energies;
}

/* sum += counters */
static void add_counters(const NewtonCounters *counters, NewtonCounters *sum)
{
    sum->minimisations += counters->minimisations;
    sum->iterations += counters->iterations;
    sum->gradients += counters->gradients;
    sum->factorisations += counters->factorisations;
    sum->solves += counters->solves;
    sum->projected += counters->projected;
    sum->trials += counters->trials;
    sum->shifted += counters->shifted;
    sum->certified += counters->certified;
    sum->skipped += counters->skipped;
    sum->seconds_assembly += counters->seconds_assembly;
    sum->seconds_factor += counters->seconds_factor;
    sum->seconds_solve += counters->seconds_solve;
    sum->smoothings += counters->smoothings;
    sum->seconds_search += counters->seconds_search;
    sum->seconds_smoothing += counters->seconds_smoothing;
}

NewtonCounters simulation_counters(const Simulation *simulation)
{
    NewtonCounters sum = {0};
    for (int i = 0; i < simulation->runs; i++)
        if (simulation->run[i].newton)
            add_counters(&simulation->run[i].newton->counters, &sum);
    return sum;
}

double simulation_bytes(const Options *options)
{
    if (!(options->scene->needs & NEEDS_MESH))
        return 0;
    double row = options->segments + 1.0, n = row * row;
    if (options->integrator && !options->integrator->implicit)
        return 250 * n;
    return (130 * log2(n) + 750) * n;
}

long long simulation_matrix_entries(const Simulation *simulation)
{
    long long sum = 0;
    for (int i = 0; i < simulation->runs; i++)
        if (simulation->run[i].newton)
            sum += simulation->run[i].newton->search.A.entries;
    return sum;
}

/* Springs, and a Newton object that asks for their Hessian. */
bool simulation_has_filter(const Simulation *simulation)
{
    return simulation->system.springs > 0 && simulation->run[0].newton;
}

/* Newton with springs, or in one variable. */
bool simulation_has_line_search(const Simulation *simulation)
{
    return simulation_has_filter(simulation) ||
           simulation->descent.scalar.f.value;
}

/* What scenes that show directions do after a change of method. */
static void aim_again(Simulation *simulation)
{
    if (simulation->scene->aim && !simulation->done)
        simulation->scene->aim(simulation);
}

void simulation_set_filter(Simulation *simulation, Filter filter)
{
    simulation->options.filter = filter;
    for (int i = 0; i < simulation->runs; i++)
        if (simulation->run[i].newton)
            simulation->run[i].newton->settings.filter = filter;
    aim_again(simulation);
}

void simulation_set_line_search(Simulation *simulation, LineSearch search)
{
    simulation->options.line_search = search;
    for (int i = 0; i < simulation->runs; i++)
        if (simulation->run[i].newton)
            simulation->run[i].newton->settings.search = search;
    aim_again(simulation);
}

/* |d|/l - 1 */
double simulation_strain(const Simulation *simulation, int run, int s)
{
    const System *system = &simulation->system;
    const double *x = simulation->run[run].x;
    int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
    return hypot(x[i] - x[j], x[i + 1] - x[j + 1]) / sqrt(system->l2[s]) - 1;
}
