#include "base/quartic.h"

#include <math.h>

double quartic_value(const Quartic *quartic, double alpha)
{
    const double *q = quartic->q;
    return alpha * (q[0] + alpha * (q[1] + alpha * (q[2] + alpha * q[3])));
}

double quartic_difference(const void *quartic, double alpha)
{
    return quartic_value(quartic, alpha);
}

/* q'(alpha) */
static double quartic_slope(const double *q, double alpha)
{
    return q[0] + alpha * (2 * q[1] + alpha * (3 * q[2] + alpha * 4 * q[3]));
}

/* The slope is a cubic.  It is < 0 after 0; so it first gets to 0 before its
 * first maximum if that is not < 0, else after its last minimum, from where on
 * it only rises. */
double quartic_first_minimum(const Quartic *quartic)
{
    const double *q = quartic->q;
    if (!(q[0] < 0 || (q[0] == 0 && q[1] < 0)))
        return 0;
    /* q''/2 = q[1] + 3 q[2] alpha + 6 q[3] alpha^2 */
    double root = 9 * q[2] * q[2] - 24 * q[1] * q[3], low = 0, high = 0;
    root = root > 0 ? sqrt(root) : 0;
    if (root > 0 && q[2] < 0) { /* the cubic rises, falls, rises */
        double peak = 2 * q[1] / (-3 * q[2] + root);
        if (peak > 0 && quartic_slope(q, peak) >= 0)
            high = peak;
        else if (q[3] > 0)
            low = (-3 * q[2] + root) / (12 * q[3]);
    }
    if (high == 0)
        for (high = low > 0 ? 2 * low : 1; quartic_slope(q, high) < 0;
             high *= 2)
            if (high > 1e30)
                return 0;
    double alpha = 0.5 * (low + high);
    for (int i = 0; i < 100 && high - low > 1e-13 * high; i++) {
        double slope = quartic_slope(q, alpha);
        if (slope < 0)
            low = alpha;
        else
            high = alpha;
        double bend = 2 * q[1] + alpha * (6 * q[2] + alpha * 12 * q[3]);
        double newton = alpha - slope / bend;
        double move = fabs(newton - alpha);
        alpha = newton > low && newton < high ? newton : 0.5 * (low + high);
        if (alpha == newton && move <= 1e-14 * alpha)
            break;
    }
    return alpha;
}

double plane_value(const PlaneQuartic *quartic, double a, double b)
{
    const double *c = quartic->c;
    double degree1 = c[0] * a + c[1] * b;
    double degree2 = a * (c[2] * a + c[3] * b) + c[4] * b * b;
    double degree3 =
        a * (a * (c[5] * a + c[6] * b) + c[7] * b * b) + c[8] * b * b * b;
    double degree4 = a * (a * (a * (c[9] * a + c[10] * b) + c[11] * b * b) +
                          c[12] * b * b * b) +
                     c[13] * b * b * b * b;
    return degree1 + degree2 + degree3 + degree4;
}
