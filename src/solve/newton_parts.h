/* newton_parts.h - what Newton's loop (newton.c) calls by name, each in a file
 * of its own.
 */
#ifndef ELASTO_NEWTON_PARTS_H
#define ELASTO_NEWTON_PARTS_H

#include "solve/newton.h"

/* ---- direction.c: gradient, search direction and the test of Algorithm 3 at
 * each iterate. */

/* Frees the matrix and its factor, which are made where they are needed. */
void direction_free_matrix(SearchDirection *search);

/* At the start of a minimisation: fills g, p, residual and, of the record, what
 * concerns them.  A gradient that vanishes passes the test, but may be that of
 * a maximum or a saddle, such as all nodes in one point: this is checked.
 * Returns OK (the test is passed), RUNNING, NOT_A_MINIMUM, or a failure. */
Status direction_first(Newton *newton);

/* The same after an update; at a saddle that multigrid came to, p leads away.
 * Return OK, RUNNING, or a failure. */
Status direction_next(Newton *newton);
Status direction_from_saddle(Newton *newton);

/* Whether the Hessian as it is, with `times` M in place of M, is positive
 * definite: by bounds, and where they do not tell by its Cholesky factor.
 * Writes over x_trial.  Returns OK, NOT_A_MINIMUM, or a failure. */
Status direction_bends_up(Newton *newton, double times);

/* Whether E bends down at the iterate by more than a hundred masses, or at all
 * where a minimum is asked for: no end.  Returns as direction_bends_up. */
Status direction_judges_end(Newton *newton);

/* ---- line_search.c: how far to go along p (slide: Algorithm 2). */

/* Fills alpha, trials, slope and change of the record, u_trial and x_trial.
 * Returns OK, or why no step lowers E: LINE_SEARCH_LIMIT, NOT_DESCENT,
 * ROUNDING_LIMIT, NOT_FINITE; alpha and change are then 0. */
Status step_length(Newton *newton);

/* ---- rounding.c: what guards the digits.  Two places lose them.  Near a
 * minimum every further decrease may be smaller than the rounding of E.  And
 * where w k outweighs the masses beyond the 16 digits of a double, the gradient
 * itself may be rounding, and along a far direction its slope anything.  In the
 * second kind of scene, and in every one without a line search, a minimisation
 * is held to what E really is. */

/* At the start of a minimisation. */
void rounding_start(Newton *newton);

/* Whether a change of E, J s^2, is at most a few units in its last place. */
bool rounding_hides(const Newton *newton, double change);

/* Whether E at u_trial, as large as it is, agrees that it has changed by
 * record.change or fallen more; true where rounding_is_low decides, or nothing
 * has to fall. */
bool rounding_confirms(Newton *newton);

/* Whether E at u, x [2n] is as low as at the start; always true where the
 * minimisation is not held to it. */
bool rounding_is_low(const Newton *newton, const double *u, const double *x);

/* After an iteration that did not converge: RUNNING, or, where the residual has
 * not become smaller for long, ROUNDING_LIMIT if E does not fall any more, and
 * ITERATION_LIMIT if no line search makes it fall. */
Status rounding_stagnation(Newton *newton);

#endif
