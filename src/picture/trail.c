#include "picture/trail.h"

#include <string.h>

/* Forgets all. */
void trail_clear(Trail *trail)
{
    trail->count = 0;
}

/* Everything moves by one place where it is full. */
void trail_add(Trail *trail, int runs, const double *point)
{
    if (trail->count == TRAIL_POINTS) {
        trail->count--;
        for (int r = 0; r < runs; r++)
            memmove(trail->point[r][0], trail->point[r][1],
                    (size_t)trail->count * sizeof trail->point[r][0]);
    }
    for (int r = 0; r < runs; r++)
        memcpy(trail->point[r][trail->count], point + 2 * r,
               sizeof trail->point[r][0]);
    trail->count++;
}

void trail_cut(Trail *trail, int steps)
{
    trail->count = steps < trail->count ? trail->count - steps : 0;
}
