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

/* Newton's factors take too long on squares larger than this; it gives up
 * after so many updates of a step. */
enum { NEWTON_SEGMENTS = 64, MAX_UPDATES = 2000 };

enum { LADDERS = 40, RUNGS = 24, FIRST_STEPS = 8, REPEATS = 3 };

/* Errors that the table asks for; the one that the first rung may have, m. */
static const double targets[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
static const double first_error = 1e-2;

typedef struct Problem {
    const Motion *motion;
    Simulation simulation; /* its system is what runs are made with */
    double *v;             /* [2n] m/s at the start */
    double *exact;         /* [4n] m, m/s, at the end; then [4n] room */
} Problem;

/* One run, or the fastest of several equal ones. */
typedef struct Rung {
    long steps;
    double tolerance, seconds;
    double error; /* m, root mean square over the masses */
    bool failed;  /* not finite, not converged, or gone by a side */
} Rung;

typedef struct Ladder {
    const IntegratorMethod *method;
    Solver solver;
    int rungs;
    Rung rung[RUNGS];
} Ladder;

/* Lagrange: sum over j of w_j f(1/n_j) is the value at 0 of the polynomial in
 * 1/n^2 through all f, with w_j = product over i of n_j^2 / (n_j^2 - n_i^2). */
static double weight_of(int j, int columns)
{
    double weight = 1;
    for (int i = 1; i <= columns; i++)
        weight *= i == j ? 1 : (double)(j * j) / (j * j - i * i);
    return weight;
}

/* Each interval H, omega H <= 1, is crossed by velocity Verlet in 1, 2, ... 6
 * steps; these results are extrapolated to steps of length 0.  Verlet is
 * symmetric, its error has even powers of the step, and what is left is
 * O(H^12) (Gragg 1965). */
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
    TimeIntegrator run;
    Status status =
        time_integrator_create(integrator_method("verlet"), system,
                               &(NewtonSettings){.h = H, .tolerance = 1},
                               problem->simulation.run[0].x, problem->v, &run);
    size_t both = 2 * run.size; /* v is behind x */
    double *start = problem->exact + both;
    if (!status)
        memcpy(problem->exact, run.x, both * sizeof *start);
    for (long k = 0; k < intervals && !status; k++) {
        memcpy(start, problem->exact, both * sizeof *start);
        for (int j = 1; j <= COLUMNS && !status; j++) {
            double weight = weight_of(j, COLUMNS);
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
    const System *system = &simulation->system;
    const double *x = simulation->run[0].x;
    problem->v = malloc(10 * (size_t)system->nodes * sizeof *problem->v);
    if (!problem->v)
        return STATUS_OUT_OF_MEMORY;
    problem->exact = problem->v + 2 * system->nodes;
    for (int i = 0; i < system->nodes; i++) {
        problem->v[2 * i] = -motion->spin * x[2 * i + 1];
        problem->v[2 * i + 1] = motion->spin * x[2 * i];
    }
    return find_exact(problem);
}

/* From nothing to the end, once. */
static Status run_once(const Problem *problem, const Ladder *ladder, Rung *rung)
{
    NewtonSettings settings = {.h = problem->motion->time / (double)rung->steps,
                               .tolerance = rung->tolerance,
                               .solver = ladder->solver,
                               .max_iterations = MAX_UPDATES};
    System system = problem->simulation.system; /* the same arrays */
    TimeIntegrator run;
    double start = bench_cpu();
    Status status =
        time_integrator_create(ladder->method, &system, &settings,
                               problem->simulation.run[0].x, problem->v, &run);
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

/* What Newton leaves undone in a step is a change of velocity of at most its
 * tolerance; the sum over all steps is steps * tolerance * time / 2.  That may
 * be a tenth of the error that is expected.
 *   longest, finest  s, m: no rung above, none after an error below */
static Status climb(const Problem *problem, double longest, double finest,
                    Ladder *ladder)
{
    double expected = first_error;
    for (long steps = FIRST_STEPS; ladder->rungs < RUNGS; steps *= 2) {
        Rung *rung = &ladder->rung[ladder->rungs++];
        double fastest = INFINITY;
        *rung = (Rung){.steps = steps};
        rung->tolerance =
            0.2 * expected / ((double)steps * problem->motion->time);
        for (int i = 0; i < REPEATS && (i == 0 || !rung->failed); i++) {
            Status status = run_once(problem, ladder, rung);
            if (status)
                return status;
            fastest = fmin(fastest, rung->seconds);
        }
        rung->seconds = fastest;
        if (2 * fastest > longest || (!rung->failed && rung->error < finest))
            break;
        expected = fmin(rung->failed ? first_error : rung->error, first_error) /
                   (1 << ladder->method->order);
    }
    return STATUS_OK;
}

/* Run time, s, at which the error is reached: interpolated between two rungs;
 * INFINITY if none does. */
static double seconds_for(const Ladder *ladder, double error)
{
    const Rung *last = NULL;
    for (int i = 0; i < ladder->rungs; i++) {
        const Rung *next = &ladder->rung[i];
        if (next->failed)
            continue;
        if (next->error <= error) {
            if (!last)
                return next->seconds;
            double part =
                log(last->error / error) / log(last->error / next->error);
            return last->seconds * pow(next->seconds / last->seconds, part);
        }
        last = next;
    }
    return INFINITY;
}

static const char *solver_of(const Ladder *ladder)
{
    return ladder->method->implicit ? solver_name(ladder->solver) : "none";
}

/* For each error the fastest explicit and the fastest implicit method. */
static void print_targets(const Ladder *ladders, int count)
{
    puts("   error m  best explicit             ms  best implicit"
         "                  ms  implicit/explicit");
    for (size_t t = 0; t < sizeof targets / sizeof *targets; t++) {
        const Ladder *best[2] = {NULL, NULL};
        double ms[2] = {INFINITY, INFINITY};
        for (int i = 0; i < count; i++) {
            int kind = ladders[i].method->implicit;
            double spent = 1e3 * seconds_for(&ladders[i], targets[t]);
            if (spent < ms[kind]) {
                best[kind] = &ladders[i];
                ms[kind] = spent;
            }
        }
        if (!best[0] || !best[1])
            continue;
        printf("   %7.0e  %-16s %11.3f  %-14s %-9s %8.3f  %8.3g: implicit %s\n",
               targets[t], best[0]->method->name, ms[0], best[1]->method->name,
               solver_of(best[1]), ms[1], ms[1] / ms[0],
               ms[1] > ms[0] ? "loses" : "wins");
    }
}

static void write_ladder(Bench *bench, const Problem *problem,
                         const Ladder *ladder)
{
    for (int i = 0; i < ladder->rungs; i++) {
        const Rung *rung = &ladder->rung[i];
        bench_row(bench, "%s,%d,%s,%s,%d,%ld,%.6g,%.6g,%.6g,%d",
                  problem->motion->name,
                  (int)problem->simulation.options.segments,
                  ladder->method->name, solver_of(ladder),
                  ladder->method->order, rung->steps, rung->tolerance,
                  rung->seconds, fmin(rung->error, 1e300), rung->failed);
    }
}

/* All methods on one problem. */
static Status climb_all(Bench *bench, const Problem *problem)
{
    static Ladder ladders[LADDERS];
    int count = 0, segments = problem->simulation.options.segments;
    double longest = bench->quick ? 0.01 : segments / 64.0 + 0.25;
    Status status = STATUS_OK;
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        for (int s = 0; s < (row->implicit ? SOLVER_COUNT : 1); s++) {
            if (status || count == LADDERS)
                return status;
            if (row->implicit && s == SOLVER_NEWTON &&
                segments > NEWTON_SEGMENTS)
                continue;
            Ladder *ladder = &ladders[count++];
            *ladder = (Ladder){.method = row, .solver = (Solver)s};
            status =
                climb(problem, longest, bench->quick ? 1e-5 : 1e-8, ladder);
            write_ladder(bench, problem, ladder);
        }
    print_targets(ladders, count);
    return status;
}

Status bench_work(Bench *bench)
{
    Status status = STATUS_OK;
    for (int m = 0; m < MOTIONS; m++)
        for (int i = 0; motions[m].segments[i] && !status; i++) {
            const Motion *motion = &motions[m];
            int segments = bench->quick ? 4 : motion->segments[i];
            Problem problem;
            if (bench->quick && i > 0)
                break;
            printf("\n  %s: %d segments, k %.0e J/m^2, stretch %g, spin %g "
                   "rad/s, %g s\n",
                   motion->name, segments, motion->stiffness, motion->stretch,
                   motion->spin, motion->time);
            status = create_problem(motion, segments, &problem);
            if (!status)
                status = climb_all(bench, &problem);
            simulation_free(&problem.simulation);
            free(problem.v);
        }
    return status;
}
