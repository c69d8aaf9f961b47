/* grid_spring.h - the law of a spring (spring_law.h) in the grid's loops, for
 * the nodes of Doubles or Floats at once.
 *
 * A spring adds c/4 s^2 to E, s = |d|^2 - l2, c = 2 w k/l2.  The gradient is
 * c s d, the Hessian c (iso I + along d d^T) with iso = s and along = 2. */
#pragma once

#include "solve/grid_loops.h"

/* The numbers of a spring in a loop: d = x_i - x_j, d2 = |d|^2, s = d2 - l^2,
 * its force factor c, and f = c s. */
typedef struct GridSpring {
    Doubles dx, dy, d2, s, c, f;
} GridSpring;

/* Evaluates the spring from node q to q + to, with its numbers at q + at. */
INLINE GridSpring evaluate_grid_spring(const Grid *grid, int kind, ptrdiff_t q,
                                       ptrdiff_t to, ptrdiff_t at)
{
    const double *x = grid->x, *y = x + grid->rows.plane;
    Doubles dx = DOUBLES(x, q) - DOUBLES(x, q + to);
    Doubles dy = DOUBLES(y, q) - DOUBLES(y, q + to);
    Doubles d2 = dx * dx + dy * dy, c = DOUBLES(grid->c[kind], q + at);
    Doubles s = d2 - DOUBLES(grid->l2[kind], q + at);
    return (GridSpring){dx, dy, d2, s, c, c * s};
}

/* A GridSpring in single precision, from Grid.float_x. */
typedef struct FloatSpring {
    Floats dx, dy, d2, s, c;
} FloatSpring;

INLINE FloatSpring evaluate_float_spring(const Grid *grid, int kind,
                                         ptrdiff_t q, ptrdiff_t to,
                                         ptrdiff_t at)
{
    const float *x = grid->float_x, *y = x + grid->rows.plane;
    Floats dx = FLOATS(x, q) - FLOATS(x, q + to);
    Floats dy = FLOATS(y, q) - FLOATS(y, q + to);
    Floats d2 = dx * dx + dy * dy, c = FLOATS(grid->float_c[kind], q + at);
    return (FloatSpring){dx, dy, d2, d2 - FLOATS(grid->float_l2[kind], q + at),
                         c};
}

/* Declares iso and along of the clamped Hessian c (iso I + along d d^T), in
 * which negative eigenvalues are 0.  The eigenvalue across d is c iso, the one
 * along d is c (iso + along |d|^2).
 *   d2  |d|^2 plus a tiny number, so that it is above 0 */
#define CLAMPED_TENSOR(s, d2, iso, along)                                      \
    __typeof__(d2) iso = WHERE((s) > 0, s);                                    \
    __typeof__(d2) along = 2 + ((s)-iso) / (d2);                               \
    along = WHERE(along > 0, along)

/* Adds a spring to the coefficients of the change of E along p:
 * E(x + a p) - E(x) = q0 a + q1 a^2 + q2 a^3 + 1/4 q3 a^4.
 *   ux, uy  difference p_i - p_j of the spring's ends */
INLINE void spring_line_polynomial(GridSpring s, Doubles ux, Doubles uy,
                                   Doubles *q0, Doubles *q1, Doubles *q2,
                                   Doubles *q3)
{
    Doubles B = s.dx * ux + s.dy * uy, C = ux * ux + uy * uy;
    Doubles cB = s.c * B, cC = s.c * C;
    *q0 += cB * s.s;
    *q1 += cB * B + 0.5 * s.s * cC;
    *q2 += cB * C;
    *q3 += cC * C;
}
