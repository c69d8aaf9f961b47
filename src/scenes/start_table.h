/* start_table.h - a start out of a file: a step of a table of states.
 */
#ifndef ELASTO_START_TABLE_H
#define ELASTO_START_TABLE_H

#include "scenes/one_line.h"

/* One step of what --states wrote, CSV or .npz, of the nodes of one run.  A
 * .npz may be any with the arrays x, y, vx, vy [step, node] or [node], stored
 * (numpy.savez).
 *   step     below 0: the last one
 *   nodes    n of each run; those of run r follow those of run r - 1
 *   runs     of the scene
 *   x, v     [2n] out, m, m/s
 * Returns OK; INVALID_INPUT: there is no such table or step, or it has other
 * nodes or fewer runs, or more of them and no panes.  (Of a table of several
 * panes it takes the first.) */
Status start_table_read(const char *name, double step, int nodes, int run,
                        int runs, double *x, double *v, Refusal told);

#endif
