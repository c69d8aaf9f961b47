/* barrier.h - the barrier f(s), which keeps a distance above 0 (lesson
 * "Boundary Treatments" of the lecture's author; Li et al.: Incremental
 * Potential Contact, 2020, have (s - 1)^2 instead of s - 1).
 *
 *   f(s)   = (s - 1) ln s          for 0 < s < 1, and 0 for s >= 1
 *   f'(s)  = ln s + 1 - 1/s  < 0   0 at s = 1
 *   f''(s) = (1 + s)/s^2     > 0   2 just below s = 1, 0 above it
 *
 * f is convex and has a continuous slope.  s > 0 is a distance divided by the
 * distance at which the barrier begins. */
#pragma once

double barrier_value(double s);     /* f(s) */
double barrier_slope(double s);     /* f'(s) */
double barrier_curvature(double s); /* f''(s) */

/* Returns f(s + t) - f(s) - f'(s) t >= 0 with full relative accuracy, also for
 * tiny t, where the difference is only rounding.  Infinite if s + t <= 0. */
double barrier_taylor_remainder(double s, double t);

/* Returns log1p(z) - z, z > -1, without cancellation for small z. */
double log1p_minus_z(double z);
