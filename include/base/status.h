/* status.h - every way in which a call can end, each with a text.
 *
 * What can fail returns a Status.  STATUS_OK is 0, so `if (status)` reads
 * "if it did not work".  Numeric kernels cannot fail and return nothing.
 */
#ifndef ELASTO_STATUS_H
#define ELASTO_STATUS_H

#include <stdbool.h>

typedef enum Status {
    STATUS_OK = 0,
    STATUS_RUNNING, /* not at the end yet: iterate again */
    /* From here to DIVERGED: see status_is_unconverged. */
    STATUS_ITERATION_LIMIT,       /* Newton used all its iterations */
    STATUS_LINE_SEARCH_LIMIT,     /* no step length lowers the energy */
    STATUS_NOT_DESCENT,           /* the direction points uphill */
    STATUS_ROUNDING_LIMIT,        /* no decrease larger than rounding left */
    STATUS_NOT_A_MINIMUM,         /* gradient 0, but the energy bends down */
    STATUS_NOT_POSITIVE_DEFINITE, /* Cholesky met a pivot that is not > 0 */
    STATUS_SINGULAR,              /* a system without usable solution */
    STATUS_BLOCKED,               /* a wall or a pin could not be moved on */
    STATUS_DIVERGED,              /* E ended above where it began */
    STATUS_NOT_FINITE,            /* NaN or infinity appeared */
    STATUS_INTERRUPTED,           /* the observer asked to stop */
    STATUS_INVALID_INPUT,         /* an argument outside its range */
    STATUS_TOO_LARGE,             /* an index or a size does not fit */
    STATUS_OUT_OF_MEMORY,
    STATUS_FILE_FAILED,   /* errno tells the reason */
    STATUS_SCREEN_FAILED, /* view_failure tells the reason */
    STATUS_COUNT
} Status;

/* A sentence without full stop, for people. */
const char *status_text(Status status);

/* The name of the constant without its prefix in lower case, for logs. */
const char *status_name(Status status);

/* True where a step ended with a usable state that is not the minimiser:
 * finite, and E not raised, but for DIVERGED.  The run goes on, and says so. */
bool status_is_unconverged(Status status);

#endif
