/* start_table.h - a start out of a file: the last step of a table of states.
 */
#ifndef ELASTO_START_TABLE_H
#define ELASTO_START_TABLE_H

#include <stddef.h>

#include "base/status.h"

/* The last step of a table that --states wrote, of the nodes of one run.
 *   nodes    n of each run; those of run r follow those of run r - 1
 *   x, v     [2n] out, m, m/s
 *   message  [size] out, one line unless OK is returned
 * Returns OK; INVALID_INPUT: there is no such table, or it has other nodes or
 * fewer runs.  (Of a table of several runs a scene of one takes the first.) */
Status start_table_read(const char *name, int nodes, int run, double *x,
                        double *v, char *message, size_t size);

#endif
