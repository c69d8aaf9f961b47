/* history.h - a few quantities over time, for plots. */
#ifndef ELASTO_HISTORY_H
#define ELASTO_HISTORY_H

#include "scenes/simulation.h"

enum { HISTORY_SERIES = 16, HISTORY_POINTS = 1024 };

typedef struct History {
    int series;                       /* rows in use, at most HISTORY_SERIES */
    const char *name[HISTORY_SERIES]; /* of each, not owned; the first is the
                                         total where there is one */
    int count;                        /* points */
    double time[HISTORY_POINTS];      /* s, ascending */
    double value[HISTORY_SERIES][HISTORY_POINTS]; /* one row a quantity */
} History;

/* Appends a point, unless a number is not finite or it is full.  A quantity
 * that is new was 0 before; the last ones are left out where there are too
 * many.
 *   time  s, in: above the one before
 *   row   [rows] in, by their names */
void history_add(History *history, double time, int rows, const Energy *row);

#endif
