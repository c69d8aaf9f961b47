/* trail.h - where points were in the last few steps.
 */
#ifndef ELASTO_TRAIL_H
#define ELASTO_TRAIL_H

enum { TRAIL_POINTS = 256, TRAIL_RUNS = 3 };

typedef struct Trail {
    int count;                                 /* steps it remembers */
    double point[TRAIL_RUNS][TRAIL_POINTS][2]; /* m, oldest first */
} Trail;

/* Forgets all. */
void trail_clear(Trail *trail);

/* Appends a step; the oldest one goes when there is no room.
 *   point  [2 runs] m, in; runs at most TRAIL_RUNS */
void trail_add(Trail *trail, int runs, const double *point);

/* Forgets the newest `steps` steps. */
void trail_cut(Trail *trail, int steps);

#endif
