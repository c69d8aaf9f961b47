/* v_cycle.h - a geometric multigrid V-cycle for the clamped Hessian of grid.h:
 * the preconditioner of conjugate gradients.
 *
 * Each spring's Hessian is a symmetric 2x2 tensor K (the block of its nodes is
 * [[K, -K], [-K, K]]).  The next coarser level has every second node; its
 * springs have the mean tensor of the four finer ones that each stands for
 * (in two dimensions stiffness does not change with the length), its masses
 * are P^T m.  P is bilinear interpolation, P^T the restriction, and a damped
 * block Jacobi iteration smooths: once before and once after on the finest
 * level, twice on the coarser ones.  All that is symmetric, so the cycle is a
 * symmetric positive definite matrix.
 *
 * Its numbers are of single precision, and so are the conjugate gradients that
 * it has beside it: they find directions, and what a test needs to know of them
 * is computed again in double precision.  Up to 32 segments, where a fold can
 * hang on the last bits of a direction, they are of double precision.
 */
#ifndef ELASTO_V_CYCLE_H
#define ELASTO_V_CYCLE_H

#include "solve/grid.h"

typedef struct VCycle VCycle;

/* Allocates for this grid, which must outlive it.  NULL: out of memory. */
VCycle *v_cycle_create(const Grid *grid);
void v_cycle_free(VCycle *cycle);

/* Masses and pins, after grid_set_nodes. */
void v_cycle_set_nodes(VCycle *cycle);

/* The tensors of all levels at grid->x. */
void v_cycle_set_up(VCycle *cycle);

/* z = B r.  size  a number about as large as the largest of r. */
void v_cycle_apply(VCycle *cycle, const double *r, double size, double *z);

/* ---- conjugate gradients for H p = s r, in the precision of the cycle and
 * with the tensors of its finest level: exact to some 6 digits of r, where a
 * new begin with the remainder goes on.
 *
 * H B b is computed for each remainder b, in the loops of the cycle itself,
 * where tensors are near; H d follows from it (Chronopoulos and Gear, 1989). */

/* p = 0, d = s B r. */
void v_solve_begin(VCycle *cycle, double s, const double *r, double size);

/* What a step leaves. */
typedef struct VRemainder {
    double square;  /* |s r - H p|_(M^-1)^2 */
    double largest; /* max over nodes of |p_x| + |p_y| */
} VRemainder;

/* p is the lowest point along d.
 * Returns false, and p is what it was, where that point does not exist. */
bool v_solve_step(VCycle *cycle, VRemainder *remainder);

/* The next d. */
void v_solve_next(VCycle *cycle);

/* p, out [2 planes]. */
void v_solve_end(const VCycle *cycle, double *p);

#endif
