/* rounding.h - what guards the digits.
 *
 * Two places lose them.  Near a minimum every further decrease may be smaller
 * than the rounding of E.  And where w k outweighs the masses beyond the 16
 * digits of a double, the gradient itself may be rounding, and along a far
 * direction its slope anything.  In the second kind of scene, and in every one
 * without a line search, a minimisation is held to what E really is.
 */
#ifndef ELASTO_ROUNDING_H
#define ELASTO_ROUNDING_H

#include "solve/newton.h"

/* Bounds of the system: before the first minimisation, and after stiffnesses
 * or masses changed. */
void rounding_bounds(const System *system, Rounding *rounding);

/* At the start of a minimisation. */
void rounding_start(Newton *newton);

/* Whether a change of E, J s^2, is at most a few units in its last place. */
bool rounding_hides(const Newton *newton, double change);

/* Whether E is as low at u + alpha way as the line search says it is; always
 * true where the minimisation is not held to it.  Writes over g and spare
 * [2n]. */
bool rounding_allows(Newton *newton, const double *way, double alpha,
                     double *spare);

/* After an iteration that did not converge: RUNNING, or ROUNDING_LIMIT where
 * the residual has not become smaller for long and E does not fall. */
Status rounding_stagnation(Newton *newton);

/* Whether a minimisation that is held to E has ended above its start. */
bool rounding_sees_rise(const Newton *newton);

#endif
