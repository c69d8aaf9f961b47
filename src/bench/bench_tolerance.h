/* bench_tolerance.h - what Newton's tolerance costs, and how far from the exact
 * minimiser it stops.
 */
#ifndef ELASTO_BENCH_TOLERANCE_H
#define ELASTO_BENCH_TOLERANCE_H

#include "bench/bench_report.h"

/* Each step of the slides' scene, from the same state, with tolerances from
 * 1e-1 to 1e-10 m/s, against a minimiser that is exact but for rounding.
 * Writes tolerance.csv. */
Status bench_tolerance(Bench *bench);

#endif
