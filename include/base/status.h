/* status.h - every way in which a call can end, each with a text.
 *
 * A function that can fail returns a Status.  STATUS_OK is 0, so `if (status)`
 * reads "if the call failed", except after a step, which may also be unfinished
 * or end without convergence.  Numeric kernels cannot fail. */
#pragma once

#include <stdbool.h>

/* Each row: the constant without its prefix, the name in logs, and a sentence
 * for messages, without full stop.  status_is_unconverged is true from
 * ITERATION_LIMIT to DIVERGED, status_is_failure after DIVERGED. */
#define STATUSES(F)                                                            \
    F(OK, ok, "converged")                                                     \
    F(RUNNING, running, "not at the end yet")                                  \
    F(ITERATION_LIMIT, iteration_limit, "Newton used all its iterations")      \
    F(LINE_SEARCH_LIMIT, line_search_limit,                                    \
      "the line search found no step that lowers the energy")                  \
    F(NOT_DESCENT, not_descent,                                                \
      "the search direction points uphill and no small step along it helps")   \
    F(ROUNDING_LIMIT, rounding_limit,                                          \
      "rounding hides every further decrease above the tolerance")             \
    F(NOT_POSITIVE_DEFINITE, not_positive_definite,                            \
      "the Hessian is not positive definite")                                  \
    F(SINGULAR, singular, "the Hessian is singular")                           \
    F(BLOCKED, blocked, "a moving obstacle or pin found no room")              \
    F(DIVERGED, diverged, "E ended above where it began")                      \
    F(NOT_FINITE, not_finite, "a number became NaN or infinite")               \
    F(INTERRUPTED, interrupted, "interrupted")                                 \
    F(INVALID_INPUT, invalid_input, "the input is out of range")               \
    F(TOO_LARGE, too_large, "the matrix is too large for 32-bit indices")      \
    F(OUT_OF_MEMORY, out_of_memory, "not enough memory")                       \
    F(FILE_FAILED, file_failed, "a file could not be written") /* errno */     \
    F(SCREEN_FAILED, screen_failed, "drawing failed")          /* Window */

#define STATUS_CONSTANT(name, lower, text) STATUS_##name,
typedef enum Status { STATUSES(STATUS_CONSTANT) STATUS_COUNT } Status;

/* Returns the sentence of a status for messages. */
const char *status_text(Status status);

/* Returns the name of a status in logs. */
const char *status_name(Status status);

/* Whether a step ended in a finite state that is not the minimiser.  E did not
 * rise, except for DIVERGED.  The run continues and reports the status. */
bool status_is_unconverged(Status status);

/* Whether a finished call has failed: neither OK nor unconverged. */
bool status_is_failure(Status status);
