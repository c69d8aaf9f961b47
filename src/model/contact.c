#include "model/contact.h"

#include <math.h>

#include "model/barrier.h"

const double *obstacle_point(const Obstacle *obstacle, const double *x)
{
    return obstacle->node < 0 ? obstacle->o : x + 2 * obstacle->node;
}

Gap contact_gap(const Obstacle *obstacle, const double *o, const double *x_i)
{
    double D[2] = {x_i[0] - o[0], x_i[1] - o[1]};
    const double *n = obstacle->n;
    if (obstacle->kind == OBSTACLE_WALL)
        return (Gap){n[0] * D[0] + n[1] * D[1], {n[0], n[1]}, INFINITY};
    double r = hypot(D[0], D[1]);
    return (Gap){r - obstacle->radius, {D[0] / r, D[1] / r}, r};
}

double contact_value(const Barrier *barrier, const Gap *gap)
{
    return barrier->c * barrier_value(gap->d / barrier->d_hat);
}

double contact_force(const Barrier *barrier, const Gap *gap)
{
    return -barrier->c / barrier->d_hat *
           barrier_slope(gap->d / barrier->d_hat);
}

bool contact_hessian(const Barrier *barrier, const Gap *gap, Filter filter,
                     double H[3])
{
    const double *n = gap->n;
    double along = barrier->c / (barrier->d_hat * barrier->d_hat) *
                   barrier_curvature(gap->d / barrier->d_hat);
    double across = -contact_force(barrier, gap) / gap->r; /* a wall's is 0 */
    bool negative = across < 0;
    if (filter == FILTER_CLAMP)
        across = 0;
    else if (filter == FILTER_ABS)
        across = -across;
    H[0] = along * n[0] * n[0] + across * n[1] * n[1];
    H[1] = (along - across) * n[0] * n[1];
    H[2] = along * n[1] * n[1] + across * n[0] * n[0];
    return negative && (filter == FILTER_CLAMP || filter == FILTER_ABS);
}

/* A ball: |D + alpha P| = R + (1-F) d is the quadratic equation
 * a alpha^2 + 2 b alpha + c0 = 0, whose smaller root is written so that nothing
 * cancels. */
double contact_reach(const Obstacle *obstacle, const Gap *gap,
                     const double P[2])
{
    const double F = CONTACT_LIMIT;
    double pn = gap->n[0] * P[0] + gap->n[1] * P[1];
    if (!(pn < 0))
        return INFINITY;
    if (obstacle->kind == OBSTACLE_WALL)
        return F * gap->d / -pn;
    double b = gap->r * pn, a = P[0] * P[0] + P[1] * P[1];
    double c0 = F * gap->d * (gap->r + obstacle->radius + (1 - F) * gap->d);
    double discriminant = b * b - a * c0;
    return discriminant > 0 ? c0 / (-b + sqrt(discriminant)) : INFINITY;
}

/* Along P the distance of a ball's centre changes by pn + k, where k is what
 * the motion across adds: sqrt((r + pn)^2 + pt^2) - (r + pn). */
double contact_remainder(const Barrier *barrier, const Gap *gap,
                         const double P[2])
{
    const double *n = gap->n;
    double pn = n[0] * P[0] + n[1] * P[1], k = 0;
    double s = gap->d / barrier->d_hat;
    if (isfinite(gap->r)) {
        double pt = n[0] * P[1] - n[1] * P[0], r = gap->r + pn;
        double length = hypot(r, pt);
        k = r > 0 ? pt * pt / (length + r) : length - r;
    }
    return barrier->c * (barrier_slope(s) * k / barrier->d_hat +
                         barrier_remainder(s, (pn + k) / barrier->d_hat));
}
