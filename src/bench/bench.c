/* bench.c - the program elasto-bench: run time against error, and how long
 * steps take. */
#include "bench/bench.h"

#include <SDL_version.h>
#include <cholmod.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The middle one, or the mean of the two in the middle; sorts the values.
 * count at least 1. */
static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, compare_doubles);
    return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

/* Prints what README says, what was measured, and whether that holds. */
static void claim(const char *what, double measured, double at_most)
{
    printf("# claim: %s: %.3g, at most %g: %s\n", what, measured, at_most,
           measured <= at_most ? "met" : "NOT MET");
}

/* The slides' numbers, on a square of so many segments. */
static Options slides_options(int segments)
{
    char message[128];
    Options options;
    options_of_line("square", &options, message, sizeof message);
    options.segments = segments;
    return options;
}

/* ---- work ---------------------------------------------------------------- */

/* Error against run time: every method crosses the same time in 8, 16, 32, ...
 * steps, until it takes too long or is as exact as anybody needs. */
typedef struct Motion {
    const char *name;
    double stiffness, stretch; /* J/m^2, at the start */
    double spin, time;         /* rad/s at the start, s */
    int segments[4];           /* 0: no more */
} Motion;

/* Stiffness 10^4 times larger makes everything 100 times as fast.  The last
 * one is where implicit methods are at home: stiff springs that hardly move,
 * in a square that turns slowly. */
static const Motion motions[] = {
    {"soft", 1e5, 1.1, 0, 0.1, {16, 64, 128, 0}},
    {"stiff", 1e9, 1.1, 0, 0.02, {16, 32, 0}},
    {"spinning", 1e9, 1, 10, 0.1, {16, 0}},
};
enum { MOTIONS = sizeof motions / sizeof *motions };

enum { FIRST_STEPS = 8, TARGETS = 5 };

/* Errors that the table asks for; the one that the first run may have, m. */
static const double targets[TARGETS] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
static const double first_error = 1e-2;

/* The fastest run that comes below a target. */
typedef struct Best {
    const char *name; /* of its method; NULL: none does */
    double ms;
} Best;

/* Run 0 is the start of all runs, run 1 where they should end. */
static Status create_motion(const Motion *motion, int segments,
                            Simulation *simulation)
{
    Options options = slides_options(segments);
    options.stiffness = motion->stiffness;
    options.stretch = motion->stretch;
    options.solver = SOLVER_MULTIGRID;
    Status status = simulation_create(&options, NULL, NULL, simulation);
    if (status)
        return status;
    TimeIntegrator *start = &simulation->run[0];
    for (size_t i = 0; i < start->size; i += 2) {
        start->v[i] = -motion->spin * start->x[i + 1];
        start->v[i + 1] = motion->spin * start->x[i];
    }
    return race_reference(simulation, motion->time);
}

/* The last direction of a minimisation changes velocities by at most the
 * tolerance; summed over all steps, positions by steps * tolerance * time / 2.
 * That may be as much as the error that is expected of the method, since the
 * last direction is used: what is left after it is a hundredth of it or less.
 * No run takes longer than so much time, none follows an error that is small
 * enough. */
static Status climb(bool quick, const Motion *motion, Simulation *simulation,
                    const IntegratorMethod *method, Best best[TARGETS])
{
    int segments = simulation->options.segments;
    double longest = quick ? 0.01 : segments / 64.0 + 0.25;
    double enough = quick ? 1e-5 : 1e-8, expected = first_error;
    RacePoint now = {.error = INFINITY};
    for (long steps = FIRST_STEPS; !(now.error < enough); steps *= 2) {
        TimeIntegrator run = {0};
        simulation->options.tolerance = 2 * expected / (steps * motion->time);
        Status status =
            race_measure(simulation, method, motion->time, steps, &run, &now);
        time_integrator_free(&run);
        if (status == STATUS_OUT_OF_MEMORY)
            return status;
        bool failed = !(now.converged && now.error < simulation->options.side);
        double ms = 1e3 * now.seconds;
        printf("%s,%d,%s,%s,%d,%ld,%.6g,%.6g,%.6g,%d\n", motion->name, segments,
               method->name, method->implicit ? "multigrid" : "none",
               method->order, steps, simulation->options.tolerance, now.seconds,
               fmin(now.error, 1e300), failed);
        if (failed)
            now.error = INFINITY;
        for (int t = 0; t < TARGETS; t++)
            if (now.error <= targets[t] && ms < best[t].ms)
                best[t] = (Best){method->name, ms};
        if (2 * now.seconds > longest)
            break;
        expected = fmin(now.error, first_error) / (1 << method->order);
    }
    return STATUS_OK;
}

/* All methods on one motion, and for each error the fastest explicit and the
 * fastest implicit one. */
static Status climb_all(bool quick, const Motion *motion,
                        Simulation *simulation)
{
    Best best[2][TARGETS];
    for (int i = 0; i < 2 * TARGETS; i++)
        best[i / TARGETS][i % TARGETS] = (Best){NULL, INFINITY};
    for (int i = 0; i < RACE_METHODS; i++) {
        const IntegratorMethod *method = race_method(i);
        Status status =
            climb(quick, motion, simulation, method, best[method->implicit]);
        if (status)
            return status;
    }
    printf("# %s, %g segments\n#  error m  best explicit             ms  best "
           "implicit        ms  implicit/explicit\n",
           motion->name, simulation->options.segments);
    for (int t = 0; t < TARGETS; t++) {
        const Best *one = &best[0][t], *other = &best[1][t];
        if (one->name && other->name)
            printf("#  %7.0e  %-16s %11.3f  %-14s %8.3f  %8.3g: implicit %s\n",
                   targets[t], one->name, one->ms, other->name, other->ms,
                   other->ms / one->ms, other->ms > one->ms ? "loses" : "wins");
    }
    return STATUS_OK;
}

static Status measure_work(bool quick)
{
    Status status = STATUS_OK;
    for (int m = 0; m < MOTIONS; m++)
        for (int i = 0; motions[m].segments[i] && !status; i++) {
            const Motion *motion = &motions[m];
            Simulation simulation;
            if (quick && i > 0)
                break;
            status = create_motion(motion, quick ? 4 : motion->segments[i],
                                   &simulation);
            if (!status)
                status = climb_all(quick, motion, &simulation);
            simulation_free(&simulation);
        }
    return status;
}

/* ---- steps --------------------------------------------------------------- */

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

/* All runs of one solver on one square; of each: */
typedef struct Runs {
    double ms[STARTS], updates[STARTS]; /* a step */
    double energy[STARTS];              /* at the end, % of that at the start */
    long unconverged;
} Runs;

static Status play(Maker maker, int segments, int start, int steps, Runs *runs)
{
    Simulation simulation;
    Options options = slides_options(segments);
    options.stretch += 1e-9 * start;
    options.solver = maker == MULTIGRID ? SOLVER_MULTIGRID : SOLVER_NEWTON;
    Status status = simulation_create(&options, NULL, NULL, &simulation);
    double energy = status ? 1 : simulation_energies(&simulation, 0).total;
    double began = clock_processor();
    for (int i = 0; i < steps && !status; i++) {
        status = maker == LECTURE
                     ? lecture_step(&simulation.system, options.timestep,
                                    options.tolerance, simulation.run[0].x,
                                    simulation.run[0].v)
                     : simulation_step(&simulation);
        if (status_is_unconverged(status)) {
            runs->unconverged++;
            status = STATUS_OK;
        }
    }
    runs->ms[start] = 1e3 * (clock_processor() - began) / steps;
    runs->updates[start] =
        (double)simulation_counters(&simulation).iterations / steps;
    if (!status)
        runs->energy[start] =
            100 * simulation_energies(&simulation, 0).total / energy;
    simulation_free(&simulation);
    return status;
}

/* All solvers on one square, by turns.  ms out: the median of a step */
static Status measure(bool quick, int segments, double ms[SOLVERS])
{
    Runs runs[SOLVERS] = {{.unconverged = 0}};
    int starts = quick ? 1 : STARTS, steps = quick ? 3 : STEPS;
    int count = 0;
    double began = clock_now();
    Status status = STATUS_OK;
    for (; count < starts && clock_now() - began < enough && !status; count++)
        for (int m = 0; m < SOLVERS && !status; m++)
            if (segments <= makers[m].largest)
                status = play((Maker)m, segments, count, steps, &runs[m]);
    for (int m = 0; m < SOLVERS && !status; m++) {
        Runs *all = &runs[m];
        if (segments > makers[m].largest)
            continue;
        ms[m] = median(all->ms, count); /* which sorts them */
        printf("%d,%s,%d,%.6g,%.6g,%.6g,%.6g,%.6g,%ld\n", segments,
               makers[m].name, count, ms[m], all->ms[0], all->ms[count - 1],
               median(all->updates, count), median(all->energy, count),
               all->unconverged);
    }
    return status;
}

static Status measure_steps(bool quick)
{
    Status status = STATUS_OK;
    for (int n = 4; n <= (quick ? 32 : 512) && !status; n *= 2) {
        double ms[SOLVERS] = {0};
        status = measure(quick, n, ms);
        if (status || quick)
            continue;
        if (n == 32)
            claim("newton's time over that of the slides' program",
                  ms[NEWTON] / ms[LECTURE], 0.2);
        if (n == 32 || n == 64)
            claim("multigrid's time over newton's", ms[MULTIGRID] / ms[NEWTON],
                  n == 32 ? 0.1 : 0.025);
        if (n == 128)
            claim("ms a step of 128 segments", ms[MULTIGRID], 16);
    }
    return status;
}

/* ---- the program --------------------------------------------------------- */

static const struct {
    const char *name, *sentence;
    Status (*run)(bool quick);
    const char *columns;
} tables[] = {
    {"work", "error against run time of all methods", measure_work,
     "case,segments,integrator,solver,order,steps,tolerance_m_s,run_time_s,"
     "error_m,failed"},
    {"steps", "milliseconds a step: the slides' program, newton, multigrid",
     measure_steps,
     "segments,solver,starts,median_ms,least_ms,most_ms,updates,"
     "energy_end_percent,unconverged"},
};
enum { TABLES = sizeof tables / sizeof *tables };

int main(int argc, char **argv)
{
    bool quick = argc == 3 && strcmp(argv[2], "--quick") == 0;
    int t = 0;
    while (t < TABLES && (argc < 2 || strcmp(argv[1], tables[t].name) != 0))
        t++;
    if (t == TABLES || argc != 2 + quick) {
        fprintf(stderr, "usage: elasto-bench TABLE [--quick]; tables:");
        for (t = 0; t < TABLES; t++)
            fprintf(stderr, " %s (%s)%s", tables[t].name, tables[t].sentence,
                    t + 1 < TABLES ? "," : "\n");
        return 2;
    }
    setvbuf(stdout, NULL, _IOLBF, 0); /* each line when it is measured */
    printf("# elasto %s; SuiteSparse %d.%d.%d; SDL %d.%d.%d; compiler %s; "
           "flags %s; one thread; %s run\n%s\n",
           ELASTO_VERSION, SUITESPARSE_MAIN_VERSION, SUITESPARSE_SUB_VERSION,
           SUITESPARSE_SUBSUB_VERSION, SDL_MAJOR_VERSION, SDL_MINOR_VERSION,
           SDL_PATCHLEVEL, __VERSION__, BENCH_FLAGS, quick ? "quick" : "full",
           tables[t].columns);
    Status status = tables[t].run(quick);
    if (status)
        fprintf(stderr, "elasto-bench: %s\n", status_text(status));
    return status || fflush(stdout) || ferror(stdout);
}
