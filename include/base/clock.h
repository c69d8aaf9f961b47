/* clock.h - the one clock: seconds that only go forward.
 */
#ifndef ELASTO_CLOCK_H
#define ELASTO_CLOCK_H

/* s since some moment; only differences mean something. */
double clock_now(void);

#endif
