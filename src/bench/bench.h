/* bench.h - a step of lecture.c, for the benchmark. */
#ifndef ELASTO_BENCH_H
#define ELASTO_BENCH_H

#include "lesson/command_line.h"
#include "run/simulation.h"

/* Makes a step by step_forward of src/lecture.c.
 *   system  in; only springs and masses are used
 *   h       s, time step
 *   tol     m/s, tolerance
 *   x, v    [2n] m, m/s, in/out
 * Returns OK, OUT_OF_MEMORY, or LINE_SEARCH_LIMIT where lecture.c ends the
 * program; x is then the last iterate. */
Status lecture_step(const System *system, double h, double tol, double *x,
                    double *v);

#endif
