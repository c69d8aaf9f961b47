/* residual_test.h - the test of Algorithm 3, max over nodes of |p_x| + |p_y|
 * over h against the tolerance, for a direction that is known up to an error in
 * the norm of the masses.  What Newton and multigrid say of it.
 */
#ifndef ELASTO_RESIDUAL_TEST_H
#define ELASTO_RESIDUAL_TEST_H

#include <math.h>
#include <stdbool.h>

/* The largest residual, m/s, that a direction with |p|_M = 1 can have: each
 * node has m |p_i|^2 <= |p|_M^2, and |p_x| + |p_y| <= sqrt(2) |p_i|.
 *   lightest  kg, the smallest mass;  h  s */
static inline double residual_per_norm(double lightest, double h)
{
    return sqrt(2 / lightest) / h;
}

/* Whether a direction with this residual passes the test, or does not, wherever
 * the exact one is.
 *   bound  m/s, on the difference of both residuals */
static inline bool residual_decides(double residual, double bound,
                                    double tolerance)
{
    return fabs(residual - tolerance) >= bound;
}

#endif
