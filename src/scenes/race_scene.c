#include "scenes/small_scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "scenes/body.h"

/* Steps of the longest time step and of the reference. */
enum { RACE_FIRST_STEPS = 8, RACE_FINER = 64 };

const IntegratorMethod *race_method(int i)
{
    static const char *const names[RACE_METHODS] = {
        "forward-euler",  "symplectic-euler", "verlet",
        "backward-euler", "midpoint",         "avf4"};
    return integrator_method(names[i]);
}

/* From the start to RACE_TIME in this many steps.
 *   from  in: the start; run out, free it in any case */
static Status run_to_end(Simulation *simulation, const IntegratorMethod *method,
                         long steps, TimeIntegrator *run)
{
    const TimeIntegrator *from = &simulation->run[0];
    const NewtonSettings settings = {.h = RACE_TIME / (double)steps,
                                     .tolerance = simulation->options.tolerance,
                                     .solver = simulation->options.solver,
                                     .filter = simulation->options.filter,
                                     .search = simulation->options.line_search,
                                     .max_iterations = 1000};
    Status status = time_integrator_create(method, &simulation->system,
                                           &settings, from->x, from->v, run);
    for (long i = 0; i < steps && !status; i++) {
        status = time_integrator_step(run);
        if (status_is_unconverged(status))
            status = STATUS_OK; /* its error will tell */
    }
    return status;
}

/* Run 1 is the reference: it stands at its end. */
Status create_race(Simulation *simulation, const NewtonSettings *settings)
{
    long finest = (long)RACE_FIRST_STEPS << (RACE_STEP_SIZES - 1);
    Status status = create_square(simulation, settings);
    if (status)
        return status;
    status = run_to_end(simulation, integrator_method("verlet"),
                        RACE_FINER * finest, &simulation->run[1]);
    if (status == STATUS_NOT_FINITE) { /* nothing to compare with */
        simulation->done = true;
        simulation->status = status;
        return STATUS_OK;
    }
    return status;
}

/* m, of the node that is farthest from where it belongs */
static double largest_error(int nodes, const double *x, const double *exact)
{
    double largest = 0;
    for (int i = 0; i < 2 * nodes; i += 2)
        largest =
            fmax(largest, hypot(x[i] - exact[i], x[i + 1] - exact[i + 1]));
    return largest;
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

Status step_race(Simulation *simulation)
{
    Race *race = &simulation->exhibit.race;
    const IntegratorMethod *method = race_method(race->count % RACE_METHODS);
    long steps = (long)RACE_FIRST_STEPS << (race->count / RACE_METHODS);
    TimeIntegrator run = {0};
    double start = clock_now();
    Status status = run_to_end(simulation, method, steps, &run);
    RacePoint *point = &race->point[race->count];
    *point = (RacePoint){.method = method,
                         .h = RACE_TIME / (double)steps,
                         .steps = steps,
                         .error = NAN,
                         .seconds = clock_now() - start,
                         .updates =
                             run.newton ? run.newton->counters.iterations : 0};
    if (!status) {
        point->error = largest_error(simulation->system.nodes, run.x,
                                     simulation->run[1].x);
        point->stable = is_stable(simulation, &run);
    }
    time_integrator_free(&run);
    if (status && status != STATUS_NOT_FINITE)
        return status;
    race->count++;
    simulation->done = race->count == RACE_METHODS * RACE_STEP_SIZES;
    return STATUS_OK;
}

const RacePoint *race_quickest(const Race *race, double error, bool implicit)
{
    const RacePoint *best = NULL;
    for (int i = 0; i < race->count; i++) {
        const RacePoint *point = &race->point[i];
        if (point->method->implicit == implicit && point->error <= error &&
            point->stable && (!best || point->seconds < best->seconds))
            best = point;
    }
    return best;
}
