#include "solve/plane_search.h"

#include <math.h>

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

enum { PLANE_MAX_ITERATIONS = 30, PLANE_MAX_HALVINGS = 60 };

/* First derivatives F_a, F_b. */
static void plane_gradient(const double *c, double a, double b, double g[2])
{
    g[0] = c[0] + 2 * c[2] * a + c[3] * b + 3 * c[5] * a * a +
           2 * c[6] * a * b + c[7] * b * b + 4 * c[9] * a * a * a +
           3 * c[10] * a * a * b + 2 * c[11] * a * b * b + c[12] * b * b * b;
    g[1] = c[1] + c[3] * a + 2 * c[4] * b + c[6] * a * a + 2 * c[7] * a * b +
           3 * c[8] * b * b + c[10] * a * a * a + 2 * c[11] * a * a * b +
           3 * c[12] * a * b * b + 4 * c[13] * b * b * b;
}

/* Second derivatives F_aa, F_ab, F_bb. */
static void plane_hessian(const double *c, double a, double b, double H[3])
{
    H[0] = 2 * c[2] + 6 * c[5] * a + 2 * c[6] * b + 12 * c[9] * a * a +
           6 * c[10] * a * b + 2 * c[11] * b * b;
    H[1] = c[3] + 2 * c[6] * a + 2 * c[7] * b + 3 * c[10] * a * a +
           4 * c[11] * a * b + 3 * c[12] * b * b;
    H[2] = 2 * c[4] + 2 * c[7] * a + 6 * c[8] * b + 2 * c[11] * a * a +
           6 * c[12] * a * b + 12 * c[13] * b * b;
}

/* -g/|h|, or 0 where the direction does not exist. */
static double scaled_step(double g, double h)
{
    return h != 0 ? -g / fabs(h) : 0;
}

/* Newton's step where H is positive definite, else downhill, each variable in
 * its own scale; so the result does not depend on the lengths of p and r. */
static void plane_direction(const double g[2], const double H[3],
                            double step[2])
{
    double det = H[0] * H[2] - H[1] * H[1];
    if (H[0] > 0 && H[2] > 0 && det > 1e-10 * H[0] * H[2]) {
        step[0] = (H[1] * g[1] - H[2] * g[0]) / det;
        step[1] = (H[1] * g[0] - H[0] * g[1]) / det;
        return;
    }
    step[0] = scaled_step(g[0], H[0]);
    step[1] = scaled_step(g[1], H[2]);
}

/* What the rounding errors of plane_value are in proportion to: the sum of
 * its terms without signs. */
static double plane_size(const PlaneQuartic *quartic, double a, double b)
{
    PlaneQuartic size;
    for (int i = 0; i < PLANE_TERMS; i++)
        size.c[i] = fabs(quartic->c[i]);
    return plane_value(&size, fabs(a), fabs(b));
}

Status plane_minimise(const PlaneQuartic *quartic, double at[2], int *trials)
{
    double value = 0;
    at[0] = at[1] = 0;
    *trials = 0;
    for (int i = 0; i < PLANE_MAX_ITERATIONS; i++) {
        double g[2], H[3], step[2];
        plane_gradient(quartic->c, at[0], at[1], g);
        plane_hessian(quartic->c, at[0], at[1], H);
        plane_direction(g, H, step);
        double slope = g[0] * step[0] + g[1] * step[1], t = 1, next = value;
        int halvings = 0;
        for (; halvings < PLANE_MAX_HALVINGS; halvings++, t /= 2) {
            next =
                plane_value(quartic, at[0] + t * step[0], at[1] + t * step[1]);
            ++*trials;
            if (next <= value + 1e-4 * t * slope)
                break;
        }
        if (halvings == PLANE_MAX_HALVINGS || !(next < value))
            break;
        at[0] += t * step[0];
        at[1] += t * step[1];
        bool settled = value - next <= 1e-6 * -next;
        value = next;
        if (settled)
            break;
    }
    return value < -1e-14 * plane_size(quartic, at[0], at[1])
               ? STATUS_OK
               : STATUS_LINE_SEARCH_LIMIT;
}
