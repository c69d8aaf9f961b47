/* v_cycle.h - p = -H^-1 g without a factor: a multigrid V-cycle on the Hessian
 * H in single precision.  On the exact H one cycle finds p.  On the clamped H
 * cycles precondition conjugate gradients, which tell how exact p is.  The
 * caller clamps H, or v_cycle_solve does for a small p that may be far from
 * exact.
 *
 * A level has a tensor K = c (iso I + along d d^T) (grid_spring.h) for each
 * spring and a mass m for each node; H x at a node is m x + sum K (x - x'),
 * with x' at the springs' other ends.  A coarser level is every second node.
 * The tensors are means of the finer ones, as stiffness does not depend on the
 * spacing in two dimensions; the masses are P^T m with the bilinear
 * interpolation P.  A coarse node is held if the fine node at its place is
 * pinned.  On the coarsest level masses outweigh springs, or nodes are few.
 *
 * A cycle smooths by Gauss-Seidel, node by node in four colours (row and column
 * even or odd), before the coarser level's correction and after it: on the
 * clamped H in the opposite order, so the cycle is symmetric and positive
 * definite, on the exact H in an order that leaves half the error.  Nodes of
 * one colour share no spring, so no bit depends on the number of lanes. */
#pragma once

#include "solve/grid.h"

enum { MAX_LEVELS = 24 };

/* p is small if the residual is at most this fraction of the tolerance. */
static const double SMALL_P = 0.2;

typedef struct Level {
    RowLayout rows;
    struct Level *coarse; /* next coarser level; NULL: there is none */
    /* [plane] blocks of A that join two nodes, by kind of spring: parts xx, xy,
     * yy, stored at the spring's first node */
    float *K[SPRING_KINDS][3];
    float *D[3]; /* [plane] inverse of the node's block of A: xx, xy, yy; 0 at
                    held nodes and outside */
    float *m;    /* [plane] mass; 0 at held nodes */
    float *x, *b, *w; /* [2 planes] x approximates A^-1 b; w: b - A x or A x */
} Level;

typedef struct VCycle {
    const Grid *grid;
    Level level[MAX_LEVELS]; /* the finest level first */
    float *p, *d, *Ad;       /* [2 planes] p, d, A d of conjugate gradients */
    bool is_clamped;         /* negative eigenvalues of the tensors become 0 */
    bool has_matrices; /* has its matrices; false: the next cycle makes them */
    long cycles;       /* number of V-cycles so far */
} VCycle;

void v_cycle_init(const Grid *grid, ArrayArena *memory, VCycle *cycle);

/* Copies masses, pins and stiffnesses from the grid, coarsens the masses, and
 * sets the number of levels. */
void v_cycle_copy_system(VCycle *cycle);

/* Computes p = -H^-1 g up to a linear residual.
 *   g         [2 planes] grad E; anything at pins
 *   square    |g|_(M^-1)^2
 *   longest   m, limit of |p_x| + |p_y| in the stopping test, h times the
 *             tolerance
 *   largest   out, max over nodes of |p_x| + |p_y|
 * Returns whether p passes the stopping test, as far as single precision tells;
 * false if the Hessian is not clamped. */
bool v_cycle_solve(VCycle *cycle, const double *g, double square,
                   double longest, double *p, double *largest);

/* Whether the exact direction passes the stopping test.  H - M is positive
 * semi-definite, so the error of p is at most |r|_(M^-1) in the norm of M,
 * where r = -g - H p is the linear residual, and at most sqrt(2/m) |r|_(M^-1)
 * at a node.
 *   largest  max over nodes of |p_x| + |p_y|
 *   square   |r|_(M^-1)^2
 *   longest  limit of |p_x| + |p_y| in the test */
bool p_meets_tolerance(const Grid *grid, double largest, double square,
                       double longest);
