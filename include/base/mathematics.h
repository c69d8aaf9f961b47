/* mathematics.h - hypot, log and log1p with the same bits on every machine.
 *
 * The C libraries round these functions differently: glibc and musl differ for
 * 14, 0.01 and 0.2 % of the arguments.  A time step therefore calls the
 * functions of this header.  sqrt and frexp are exact in every library.  Errors
 * are below 1.5 units in the last place. */
#pragma once

/* The program tests for NaN and infinity, and its sums must keep their order,
 * or the hash of a run changes.  Fast-math options break both. */
#if defined __FAST_MATH__ || __FINITE_MATH_ONLY__ || __ASSOCIATIVE_MATH__
#error "elasto needs NaN, infinity and sums in order: no -ffast-math, no -Ofast"
#endif

/* Returns sqrt(x^2 + y^2); the squares do not overflow. */
double math_hypot(double x, double y);

/* Returns the natural logarithm of x: -infinity for 0, NaN for x < 0. */
double math_log(double x);

/* Returns log(1 + x), accurate for small x as well. */
double math_log1p(double x);
