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

/* Processor time (s) that this program has used, not that of other programs.  A
 * system without such a clock gives the elapsed time. */
static inline double clock_processor_time(void)
{
    struct timespec now;
    if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now))
        return clock_now();
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
