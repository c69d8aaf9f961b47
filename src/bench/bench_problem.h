/* bench_problem.h - one motion with its exact end, and what a method makes of
 * it: the run time and the error of one run.
 */
#ifndef ELASTO_BENCH_PROBLEM_H
#define ELASTO_BENCH_PROBLEM_H

#include "bench/bench_reference.h"
#include "scenes/simulation.h"

typedef struct Motion {
    const char *name;
    double stiffness; /* J/m^2 */
    double stretch;   /* at the start */
    double spin;      /* rad/s, angular velocity at the start */
    double time;      /* s */
} Motion;

typedef struct Problem {
    Motion motion;
    int segments;
    Simulation simulation; /* its system is what runs are made with */
    double *x, *v;         /* [2n] m, m/s at the start */
    double energy;         /* J at the start, > 0 */
    Reference reference;
    double self_error; /* m, of the reference, with half the intervals */
    double growth;     /* of a random disturbance of 1e-9 m until the end */
} Problem;

/* One run, or the fastest of several equal ones. */
typedef struct RunResult {
    long steps;
    double seconds; /* from nothing to the end */
    double error;   /* m, root mean square over the masses */
    double drift;   /* |energy at the end / at the start - 1| */
    long iterations, factorisations; /* Newton's */
    long unconverged;                /* steps */
    Status status;                   /* OK, or why it ended before its time */
    bool failed; /* not finite, or unconverged steps, or gone by a side */
} RunResult;

/* The slides' numbers, on a square of so many segments. */
Options slides_options(int segments);

/* Fills the problem; free it with problem_free in any case.
 * Returns OK, OUT_OF_MEMORY, INVALID_INPUT. */
Status problem_create(const Motion *motion, int segments, Problem *problem);
void problem_free(Problem *problem);

/* Error and drift of a state.  x [2n] m, v [2n] m/s in. */
void problem_judge(const Problem *problem, const double *x, const double *v,
                   RunResult *result);

/* The motion in so many equal steps, several times.
 *   solver, tolerance  Newton's; explicit methods ignore them
 *   repeats            1 or more
 * Returns OK or OUT_OF_MEMORY; what else happens is a result. */
Status problem_run(const Problem *problem, const IntegratorMethod *method,
                   Solver solver, long steps, double tolerance, int repeats,
                   RunResult *result);

/* Newton's tolerance, m/s, where an error of so many metres is expected: what
 * is left undone in a step is a change of velocity of at most the tolerance,
 * which by the end has moved the masses by at most tolerance * time; the sum
 * over all steps is steps * tolerance * time / 2.  That may be a tenth of the
 * error. */
double problem_tolerance(const Problem *problem, long steps, double error);

#endif
