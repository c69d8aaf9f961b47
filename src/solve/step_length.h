/* step_length.h - how far to go along p (slide: Algorithm 2).
 */
#ifndef ELASTO_STEP_LENGTH_H
#define ELASTO_STEP_LENGTH_H

#include "solve/newton.h"

/* Fills alpha, trials, slope and change of the record.
 * Returns OK, or why no step lowers E: LINE_SEARCH_LIMIT, NOT_DESCENT,
 * ROUNDING_LIMIT, NOT_FINITE; alpha and change are then 0. */
Status step_length(Newton *newton);

#endif
