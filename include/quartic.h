/* quartic.h - what the energy is along a line and in a plane: polynomials of
 * degree 4 without constant term, in one and in two variables.
 */
#ifndef ELASTO_QUARTIC_H
#define ELASTO_QUARTIC_H

/* q(alpha) = q[0] alpha + q[1] alpha^2 + q[2] alpha^3 + q[3] alpha^4 */
typedef struct Quartic {
    double q[4]; /* J s^2 */
} Quartic;

/* q(alpha) - q(0), by Horner's rule. */
double quartic_value(const Quartic *quartic, double alpha);

/* The same, as line_search_backtrack calls it. */
double quartic_difference(const void *quartic, double alpha);

/* Coefficients of a, b, a^2, ab, b^2, a^3, a^2 b, a b^2, b^3, a^4, a^3 b,
 * a^2 b^2, a b^3, b^4, J s^2. */
enum { PLANE_TERMS = 14 };

typedef struct PlaneQuartic {
    double c[PLANE_TERMS];
} PlaneQuartic;

/* s[0] + s[1] a + s[2] b + s[3] a^2 + s[4] ab + s[5] b^2 */
typedef struct PlaneQuadratic {
    double s[6];
} PlaneQuadratic;

/* quartic += w s^2, without its constant term and its terms in a and b alone:
 * those are the slopes, known more exactly from the gradient. */
static inline void plane_add_square(const PlaneQuadratic *quadratic, double w,
                                    PlaneQuartic *quartic)
{
    const double *s = quadratic->s;
    double *c = quartic->c;
    c[2] += w * (s[1] * s[1] + 2 * s[0] * s[3]);
    c[3] += w * 2 * (s[1] * s[2] + s[0] * s[4]);
    c[4] += w * (s[2] * s[2] + 2 * s[0] * s[5]);
    c[5] += w * 2 * s[1] * s[3];
    c[6] += w * 2 * (s[1] * s[4] + s[2] * s[3]);
    c[7] += w * 2 * (s[2] * s[4] + s[1] * s[5]);
    c[8] += w * 2 * s[2] * s[5];
    c[9] += w * s[3] * s[3];
    c[10] += w * 2 * s[3] * s[4];
    c[11] += w * (s[4] * s[4] + 2 * s[3] * s[5]);
    c[12] += w * 2 * s[4] * s[5];
    c[13] += w * s[5] * s[5];
}

/* E(x + a p + b r) - E(x) */
double plane_value(const PlaneQuartic *quartic, double a, double b);

#endif
