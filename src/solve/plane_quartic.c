/* plane_quartic.c - E in the plane of two directions, which only the lagged
 * solver asks for (incremental_potential.h). */
#include "model/avf_energy.h"
#include "model/central_field.h"
#include "model/mass_spring_energy.h"
#include "solve/incremental_potential.h"

bool incremental_potential_has_plane(const System *system)
{
    for (int t = 0; t < system->terms; t++)
        if (system->term[t].kind != &mass_spring_energy &&
            system->term[t].kind != &central_field)
            return false;
    return true;
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

PlaneQuartic incremental_potential_in_plane(const Iterate *at, const double *r)
{
    const IncrementalPotential *E = &at->E;
    const System *system = E->system;
    const double *g = at->g, *p = at->p;
    PlaneQuartic plane = {{0}};
    double field = E->weight * central_field_omega2(system);
    double quadratic = 0.5 * (1 + (E->averaged ? 0.5 * field : field));
    for (int i = 0; i < 2 * system->nodes; i++) {
        double m = quadratic * system->m[i / 2];
        plane.c[0] += g[i] * p[i];
        plane.c[1] += g[i] * r[i];
        plane.c[2] += m * p[i] * p[i];
        plane.c[3] += 2 * m * p[i] * r[i];
        plane.c[4] += m * r[i] * r[i];
    }
    if (E->averaged)
        avf_energy_in_plane(system->springs, E->x_n, at->u, p, r, system->e,
                            system->l2, system->k, E->weight, &plane);
    else
        springs_in_plane(E, at->x, p, r, &plane);
    return plane;
}
