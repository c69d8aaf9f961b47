#include "solve/plane_search.h"

#include <math.h>

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
