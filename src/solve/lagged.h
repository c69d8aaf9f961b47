/* lagged.h - what only the solver with old factors needs: the lowest point in
 * the plane of p and the last update in the place of Algorithm 2, and sweeps
 * over the nodes that put right what an old factor does not know.
 */
#ifndef ELASTO_LAGGED_H
#define ELASTO_LAGGED_H

#include "solve/newton.h"

/* Whether this solver looks for its step in a plane: with a line search, and
 * where all terms are polynomials in it. */
bool lagged_has_plane(const Newton *newton);

/* r becomes alpha p + beta r, the lowest point in the plane of p and the last
 * update r.  OK or LINE_SEARCH_LIMIT. */
Status lagged_search(Newton *newton);

/* Smooths u and x after an update.  Returns OK, OUT_OF_MEMORY. */
Status lagged_smooth(Newton *newton);

/* Whether the factor is young enough for another direction. */
bool lagged_keeps_factor(const Newton *newton);

#endif
