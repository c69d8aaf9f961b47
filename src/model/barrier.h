/* barrier.h - the function that keeps a distance above zero: a logarithm that
 * ends smoothly at s = 1 (Li et al.: Incremental Potential Contact, 2020, with
 * one power of (s - 1); lesson "Boundary Treatments" of the lecture's author).
 *
 *   f(s)   = (s - 1) ln s          for 0 < s < 1, and 0 from there on
 *   f'(s)  = ln s + 1 - 1/s  < 0   0 at s = 1
 *   f''(s) = (1 + s)/s^2     > 0   2 just before s = 1, 0 behind it
 *
 * f has a continuous slope and is convex.  s is a distance over the one at
 * which the barrier begins; none of the functions may be asked for s <= 0.
 */
#ifndef ELASTO_BARRIER_H
#define ELASTO_BARRIER_H

double barrier_value(double s);
double barrier_slope(double s);
double barrier_curvature(double s);

/* R(s, t) = f(s + t) - f(s) - f'(s) t >= 0 with full relative accuracy, also
 * where t is so small that the difference would be nothing but rounding.
 *   s, s + t  > 0; infinite where s + t <= 0 */
double barrier_remainder(double s, double t);

/* log1p(z) - z, without cancellation for small z > -1. */
double log1p_minus(double z);

#endif
