#include "bench/bench_filters.h"

#include <stdio.h>

#include "bench/bench_problem.h"

enum { FILTER_SEGMENTS = 8, FILTER_STEPS = 10 };

static const double filter_stretches[] = {0.2, 0.35, 0.5, 0.7, 0.85,
                                          1.1, 1.4,  2,   3};
enum { STRETCHES = sizeof filter_stretches / sizeof *filter_stretches };

static const double filter_timesteps[] = {0.004, 0.02};

/* What became of the steps. */
typedef struct FilterResult {
    NewtonCounters counters;
    double seconds;
    long steps, unconverged;
    bool failed; /* a step could not be made */
} FilterResult;

static Status measure_filter(Filter filter, double timestep, double stretch,
                             FilterResult *result)
{
    Simulation simulation;
    Options options = slides_options(FILTER_SEGMENTS);
    options.filter = filter;
    options.timestep = timestep;
    options.stretch = stretch;
    *result = (FilterResult){0};
    Status status = simulation_create(&options, NULL, NULL, &simulation);
    double start = clock_now();
    while (!status && simulation.steps < FILTER_STEPS && !result->failed) {
        Status step = simulation_step(&simulation);
        result->failed = step && !status_is_unconverged(step);
        status = step == STATUS_OUT_OF_MEMORY ? step : STATUS_OK;
    }
    result->seconds = clock_now() - start;
    result->steps = simulation.steps;
    result->unconverged = simulation.unconverged;
    result->counters = simulation_counters(&simulation);
    simulation_free(&simulation);
    return status;
}

/* Iterations/factorisations, and a mark where not all steps converged. */
static void print_filter(const FilterResult *result)
{
    char cell[32];
    snprintf(cell, sizeof cell, "%ld/%ld%s", result->counters.iterations,
             result->counters.factorisations,
             result->failed            ? "x"
             : result->unconverged > 0 ? "!"
                                       : "");
    printf(" %10s", cell);
}

static Status filter_row(Bench *bench, Filter filter, double timestep)
{
    printf("  %-10s", filter_name(filter));
    for (int i = 0; i < STRETCHES; i++) {
        FilterResult result;
        double stretch = filter_stretches[i];
        Status status = measure_filter(filter, timestep, stretch, &result);
        if (status)
            return status;
        print_filter(&result);
        bench_csv_row(bench, "%s,%g,%g,%ld,%ld,%ld,%ld,%ld,%d,%.6g",
                      filter_name(filter), timestep, stretch, result.steps,
                      result.counters.iterations,
                      result.counters.factorisations, result.counters.projected,
                      result.unconverged, result.failed, 1e3 * result.seconds);
    }
    putchar('\n');
    return STATUS_OK;
}

/* All filters, side by side. */
static Status filter_table(Bench *bench, double timestep)
{
    printf("  time step %g s, %d segments, %d steps: "
           "iterations/factorisations; ! some steps did not converge, x one "
           "failed\n  stretch   ",
           timestep, FILTER_SEGMENTS, FILTER_STEPS);
    for (int i = 0; i < STRETCHES; i++)
        printf(" %10g", filter_stretches[i]);
    putchar('\n');
    Status status = STATUS_OK;
    for (int f = 0; f < FILTER_COUNT && !status; f++)
        status = filter_row(bench, (Filter)f, timestep);
    return status;
}

Status bench_filters(Bench *bench)
{
    Status status =
        bench_csv_open(bench, "filters",
                       "filter,timestep_s,stretch,steps,iterations,"
                       "factorisations,projected,unconverged,failed,ms");
    if (status)
        return status;
    for (int i = 0; i < 2 && !status; i++)
        status = filter_table(bench, filter_timesteps[i]);
    return bench_csv_close(bench, status);
}
