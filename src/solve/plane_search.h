/* plane_search.h - the lowest point of E on a line and in the plane of two
 * directions, for multigrid.
 *
 * E(x + a p + b r) - E(x) is an exact polynomial of degree 4 in a and b.
 * Minimising it over the new direction p and the last update r makes Newton's
 * iteration a preconditioned nonlinear conjugate gradient method, which needs
 * few iterations even where the Hessian's factor is old.
 */
#ifndef ELASTO_PLANE_SEARCH_H
#define ELASTO_PLANE_SEARCH_H

#include "base/quartic.h"
#include "base/status.h"

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

/* A local minimum with a value below 0, by a safeguarded Newton method from
 * (0, 0).
 *   at      [2] out, a and b
 *   trials  out, values looked at
 * Returns OK or LINE_SEARCH_LIMIT (nothing below 0 was found). */
Status plane_minimise(const PlaneQuartic *quartic, double at[2], int *trials);

#endif
