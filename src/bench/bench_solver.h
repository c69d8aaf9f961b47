/* bench_solver.h - milliseconds a step, and where they go, from small squares
 * to large ones.
 */
#ifndef ELASTO_BENCH_SOLVER_H
#define ELASTO_BENCH_SOLVER_H

#include "bench/bench_report.h"

/* Ten steps of the slides' scene at 4, 8, ... 256 segments with each solver;
 * one that takes too long is stopped and left out on larger squares.  Writes
 * solver.csv. */
Status bench_solver(Bench *bench);

#endif
