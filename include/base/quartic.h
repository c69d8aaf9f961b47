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

/* Where q ends to fall for the first time on the way from 0; 0 where it does
 * not fall there, or falls for ever. */
double quartic_first_minimum(const Quartic *quartic);

/* Coefficients of a, b, a^2, ab, b^2, a^3, a^2 b, a b^2, b^3, a^4, a^3 b,
 * a^2 b^2, a b^3, b^4, J s^2. */
enum { PLANE_TERMS = 14 };

typedef struct PlaneQuartic {
    double c[PLANE_TERMS];
} PlaneQuartic;

/* E(x + a p + b r) - E(x) */
double plane_value(const PlaneQuartic *quartic, double a, double b);

#endif
