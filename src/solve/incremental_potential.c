#include "solve/incremental_potential.h"

#include "model/avf_energy.h"
#include "model/inertia_energy.h"
#include "model/mass_spring_energy.h"

/* The central field averaged: m omega2 (x_n + u/2) is its gradient. */
static double average_central_value(const IncrementalPotential *E,
                                    const double *u)
{
    const System *system = E->system;
    double sum = 0;
    for (int i = 0; i < 2 * system->nodes; i++)
        sum += system->m[i / 2] * u[i] * (E->x_n[i] + 0.25 * u[i]);
    return system->omega2 * sum;
}

double incremental_potential_value(const IncrementalPotential *E,
                                   const double *u, const double *x)
{
    const System *system = E->system;
    double inertia =
        inertia_energy_value(system->nodes, u, E->u_tilde, system->m);
    if (!E->averaged)
        return inertia + E->weight * system_potential(system, x);
    double phi = avf_energy_value(system->springs, E->x_n, u, system->e,
                                  system->l2, system->k);
    if (system->omega2 > 0)
        phi += average_central_value(E, u);
    return inertia + E->weight * phi;
}

double incremental_potential_scale(const IncrementalPotential *E,
                                   const double *u, const double *x)
{
    const System *system = E->system;
    return inertia_energy_value(system->nodes, u, E->u_tilde, system->m) +
           E->weight * system_potential(system, x);
}

/* grad Phi, weighted, with 0 for pinned nodes. */
static void average_gradient(const IncrementalPotential *E, const double *u,
                             double *g)
{
    const System *system = E->system;
    avf_energy_gradient(system->springs, E->x_n, u, system->e, system->l2,
                        system->k, E->weight, g);
    if (system->omega2 > 0)
        for (int i = 0; i < 2 * system->nodes; i++)
            g[i] += E->weight * system->omega2 * system->m[i / 2] *
                    (E->x_n[i] + 0.5 * u[i]);
    system_clear_pinned(system, g);
}

void incremental_potential_gradient(const IncrementalPotential *E,
                                    const double *u, const double *x, double *g)
{
    const System *system = E->system;
    for (int i = 0; i < 2 * system->nodes; i++)
        g[i] = 0;
    inertia_energy_gradient(system->nodes, u, E->u_tilde, system->m, g);
    if (E->averaged)
        average_gradient(E, u, g);
    else
        system_gradient(system, x, E->weight, g);
}

/* The 2x2 block of node places r and c; on the diagonal only one triangle. */
static void add_block(Triplets *triplets, int r, int c)
{
    triplets_add(triplets, 2 * r, 2 * c);
    triplets_add(triplets, 2 * r, 2 * c + 1);
    if (r != c)
        triplets_add(triplets, 2 * r + 1, 2 * c);
    triplets_add(triplets, 2 * r + 1, 2 * c + 1);
}

Status incremental_potential_pattern(const System *system, Triplets *triplets)
{
    const int *order = system->order;
    long long diagonal = 2LL * system->nodes;
    Status status = triplets_create(
        2 * system->nodes,
        diagonal + (long long)SPRING_ENTRIES * system->springs, triplets);
    if (status)
        return status;
    for (int i = 0; i < system->nodes; i++) {
        int place = order ? order[i] : i;
        triplets_add(triplets, 2 * place, 2 * place);
        triplets_add(triplets, 2 * place + 1, 2 * place + 1);
    }
    for (int s = 0; s < system->springs; s++) {
        int i = system->e[2 * s], j = system->e[2 * s + 1];
        int r = order ? order[i] : i, c = order ? order[j] : j;
        add_block(triplets, r, r);
        add_block(triplets, c, c);
        add_block(triplets, r, c);
    }
    return STATUS_OK;
}

void incremental_potential_drop_pinned(const System *system, const Sparse *A,
                                       int *slot)
{
    if (!system->pinned)
        return;
    slot += 2 * system->nodes;
    for (int s = 0; s < system->springs; s++, slot += SPRING_ENTRIES) {
        bool i = system->pinned[system->e[2 * s]];
        bool j = system->pinned[system->e[2 * s + 1]];
        for (int t = 0; t < SPRING_ENTRIES; t++)
            if ((i && t < 3) || (j && t >= 3 && t < 6) || ((i || j) && t >= 6))
                slot[t] = A->entries;
    }
}

/* Weight of the central field's quadratic form: averaged, half of it. */
static double central_weight(const IncrementalPotential *E)
{
    double w = E->weight * E->system->omega2;
    return E->averaged ? 0.5 * w : w;
}

int incremental_potential_hessian(const IncrementalPotential *E,
                                  const double *u, const double *x,
                                  Filter filter, const int *slot, Sparse *A)
{
    const System *system = E->system;
    int diagonal = 2 * system->nodes;
    sparse_clear(A);
    inertia_energy_hessian(system->nodes, system->m, slot, A->value);
    if (system->omega2 > 0)
        for (int t = 0; t < diagonal; t++)
            A->value[slot[t]] += central_weight(E) * system->m[t / 2];
    slot += diagonal;
    if (E->averaged)
        return avf_energy_hessian(system->springs, E->x_n, u, system->e,
                                  system->l2, system->k, E->weight, filter,
                                  slot, A->value);
    return mass_spring_energy_hessian(system->springs, x, system->e, system->l2,
                                      system->k, E->weight, filter, slot,
                                      A->value);
}

void incremental_potential_product(const IncrementalPotential *E,
                                   const double *u, const double *x,
                                   Filter filter, const double *q, double *y)
{
    const System *system = E->system;
    for (int i = 0; i < 2 * system->nodes; i++)
        y[i] = (1 + central_weight(E)) * system->m[i / 2] * q[i];
    if (E->averaged)
        avf_energy_product(system->springs, E->x_n, u, system->e, system->l2,
                           system->k, E->weight, filter, q, y);
    else
        mass_spring_energy_product(system->springs, x, system->e, system->l2,
                                   system->k, E->weight, filter, q, y);
    system_clear_pinned(system, y);
}

/* With q = p_i - p_j, B = 2 d.q/l2 and C = |q|^2/l2 a spring's strain along
 * the direction is s + alpha B + alpha^2 C, so its energy
 * l2 k/2 (s + alpha B + alpha^2 C)^2 has the coefficients below. */
static void springs_along(const IncrementalPotential *E, const double *x,
                          const double *p, double q[3])
{
    const System *system = E->system;
    for (int s = 0; s < system->springs; s++) {
        int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
        double d0 = x[i] - x[j], d1 = x[i + 1] - x[j + 1];
        double p0 = p[i] - p[j], p1 = p[i + 1] - p[j + 1];
        double l2 = system->l2[s];
        double w = E->weight * 0.5 * system->k[s] / l2;
        double strain = d0 * d0 + d1 * d1 - l2;
        double B = 2 * (d0 * p0 + d1 * p1);
        double C = p0 * p0 + p1 * p1;
        q[0] += w * (B * B + 2 * strain * C);
        q[1] += 2 * w * B * C;
        q[2] += w * C * C;
    }
}

/* The inertia energy and the central field are quadratic; g.p is the slope of
 * all terms. */
Quartic incremental_potential_along(const IncrementalPotential *E,
                                    const double *u, const double *x,
                                    const double *g, const double *p)
{
    const System *system = E->system;
    Quartic along = {{0, 0, 0, 0}};
    double quadratic = 0.5 * (1 + central_weight(E));
    for (int i = 0; i < 2 * system->nodes; i++) {
        along.q[0] += g[i] * p[i];
        along.q[1] += quadratic * system->m[i / 2] * p[i] * p[i];
    }
    if (E->averaged)
        avf_energy_along(system->springs, E->x_n, u, p, system->e, system->l2,
                         system->k, E->weight, along.q + 1);
    else
        springs_along(E, x, p, along.q + 1);
    return along;
}

/* d = a_i - a_j for springs s and t, one in each lane. */
static inline void differences(const System *system, const double *a, int s,
                               int t, Lanes d[2])
{
    const int *e = system->e;
    Lanes ds = lanes_load(a + 2 * e[2 * s]) - lanes_load(a + 2 * e[2 * s + 1]);
    Lanes dt = lanes_load(a + 2 * e[2 * t]) - lanes_load(a + 2 * e[2 * t + 1]);
    d[0] = (Lanes){ds[0], dt[0]};
    d[1] = (Lanes){ds[1], dt[1]};
}

/* A spring's strain in the plane is a quadratic in a and b; its energy is
 * l2 k/2 times the square of that. */
static void springs_in_plane(const IncrementalPotential *E, const double *x,
                             const double *p, const double *r,
                             PlaneQuartic *quartic)
{
    const System *system = E->system;
    PlaneSums sums = {{{0}}};
    for (int s = 0, last = system->springs - 1; s <= last; s += LANES) {
        int t = s < last ? s + 1 : s;
        Lanes d[2], P[2], R[2], l2 = {system->l2[s], system->l2[t]};
        Lanes k = {system->k[s], s < last ? system->k[t] : 0};
        differences(system, x, s, t, d);
        differences(system, p, s, t, P);
        differences(system, r, s, t, R);
        PlaneQuadratics strains = {{
            d[0] * d[0] + d[1] * d[1] - l2,
            2 * (d[0] * P[0] + d[1] * P[1]),
            2 * (d[0] * R[0] + d[1] * R[1]),
            P[0] * P[0] + P[1] * P[1],
            2 * (P[0] * R[0] + P[1] * R[1]),
            R[0] * R[0] + R[1] * R[1],
        }};
        plane_add_squares(&strains, E->weight * 0.5 * k / l2, &sums);
    }
    plane_add(&sums, quartic);
}

PlaneQuartic incremental_potential_in_plane(const IncrementalPotential *E,
                                            const double *u, const double *x,
                                            const double *g, const double *p,
                                            const double *r)
{
    const System *system = E->system;
    PlaneQuartic plane = {{0}};
    double quadratic = 0.5 * (1 + central_weight(E));
    for (int i = 0; i < 2 * system->nodes; i++) {
        double m = quadratic * system->m[i / 2];
        plane.c[0] += g[i] * p[i];
        plane.c[1] += g[i] * r[i];
        plane.c[2] += m * p[i] * p[i];
        plane.c[3] += 2 * m * p[i] * r[i];
        plane.c[4] += m * r[i] * r[i];
    }
    if (E->averaged)
        avf_energy_in_plane(system->springs, E->x_n, u, p, r, system->e,
                            system->l2, system->k, E->weight, &plane);
    else
        springs_in_plane(E, x, p, r, &plane);
    return plane;
}
