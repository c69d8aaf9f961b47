/* mass_spring_energy.c - energy of all springs (slide MassSpringEnergy.py). */
#include "model/mass_spring_energy.h"

static double mass_spring_potential(const EvalPoint *at)
{
    const System *system = at->system;
    double sum = 0, d[2];
    for (int i = 0; i < system->springs; i++) {
        double d2 = spring_vector(system->e + 2 * i, at->x, d);
        sum += spring_energy(at->l2[i], at->k[i], spring_strain(d2, at->l2[i]));
    }
    return sum;
}

static void mass_spring_gradient(const EvalPoint *at, double *g)
{
    const System *system = at->system;
    for (int i = 0; i < system->springs; i++) {
        const int *e = system->e + 2 * i;
        double d[2], d2 = spring_vector(e, at->x, d);
        double s = spring_strain(d2, at->l2[i]);
        spring_add_gradient(e, spring_gradient_factor(at->weight * at->k[i], s),
                            d, g);
    }
}

static int mass_spring_hessian(const EvalPoint *at, Projection projection,
                               const int **slot, const double *q, double *out)
{
    const System *system = at->system;
    int projected = 0;
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * s;
        double d[2], H[3];
        spring_vector(e, at->x, d);
        projected +=
            spring_hessian(d, at->l2[s], at->weight * at->k[s], projection, H);
        mass_spring_add_hessian(H, e, slot, q, out);
    }
    return projected;
}

/* Along p the energy of a spring, c/4 (|d|^2 - l2)^2, becomes
 * c/4 (|d|^2 - l2 + alpha B + alpha^2 C)^2. */
static void mass_spring_line_polynomial(const EvalPoint *at, const double *p,
                                        double q[3])
{
    const System *system = at->system;
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * s;
        double d[2], change[2], l2 = at->l2[s];
        double c = 0.25 * spring_hessian_factor(l2, at->weight * at->k[s]);
        double d2 = spring_vector(e, at->x, d);
        double C = spring_vector(e, p, change);
        double B = 2 * (d[0] * change[0] + d[1] * change[1]);
        q[0] += c * (B * B + 2 * spring_eigenvalue_across(d2, l2) * C);
        q[1] += 2 * c * B * C;
        q[2] += c * C * C;
    }
}

void mass_spring_add_triplets(const EvalPoint *at, Triplets *triplets)
{
    for (int s = 0; s < at->system->springs; s++) {
        int i = at->system->e[2 * s], j = at->system->e[2 * s + 1];
        add_block_triplets(at->system, i, i, triplets);
        add_block_triplets(at->system, j, j, triplets);
        add_block_triplets(at->system, i, j, triplets);
    }
}

double mass_spring_max_stiffness(const EvalPoint *at)
{
    double most = 0;
    for (int s = 0; s < at->system->springs; s++)
        most = max_or_nan(most, at->k[s]);
    return most;
}

const TermKind mass_spring_energy = {
    .energy_name = "elastic",
    .potential = mass_spring_potential,
    .gradient = mass_spring_gradient,
    .add_triplets = mass_spring_add_triplets,
    .hessian = mass_spring_hessian,
    .line_polynomial = mass_spring_line_polynomial,
    .max_stiffness = mass_spring_max_stiffness,
    .supports_all_integrators = true,
};
