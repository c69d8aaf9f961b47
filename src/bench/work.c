/* Error against run time: every method crosses the same time in 8, 16, 32, ...
 * steps, until it takes too long or is as exact as anybody needs. */
#include "bench/bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* A step has so many updates at most. */
enum { MAX_UPDATES = 2000, FIRST_STEPS = 8, REPEATS = 3, TARGETS = 5 };

/* Errors that the table asks for; the one that the first run may have, m. */
static const double targets[TARGETS] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
static const double first_error = 1e-2;

typedef struct Problem {
    const Motion *motion;
    Simulation simulation; /* at the start; its system is that of all runs */
    double *exact;         /* [4n] m, m/s, at the end; then [4n] room */
} Problem;

/* One run, or the fastest of several equal ones. */
typedef struct Rung {
    long steps;
    double tolerance, seconds;
    double error; /* m, root mean square over the masses */
    bool failed;  /* not finite, not converged, or gone by a side */
} Rung;

/* The fastest method for a target. */
typedef struct Best {
    const char *name;
    double ms;
} Best;

/* Each interval H, omega H <= 1, is crossed by velocity Verlet in 1, 2, ... 6
 * steps; these results are extrapolated to steps of length 0.  Verlet is
 * symmetric, its error has even powers of the step, and what is left is
 * O(H^12) (Gragg 1965).  Lagrange: the polynomial in 1/n^2 through all results
 * has at 0 the sum over j of w_j times result j, with w_j = product over i of
 * n_j^2 / (n_j^2 - n_i^2). */
static Status find_exact(Problem *problem)
{
    enum { COLUMNS = 6 };
    const Motion *motion = problem->motion;
    System *system = &problem->simulation.system;
    /* Eight springs at a node, each of 2k (3 |d|^2 / l2 - 1) at most: by
     * Gershgorin omega^2 is below twice their sum over m. */
    double along =
        2 * system->k[0] * (3 * motion->stretch * motion->stretch - 1);
    double omega = sqrt(2 * 8 * along / system->m[0]);
    long intervals = 1 + (long)(motion->time * omega);
    double H = motion->time / (double)intervals;
    const TimeIntegrator *begin = &problem->simulation.run[0];
    TimeIntegrator run;
    Status status = time_integrator_create(
        integrator_method("verlet"), system,
        &(NewtonSettings){.h = H, .tolerance = 1}, begin->x, begin->v, &run);
    size_t both = 2 * run.size; /* v is behind x */
    double *start = problem->exact + both;
    if (!status)
        memcpy(problem->exact, run.x, both * sizeof *start);
    for (long k = 0; k < intervals && !status; k++) {
        memcpy(start, problem->exact, both * sizeof *start);
        for (int j = 1; j <= COLUMNS && !status; j++) {
            double weight = 1;
            for (int i = 1; i <= COLUMNS; i++)
                weight *= i == j ? 1 : (double)(j * j) / (j * j - i * i);
            memcpy(run.x, start, both * sizeof *start);
            run.memory_h = 0;
            run.h = H / j;
            for (int step = 0; step < j && !status; step++)
                status = time_integrator_step(&run);
            for (size_t i = 0; i < both; i++)
                problem->exact[i] += weight * (run.x[i] - start[i]);
        }
    }
    time_integrator_free(&run);
    return status;
}

/* sqrt(sum m |x - exact|^2 / sum m), m; all masses are alike. */
static double error_of(const Problem *problem, const TimeIntegrator *run)
{
    double sum = 0;
    for (size_t i = 0; i < run->size; i++)
        sum +=
            (run->x[i] - problem->exact[i]) * (run->x[i] - problem->exact[i]);
    return sqrt(2 * sum / (double)run->size);
}

static Status create_problem(const Motion *motion, int segments,
                             Problem *problem)
{
    Options options = slides_options(segments);
    options.stiffness = motion->stiffness;
    options.stretch = motion->stretch;
    options.integrator = integrator_method("verlet") - integrator_methods;
    *problem = (Problem){.motion = motion};
    Simulation *simulation = &problem->simulation;
    Status status = simulation_create(&options, NULL, NULL, simulation);
    if (status)
        return status;
    const double *x = simulation->run[0].x;
    double *v = simulation->run[0].v;
    for (int i = 0; i < simulation->system.nodes; i++) {
        v[2 * i] = -motion->spin * x[2 * i + 1];
        v[2 * i + 1] = motion->spin * x[2 * i];
    }
    problem->exact = malloc(8 * (size_t)simulation->system.nodes * sizeof *v);
    return problem->exact ? find_exact(problem) : STATUS_OUT_OF_MEMORY;
}

/* From nothing to the end, once. */
static Status run_once(const Problem *problem, const IntegratorMethod *method,
                       Rung *rung)
{
    NewtonSettings settings = {.h = problem->motion->time / (double)rung->steps,
                               .tolerance = rung->tolerance,
                               .solver = SOLVER_MULTIGRID,
                               .max_iterations = MAX_UPDATES};
    System system = problem->simulation.system; /* the same arrays */
    const TimeIntegrator *begin = &problem->simulation.run[0];
    TimeIntegrator run;
    double start = bench_cpu();
    Status status = time_integrator_create(method, &system, &settings, begin->x,
                                           begin->v, &run);
    while (!status && run.steps < rung->steps)
        status = time_integrator_step(&run);
    rung->seconds = bench_cpu() - start;
    if (status != STATUS_OUT_OF_MEMORY) {
        rung->error = error_of(problem, &run);
        rung->failed =
            status || !(rung->error < problem->simulation.options.side);
        status = STATUS_OK;
    }
    time_integrator_free(&run);
    return status;
}

/* Where a method comes below an error between two rungs, `last` or none before
 * it, its time is interpolated. */
static void find_best(const Rung *last, const Rung *now, const char *name,
                      Best best[TARGETS])
{
    for (int t = 0; t < TARGETS; t++) {
        double ms = 1e3 * now->seconds;
        if (now->error > targets[t] || last->error <= targets[t])
            continue;
        if (isfinite(last->error))
            ms = 1e3 * last->seconds *
                 pow(now->seconds / last->seconds,
                     log(last->error / targets[t]) /
                         log(last->error / now->error));
        if (ms < best[t].ms)
            best[t] = (Best){name, ms};
    }
}

/* What a minimisation leaves undone in a step is a change of velocity of at
 * most its tolerance; the sum over all steps is steps * tolerance * time / 2.
 * That may be a tenth of the error that is expected.  No run takes longer than
 * so much time, none follows an error that is small enough. */
static Status climb(bool quick, const Problem *problem,
                    const IntegratorMethod *method, Best best[TARGETS])
{
    const Motion *motion = problem->motion;
    int segments = problem->simulation.options.segments;
    double longest = quick ? 0.01 : segments / 64.0 + 0.25;
    double enough = quick ? 1e-5 : 1e-8, expected = first_error;
    Rung last = {.error = INFINITY}, now = {.failed = true};
    for (long steps = FIRST_STEPS; now.failed || now.error >= enough;
         steps *= 2) {
        double fastest = INFINITY;
        now = (Rung){.steps = steps,
                     .tolerance = 0.2 * expected / (steps * motion->time)};
        for (int i = 0; i < REPEATS && (i == 0 || !now.failed); i++) {
            Status status = run_once(problem, method, &now);
            if (status)
                return status;
            fastest = fmin(fastest, now.seconds);
        }
        now.seconds = fastest;
        printf("%s,%d,%s,%s,%d,%ld,%.6g,%.6g,%.6g,%d\n", motion->name, segments,
               method->name, method->implicit ? "multigrid" : "none",
               method->order, steps, now.tolerance, now.seconds,
               fmin(now.error, 1e300), now.failed);
        if (!now.failed) {
            find_best(&last, &now, method->name, best);
            last = now;
        }
        if (2 * fastest > longest)
            break;
        expected = fmin(now.failed ? first_error : now.error, first_error) /
                   (1 << method->order);
    }
    return STATUS_OK;
}

/* All methods on one problem, and for each error the fastest explicit and the
 * fastest implicit one. */
static Status climb_all(bool quick, const Problem *problem)
{
    Best best[2][TARGETS];
    for (int i = 0; i < 2 * TARGETS; i++)
        best[i / TARGETS][i % TARGETS] = (Best){NULL, INFINITY};
    for (const IntegratorMethod *row = integrator_methods; row->name; row++) {
        Status status = climb(quick, problem, row, best[row->implicit]);
        if (status)
            return status;
    }
    printf("# %s, %g segments\n#  error m  best explicit             ms  best "
           "implicit        ms  implicit/explicit\n",
           problem->motion->name, problem->simulation.options.segments);
    for (int t = 0; t < TARGETS; t++) {
        const Best *one = &best[0][t], *other = &best[1][t];
        if (one->name && other->name)
            printf("#  %7.0e  %-16s %11.3f  %-14s %8.3f  %8.3g: implicit %s\n",
                   targets[t], one->name, one->ms, other->name, other->ms,
                   other->ms / one->ms, other->ms > one->ms ? "loses" : "wins");
    }
    return STATUS_OK;
}

Status bench_work(bool quick)
{
    Status status = STATUS_OK;
    for (int m = 0; m < MOTIONS; m++)
        for (int i = 0; motions[m].segments[i] && !status; i++) {
            const Motion *motion = &motions[m];
            int segments = quick ? 4 : motion->segments[i];
            Problem problem;
            if (quick && i > 0)
                break;
            status = create_problem(motion, segments, &problem);
            if (!status)
                status = climb_all(quick, &problem);
            simulation_free(&problem.simulation);
            free(problem.exact);
        }
    return status;
}
