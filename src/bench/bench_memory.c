#include "bench/bench_memory.h"

#include <stdio.h>
#include <sys/resource.h>

#include "bench/bench_problem.h"

/* The most that the process ever had in memory, bytes. */
static double process_peak(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
    return (double)usage.ru_maxrss;
#else
    return 1024.0 * (double)usage.ru_maxrss;
#endif
}

/* What the step took. */
static void report_memory(Bench *bench, const Simulation *simulation,
                          double setup, double step)
{
    const Newton *newton = simulation->run[0].newton;
    const NewtonCounters *counters = &newton->counters;
    const Cholesky *cholesky = newton->search.cholesky;
    double cholmod = 0, entries = 0; /* multigrid needs no factor */
    if (cholesky) {
        cholmod = cholesky_peak_bytes(cholesky);
        entries = cholesky_factor_entries(cholesky);
    }
    double peak = process_peak();
    printf("  %d segments, %d unknowns: set up in %.2f s, one step in %.2f s "
           "(%ld iterations, %ld factorisations)%s\n"
           "  factor: %.3g entries; peak memory: CHOLMOD %.0f MB, process "
           "%.0f MB\n",
           simulation->options.segments, 2 * simulation->system.nodes, setup,
           step, counters->iterations, counters->factorisations,
           simulation->unconverged ? ", not converged" : "", entries,
           1e-6 * cholmod, 1e-6 * peak);
    bench_csv_row(bench, "%d,%d,%.6g,%.6g,%ld,%ld,%ld,%.6g,%.0f,%.0f",
                  simulation->options.segments, 2 * simulation->system.nodes,
                  setup, step, counters->iterations, counters->factorisations,
                  simulation->unconverged, entries, cholmod, peak);
}

Status bench_memory(Bench *bench)
{
    Options options = slides_options(bench->quick ? 64 : 512);
    options.solver = SOLVER_MULTIGRID;
    Simulation simulation = {0};
    Status status = bench_csv_open(
        bench, "memory",
        "segments,unknowns,setup_s,step_s,iterations,factorisations,"
        "unconverged,factor_entries,cholmod_peak_bytes,process_peak_bytes");
    if (status)
        return status;
    bench_progress(bench, "memory: %d segments, one step", options.segments);
    double start = clock_now();
    status = simulation_create(&options, NULL, NULL, &simulation);
    double created = clock_now();
    if (!status)
        status = simulation_step(&simulation);
    double stepped = clock_now();
    if (!status || status_is_unconverged(status)) {
        bench_progress(bench, NULL);
        report_memory(bench, &simulation, created - start, stepped - created);
        status = STATUS_OK;
    }
    simulation_free(&simulation);
    return bench_csv_close(bench, status);
}
