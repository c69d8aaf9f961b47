#include "model/mass_spring_energy.h"

#include <math.h>

/* sum l2 k/2 s^2 */
static double value(const EvalPoint *at)
{
    const System *system = at->system;
    double sum = 0, d[2];
    for (int i = 0; i < system->springs; i++) {
        double s = spring_strain(system->e + 2 * i, at->l2[i], at->x, d);
        sum += at->l2[i] * 0.5 * at->k[i] * s * s;
    }
    return sum;
}

/* grad_i P = 2 k s d, grad_j P = -2 k s d */
static void gradient(const EvalPoint *at, double *g)
{
    const System *system = at->system;
    for (int i = 0; i < system->springs; i++) {
        const int *e = system->e + 2 * i;
        double d[2], s = spring_strain(e, at->l2[i], at->x, d);
        spring_add_force(e, at->w * 2 * at->k[i] * s, d, g);
    }
}

static int hessian(const EvalPoint *at, Filter filter, const int *slot,
                   const double *q, double *out)
{
    const System *system = at->system;
    int projected = 0;
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * s;
        double d[2], H[3];
        spring_strain(e, at->l2[s], at->x, d);
        projected += spring_hessian(d, at->l2[s], at->w * at->k[s], filter, H);
        mass_spring_add(H, e, s, slot, q, out);
    }
    return projected;
}

/* With q = p_i - p_j, B = 2 d.q/l2 and C = |q|^2/l2 a spring's strain along
 * the direction is s + alpha B + alpha^2 C, so its energy
 * l2 k/2 (s + alpha B + alpha^2 C)^2 has the coefficients below. */
static void along(const EvalPoint *at, const double *p, double q[3])
{
    const System *system = at->system;
    const double *x = at->x, *l2 = at->l2, w = at->w;
    for (int s = 0; s < system->springs; s++) {
        int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
        double d0 = x[i] - x[j], d1 = x[i + 1] - x[j + 1];
        double p0 = p[i] - p[j], p1 = p[i + 1] - p[j + 1];
        double factor = w * 0.5 * at->k[s] / l2[s];
        double strain = d0 * d0 + d1 * d1 - l2[s];
        double B = 2 * (d0 * p0 + d1 * p1);
        double C = p0 * p0 + p1 * p1;
        q[0] += factor * (B * B + 2 * strain * C);
        q[1] += 2 * factor * B * C;
        q[2] += factor * C * C;
    }
}

long long mass_spring_entries(const EvalPoint *at)
{
    return (long long)SPRING_ENTRIES * at->system->springs;
}

void mass_spring_pattern(const EvalPoint *at, Triplets *triplets)
{
    for (int s = 0; s < at->system->springs; s++) {
        int i = at->system->e[2 * s], j = at->system->e[2 * s + 1];
        term_add_block(at->system, i, i, triplets);
        term_add_block(at->system, j, j, triplets);
        term_add_block(at->system, i, j, triplets);
    }
}

double mass_spring_curvature_bound(const EvalPoint *at)
{
    double most = 0;
    for (int s = 0; s < at->system->springs; s++)
        most = larger_bound(most, at->k[s]);
    return most;
}

const TermKind mass_spring_energy = {
    .energy = "elastic",
    .value = value,
    .gradient = gradient,
    .entries = mass_spring_entries,
    .pattern = mass_spring_pattern,
    .hessian = hessian,
    .along = along,
    .curvature_bound = mass_spring_curvature_bound,
    .internal = true,
};
