/* history.h - a few quantities over time, for plots, in constant memory.
 *
 * When it is full every second point goes and from then on only every second
 * one is taken; so it always spans the whole run.
 */
#ifndef ELASTO_HISTORY_H
#define ELASTO_HISTORY_H

enum { HISTORY_SERIES = 3, HISTORY_POINTS = 1024 };

typedef struct History {
    int count;   /* points, the newest included */
    long stride; /* every stride-th call of history_add is kept */
    long calls;  /* of history_add since it was empty */
    double high; /* largest value that was ever added, at least 0 */
    double time[HISTORY_POINTS];                  /* s, ascending */
    double value[HISTORY_SERIES][HISTORY_POINTS]; /* one row a quantity */
} History;

/* Empties it. */
void history_clear(History *history);

/* Appends a point; nothing happens if a number is not finite.
 *   time   s, in: above the one before
 *   value  [HISTORY_SERIES] in */
void history_add(History *history, double time, const double *value);

#endif
