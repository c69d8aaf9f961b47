/* v_cycle.h - p = -H^-1 g without a factor: conjugate gradients in single
 * precision on the clamped Hessian H, preconditioned by a multigrid V-cycle.
 *
 * A level has a tensor, K = w 2k/l2 (iso I + along d d^T), for each spring and
 * a mass for each node; H x at a node is m x + sum K (x - x').  A coarser level
 * is every second node: its tensors are means of the finer ones, as stiffness
 * does not depend on the spacing in two dimensions; its masses are P^T m with P
 * bilinear.  Where the finer node in a node's place is pinned, it is held.
 *
 * A cycle smooths by Gauss-Seidel, node by node in four colours (row and column
 * even or odd), before and, in the opposite order, after what the coarser level
 * adds; so it is symmetric and positive definite.  Nodes of a colour do not
 * see each other, so the bits do not depend on lanes.
 */
#ifndef ELASTO_V_CYCLE_H
#define ELASTO_V_CYCLE_H

#include "solve/grid.h"

enum { MAX_LEVELS = 24 };

typedef struct Level {
    Rows rows;
    struct Level *coarse; /* NULL: it is the coarsest */
    float *K[KINDS][3];   /* [plane] tensors xx, xy, yy at their first node */
    float *D[3];      /* [plane] inverse 2x2 blocks; 0 where held, outside */
    float *m;         /* [plane] 0 where held */
    float *x, *b, *w; /* [2 planes] about A^-1 b; what is left, or A x */
} Level;

typedef struct VCycle {
    const Grid *grid;
    Level level[MAX_LEVELS]; /* the finest first */
    int levels;
    float *c[KINDS];   /* [plane] the grid's */
    float *p, *d, *Ad; /* [2 planes] of conjugate gradients */
    bool set_up;       /* the tensors are those at grid->x; set to false when
                          that moves */
    long cycles;       /* since somebody has set it to 0 */
} VCycle;

void v_cycle_lay_out(const Grid *grid, Memory *memory, VCycle *cycle);

/* Masses and pins, from the grid's. */
void v_cycle_read_system(VCycle *cycle);

/* p = about -H^-1 a; or, where it adds, p += H^-1 a.
 *   a       [2 planes] anything at pins
 *   square  |a|_(M^-1)^2
 *   share   it may end where the remainder, in that norm, fell to so much of
 * it, length  > 0: or where it is certain whether the largest |p_x| + |p_y| is
 *           above this, see v_decides
 * Returns the largest |p_x| + |p_y| of the nodes, as p will be. */
double v_solve(VCycle *cycle, const double *a, double square, double share,
               double length, bool adds, double *p);

/* Whether the largest |p_x| + |p_y| of the exact direction is on the same side
 * of `length` as this one: H - M is positive semi-definite, so the error is at
 * most the remainder's |r|_(M^-1) in the norm of M, and no node's share of it
 * more than sqrt(2/m) times that.
 *   square  |r|_(M^-1)^2 */
bool v_decides(const Grid *grid, double largest, double square, double length);

#endif
