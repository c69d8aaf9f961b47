/* bench.h - the slides' program, for the benchmark. */
#ifndef ELASTO_BENCH_H
#define ELASTO_BENCH_H

#include "lesson/command_line.h"
#include "run/simulation.h"

/* step_forward of src/lecture.c.
 *   system  springs and masses are used, nothing else
 *   h, tol  s, m/s
 *   x, v    [2n] m, m/s, in/out
 * Returns OK, OUT_OF_MEMORY, or LINE_SEARCH_LIMIT: it gave up, as the slides'
 * program may, and x is where it was then. */
Status lecture_step(const System *system, double h, double tol, double *x,
                    double *v);

#endif
