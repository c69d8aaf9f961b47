/* trial_scenes.c - scenes of many runs of the square: race and envelope. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "model/spring_law.h"
#include "simulation/body.h"
#include "scenes/small_scenes.h"
#include "base/mathematics.h"

/* Makes steps of a method with these options, from the state of another run.
 *   run  out; free it in any case
 * Returns the last status that is not OK, or the failure that ended the run. */
static Status make_trial_run(const Options *options,
                             const IntegratorMethod *method, System *system,
                             const TimeIntegrator *from, long steps,
                             TimeIntegrator *run)
{
    NewtonSettings settings = {0};
    options_fill_newton_settings(options, &settings);
    Status worst = time_integrator_create(method, system, &settings, from->x,
                                          from->v, run);
    for (long i = 0; i < steps && !status_is_failure(worst); i++) {
        Status status = time_integrator_make_step(run);
        worst = status ? status : worst;
    }
    return worst;
}

/* ---- run time against error ---------------------------------------------- */

/* Number of steps of a run with the longest time step */
enum { RACE_FEWEST_STEPS = 8 };

const IntegratorMethod *race_get_method(int i)
{
    static const char *const names[RACE_METHODS] = {
        "symplectic-euler", "verlet", "backward-euler", "midpoint"};
    return integrator_find_method(names[i]);
}

/* Returns an upper bound of the angular frequencies, 1/s.  The curvature of a
 * spring's energy is largest along the spring; a compressed spring counts as a
 * spring at rest.  A node has at most eight springs, so by Gershgorin omega^2
 * is at most 2 * 8 times the largest curvature, divided by m. */
static double find_frequency_bound(const System *system, const double *x)
{
    double most = 0;
    for (int s = 0; s < system->springs; s++) {
        double d[2], l2 = system->l2[s];
        double d2 = fmax(spring_vector(system->e + 2 * s, x, d), l2);
        most = fmax(most, spring_hessian_factor(l2, system->k[s]) *
                              spring_eigenvalue_along(d2, l2));
    }
    return sqrt(2 * 8 * most / system->m[0]);
}

/* Moves a run by H seconds almost exactly, by extrapolation (Gragg 1965).
 * Verlet makes 1, 2, ... 6 steps; the results are extrapolated to steps of
 * length 0.  Verlet's error has even powers of the step only, so an error of
 * O(H^12) remains.  The extrapolated value is the sum over j of w_j times the
 * result of j steps.  The weight w_j (Lagrange's formula) is the product of
 * j^2 / (j^2 - i^2) over all i other than j.
 *   from, to  scratch, [2 x_length] */
static Status advance_exactly(TimeIntegrator *run, double H, double *from,
                              double *to)
{
    enum { EXTRAPOLATION_LEVELS = 6 };
    size_t both = 2 * run->x_length, bytes = both * sizeof *to;
    Status status = STATUS_OK;
    memcpy(from, run->x, bytes); /* x and v are one array */
    memcpy(to, run->x, bytes);
    for (int j = 1; j <= EXTRAPOLATION_LEVELS && !status; j++) {
        double weight = 1;
        for (int i = 1; i <= EXTRAPOLATION_LEVELS; i++)
            weight *= i == j ? 1 : (double)(j * j) / (j * j - i * i);
        memcpy(run->x, from, bytes);
        run->history_h = 0;
        run->h = H / j;
        for (int step = 0; step < j && !status; step++)
            status = time_integrator_make_step(run);
        for (size_t i = 0; i < both; i++)
            to[i] += weight * (run->x[i] - from[i]);
    }
    memcpy(run->x, to, bytes);
    return status;
}

Status race_make_reference(Simulation *simulation, double time)
{
    const double max_intervals = 1 << 14; /* bounds the run time */
    const TimeIntegrator *start = &simulation->run[0];
    TimeIntegrator *run = &simulation->run[1];
    double bound = find_frequency_bound(&simulation->system, start->x);
    double intervals = floor(1 + time * bound);
    Status status =
        simulation_start_run(simulation, 1, integrator_find_method("verlet"),
                             &simulation->system, start->x, start->v);
    if (!status && !(intervals <= max_intervals))
        status = STATUS_NOT_FINITE;
    double *scratch = malloc(4 * start->x_length * sizeof *scratch);
    if (!scratch)
        return STATUS_OUT_OF_MEMORY;
    for (int k = 0; k < intervals && !status; k++)
        status = advance_exactly(run, time / intervals, scratch,
                                 scratch + 2 * start->x_length);
    free(scratch);
    return status;
}

Status create_race_scene(Simulation *simulation)
{
    Status status = create_square_scene(simulation);
    if (!status)
        status = race_make_reference(simulation, RACE_TIME);
    if (status == STATUS_NOT_FINITE) { /* no exact end to compare runs with */
        simulation->is_over = true;
        simulation->status = status;
        return STATUS_OK;
    }
    return status;
}

/* Returns the energy of a run, J. */
static double find_run_energy(const TimeIntegrator *run)
{
    return system_potential(run->system, run->x) +
           system_kinetic_energy(run->system, run->v);
}

/* Whether the energy of a run stays bounded.  Implicit methods are stable. */
static bool run_is_stable(const Simulation *simulation, TimeIntegrator *run)
{
    for (int i = 0; i < RACE_EXTRA_STEPS && run->method->stages == 0; i++)
        if (time_integrator_make_step(run))
            return false;
    return run->method->stages > 0 ||
           find_run_energy(run) <=
               RACE_MAX_ENERGY_RATIO * find_run_energy(&simulation->run[0]);
}

/* Measures the processor time of a run.  The run is repeated until a clock that
 * ticks in tenths of a millisecond, as in a browser, is accurate enough; the
 * least of several measurements counts, because disturbances only add time. */
static Status measure_run_time(Simulation *simulation,
                               const IntegratorMethod *method, double h,
                               long steps, TimeIntegrator *run, double *seconds)
{
    const double shortest = 1e-3; /* shortest measurement, s */
    double end =
        clock_processor_time() + 0.01; /* latest start of a measurement, s */
    Options options = simulation->options;
    Status status = STATUS_OK;
    options.timestep = h;
    *seconds = INFINITY;
    for (int i = 0;
         (i < 2 || clock_processor_time() < end) && !status_is_failure(status);
         i++) {
        double start = clock_processor_time(), taken = 0;
        int runs = 0;
        while (!status_is_failure(status) && taken < shortest) {
            time_integrator_free(run);
            status = make_trial_run(&options, method, &simulation->system,
                                    &simulation->run[0], steps, run);
            taken = clock_processor_time() - start;
            runs++;
        }
        *seconds = fmin(*seconds, taken / runs);
    }
    return status;
}

Status race_measure_method(Simulation *simulation,
                           const IntegratorMethod *method, double time,
                           long steps, TimeIntegrator *run, RaceResult *point)
{
    const double *exact = simulation->run[1].x;
    *point =
        (RaceResult){.method = method, .h = time / (double)steps, .error = NAN};
    Status status = measure_run_time(simulation, method, point->h, steps, run,
                                     &point->processor_time);
    point->converged = status == STATUS_OK;
    if (status_is_failure(status))
        return status;
    point->error = 0;
    for (size_t i = 0; i < run->x_length; i += 2)
        point->error =
            fmax(point->error, math_hypot(run->x[i] - exact[i],
                                          run->x[i + 1] - exact[i + 1]));
    return STATUS_OK;
}

Status step_race_scene(Simulation *simulation)
{
    MethodRace *race = &simulation->exhibit.race;
    const IntegratorMethod *method =
        race_get_method(race->run_count % RACE_METHODS);
    long steps = (long)RACE_FEWEST_STEPS << (race->run_count / RACE_METHODS);
    TimeIntegrator run = {0};
    double seconds;
    RaceResult *point = &race->result[race->run_count];
    /* The method's last run (2h) is timed again; the shorter time counts. */
    if (race->run_count >= RACE_METHODS) {
        RaceResult *before = point - RACE_METHODS;
        measure_run_time(simulation, method, before->h, steps / 2, &run,
                         &seconds);
        before->processor_time = fmin(before->processor_time, seconds);
    }
    Status status =
        race_measure_method(simulation, method, RACE_TIME, steps, &run, point);
    if (!status)
        point->is_stable = run_is_stable(simulation, &run);
    time_integrator_free(&run);
    if (status && status != STATUS_NOT_FINITE)
        return status;
    race->run_count++;
    simulation->is_over = race->run_count == RACE_METHODS * RACE_STEP_SIZES;
    return STATUS_OK;
}

/* ---- how far the solver can be trusted ----------------------------------- */

double envelope_get_timestep(int column)
{
    return pow(10, 0.5 * column - 9);
}

double envelope_get_stiffness(int row)
{
    return pow(10, row - 6);
}

/* Returns the column or row whose value is nearest on a logarithmic scale. */
static int find_nearest_index(double value, double first, double per_ten,
                              int count)
{
    double place = round((log10(value) - first) * per_ten);
    return (int)fmin(fmax(place, 0), count - 1);
}

Status envelope_run_cell(Simulation *simulation, int column, int row)
{
    ConvergenceMap *map = &simulation->exhibit.envelope;
    TimeIntegrator *run = &simulation->run[0];
    Options options = simulation->options;
    options.timestep = envelope_get_timestep(column);
    for (int s = 0; s < simulation->system.springs; s++)
        simulation->system.k[s] = envelope_get_stiffness(row);
    time_integrator_free(run);
    Status worst =
        make_trial_run(&options, &integrator_methods[0], &simulation->system,
                       &simulation->run[1], ENVELOPE_STEPS, run);
    if (worst == STATUS_OUT_OF_MEMORY)
        return worst;
    int updates = (int)run->newton->counters.updates;
    map->cell[row][column] = (ConvergenceCell){
        .is_known = true, .run_status = worst, .updates = updates};
    map->shown_column = column;
    map->shown_row = row;
    return STATUS_OK;
}

/* Makes run[1], the state from which the run of each cell begins.  run[0] is
 * the run of the shown cell. */
Status create_envelope_scene(Simulation *simulation)
{
    const Options *options = &simulation->options;
    Status status = create_square_scene(simulation);
    simulation->run[1] = simulation->run[0];
    simulation->run[0] = (TimeIntegrator){0};
    if (status)
        return status;
    return envelope_run_cell(
        simulation,
        find_nearest_index(options->timestep, -9, 2, ENVELOPE_COLUMNS),
        find_nearest_index(options->stiffness, -6, 1, ENVELOPE_ROWS));
}

/* The row's runs replace run 0, so the shown cell's run is made again. */
Status step_envelope_scene(Simulation *simulation)
{
    const ConvergenceMap *map = &simulation->exhibit.envelope;
    int row = (int)simulation->steps,
        shown[2] = {map->shown_column, map->shown_row};
    Status status = STATUS_OK;
    for (int column = 0; column < ENVELOPE_COLUMNS && !status; column++)
        status = envelope_run_cell(simulation, column, row);
    if (!status)
        status = envelope_run_cell(simulation, shown[0], shown[1]);
    simulation->is_over = row + 1 >= ENVELOPE_ROWS;
    return status;
}
