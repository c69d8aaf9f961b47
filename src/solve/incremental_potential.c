#include "solve/incremental_potential.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/inertia_energy.h"

static Place place_of(const IncrementalPotential *E, const double *u,
                      const double *x)
{
    Place at = place_at(E->system, E->x_n, u, x);
    at.w = E->weight;
    at.averaged = E->averaged;
    return at;
}

/* E; or, with the sizes of all terms, as they are: an averaged energy is 0 for
 * u = 0. */
static double sum_of(const IncrementalPotential *E, const double *u,
                     const double *x, bool sizes)
{
    Place at = place_of(E, u, x);
    double P = 0;
    at.averaged = E->averaged && !sizes;
    for (const TermKind *kind; (kind = next_energy(&at));) {
        double value = kind->value(&at);
        P += sizes ? fabs(value) : value;
    }
    return inertia_energy_value(E->system->nodes, u, E->u_tilde, E->system->m) +
           E->weight * P;
}

double incremental_potential_value(const IncrementalPotential *E,
                                   const double *u, const double *x)
{
    return sum_of(E, u, x, false);
}

double incremental_potential_scale(const IncrementalPotential *E,
                                   const double *u, const double *x)
{
    return sum_of(E, u, x, true);
}

void incremental_potential_gradient(const IncrementalPotential *E,
                                    const double *u, const double *x, double *g)
{
    const System *system = E->system;
    Place at = place_of(E, u, x);
    for (int i = 0; i < 2 * system->nodes; i++)
        g[i] = 0;
    inertia_energy_gradient(system->nodes, u, E->u_tilde, system->m, g);
    for (const TermKind *kind; (kind = next_energy(&at));)
        kind->gradient(&at, g);
    system_clear_pinned(system, g);
}

/* The masses on the diagonal, then the terms one after the other. */
static Status create_triplets(const System *system, Triplets *triplets)
{
    Place at = place_at(system, NULL, NULL, NULL);
    long long count = 2LL * system->nodes;
    for (const TermKind *kind; (kind = next_energy(&at));)
        count += kind->entries ? kind->entries(&at) : 0;
    Status status = triplets_create(2 * system->nodes, count, triplets);
    for (int i = 0; i < system->nodes && !status; i++)
        term_add_diagonal(system, i, triplets);
    for (const TermKind *kind; !status && (kind = next_energy(&at));)
        if (kind->pattern)
            kind->pattern(&at, triplets);
    return status;
}

/* Slots of the terms' entries in rows or columns of pinned nodes.  A column
 * begins with its diagonal, which is 1 here, for a while, where it is pinned.
 */
static void drop_pinned(const System *system, const Triplets *triplets,
                        const Sparse *A, int *slot)
{
    int masses = 2 * system->nodes;
    for (int t = 0; system->pinned && t < masses; t++)
        A->value[slot[t]] = system->pinned[t / 2];
    for (int t = masses; system->pinned && t < triplets->count; t++)
        if (A->value[A->start[triplets->row[t]]] != 0 ||
            A->value[A->start[triplets->column[t]]] != 0)
            slot[t] = A->entries;
}

Status incremental_potential_pattern(const System *system, Sparse *A,
                                     int **slot)
{
    Triplets triplets;
    *A = (Sparse){0};
    *slot = NULL;
    Status status = create_triplets(system, &triplets);
    if (!status) {
        *slot = malloc((size_t)triplets.count * sizeof **slot);
        status =
            *slot ? sparse_create(&triplets, A, *slot) : STATUS_OUT_OF_MEMORY;
    }
    if (!status)
        drop_pinned(system, &triplets, A, *slot);
    triplets_free(&triplets);
    return status;
}

int incremental_potential_hessian(const Iterate *at, Filter filter,
                                  const int *slot, Sparse *A)
{
    const IncrementalPotential *E = &at->E;
    const System *system = E->system;
    Place place = place_of(E, at->u, at->x);
    int projected = 0;
    memset(A->value, 0, ((size_t)A->entries + 1) * sizeof *A->value);
    inertia_energy_hessian(system->nodes, system->m, slot, A->value);
    slot += 2 * system->nodes;
    for (const TermKind *kind; (kind = next_energy(&place));) {
        if (!kind->hessian)
            continue;
        projected += kind->hessian(&place, filter, slot, NULL, A->value);
        slot += place.term->kind->entries(&place);
    }
    return projected;
}

void incremental_potential_product(const Iterate *at, Filter filter,
                                   const double *q, double *y)
{
    const IncrementalPotential *E = &at->E;
    const System *system = E->system;
    Place place = place_of(E, at->u, at->x);
    for (int i = 0; i < 2 * system->nodes; i++)
        y[i] = system->m[i / 2] * q[i];
    for (const TermKind *kind; (kind = next_energy(&place));)
        if (kind->hessian)
            kind->hessian(&place, filter, NULL, q, y);
    system_clear_pinned(system, y);
}

/* The inertia energy is quadratic; g.p is the slope of all terms. */
Along incremental_potential_along(const Iterate *at)
{
    const IncrementalPotential *E = &at->E;
    const System *system = E->system;
    Place place = place_of(E, at->u, at->x);
    Along along = {.at = at};
    double *q = along.smooth.q;
    for (int i = 0; i < 2 * system->nodes; i++) {
        q[0] += at->g[i] * at->p[i];
        q[1] += 0.5 * system->m[i / 2] * at->p[i] * at->p[i];
    }
    for (const TermKind *kind; (kind = next_energy(&place));) {
        if (kind->along)
            kind->along(&place, at->p, q + 1);
        along.rough = along.rough || kind->remainder || kind->allowed;
    }
    return along;
}

double along_difference(const void *function, double alpha)
{
    const Along *along = function;
    double sum = quartic_value(&along->smooth, alpha);
    if (!along->rough)
        return sum;
    const Iterate *at = along->at;
    Place place = place_of(&at->E, at->u, at->x);
    for (const TermKind *kind; (kind = next_energy(&place));)
        if (kind->remainder)
            sum += kind->remainder(&place, at->p, alpha);
    return sum;
}

double incremental_potential_reach(const Iterate *at)
{
    Place place = place_of(&at->E, at->u, at->x);
    double reach = 1;
    for (const TermKind *kind; (kind = next_energy(&place));)
        if (kind->reach)
            reach = fmin(reach, kind->reach(&place, at->p));
    return reach;
}

bool incremental_potential_allowed(const IncrementalPotential *E,
                                   const double *u, const double *x)
{
    Place at = place_of(E, u, x);
    for (const TermKind *kind; (kind = next_energy(&at));)
        if (kind->allowed && !kind->allowed(&at))
            return false;
    return true;
}

double incremental_potential_concave(const Iterate *at, double *sum)
{
    const System *system = at->E.system;
    Place place = place_of(&at->E, at->u, at->x);
    double largest = 0;
    for (int i = 0; i < system->nodes; i++)
        sum[i] = 0;
    for (const TermKind *kind; (kind = next_energy(&place));)
        if (kind->concave)
            kind->concave(&place, sum);
    for (int i = 0; i < system->nodes; i++) {
        double c = sum[i] / system->m[i];
        largest = isnan(c) ? INFINITY : fmax(largest, c);
    }
    return largest;
}

void incremental_potential_inertia(const Iterate *at, double *m,
                                   double *u_tilde)
{
    const System *system = at->E.system;
    Place place = place_of(&at->E, at->u, at->x);
    for (int i = 0; i < 2 * system->nodes; i++) {
        m[i] = system->m[i / 2];
        u_tilde[i] = at->E.u_tilde[i];
        at->g[i] = 0;
        at->p[i] = 1;
    }
    for (const TermKind *kind; (kind = next_energy(&place));)
        if (kind->diagonal) {
            kind->gradient(&place, at->g);
            kind->hessian(&place, FILTER_NONE, NULL, at->p, m);
        }
    for (int i = 0; i < 2 * system->nodes; i++)
        if (m[i] != system->m[i / 2]) {
            double away = at->u[i] - u_tilde[i];
            double g = system->m[i / 2] * away + at->g[i];
            u_tilde[i] = at->u[i] - g / m[i];
        }
}

/* From u_tilde each coordinate alone has its Newton step g/H, and H g tells H:
 * it is exact where E is quadratic. */
Status incremental_potential_solve(Iterate *at)
{
    const System *system = at->E.system;
    for (int t = 0; t < system->terms; t++)
        if (system->term[t].kind->value && !system->term[t].kind->diagonal)
            return STATUS_RUNNING;
    for (int i = 0; i < 2 * system->nodes; i++) {
        if (!system->pinned || !system->pinned[i / 2])
            at->u[i] = at->E.u_tilde[i];
        at->x[i] = at->E.x_n[i] + at->u[i];
    }
    incremental_potential_gradient(&at->E, at->u, at->x, at->g);
    incremental_potential_product(at, FILTER_NONE, at->g, at->p);
    for (int i = 0; i < 2 * system->nodes; i++) {
        at->u[i] -= at->g[i] == 0 ? 0 : at->g[i] * (at->g[i] / at->p[i]);
        at->x[i] = at->E.x_n[i] + at->u[i];
    }
    return all_finite(at->x, 2 * (size_t)system->nodes) ? STATUS_OK
                                                        : STATUS_NOT_FINITE;
}
