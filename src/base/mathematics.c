/* mathematics.c - hypot, log and log1p with the same bits everywhere. */
#include "base/mathematics.h"

#include <math.h>

double math_hypot(double x, double y)
{
    double large = fmax(fabs(x), fabs(y)), small = fmin(fabs(x), fabs(y));
    double scale = large > 0x1p500 ? 0x1p600 : large < 0x1p-450 ? 0x1p-600 : 1;
    if (isinf(large) || isnan(x) || isnan(y))
        return isinf(large) ? INFINITY : NAN;
    large /= scale;
    small /= scale;
    return scale * sqrt(large * large + small * small);
}

/* x = 2^k (1 + f) with |f| at most about 0.41.  With s = f / (2 + f),
 * log(1 + f) = 2 s + 2 s^3/3 + 2 s^5/5 + ..., computed as f minus small terms,
 * so that rounding errors are small, too (Tang 1990, and fdlibm). */
double math_log(double x)
{
    static const double high = 0x1.62e42feep-1, low = 0x1.a39ef35793c76p-33;
    int k;
    if (!(x > 0) || isinf(x))
        return x == 0 ? -INFINITY : x > 0 ? x : NAN;
    double m = frexp(x, &k);
    if (m < 0.70710678118654752) {
        m *= 2;
        k--;
    }
    double f = m - 1, s = f / (2 + f), z = s * s, half = 0.5 * f * f;
    double sum = 2.0 / 15 + z * (2.0 / 17 + z * (2.0 / 19 + z * (2.0 / 21)));
    sum = 2.0 / 9 + z * (2.0 / 11 + z * (2.0 / 13 + z * sum));
    sum = z * (2.0 / 3 + z * (2.0 / 5 + z * (2.0 / 7 + z * sum)));
    return k * high - ((half - (s * (half + sum) + k * low)) - f);
}

double math_log1p(double x)
{
    double u = 1 + x;
    if (u == 1)
        return x;
    return isfinite(u) && u > 0 ? math_log(u) + (x - (u - 1)) / u : math_log(u);
}
