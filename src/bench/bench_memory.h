/* bench_memory.h - one step of a large square: time and memory.
 */
#ifndef ELASTO_BENCH_MEMORY_H
#define ELASTO_BENCH_MEMORY_H

#include "bench/bench_report.h"

/* One step at 512 segments with the multigrid solver.  The peak of the process
 * tells something only if this is the first part that runs.  Writes
 * memory.csv. */
Status bench_memory(Bench *bench);

#endif
