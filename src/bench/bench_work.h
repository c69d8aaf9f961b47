/* bench_work.h - error against run time of all methods: what each buys for the
 * time it takes.
 *
 * Every method crosses the same time in 8, 16, 32, ... steps, until it takes
 * too long or is as exact as anybody needs.  Newton's tolerance follows from
 * the error that the last rung of this ladder had (problem_tolerance).
 */
#ifndef ELASTO_BENCH_WORK_H
#define ELASTO_BENCH_WORK_H

#include "bench/bench_problem.h"
#include "bench/bench_report.h"

/* One method with one solver, and its results from coarse to fine. */
enum { LADDER_MAX = 24 };

typedef struct Ladder {
    const IntegratorMethod *method;
    Solver solver;
    int rungs;
    RunResult rung[LADDER_MAX];
    double tolerance[LADDER_MAX]; /* m/s, Newton's */
} Ladder;

/* Climbs it.
 *   longest  s, no rung that would take longer
 *   finest   m, no rung after one with an error below
 * Returns OK or OUT_OF_MEMORY. */
Status ladder_climb(const Bench *bench, const Problem *problem,
                    const IntegratorMethod *method, Solver solver,
                    double longest, double finest, Ladder *ladder);

/* Run time, s, at which the error, m, is reached: interpolated between two
 * rungs; that of the first rung if it is good enough; INFINITY if none is. */
double ladder_seconds(const Ladder *ladder, double error);

/* Writes work_precision.csv, prints what is best for which error. */
Status bench_work_precision(Bench *bench);

#endif
