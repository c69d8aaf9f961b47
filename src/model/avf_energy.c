#include "model/avf_energy.h"

#include <math.h>

#include "model/mass_spring_energy.h"
#include "model/system.h"

/* What all integrals of one spring are made of. */
typedef struct AverageSpring {
    double d[2], delta[2]; /* m */
    double s, B, C;        /* strain s + t B + t^2 C */
} AverageSpring;

static AverageSpring average_spring(const double *x_n, const double *u,
                                    const int e[2], double l2)
{
    const double *xi = x_n + 2 * e[0], *xj = x_n + 2 * e[1];
    const double *ui = u + 2 * e[0], *uj = u + 2 * e[1];
    AverageSpring a = {.d = {xi[0] - xj[0], xi[1] - xj[1]},
                       .delta = {ui[0] - uj[0], ui[1] - uj[1]}};
    a.s = (a.d[0] * a.d[0] + a.d[1] * a.d[1]) / l2 - 1;
    a.B = 2 * (a.d[0] * a.delta[0] + a.d[1] * a.delta[1]) / l2;
    a.C = (a.delta[0] * a.delta[0] + a.delta[1] * a.delta[1]) / l2;
    return a;
}

/* sum l2 k/2 [2 s B + (B^2 + 2 s C)/2 + 2 B C/3 + C^2/4] */
double avf_energy_value(int springs, const double *x_n, const double *u,
                        const int *e, const double *l2, const double *k)
{
    double sum = 0;
    for (int i = 0; i < springs; i++) {
        AverageSpring a = average_spring(x_n, u, e + 2 * i, l2[i]);
        sum += l2[i] * 0.5 * k[i] *
               (2 * a.s * a.B + 0.5 * (a.B * a.B + 2 * a.s * a.C) +
                2 * a.B * a.C / 3 + 0.25 * a.C * a.C);
    }
    return sum;
}

/* integral of 2 k s(t) (d + t delta):
 * k [(2 s + B + 2C/3) d + (s + 2B/3 + C/2) delta] */
void avf_energy_gradient(int springs, const double *x_n, const double *u,
                         const int *e, const double *l2, const double *k,
                         double scale, double *g)
{
    for (int i = 0; i < springs; i++) {
        AverageSpring a = average_spring(x_n, u, e + 2 * i, l2[i]);
        double along_d = scale * k[i] * (2 * a.s + a.B + 2 * a.C / 3);
        double along_delta = scale * k[i] * (a.s + 2 * a.B / 3 + 0.5 * a.C);
        double *gi = g + 2 * e[2 * i], *gj = g + 2 * e[2 * i + 1];
        for (int c = 0; c < 2; c++) {
            double f = along_d * a.d[c] + along_delta * a.delta[c];
            gi[c] += f;
            gj[c] -= f;
        }
    }
}

/* (2k/l2) [d d^T + 2/3 (d delta^T + delta d^T) + delta delta^T/2]
 * + k (s + 2B/3 + C/2) I */
static void average_hessian(const AverageSpring *a, double l2, double k,
                            double H[3])
{
    double factor = 2 * k / l2;
    double round = k * (a->s + 2 * a->B / 3 + 0.5 * a->C);
    const double *d = a->d, *delta = a->delta;
    H[0] = factor * (d[0] * d[0] + 4 * d[0] * delta[0] / 3 +
                     0.5 * delta[0] * delta[0]) +
           round;
    H[1] = factor * (d[0] * d[1] + 2 * (d[0] * delta[1] + delta[0] * d[1]) / 3 +
                     0.5 * delta[0] * delta[1]);
    H[2] = factor * (d[1] * d[1] + 4 * d[1] * delta[1] / 3 +
                     0.5 * delta[1] * delta[1]) +
           round;
}

int avf_energy_hessian(int springs, const double *x_n, const double *u,
                       const int *e, const double *l2, const double *k,
                       double scale, Filter filter, const int *slot,
                       double *values)
{
    int projected = 0;
    for (int i = 0; i < springs; i++) {
        AverageSpring a = average_spring(x_n, u, e + 2 * i, l2[i]);
        double H[3];
        average_hessian(&a, l2[i], scale * k[i], H);
        projected += filter_2x2(filter, H);
        mass_spring_scatter(H, i, slot, values);
    }
    return projected;
}

void avf_energy_product(int springs, const double *x_n, const double *u,
                        const int *e, const double *l2, const double *k,
                        double scale, Filter filter, const double *q, double *y)
{
    for (int i = 0; i < springs; i++) {
        AverageSpring a = average_spring(x_n, u, e + 2 * i, l2[i]);
        double H[3];
        average_hessian(&a, l2[i], scale * k[i], H);
        filter_2x2(filter, H);
        mass_spring_multiply(H, e + 2 * i, q, y);
    }
}

/* Along p: B + alpha b, C + alpha c1 + alpha^2 c2 with b = 2 d.q/l2,
 * c1 = 2 delta.q/l2, c2 = |q|^2/l2, q = p_i - p_j, put into Phi. */
void avf_energy_along(int springs, const double *x_n, const double *u,
                      const double *p, const int *e, const double *l2,
                      const double *k, double scale, double q[3])
{
    for (int i = 0; i < springs; i++) {
        AverageSpring a = average_spring(x_n, u, e + 2 * i, l2[i]);
        const double *pi = p + 2 * e[2 * i], *pj = p + 2 * e[2 * i + 1];
        double q0 = pi[0] - pj[0], q1 = pi[1] - pj[1];
        double w = scale * l2[i] * 0.5 * k[i];
        double b = 2 * (a.d[0] * q0 + a.d[1] * q1) / l2[i];
        double c1 = 2 * (a.delta[0] * q0 + a.delta[1] * q1) / l2[i];
        double c2 = (q0 * q0 + q1 * q1) / l2[i];
        q[0] += w * (0.5 * b * b + a.s * c2 + 2 * (a.B * c2 + b * c1) / 3 +
                     0.25 * c1 * c1 + 0.5 * a.C * c2);
        q[1] += w * (2 * b * c2 / 3 + 0.5 * c1 * c2);
        q[2] += w * 0.25 * c2 * c2;
    }
}

/* The Hessian is the integral of t H(x_n + t u), so what a spring lacks in
 * length is at most half of what it lacks where it is shortest on its way. */
static void concave(const Term *term, const Place *at, double w, double *sum)
{
    (void)term;
    const System *system = at->system;
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * s;
        AverageSpring a = average_spring(at->x_n, at->u, e, system->l2[s]);
        double t = a.C > 0 ? fmin(fmax(-a.B / (2 * a.C), 0), 1) : 0;
        double missing = -(a.s + t * (a.B + t * a.C));
        if (!(missing > 0))
            continue;
        sum[e[0]] += 2 * w * system->k[s] * missing;
        sum[e[1]] += 2 * w * system->k[s] * missing;
    }
}

static double value(const Term *term, const Place *at)
{
    (void)term;
    const System *system = at->system;
    return avf_energy_value(system->springs, at->x_n, at->u, system->e,
                            system->l2, system->k);
}

static void gradient(const Term *term, const Place *at, double w, double *g)
{
    (void)term;
    const System *system = at->system;
    avf_energy_gradient(system->springs, at->x_n, at->u, system->e, system->l2,
                        system->k, w, g);
}

static int hessian(const Term *term, const Place *at, double w, Filter filter,
                   const int *slot, double *values)
{
    (void)term;
    const System *system = at->system;
    return avf_energy_hessian(system->springs, at->x_n, at->u, system->e,
                              system->l2, system->k, w, filter, slot, values);
}

static void product(const Term *term, const Place *at, double w, Filter filter,
                    const double *q, double *y)
{
    (void)term;
    const System *system = at->system;
    avf_energy_product(system->springs, at->x_n, at->u, system->e, system->l2,
                       system->k, w, filter, q, y);
}

static void along(const Term *term, const Place *at, const double *p, double w,
                  double reach, double q[3])
{
    (void)term;
    (void)reach;
    const System *system = at->system;
    avf_energy_along(system->springs, at->x_n, at->u, p, system->e, system->l2,
                     system->k, w, q);
}

const TermKind avf_energy = {
    .name = "springs",
    .value = value,
    .gradient = gradient,
    .entries = mass_spring_entries,
    .pattern = mass_spring_pattern,
    .hessian = hessian,
    .product = product,
    .along = along,
    .stiffest = mass_spring_stiffest,
    .force = mass_spring_force,
    .concave = concave,
    .internal = true,
};
