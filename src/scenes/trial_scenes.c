/* trial_scenes.c - many runs of one square: the race, the envelope. */
#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "scenes/body.h"
#include "scenes/simulation.h"
#include "base/mathematics.h"

/* The last status that is not OK of so many steps with these options, or the
 * failure that ended them; x, v: the start, run out, free it in any case. */
static Status trial_run(const Options *options, const IntegratorMethod *method,
                        System *system, const TimeIntegrator *from, long steps,
                        TimeIntegrator *run)
{
    NewtonSettings settings = {0};
    newton_settings_take(options, &settings);
    Status worst = time_integrator_create(method, system, &settings, from->x,
                                          from->v, run);
    bool goes_on = worst == STATUS_OK;
    for (long i = 0; i < steps && goes_on; i++) {
        Status status = time_integrator_step(run);
        if (status)
            worst = status;
        goes_on = !status || status_is_unconverged(status);
    }
    return worst;
}

/* ---- run time against error ---------------------------------------------- */

/* Steps of the longest time step and of the reference. */
enum { RACE_FIRST_STEPS = 8, RACE_FINER = 64 };

const IntegratorMethod *race_method(int i)
{
    static const char *const names[RACE_METHODS] = {
        "forward-euler", "symplectic-euler", "verlet", "backward-euler",
        "bdf2",          "midpoint",         "sdirk2", "avf",
        "avf4"};
    return integrator_method(names[i]);
}

/* From the start to RACE_TIME in this many steps; how well they converge, the
 * error will tell. */
static Status run_to_end(Simulation *simulation, const IntegratorMethod *method,
                         long steps, TimeIntegrator *run)
{
    Options options = simulation->options;
    options.timestep = RACE_TIME / (double)steps;
    Status status = trial_run(&options, method, &simulation->system,
                              &simulation->run[0], steps, run);
    return status_is_unconverged(status) ? STATUS_OK : status;
}

/* Run 1 is the reference: it stands at its end. */
Status create_race(Simulation *simulation)
{
    long finest = (long)RACE_FIRST_STEPS << (RACE_STEP_SIZES - 1);
    Status status = create_square(simulation);
    if (!status)
        status = run_to_end(simulation, integrator_method("verlet"),
                            RACE_FINER * finest, &simulation->run[1]);
    if (status == STATUS_NOT_FINITE) { /* nothing to compare with */
        simulation->done = true;
        simulation->status = status;
        return STATUS_OK;
    }
    return status;
}

/* J */
static double energy_of(const TimeIntegrator *run)
{
    return system_potential(run->system, run->x) +
           system_kinetic(run->system, run->v);
}

/* Whether an explicit run can go on; implicit ones always do, and forward Euler
 * adds energy with any time step. */
static bool is_stable(const Simulation *simulation, TimeIntegrator *run)
{
    if (strcmp(run->method->name, "forward-euler") == 0)
        return false;
    for (int i = 0; i < RACE_LONGER && !run->method->implicit; i++)
        if (time_integrator_step(run))
            return false;
    return run->method->implicit ||
           energy_of(run) <= RACE_ENERGY * energy_of(&simulation->run[0]);
}

/* The part of the energy at the start that is left when the run has gone on to
 * a whole second; NaN: it has not come so far. */
static double energy_later(const Simulation *simulation, TimeIntegrator *run)
{
    while (run->clock.now + 0.5 * run->h < 1) {
        Status status = time_integrator_step(run);
        if (status && !status_is_unconverged(status))
            return NAN;
    }
    return energy_of(run) / energy_of(&simulation->run[0]);
}

/* Runs to the end again and again, until a clock that ticks in tenths of a
 * millisecond, as a browser's does, can tell how long one takes: the least of
 * several times, for whatever disturbs it only adds to it. */
static Status measure_run(Simulation *simulation,
                          const IntegratorMethod *method, long steps,
                          TimeIntegrator *run, double *seconds)
{
    const double enough = 1e-3, all = 0.01; /* s, of a time, and of them all */
    double end = clock_worked() + all;
    Status status = STATUS_OK;
    *seconds = INFINITY;
    for (int i = 0; (i < 2 || clock_worked() < end) && !status; i++) {
        double start = clock_worked(), taken = 0;
        int runs = 0;
        while (!status && taken < enough) {
            time_integrator_free(run);
            status = run_to_end(simulation, method, steps, run);
            taken = clock_worked() - start;
            runs++;
        }
        *seconds = fmin(*seconds, taken / runs);
    }
    return status;
}

double race_stable(const Race *race, int method)
{
    for (int i = method; i < race->count; i += RACE_METHODS)
        if (race->point[i].stable)
            return race->point[i].h;
    return NAN;
}

Status step_race(Simulation *simulation)
{
    Race *race = &simulation->exhibit.race;
    const IntegratorMethod *method = race_method(race->count % RACE_METHODS);
    long steps = (long)RACE_FIRST_STEPS << (race->count / RACE_METHODS);
    TimeIntegrator run = {0};
    double seconds;
    RacePoint *point = &race->point[race->count];
    if (race->count >= RACE_METHODS) { /* its last one once more, later */
        RacePoint *before = point - RACE_METHODS;
        measure_run(simulation, method, steps / 2, &run, &seconds);
        before->seconds = fmin(before->seconds, seconds);
    }
    Status status = measure_run(simulation, method, steps, &run, &seconds);
    *point = (RacePoint){.method = method,
                         .h = RACE_TIME / (double)steps,
                         .error = NAN,
                         .later = NAN,
                         .seconds = seconds};
    if (!status) {
        const double *exact = simulation->run[1].x;
        point->error = 0;
        for (size_t i = 0; i < run.size; i += 2)
            point->error =
                fmax(point->error, math_hypot(run.x[i] - exact[i],
                                              run.x[i + 1] - exact[i + 1]));
        if (race->count / RACE_METHODS == RACE_SHOWN)
            point->later = energy_later(simulation, &run);
        point->stable = is_stable(simulation, &run);
    }
    time_integrator_free(&run);
    if (status && status != STATUS_NOT_FINITE)
        return status;
    race->count++;
    simulation->done = race->count == RACE_METHODS * RACE_STEP_SIZES;
    return STATUS_OK;
}

/* ---- how far the solver can be trusted ----------------------------------- */

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

Status envelope_visit(Simulation *simulation, int column, int row)
{
    EnvelopeMap *map = &simulation->exhibit.map;
    TimeIntegrator *run = &simulation->run[0];
    Options options = simulation->options;
    options.timestep = envelope_timestep(column);
    for (int s = 0; s < simulation->system.springs; s++)
        simulation->system.k[s] = envelope_stiffness(row);
    time_integrator_free(run);
    Status worst =
        trial_run(&options, &integrator_methods[0], &simulation->system,
                  &simulation->run[1], ENVELOPE_STEPS, run);
    if (worst == STATUS_OUT_OF_MEMORY)
        return worst;
    int updates = (int)run->newton->counters.iterations;
    map->cell[row][column] = (EnvelopeCell){
        .known = true,
        .worst = worst,
        .updates = updates,
        .undone = !worst && updates == 0 && !simulation_rests(simulation)};
    map->column = column;
    map->row = row;
    return STATUS_OK;
}

/* Run 1 is the start of all of them. */
Status create_envelope(Simulation *simulation)
{
    const Options *options = &simulation->options;
    Status status = create_square(simulation);
    simulation->run[1] = simulation->run[0];
    simulation->run[0] = (TimeIntegrator){0};
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
