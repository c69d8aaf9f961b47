/* Phi(u), whose gradient is the spring force averaged along the straight way
 * from x_n to x_n + u:
 *   grad Phi(u) = integral over t = 0 ... 1 of grad P(x_n + t u).
 * A step that minimises with Phi instead of P conserves energy exactly (Rojas,
 * Liu, Kavan: Average Vector Field Integration for St. Venant-Kirchhoff
 * Deformable Models, 2018).
 *
 * With d = x_n,i - x_n,j, delta = u_i - u_j, s = |d|^2/l2 - 1,
 * B = 2 d.delta/l2 and C = |delta|^2/l2 the strain on the way is
 * s + t B + t^2 C, and the integrals are polynomials.
 */
#include "model/mass_spring_energy.h"

#include <math.h>

/* What all integrals of one spring are made of. */
typedef struct AverageSpring {
    const int *e;          /* [2] its nodes */
    double l2, k;          /* m^2, J/m^2 */
    double d[2], delta[2]; /* m */
    double s, B, C;        /* strain s + t B + t^2 C */
} AverageSpring;

static AverageSpring average_spring(const Place *at, int spring)
{
    const int *e = at->system->e + 2 * spring;
    const double *ui = at->u + 2 * e[0], *uj = at->u + 2 * e[1];
    AverageSpring a = {.e = e,
                       .l2 = at->l2[spring],
                       .k = at->k[spring],
                       .delta = {ui[0] - uj[0], ui[1] - uj[1]}};
    a.s = spring_strain(e, a.l2, at->x_n, a.d);
    a.B = 2 * (a.d[0] * a.delta[0] + a.d[1] * a.delta[1]) / a.l2;
    a.C = (a.delta[0] * a.delta[0] + a.delta[1] * a.delta[1]) / a.l2;
    return a;
}

/* sum l2 k/2 [2 s B + (B^2 + 2 s C)/2 + 2 B C/3 + C^2/4] */
static double value(const Place *at)
{
    double sum = 0;
    for (int i = 0; i < at->system->springs; i++) {
        AverageSpring a = average_spring(at, i);
        sum += a.l2 * 0.5 * a.k *
               (2 * a.s * a.B + 0.5 * (a.B * a.B + 2 * a.s * a.C) +
                2 * a.B * a.C / 3 + 0.25 * a.C * a.C);
    }
    return sum;
}

/* integral of 2 k s(t) (d + t delta):
 * k [(2 s + B + 2C/3) d + (s + 2B/3 + C/2) delta] */
static void gradient(const Place *at, double *g)
{
    for (int i = 0; i < at->system->springs; i++) {
        AverageSpring a = average_spring(at, i);
        double k = at->w * a.k;
        double along_d = k * (2 * a.s + a.B + 2 * a.C / 3);
        double along_delta = k * (a.s + 2 * a.B / 3 + 0.5 * a.C);
        double f[2];
        for (int c = 0; c < 2; c++)
            f[c] = along_d * a.d[c] + along_delta * a.delta[c];
        spring_add_force(a.e, 1, f, g);
    }
}

/* (2k/l2) [d d^T + 2/3 (d delta^T + delta d^T) + delta delta^T/2]
 * + k (s + 2B/3 + C/2) I */
static int hessian(const Place *at, Filter filter, const int *slot,
                   const double *q, double *out)
{
    int projected = 0;
    for (int i = 0; i < at->system->springs; i++) {
        AverageSpring a = average_spring(at, i);
        const double *d = a.d, *delta = a.delta;
        double k = at->w * a.k, factor = 2 * k / a.l2;
        double round = k * (a.s + 2 * a.B / 3 + 0.5 * a.C);
        double mixed = d[0] * delta[1] + delta[0] * d[1];
        double H[3];
        H[1] =
            factor * (d[0] * d[1] + 2 * mixed / 3 + 0.5 * delta[0] * delta[1]);
        for (int c = 0; c < 2; c++)
            H[2 * c] = factor * (d[c] * d[c] + 4 * d[c] * delta[c] / 3 +
                                 0.5 * delta[c] * delta[c]) +
                       round;
        projected += filter_2x2(filter, H);
        mass_spring_add(H, a.e, i, slot, q, out);
    }
    return projected;
}

/* Along p: B + alpha b, C + alpha c1 + alpha^2 c2 with b = 2 d.q/l2,
 * c1 = 2 delta.q/l2, c2 = |q|^2/l2, q = p_i - p_j, put into Phi. */
static void along(const Place *at, const double *p, double q[3])
{
    for (int i = 0; i < at->system->springs; i++) {
        AverageSpring a = average_spring(at, i);
        const double *pi = p + 2 * a.e[0], *pj = p + 2 * a.e[1];
        double q0 = pi[0] - pj[0], q1 = pi[1] - pj[1], l2 = a.l2;
        double factor = at->w * l2 * 0.5 * a.k;
        double b = 2 * (a.d[0] * q0 + a.d[1] * q1) / l2;
        double c1 = 2 * (a.delta[0] * q0 + a.delta[1] * q1) / l2;
        double c2 = (q0 * q0 + q1 * q1) / l2;
        q[0] += factor * (0.5 * b * b + a.s * c2 + 2 * (a.B * c2 + b * c1) / 3 +
                          0.25 * c1 * c1 + 0.5 * a.C * c2);
        q[1] += factor * (2 * b * c2 / 3 + 0.5 * c1 * c2);
        q[2] += factor * 0.25 * c2 * c2;
    }
}

/* The Hessian is the integral of t H(x_n + t u), so what a spring lacks in
 * length is at most half of what it lacks where it is shortest on its way. */
static void concave(const Place *at, double *sum)
{
    for (int s = 0; s < at->system->springs; s++) {
        AverageSpring a = average_spring(at, s);
        double t = a.C > 0 ? fmin(fmax(-a.B / (2 * a.C), 0), 1) : 0;
        double missing = -(a.s + t * (a.B + t * a.C));
        double c = 2 * at->w * a.k * fmax(missing, 0);
        sum[a.e[0]] += c;
        sum[a.e[1]] += c;
    }
}

const TermKind avf_energy = {
    .value = value,
    .gradient = gradient,
    .hessian = hessian,
    .along = along,
    .concave = concave,
};
