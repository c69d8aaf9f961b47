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
    /* [plane] blocks of A that join two nodes, by kind of spring: parts xx, xy,
     * yy, stored at the first of the two */
    float *K[KINDS][3];
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
    bool is_set_up;    /* the tensors are those at grid->x; set to false when
                       that moves */
    long cycles;       /* since somebody has set it to 0 */
} VCycle;

void v_cycle_lay_out(const Grid *grid, Memory *memory, VCycle *cycle);

/* Masses and pins, from the grid's. */
void v_cycle_read_system(VCycle *cycle);

/* p = -H^-1 g, up to a remainder.
 *   g        [2 planes] grad E; anything at pins
 *   square   |g|_(M^-1)^2
 *   longest  largest |p_x| + |p_y| of a node with which p passes the test
 *   largest  out, max over nodes of |p_x| + |p_y|
 * Returns whether p passes the test, as far as single precision tells. */
bool v_cycle_solve(VCycle *cycle, const double *g, double square,
                   double longest, double *p, double *largest);

/* Whether the exact direction passes the test.  H - M is positive
 * semi-definite, so the error of p is at most |r|_(M^-1) in the norm of M,
 * where r = -g - H p is the remainder of p, and at most sqrt(2/m) times that at
 * a node.
 *   square            |r|_(M^-1)^2
 *   largest, longest  as above, of p */
bool v_cycle_passes(const Grid *grid, double largest, double square,
                    double longest);

#endif
