#include "model/friction.h"

#include <math.h>

double friction_value(double y, double e)
{
    double a = fabs(y);
    return a < e ? a * a / e * (1 - a / (3 * e)) : a - e / 3;
}

double friction_slope(double y, double e)
{
    double a = fmin(fabs(y) / e, 1);
    return copysign(a * (2 - a), y);
}

double friction_curvature(double y, double e)
{
    return 2 / e * fmax(0, 1 - fabs(y) / e);
}

/* On one piece, [0, e] mirrored or not, f0'' is linear: the remainder of a step
 * from y to z = y + t is t^2 (2 f0''(y) + f0''(z))/6. */
static double remainder_on_piece(double y, double z, double e)
{
    double t = z - y;
    return t * t * (2 * friction_curvature(y, e) + friction_curvature(z, e)) /
           6;
}

/* From y >= 0 on to y + t, both >= 0 and in order; `back`: the other way. */
static double remainder_on_side(double y, double t, double e)
{
    double z = y + t;
    if (y <= e && z <= e)
        return t * t *
               (2 * friction_curvature(y, e) + friction_curvature(z, e)) / 6;
    if (y > e && z > e)
        return 0;
    if (y > e) /* into the piece: the slope at y is the one at e */
        return remainder_on_piece(e, z, e);
    /* out of it: what the first way leaves of the slope, all the way after */
    double missing = 1 - y / e;
    return remainder_on_piece(y, e, e) + missing * missing * (z - e);
}

/* R(a -> c) = R(a -> b) + (f'(b) - f'(a)) (c - b) + R(b -> c) with b = 0 where
 * the way passes it. */
double friction_remainder(double y, double t, double e)
{
    double z = y + t;
    if (y < 0) { /* f0 is even */
        y = -y;
        t = -t;
        z = -z;
    }
    if (z >= 0)
        return remainder_on_side(y, t, e);
    return remainder_on_side(y, -y, e) - friction_slope(y, e) * z +
           remainder_on_side(0, -z, e);
}
