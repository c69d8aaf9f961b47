/* barrier.c - the logarithmic barrier of a distance, and its derivatives. */
#include "model/barrier.h"

#include <math.h>

#include "base/mathematics.h"

double barrier_value(double s)
{
    return s < 1 ? (s - 1) * math_log(s) : 0;
}

double barrier_slope(double s)
{
    return s < 1 ? math_log(s) + 1 - 1 / s : 0;
}

double barrier_curvature(double s)
{
    return s < 1 ? (1 + s) / (s * s) : 0;
}

/* With r = z/(2 + z), log1p(z) = 2 (r + r^3/3 + ...) and 2r - z = -z r. */
double log1p_minus_z(double z)
{
    if (!(fabs(z) < 0.25))
        return math_log1p(z) - z;
    double r = z / (2 + z), q = r * r;
    double series = 1.0 / 15 + q * (1.0 / 17 + q / 19);
    series = 1.0 / 9 + q * (1.0 / 11 + q * (1.0 / 13 + q * series));
    series = 1.0 / 3 + q * (1.0 / 5 + q * (1.0 / 7 + q * series));
    return -z * r + 2 * r * q * series;
}

/* The four cases: s and s + t are inside the barrier, the step leaves the
 * barrier, the step enters it, or both are outside.  Every summand is >= 0. */
double barrier_taylor_remainder(double s, double t)
{
    double end = s + t;
    if (!(end > 0))
        return INFINITY;
    if (s < 1 && end < 1) {
        double z = t / s;
        return (s - 1) * log1p_minus_z(z) + t * math_log1p(z);
    }
    if (s < 1)
        return -(end - 1) * math_log(s) + (1 - s) * t / s;
    return end < 1 ? (end - 1) * math_log(end) : 0;
}
