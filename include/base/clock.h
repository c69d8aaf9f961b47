/* clock.h - elapsed time and processor time, in seconds.  Only differences of
 * two readings have a meaning. */
#pragma once

#include <time.h>

/* Elapsed time, s.  The clock never goes back. */
static inline double clock_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Processor time that this program has used, s, so other programs do not count.
 * A system without such a clock gives the elapsed time. */
static inline double clock_processor_time(void)
{
    struct timespec now;
    if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now))
        return clock_now();
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
