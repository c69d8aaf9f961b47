/* multigrid.h - the minimiser of a time step on a square grid of springs,
 * without a factor of any matrix.
 *
 * Newton's method for E = |u - u_tilde|_M^2/2 + w P(x_n + u), whose directions
 * come from conjugate gradients on the clamped Hessian, preconditioned by one
 * multigrid V-cycle each (v_cycle.h); the step along one is exact, as E is a
 * quartic there.  Where folds run, tiles of nodes relax in between (tiles.h).
 * No update raises E.
 *
 * The test of Algorithm 3 needs p = -H^-1 g, which conjugate gradients know up
 * to a remainder r = -g - H p, here computed in double precision.  H - M is
 * positive semi-definite, so the error is at most |r|_(M^-1) in the norm of M,
 * and the residual, max over nodes of |p_x| + |p_y|, over h, is known up to
 * sqrt(2/m)/h |r|_(M^-1) with the smallest m.  The iteration goes on until that
 * decides the test, to either side; what is not decided is not converged.
 *
 * A step depends on nothing but what it is given.  Results have the same bits
 * for every width of registers.
 */
#ifndef ELASTO_MULTIGRID_H
#define ELASTO_MULTIGRID_H

#include "solve/newton.h"

/* Allocates for segments x segments cells.
 * Returns OK, OUT_OF_MEMORY (then *multigrid is NULL). */
Status multigrid_create(int segments, Multigrid **multigrid);
void multigrid_free(Multigrid *multigrid);

/* Whether multigrid makes the minimisation that newton->at describes: it is
 * asked for, and the terms and settings are those that it knows.  Writes
 * newton->refusal where it is asked for and cannot. */
bool multigrid_takes(Newton *newton);

#endif
