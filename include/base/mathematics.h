/* mathematics.h - functions whose bits are the same everywhere.  The libraries
 * of C round hypot, log and log1p differently (glibc and musl in 14, 0.01 and
 * 0.2 % of arguments), so what a time step calls stands here.  sqrt and frexp
 * are exact in every library.  Errors are below 1.5 units in the last place.
 */
#ifndef ELASTO_MATHEMATICS_H
#define ELASTO_MATHEMATICS_H

/* Input is refused and runs end where a number is NaN or infinite; sums keep
 * their order, so that a run has one hash. */
#if defined __FAST_MATH__ || __FINITE_MATH_ONLY__ || __ASSOCIATIVE_MATH__
#error "elasto needs NaN, infinity and sums in order: no -ffast-math, no -Ofast"
#endif

/* sqrt(x^2 + y^2), without overflow on the way. */
double math_hypot(double x, double y);

/* The natural logarithm of x; -inf for 0, NaN below.  */
double math_log(double x);

/* log(1 + x), accurate for small x as well. */
double math_log1p(double x);

#endif
