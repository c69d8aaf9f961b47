/* bench_claims.h - what is said about this program, measured.
 */
#ifndef ELASTO_BENCH_CLAIMS_H
#define ELASTO_BENCH_CLAIMS_H

#include "bench/bench_report.h"

/* Runs that are compared alternate, and each ratio is the median of theirs.
 * Writes claims.csv. */
Status bench_claims(Bench *bench);

#endif
