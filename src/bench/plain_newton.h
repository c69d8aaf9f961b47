/* plain_newton.h - the slides' time step as naively as they have it.
 *
 * Every iteration makes all triplets anew, projects 4x4 blocks by their
 * eigenvalues, sorts, analyses the pattern, factors and solves with CHOLMOD's
 * defaults, and the line search evaluates whole energies.  newton.c gives the
 * same iterates in a fraction of the time; the benchmark says how much, and a
 * test holds the two equal.  Springs only: no pins, no central field.
 */
#ifndef ELASTO_PLAIN_NEWTON_H
#define ELASTO_PLAIN_NEWTON_H

#include "base/status.h"
#include "model/system.h"

/* What was done, and how long it took, s. */
typedef struct PlainCounters {
    long iterations; /* updates */
    long factorisations;
    double seconds_assembly; /* gradient, triplets, projection, sorting */
    double seconds_analysis;
    double seconds_factor, seconds_solve, seconds_search;
} PlainCounters;

/* One step of implicit Euler (slides: step_forward in time_integrator.py).
 *   h               s
 *   tolerance       m/s
 *   max_iterations  then ITERATION_LIMIT
 *   x, v            [2n] m, m/s, in/out
 *   counters        in/out, added to
 * Returns OK; an unconverged status (the step was made); or a failure:
 * OUT_OF_MEMORY, NOT_FINITE (x and v as they were). */
Status plain_newton_step(const System *system, double h, double tolerance,
                         int max_iterations, double *x, double *v,
                         PlainCounters *counters);

#endif
