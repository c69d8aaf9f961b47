/* bench_filters.h - what is done with negative eigenvalues, and how many
 * iterations that takes.
 */
#ifndef ELASTO_BENCH_FILTERS_H
#define ELASTO_BENCH_FILTERS_H

#include "bench/bench_report.h"

/* Ten steps of 8 x 8 cells with each filter, stretched by 0.2 ... 3, with the
 * slides' time step and five times that.  Writes filters.csv. */
Status bench_filters(Bench *bench);

#endif
