/* bench_lecture.h - the slides' algorithm as src/lecture.c has it, timed.
 *
 * Every iteration makes all triplets anew, projects 4x4 blocks by their
 * eigenvalues, sorts, analyses the pattern, factors and solves with CHOLMOD's
 * defaults, and the line search evaluates whole energies.
 */
#ifndef ELASTO_BENCH_LECTURE_H
#define ELASTO_BENCH_LECTURE_H

#include "base/status.h"
#include "model/system.h"

/* What was done, and how long it took, s. */
typedef struct LectureCounters {
    long factorisations;     /* one more than updates in each step */
    double seconds_assembly; /* triplets, projection, sorting, gradient */
    double seconds_analysis;
    double seconds_factor, seconds_solve;
    double seconds_search; /* all that is outside search_dir */
} LectureCounters;

/* step_forward of lecture.c.
 *   system    springs and masses are used, nothing else
 *   h, tol    s, m/s
 *   x, v      [2n] m, m/s, in/out
 *   counters  in/out, added to
 * Returns OK, OUT_OF_MEMORY, or LINE_SEARCH_LIMIT: it gave up (and said why on
 * standard error), and x is where it was then. */
Status lecture_step(const System *system, double h, double tol, double *x,
                    double *v, LectureCounters *counters);

#endif
