/* history.h - a few quantities over time, for plots, in constant memory.
 *
 * When it is full every second point goes and from then on only every second
 * one is taken; so it always spans the whole run.
 */
#ifndef ELASTO_HISTORY_H
#define ELASTO_HISTORY_H

enum { HISTORY_SERIES = 16, HISTORY_POINTS = 1024 };

typedef struct History {
    int series;                       /* rows in use, at most HISTORY_SERIES */
    const char *name[HISTORY_SERIES]; /* of each, not owned; the first is the
                                         total where there is one */
    int count;                        /* points, the newest included */
    long stride; /* every stride-th call of history_add is kept */
    long calls;  /* of history_add since it was empty */
    double time[HISTORY_POINTS];                  /* s, ascending */
    double value[HISTORY_SERIES][HISTORY_POINTS]; /* one row a quantity */
} History;

/* Empties it; it has no series any more. */
void history_clear(History *history);

/* The series of this name, which began with 0 where it is new; the last one
 * where there is no room for another. */
int history_series(History *history, const char *name);

/* Appends a point, unless a number is not finite.
 *   time   s, in: above the one before
 *   value  [series] in */
void history_add(History *history, double time, const double *value);

/* Forgets what is later than this time, for a run that goes on from an old
 * state. */
void history_cut(History *history, double time);

#endif
