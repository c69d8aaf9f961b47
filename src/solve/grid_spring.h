/* grid_spring.h - the law of a spring (spring_law.h) in the grid's loops, for a
 * Pair of nodes at once, and the sums over a node's springs.
 *
 * A spring adds c/4 s^2 to E, s = |d|^2 - l2, c = 2 w k/l2.  The gradient is
 * c s d, the Hessian c (iso I + along d d^T) with iso = s and along = 2. */
#ifndef ELASTO_GRID_SPRING_H
#define ELASTO_GRID_SPRING_H

#include "solve/grid_loops.h"

/* The numbers of a spring in a loop: d = x_i - x_j, d2 = |d|^2, s = d2 - l^2,
 * its force factor c, and f = c s. */
typedef struct Spring {
    Pair dx, dy, d2, s, c, f;
} Spring;

/* Evaluates the spring from node q to q + to, with its numbers at q + at. */
INLINE Spring evaluate_grid_spring(const Grid *grid, int kind, int q, int to,
                                   int at)
{
    const double *x = grid->x, *y = x + grid->rows.plane;
    Pair dx = PAIR(x, q) - PAIR(x, q + to), dy = PAIR(y, q) - PAIR(y, q + to);
    Pair d2 = dx * dx + dy * dy, c = PAIR(grid->c[kind], q + at);
    Pair s = d2 - PAIR(grid->l2[kind], q + at);
    return (Spring){dx, dy, d2, s, c, c * s};
}

/* Declares iso and along of the clamped Hessian c (iso I + along d d^T), in
 * which negative eigenvalues are 0.  The eigenvalue across d is c iso, the one
 * along d is c (iso + along |d|^2).
 *   d2  |d|^2 plus a tiny number, so that it is above 0 */
#define CLAMPED_TENSOR(s, d2, iso, along)                                      \
    __typeof__(d2) iso = WHERE((s) > 0, s);                                    \
    __typeof__(d2) along = 2 + ((s)-iso) / (d2);                               \
    along = WHERE(along > 0, along)

/* Adds a spring to the sums f1, f2, f3, which give the change of E along p:
 * E(x + a p) - E(x) = q[0] a + q[1] a^2 + q[2] a^3 + q[3] a^4, where the
 * springs contribute f1/4 to q[1], f2/2 to q[2] and f3/4 to q[3].
 *   ux, uy  difference p_i - p_j of the spring's ends */
INLINE void spring_line_polynomial(Spring s, Pair ux, Pair uy, Pair *f1,
                                   Pair *f2, Pair *f3)
{
    Pair B = 2 * (s.dx * ux + s.dy * uy), C = ux * ux + uy * uy;
    *f1 += s.c * (B * B + 2 * s.s * C);
    *f2 += s.c * B * C;
    *f3 += s.c * C * C;
}

/* ---- a node that moves while the others stay ---- */

/* Sums over a node's springs: gradient of E (GX, GY), Hessian block, not
 * clamped (XX, XY, YY), c d (CX, CY), c (CC), and the negative f (NEGATIVE). */
enum { GX, GY, XX, XY, YY, CX, CY, CC, NEGATIVE, SUMS };

typedef double NodeSums[SUMS][LANES];

/* Computes the sums of LANES nodes of a row, in a loop of its own, since steps
 * that do not wait for each other are faster. */
INLINE void gather_springs(const Grid *grid, NodeRun at, NodeSums of)
{
    const double *const ax = grid->from_target, *const ay =
                                                    ax + grid->rows.plane;
    EACH_PAIR (NEXT(at, LANES)) {
        const int q = at.first + e;
        Pair mass = PAIR(grid->m, q + at.node), iso = mass;
        Pair gx = mass * PAIR(ax, q), gy = mass * PAIR(ay, q);
        Pair xx = {0}, xy = {0}, yy = {0};
        Pair cx = {0}, cy = {0}, c = {0}, negative = {0};
#define ADD(kind, to, numbers)                                                 \
    {                                                                          \
        Spring s = evaluate_grid_spring(grid, kind, q, to, numbers);           \
        Pair fx = s.c * s.dx, fy = s.c * s.dy;                                 \
        gx += s.f * s.dx;                                                      \
        gy += s.f * s.dy;                                                      \
        IN_ORDER(gx, gy);                                                      \
        iso += s.f;                                                            \
        negative += WHERE(s.f < 0, s.f);                                       \
        IN_ORDER(iso, negative);                                               \
        xx += fx * s.dx;                                                       \
        xy += fx * s.dy;                                                       \
        cx += fx;                                                              \
        IN_ORDER(xx, xy);                                                      \
        yy += fy * s.dy;                                                       \
        cy += fy;                                                              \
        IN_ORDER(yy, cy);                                                      \
        c += s.c;                                                              \
        IN_ORDER(c, cx);                                                       \
    }
        ALL_SPRINGS(ADD, at)
#undef ADD
        PAIR(of[GX], e) = gx;
        PAIR(of[GY], e) = gy;
        PAIR(of[XX], e) = iso + 2 * xx;
        PAIR(of[XY], e) = 2 * xy;
        PAIR(of[YY], e) = iso + 2 * yy;
        PAIR(of[CX], e) = cx;
        PAIR(of[CY], e) = cy;
        PAIR(of[CC], e) = c;
        PAIR(of[NEGATIVE], e) = negative;
    }
}

/* Writes the coefficients q of the change of E, q[0] a + ... + q[3] a^4, when
 * the node moves by a p. */
INLINE void node_line_polynomial(const NodeSums of, int e, double px, double py,
                                 double q[4])
{
    double A = of[XX][e], B = of[XY][e], C = of[YY][e], p2 = px * px + py * py;
    q[0] = of[GX][e] * px + of[GY][e] * py;
    q[1] = 0.5 * (A * px * px + 2 * B * px * py + C * py * py);
    q[2] = p2 * (of[CX][e] * px + of[CY][e] * py);
    q[3] = 0.25 * of[CC][e] * p2 * p2;
}

#endif
