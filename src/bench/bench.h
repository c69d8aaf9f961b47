/* bench.h - what the tables of the benchmark share: the clock, and claims that
 * are checked where they are printed.
 */
#ifndef ELASTO_BENCH_H
#define ELASTO_BENCH_H

#include "scenes/simulation.h"

/* A table: prints its rows as CSV, and what is said of them behind a #.
 *   quick  seconds instead of minutes: does it all work?
 * Returns OK, OUT_OF_MEMORY. */
Status bench_work(bool quick);

/* Processor time of this thread, s: what a busy machine changes least. */
double bench_cpu(void);

/* The slides' numbers, on a square of so many segments. */
Options slides_options(int segments);

/* step_forward of src/lecture.c.
 *   system  springs and masses are used, nothing else
 *   h, tol  s, m/s
 *   x, v    [2n] m, m/s, in/out
 * Returns OK, OUT_OF_MEMORY, or LINE_SEARCH_LIMIT: it gave up, as the slides'
 * program may, and x is where it was then. */
Status lecture_step(const System *system, double h, double tol, double *x,
                    double *v);

#endif
