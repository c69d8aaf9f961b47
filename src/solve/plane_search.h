/* plane_search.h - the lowest point of E in the plane of two directions.
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

/* A local minimum with a value below 0, by a safeguarded Newton method from
 * (0, 0).
 *   at      [2] out, a and b
 *   trials  out, values looked at
 * Returns OK or LINE_SEARCH_LIMIT (nothing below 0 was found). */
Status plane_minimise(const PlaneQuartic *quartic, double at[2], int *trials);

#endif
