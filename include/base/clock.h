/* clock.h - the one clock: seconds that only go forward.
 */
#ifndef ELASTO_CLOCK_H
#define ELASTO_CLOCK_H

#include <time.h>

/* s since some moment; only differences mean something. */
static inline double clock_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
