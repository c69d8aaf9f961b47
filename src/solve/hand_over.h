/* hand_over.h - Newton's minimisations that multigrid takes over, and what it
 * gives back.
 */
#ifndef ELASTO_HAND_OVER_H
#define ELASTO_HAND_OVER_H

#include "solve/newton.h"

/* Whether multigrid is asked for, and takes the minimisation that newton->at
 * describes; working and refusal say so. */
bool hand_over_wanted(Newton *newton);

/* In the place of direction_first. */
Status hand_over_start(Newton *newton);

/* In the place of an iteration.  What multigrid cannot end, such as a search
 * among rounding errors, goes on by factors from where it is. */
Status hand_over_iterate(Newton *newton);

#endif
