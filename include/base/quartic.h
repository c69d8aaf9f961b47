/* quartic.h - what the energy is along a line and in a plane: polynomials of
 * degree 4 without constant term, in one and in two variables.
 */
#ifndef ELASTO_QUARTIC_H
#define ELASTO_QUARTIC_H

#include "base/lanes.h"

/* q(alpha) = q[0] alpha + q[1] alpha^2 + q[2] alpha^3 + q[3] alpha^4 */
typedef struct Quartic {
    double q[4]; /* J s^2 */
} Quartic;

/* q(alpha) - q(0), by Horner's rule. */
double quartic_value(const Quartic *quartic, double alpha);

/* The same, as line_search_backtrack calls it. */
double quartic_difference(const void *quartic, double alpha);

/* Where q ends to fall for the first time on the way from 0; 0 where it does
 * not fall there, or falls for ever. */
double quartic_first_minimum(const Quartic *quartic);

/* Coefficients of a, b, a^2, ab, b^2, a^3, a^2 b, a b^2, b^3, a^4, a^3 b,
 * a^2 b^2, a b^3, b^4, J s^2. */
enum { PLANE_TERMS = 14 };

typedef struct PlaneQuartic {
    double c[PLANE_TERMS];
} PlaneQuartic;

/* s[0] + s[1] a + s[2] b + s[3] a^2 + s[4] ab + s[5] b^2, one in each lane. */
typedef struct PlaneQuadratics {
    Lanes s[6];
} PlaneQuadratics;

/* Coefficients of a PlaneQuartic, a share of each in each lane. */
typedef struct PlaneSums {
    Lanes c[PLANE_TERMS];
} PlaneSums;

/* sums += w s^2, without its constant term and its terms in a and b alone:
 * those are the slopes, known more exactly from the gradient. */
static inline void plane_add_squares(const PlaneQuadratics *quadratics, Lanes w,
                                     PlaneSums *sums)
{
    const Lanes *s = quadratics->s;
    Lanes *c = sums->c;
    Lanes ws0 = 2 * w * s[0], ws1 = 2 * w * s[1], ws2 = 2 * w * s[2];
    Lanes ws3 = w * s[3], ws4 = w * s[4], ws5 = w * s[5];
    c[2] += w * s[1] * s[1] + ws0 * s[3];
    c[3] += ws1 * s[2] + ws0 * s[4];
    c[4] += w * s[2] * s[2] + ws0 * s[5];
    c[5] += ws1 * s[3];
    c[6] += ws1 * s[4] + ws2 * s[3];
    c[7] += ws1 * s[5] + ws2 * s[4];
    c[8] += ws2 * s[5];
    c[9] += ws3 * s[3];
    c[10] += 2 * ws3 * s[4];
    c[11] += ws4 * s[4] + 2 * ws3 * s[5];
    c[12] += 2 * ws4 * s[5];
    c[13] += ws5 * s[5];
}

/* quartic += the sums over the lanes */
static inline void plane_add(const PlaneSums *sums, PlaneQuartic *quartic)
{
    for (int i = 0; i < PLANE_TERMS; i++)
        quartic->c[i] += lanes_sum(sums->c[i]);
}

/* E(x + a p + b r) - E(x) */
double plane_value(const PlaneQuartic *quartic, double a, double b);

#endif
