/* bench_starts.h - solvers over nine starts.
 */
#ifndef ELASTO_BENCH_STARTS_H
#define ELASTO_BENCH_STARTS_H

#include "bench/bench_report.h"
#include "scenes/options.h"

/* Medians over starts that are a billionth apart, of processor time of one
 * thread. */
typedef struct StartRow {
    int starts;
    double ms, least, most;  /* a step */
    double iterations;       /* a step */
    double smooth, buckling; /* ms, a step of this kind; 0: there was none */
    double energy;           /* at the end, % of that at the start */
    double longest;          /* s, of all runs */
    long unconverged;        /* steps */
} StartRow;

/* So many steps from so many starts, fewer where a run takes long.
 * Returns OK, or what a step failed with. */
Status starts_measure(const Options *options, int starts, int steps,
                      StartRow *row);

/* The same for one or two sorts of runs, by turns: what slows the machine for a
 * while slows both.
 *   options  [sorts]; row [sorts] out */
Status starts_compare(const Options *options, int sorts, int starts, int steps,
                      StartRow *row);

/* Processor time, iterations and energy of every solver at 16 ... 512 segments,
 * with and without the look for negative curvature, and how its steps grow with
 * the nodes.  Which fold a minimisation takes is decided by rounding; so there
 * are nine starts a billionth apart, and the median counts. */
Status bench_starts(Bench *bench);

/* The same step problems for every solver: how often it ends on a saddle, and
 * how often at newton's energy. */
Status bench_saddles(Bench *bench);

#endif
