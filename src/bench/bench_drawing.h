/* bench_drawing.h - milliseconds a frame, without a screen.
 */
#ifndef ELASTO_BENCH_DRAWING_H
#define ELASTO_BENCH_DRAWING_H

#include "bench/bench_report.h"

/* Frames of 900 x 900 pixels of squares with 4, 8, ... 256 segments, with the
 * texts around them; the median.  Writes drawing.csv. */
Status bench_drawing(Bench *bench);

#endif
