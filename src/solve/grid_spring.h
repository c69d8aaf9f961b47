/* grid_spring.h - the law of a spring (spring_law.h) in the grid's loops, for
 * the nodes of Doubles or Floats at once.
 *
 * A spring adds c/4 s^2 to E, s = |d|^2 - l2, c = 2 w k/l2.  The gradient is
 * c s d, the Hessian c (iso I + along d d^T) with iso = s and along = 2. */
#pragma once

#include <stdbool.h>

#include "solve/grid_loops.h"

/* Defines a struct of a spring's d = x_i - x_j, d2 = |d|^2, s = d2 - l2 and
 * Hessian factor c, and the function that computes it in double or single
 * precision: the nodes are q and q + to, and c and l2 have the index q + at. */
#define DEFINE_SPRING(Type, evaluate, Numbers, AT, of_x, of_c, of_l2)          \
    typedef struct Type {                                                      \
        Numbers dx, dy, d2, s, c;                                              \
    } Type;                                                                    \
    INLINE Type evaluate(const Grid *grid, int kind, ptrdiff_t q,              \
                         ptrdiff_t to, ptrdiff_t at)                           \
    {                                                                          \
        const __typeof__(*grid->of_x) *x = grid->of_x;                         \
        const __typeof__(*x) *y = x + grid->rows.plane_length;                 \
        Numbers dx = AT(x, q) - AT(x, q + to), dy = AT(y, q) - AT(y, q + to);  \
        Numbers d2 = dx * dx + dy * dy, c = AT(grid->of_c[kind], q + at);      \
        return (Type){dx, dy, d2, d2 - AT(grid->of_l2[kind], q + at), c};      \
    }
DEFINE_SPRING(GridSpring, evaluate_grid_spring, Doubles, DOUBLES, x, c, l2)
DEFINE_SPRING(FloatSpring, evaluate_float_spring, Floats, FLOATS, float_x,
              float_c, float_l2)

/* Declares iso and along of a spring's Hessian c (iso I + along d d^T).  Its
 * eigenvalues are c iso across d and c (iso + along |d|^2) along d; is_clamped
 * sets negative ones to 0.  1e-35 keeps |d|^2 above 0. */
#define SPRING_TENSOR(spring, is_clamped, iso, along)                          \
    __typeof__((spring).s) iso = (spring).s, along = {0};                      \
    along += 2;                                                                \
    if (is_clamped) {                                                          \
        iso = WHERE(iso > 0, iso);                                             \
        along = 2 + ((spring).s - iso) / ((spring).d2 + 1e-35f);               \
        along = WHERE(along > 0, along);                                       \
    }

/* Adds the product of the clamped Hessian with u to h.
 *   ux, uy  difference p_i - p_j of the spring's ends */
INLINE void add_hessian_product(GridSpring s, Doubles ux, Doubles uy,
                                Doubles *hx, Doubles *hy)
{
    SPRING_TENSOR(s, true, iso, along);
    along *= s.dx * ux + s.dy * uy;
    *hx += s.c * (iso * ux + along * s.dx);
    *hy += s.c * (iso * uy + along * s.dy);
}

/* Writes the Hessian's parts xx, xy, yy. */
INLINE void float_spring_hessian(FloatSpring s, bool is_clamped, Floats H[3])
{
    SPRING_TENSOR(s, is_clamped, iso, along);
    H[0] = s.c * (iso + along * s.dx * s.dx);
    H[1] = s.c * along * s.dx * s.dy;
    H[2] = s.c * (iso + along * s.dy * s.dy);
}

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

/* ---- a node that moves alone ---- */

/* Sums over a node's springs: gradient of E (GX, GY), unclamped Hessian (HXX,
 * HXY, HYY), c d (CDX, CDY), c (SUM_C), and negative f = c s (SUM_NEGATIVE_F).
 * The Hessian is SUM_F I + 2 sum of c d d^T; SUM_F is the mass + sum of f. */
enum { GX, GY, HXX, HXY, HYY, CDX, CDY, SUM_C, SUM_NEGATIVE_F, SUM_COUNT };
enum { SUM_F = SUM_COUNT }; /* no member of SpringSums */

typedef float SpringSums[SUM_COUNT][LANES];

/* Adds a spring to the sums.
 *   w  in, change of d since the start, d = d0 + w: adds only the change of the
 *      force, c (s d - s0 d0) = c (s w + (s - s0) d0).  NULL: adds c s d */
INLINE void add_spring_sums(FloatSpring s, const Floats w[2],
                            Floats sum[SUM_COUNT + 1])
{
    Floats wx = w ? w[0] : s.dx, wy = w ? w[1] : s.dy;
    if (w) {
        Floats more = (2 * s.dx + wx) * wx + (2 * s.dy + wy) * wy;
        sum[GX] += s.c * more * s.dx;
        sum[GY] += s.c * more * s.dy;
        s.dx += wx;
        s.dy += wy;
        s.s += more;
    }
    Floats fx = s.c * s.dx, fy = s.c * s.dy, f = s.c * s.s;
    sum[GX] += f * wx;
    sum[GY] += f * wy;
    IN_ORDER(sum[GX], sum[GY]);
    sum[SUM_F] += f;
    sum[SUM_NEGATIVE_F] += WHERE(f < 0, f);
    IN_ORDER(sum[SUM_F], sum[SUM_NEGATIVE_F]);
    sum[HXX] += fx * s.dx;
    sum[HXY] += fx * s.dy;
    sum[CDX] += fx;
    IN_ORDER(sum[HXX], sum[HXY]);
    sum[HYY] += fy * s.dy;
    sum[CDY] += fy;
    IN_ORDER(sum[HYY], sum[CDY]);
    sum[SUM_C] += s.c;
    IN_ORDER(sum[SUM_C], sum[CDX]);
}

INLINE void store_spring_sums(Floats sum[SUM_COUNT + 1], int e, SpringSums of)
{
    sum[HXX] = sum[SUM_F] + 2 * sum[HXX];
    sum[HXY] = 2 * sum[HXY];
    sum[HYY] = sum[SUM_F] + 2 * sum[HYY];
    for (int s = 0; s < SUM_COUNT; s++)
        FLOATS(of[s], e) = sum[s];
}

/* Writes the coefficients q of the change of E, q[0] a + ... + q[3] a^4, when
 * the node moves by a p. */
INLINE void node_line_polynomial(const SpringSums of, int e, float px, float py,
                                 float q[4])
{
    float A = of[HXX][e], B = of[HXY][e], C = of[HYY][e],
          p2 = px * px + py * py;
    q[0] = of[GX][e] * px + of[GY][e] * py;
    q[1] = 0.5f * (A * px * px + 2 * B * px * py + C * py * py);
    q[2] = p2 * (of[CDX][e] * px + of[CDY][e] * py);
    q[3] = 0.25f * of[SUM_C][e] * p2 * p2;
}
