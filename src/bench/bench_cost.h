/* bench_cost.h - what steps of implicit Euler cost, and where the time goes.
 */
#ifndef ELASTO_BENCH_COST_H
#define ELASTO_BENCH_COST_H

#include "scenes/simulation.h"

/* Who makes the steps: a solver of newton.h, or lecture.c. */
enum { COST_PLAIN = SOLVER_COUNT, COST_SOLVERS };

/* Sums over all steps; s. */
typedef struct Cost {
    long steps;
    double total; /* of the steps alone, with the analysis of the pattern */
    double assembly, analysis, factor, solve, search, multigrid, rest;
    long iterations, factorisations, solves, unconverged;
    double energy_start, energy_end; /* J */
    double bare;    /* as many calls of factor and solve alone, in a row */
    double memory;  /* bytes that CHOLMOD held at most; 0: unknown */
    bool timed_out; /* stopped before its last step: nothing else is filled */
} Cost;

const char *cost_name(int solver);

/* Makes the steps.
 *   options  the scene, but for the solver
 *   solver   a Solver or COST_PLAIN
 *   longest  s, then it is stopped
 * Returns OK; OUT_OF_MEMORY or whatever a step failed with. */
Status cost_measure(const Options *options, int solver, long steps,
                    double longest, Cost *cost);

/* The one of count costs that has the median total. */
const Cost *cost_median(Cost *costs, int count);

#endif
