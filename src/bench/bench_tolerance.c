#include "bench/bench_tolerance.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bench/bench_problem.h"

/* m/s; the slides' own is 1e-2. */
static const double tolerances[] = {1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10};
enum { TOLERANCES = sizeof tolerances / sizeof *tolerances };

/* Where rounding is all that is left, m/s. */
static const double exact_tolerance = 1e-13;

/* A step ended elsewhere if it is so many times further away than Newton's last
 * direction can be: at a saddle that passes the test, or in another minimum. */
static const double elsewhere_factor = 10;

enum { TOLERANCE_STEPS = 25, TOLERANCE_QUICK_STEPS = 10 };

/* Of all steps. */
typedef struct ToleranceResult {
    double seconds;
    double distance[TOLERANCE_STEPS]; /* m, root mean square over the masses */
    long steps, elsewhere;
    NewtonCounters counters;
    long unconverged;
} ToleranceResult;

/* A simulation with this tolerance. */
static Status create_tolerant(int segments, Solver solver, double tolerance,
                              Simulation *simulation)
{
    Options options = slides_options(segments);
    options.solver = solver;
    options.tolerance = tolerance;
    return simulation_create(&options, NULL, NULL, simulation);
}

/* Root mean square over the masses, which are all equal. */
static double position_distance(const TimeIntegrator *a,
                                const TimeIntegrator *b)
{
    double sum = 0;
    for (int i = 0; i < 2 * a->system->nodes; i++)
        sum += (a->x[i] - b->x[i]) * (a->x[i] - b->x[i]);
    return sqrt(sum / a->system->nodes);
}

/* One step of both from the state of the exact one. */
static Status compare_step(Simulation *exact, Simulation *probe,
                           ToleranceResult *result)
{
    TimeIntegrator *from = &exact->run[0], *to = &probe->run[0];
    size_t bytes = 2 * (size_t)from->system->nodes * sizeof(double);
    memcpy(to->x, from->x, bytes);
    memcpy(to->v, from->v, bytes);
    double start = clock_now();
    Status status = simulation_step(probe);
    result->seconds += clock_now() - start;
    if (status && !status_is_unconverged(status))
        return status;
    status = simulation_step(exact);
    if (status && !status_is_unconverged(status))
        return status;
    double distance = position_distance(from, to);
    result->elsewhere +=
        distance > elsewhere_factor * to->h * probe->options.tolerance;
    result->distance[result->steps++] = distance;
    return STATUS_OK;
}

static Status measure_tolerance(int segments, Solver solver, double tolerance,
                                long steps, ToleranceResult *result)
{
    Simulation exact = {0}, probe = {0};
    *result = (ToleranceResult){0};
    Status status =
        create_tolerant(segments, SOLVER_NEWTON, exact_tolerance, &exact);
    if (!status)
        status = create_tolerant(segments, solver, tolerance, &probe);
    for (long i = 0; i < steps && !status; i++)
        status = compare_step(&exact, &probe, result);
    if (!status) {
        result->counters = simulation_counters(&probe);
        result->unconverged = probe.unconverged;
    }
    simulation_free(&exact);
    simulation_free(&probe);
    return status;
}

static Status tolerance_square(Bench *bench, int segments, Solver solver,
                               long steps)
{
    for (int i = 0; i < TOLERANCES; i++) {
        ToleranceResult result;
        bench_progress(bench, "tolerance: %d segments, %s, %g m/s", segments,
                       solver_name(solver), tolerances[i]);
        Status status =
            measure_tolerance(segments, solver, tolerances[i], steps, &result);
        if (status)
            return status;
        double n = (double)steps, ms = 1e3 * result.seconds / n;
        double median = bench_median(result.distance, (int)steps);
        double worst = result.distance[steps - 1]; /* they are sorted now */
        const NewtonCounters *counters = &result.counters;
        bench_progress(bench, NULL);
        printf("  %8d %-6s %9.0e %9.3f %11.2f %14.2f %15.1e %14.1e %9ld "
               "%12ld\n",
               segments, solver_name(solver), tolerances[i], ms,
               (double)counters->iterations / n,
               (double)counters->factorisations / n, median, worst,
               result.elsewhere, result.unconverged);
        bench_csv_row(bench, "%d,%s,%g,%ld,%.6g,%ld,%ld,%.6g,%.6g,%ld,%ld",
                      segments, solver_name(solver), tolerances[i], steps, ms,
                      counters->iterations, counters->factorisations, median,
                      worst, result.elsewhere, result.unconverged);
    }
    return STATUS_OK;
}

Status bench_tolerance(Bench *bench)
{
    const int segments[] = {4, 16, 32};
    int squares = bench->quick ? 1 : 3;
    Status status =
        bench_csv_open(bench, "tolerance",
                       "segments,solver,tolerance_m_s,steps,step_ms,iterations,"
                       "factorisations,median_distance_m,worst_distance_m,"
                       "elsewhere,unconverged");
    if (status)
        return status;
    printf("  distance of a step's end to the exact minimiser, m; elsewhere: "
           "steps more than %g h times\n  the tolerance away, at a saddle that "
           "passes the test or in another minimum\n"
           "  segments solver tolerance   ms/step  iterations factorisations "
           "median distance worst distance elsewhere unconverged\n",
           elsewhere_factor);
    for (int i = 0; i < squares && !status; i++)
        for (int s = 0; s < SOLVER_COUNT && !status; s++)
            status = tolerance_square(bench, segments[i], (Solver)s,
                                      bench->quick ? TOLERANCE_QUICK_STEPS
                                                   : TOLERANCE_STEPS);
    return bench_csv_close(bench, status);
}
