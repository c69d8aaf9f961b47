/* clock.h - seconds that only go forward: those of the wall, and those that
 * this program has worked.
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

/* The same, of the processor's time, as far as the system tells it: whatever
 * else the computer does is not in it. */
static inline double clock_processor(void)
{
    struct timespec now;
    if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now))
        return clock_now();
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
