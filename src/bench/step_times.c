#include "base/clock.h"
#include "bench/bench.h"

#include <limits.h>
#include <math.h>
#include <string.h>

/* Which fold a buckling step takes hangs on the last bits: so every run is
 * made from nine starts, stretches that are a billionth apart. */
enum { STARTS = 9, STEPS = 10, SOLVERS = 3 };

typedef enum Maker { LECTURE, NEWTON, MULTIGRID } Maker;

static const struct {
    const char *name;
    int largest; /* squares above take too long */
} makers[SOLVERS] = {{"lecture.c", 32}, {"newton", 64}, {"multigrid", 512}};

/* No further start of a size after so much time, s. */
static const double enough = 60;

/* A step buckles that needs more than so many times the updates of the easiest
 * one before it. */
enum { BUCKLING_RATIO = 2 };

/* One run, milliseconds of processor time a step. */
typedef struct Run {
    double total, smooth, buckling, updates;
    double energy; /* at the end, % of that at the start */
    long unconverged;
} Run;

/* A step of lecture.c, from the state of the simulation and into it. */
static Status step_as_slides(Simulation *simulation)
{
    TimeIntegrator *run = &simulation->run[0];
    return lecture_step(&simulation->system, simulation->options.timestep,
                        simulation->options.tolerance, run->x, run->v);
}

static Status play(Maker maker, int segments, int start, int steps, Run *run)
{
    Simulation simulation;
    Options options = slides_options(segments);
    options.stretch += 1e-9 * start;
    options.solver = maker == MULTIGRID ? SOLVER_MULTIGRID : SOLVER_NEWTON;
    *run = (Run){0};
    Status status = simulation_create(&options, NULL, NULL, &simulation);
    double energy = status ? 1 : simulation_energies(&simulation, 0).total;
    long least = LONG_MAX;
    int folds = 0;
    for (int i = 0; i < steps && !status; i++) {
        long before = simulation_counters(&simulation).iterations;
        double began = bench_cpu();
        status = maker == LECTURE ? step_as_slides(&simulation)
                                  : simulation_step(&simulation);
        double spent = 1e3 * (bench_cpu() - began);
        long made = simulation_counters(&simulation).iterations - before;
        if (status_is_unconverged(status)) {
            run->unconverged++;
            status = STATUS_OK;
        }
        least = made < least ? made : least;
        bool buckles = made > BUCKLING_RATIO * least;
        folds += buckles;
        *(buckles ? &run->buckling : &run->smooth) += spent;
        run->total += spent / steps;
    }
    NewtonCounters counters = simulation_counters(&simulation);
    run->buckling /= folds ? folds : 1;
    run->smooth /= steps > folds ? steps - folds : 1;
    run->updates = (double)counters.iterations / steps;
    if (!status)
        run->energy = 100 * simulation_energies(&simulation, 0).total / energy;
    simulation_free(&simulation);
    return status;
}

/* The median of one number of all runs. */
static double median_of(const Run *runs, int count, size_t offset)
{
    double values[STARTS];
    for (int i = 0; i < count; i++)
        memcpy(&values[i], (const char *)&runs[i] + offset, sizeof *values);
    return bench_median(values, count);
}

#define MEDIAN(what) median_of(runs, count, offsetof(Run, what))

/* Returns the median time of a step, ms. */
static double report(Bench *bench, Maker maker, int segments, const Run *runs,
                     int count)
{
    double least = INFINITY, most = 0;
    long unconverged = 0;
    for (int i = 0; i < count; i++) {
        least = fmin(least, runs[i].total);
        most = fmax(most, runs[i].total);
        unconverged += runs[i].unconverged;
    }
    printf("  %8d %-10s %6d %10.3f %10.3f %10.3f %8.1f %9.3f %9.3f %7.3f\n",
           segments, makers[maker].name, count, MEDIAN(total), least, most,
           MEDIAN(updates), MEDIAN(smooth), MEDIAN(buckling), MEDIAN(energy));
    bench_row(bench, "%d,%s,%d,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%ld",
              segments, makers[maker].name, count, MEDIAN(total), least, most,
              MEDIAN(updates), MEDIAN(smooth), MEDIAN(buckling), MEDIAN(energy),
              unconverged);
    return MEDIAN(total);
}

/* All solvers on one square, by turns. */
static Status measure(Bench *bench, int segments, double ms[SOLVERS])
{
    Run runs[SOLVERS][STARTS];
    int starts = bench->quick ? 1 : STARTS, count = 0;
    double began = clock_now();
    Status status = STATUS_OK;
    while (count < starts && clock_now() - began < enough && !status) {
        for (int m = 0; m < SOLVERS && !status; m++) {
            if (segments <= makers[m].largest)
                status = play((Maker)m, segments, count,
                              bench->quick ? 3 : STEPS, &runs[m][count]);
        }
        count++;
    }
    for (int m = 0; m < SOLVERS && !status; m++)
        if (segments <= makers[m].largest)
            ms[m] = report(bench, (Maker)m, segments, runs[m], count);
    return status;
}

Status bench_steps(Bench *bench)
{
    Status status = STATUS_OK;
    puts("  ms of processor time a step, the first ten of the default scene\n"
         "  segments solver     starts     median      least       most"
         "  updates    smooth  buckling   E, %");
    for (int n = 4; n <= (bench->quick ? 32 : 512) && !status; n *= 2) {
        double ms[SOLVERS] = {0};
        status = measure(bench, n, ms);
        if (status || bench->quick)
            continue;
        if (n == 32)
            bench_claim("newton's time over that of the slides' program",
                        ms[NEWTON] / ms[LECTURE], 0.2);
        if (n == 32 || n == 64)
            bench_claim("multigrid's time over newton's",
                        ms[MULTIGRID] / ms[NEWTON], n == 32 ? 0.1 : 0.025);
        if (n == 128)
            bench_claim("ms a step of 128 segments", ms[MULTIGRID], 16);
    }
    return status;
}
