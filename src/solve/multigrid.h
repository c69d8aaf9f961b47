/* multigrid.h - minimises E on a square grid of springs without a matrix.
 *
 * Newton's method for E = |u - u_tilde|_M^2/2 + w P(x_n + u).  A multigrid
 * V-cycle on the Hessian finds the directions (v_cycle.h).  Each direction is
 * made conjugate to the one before.  E along a direction is a quartic, whose
 * minimum is the step length.  After a poor direction tiles of nodes find a
 * second one (tiles.h); the direction that follows is not conjugate.  The
 * Hessian is clamped from the second poor direction of a step on until one
 * V-cycle gives a good one, and where E does not fall along p.  No update
 * raises E.
 *
 * The test of Algorithm 3 needs p = -H^-1 g with the clamped H, which conjugate
 * gradients know up to a linear residual r = -g - H p, computed in double
 * precision.  H - M is positive semi-definite, so the error of p is at most
 * |r|_(M^-1) in the norm of M, and the residual, max over nodes of |p_x| +
 * |p_y|, over h, is known up to sqrt(2/m)/h |r|_(M^-1) with the smallest m.  p
 * passes the test if the residual plus this bound is at most the tolerance.
 * With p = 0, r = -g the bound limits the next p: a step also ends if that p is
 * negligible.  If p seems to pass, and the next p is at most half of the
 * tolerance, the next p is the last one.
 *
 * A step depends on its arguments alone.  Results have the same bits for every
 * width of registers. */
#pragma once

#include "solve/newton.h"

/* Allocates multigrid for a square of segments x segments cells.  Returns OK,
 * OUT_OF_MEMORY (then *multigrid is NULL). */
Status multigrid_create(int segments, Multigrid **multigrid);
void multigrid_free(Multigrid *multigrid);

/* Whether multigrid makes the minimisation that newton->iterate describes: the
 * settings ask for multigrid, and all terms suit it.  newton->refusal_reason
 * becomes the reason why multigrid cannot, or NULL. */
bool multigrid_accepts_problem(Newton *newton);
