#include "solve/incremental_potential.h"

#include <math.h>
#include <stdlib.h>

#include "model/inertia_energy.h"

const TermKind *incremental_potential_kind(const IncrementalPotential *E, int t)
{
    const TermKind *kind = E->system->term[t].kind;
    return E->averaged && kind->value ? kind->averaged : kind;
}

static Place place_of(const IncrementalPotential *E, const double *u,
                      const double *x)
{
    return (Place){E->system, E->x_n, u, x};
}

double incremental_potential_value(const IncrementalPotential *E,
                                   const double *u, const double *x)
{
    const System *system = E->system;
    Place at = place_of(E, u, x);
    double sum = 0;
    for (int t = 0; t < system->terms; t++)
        if (system->term[t].kind->value)
            sum +=
                incremental_potential_kind(E, t)->value(&system->term[t], &at);
    return inertia_energy_value(system->nodes, u, E->u_tilde, system->m) +
           E->weight * sum;
}

/* Terms as they are, not averaged: an averaged energy is 0 for u = 0. */
double incremental_potential_scale(const IncrementalPotential *E,
                                   const double *u, const double *x)
{
    const System *system = E->system;
    Place at = place_of(E, u, x);
    double sum = 0;
    for (int t = 0; t < system->terms; t++)
        if (system->term[t].kind->value)
            sum += fabs(system->term[t].kind->value(&system->term[t], &at));
    return inertia_energy_value(system->nodes, u, E->u_tilde, system->m) +
           E->weight * sum;
}

void incremental_potential_gradient(const IncrementalPotential *E,
                                    const double *u, const double *x, double *g)
{
    const System *system = E->system;
    Place at = place_of(E, u, x);
    for (int i = 0; i < 2 * system->nodes; i++)
        g[i] = 0;
    inertia_energy_gradient(system->nodes, u, E->u_tilde, system->m, g);
    for (int t = 0; t < system->terms; t++)
        if (system->term[t].kind->value)
            incremental_potential_kind(E, t)->gradient(&system->term[t], &at,
                                                       E->weight, g);
    system_clear_pinned(system, g);
}

/* The masses on the diagonal, then the terms one after the other. */
static Status create_triplets(const System *system, Triplets *triplets)
{
    long long count = 2LL * system->nodes;
    for (int t = 0; t < system->terms; t++)
        if (system->term[t].kind->value)
            count += system->term[t].kind->entries(&system->term[t], system);
    Status status = triplets_create(2 * system->nodes, count, triplets);
    if (status)
        return status;
    for (int i = 0; i < system->nodes; i++) {
        int place = system->order ? system->order[i] : i;
        triplets_add(triplets, 2 * place, 2 * place);
        triplets_add(triplets, 2 * place + 1, 2 * place + 1);
    }
    for (int t = 0; t < system->terms; t++)
        if (system->term[t].kind->value)
            system->term[t].kind->pattern(&system->term[t], system, triplets);
    return STATUS_OK;
}

/* Slots of the terms' entries in rows or columns of pinned nodes. */
static Status drop_pinned(const System *system, const Triplets *triplets,
                          const Sparse *A, int *slot)
{
    if (!system->pinned)
        return STATUS_OK;
    bool *pinned = calloc((size_t)system->nodes, sizeof *pinned);
    if (!pinned)
        return STATUS_OUT_OF_MEMORY;
    for (int i = 0; i < system->nodes; i++)
        pinned[system->order ? system->order[i] : i] = system->pinned[i];
    for (int t = 2 * system->nodes; t < triplets->count; t++)
        if (pinned[triplets->row[t] / 2] || pinned[triplets->column[t] / 2])
            slot[t] = A->entries;
    free(pinned);
    return STATUS_OK;
}

Status incremental_potential_pattern(const System *system, Triangle triangle,
                                     Sparse *A, int **slot)
{
    Triplets triplets;
    *A = (Sparse){0};
    *slot = NULL;
    Status status = create_triplets(system, &triplets);
    if (!status) {
        *slot = malloc((size_t)triplets.count * sizeof **slot);
        status = *slot ? sparse_create(&triplets, triangle, A, *slot)
                       : STATUS_OUT_OF_MEMORY;
    }
    if (!status)
        status = drop_pinned(system, &triplets, A, *slot);
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
    sparse_clear(A);
    inertia_energy_hessian(system->nodes, system->m, slot, A->value);
    slot += 2 * system->nodes;
    for (int t = 0; t < system->terms; t++) {
        const Term *term = &system->term[t];
        const TermKind *kind = incremental_potential_kind(E, t);
        if (!kind->value)
            continue;
        projected +=
            kind->hessian(term, &place, E->weight, filter, slot, A->value);
        slot += kind->entries(term, system);
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
    for (int t = 0; t < system->terms; t++)
        if (system->term[t].kind->value)
            incremental_potential_kind(E, t)->product(&system->term[t], &place,
                                                      E->weight, filter, q, y);
    system_clear_pinned(system, y);
}

/* The inertia energy is quadratic; g.p is the slope of all terms. */
Along incremental_potential_along(const Iterate *at, double reach)
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
    for (int t = 0; t < system->terms; t++) {
        const TermKind *kind = incremental_potential_kind(E, t);
        if (kind->along)
            kind->along(&system->term[t], &place, at->p, E->weight, reach,
                        q + 1);
        along.rough += kind->remainder != NULL;
    }
    return along;
}

double along_difference(const void *function, double alpha)
{
    const Along *along = function;
    double sum = quartic_value(&along->smooth, alpha);
    if (along->rough == 0)
        return sum;
    const Iterate *at = along->at;
    Place place = place_of(&at->E, at->u, at->x);
    for (int t = 0; t < at->E.system->terms; t++) {
        const TermKind *kind = incremental_potential_kind(&at->E, t);
        if (kind->remainder)
            sum += kind->remainder(&at->E.system->term[t], &place, at->p,
                                   at->E.weight, alpha);
    }
    return sum;
}

double incremental_potential_reach(const Iterate *at)
{
    Place place = place_of(&at->E, at->u, at->x);
    double reach = 1;
    for (int t = 0; t < at->E.system->terms; t++) {
        const TermKind *kind = incremental_potential_kind(&at->E, t);
        if (kind->reach)
            reach =
                fmin(reach, kind->reach(&at->E.system->term[t], &place, at->p));
    }
    return reach;
}

bool incremental_potential_is_limited(const IncrementalPotential *E)
{
    for (int t = 0; t < E->system->terms; t++)
        if (incremental_potential_kind(E, t)->allowed)
            return true;
    return false;
}

bool incremental_potential_allowed(const IncrementalPotential *E,
                                   const double *u, const double *x)
{
    Place at = place_of(E, u, x);
    for (int t = 0; t < E->system->terms; t++) {
        const TermKind *kind = incremental_potential_kind(E, t);
        if (kind->allowed && !kind->allowed(&E->system->term[t], &at))
            return false;
    }
    return true;
}

bool incremental_potential_is_convex(const Iterate *at, double times,
                                     double *sum)
{
    const System *system = at->E.system;
    Place place = place_of(&at->E, at->u, at->x);
    for (int i = 0; i < system->nodes; i++)
        sum[i] = 0;
    for (int t = 0; t < system->terms; t++) {
        const TermKind *kind = incremental_potential_kind(&at->E, t);
        if (!kind->value)
            continue;
        if (!kind->concave)
            return false;
        kind->concave(&system->term[t], &place, at->E.weight, sum);
    }
    for (int i = 0; i < system->nodes; i++)
        if (!(sum[i] < times * system->m[i]))
            return false;
    return true;
}

bool incremental_potential_solve(Iterate *at, Status *status)
{
    const System *system = at->E.system;
    Place place = place_of(&at->E, at->u, at->x);
    double sum = 0;
    if (system->terms > 1 ||
        (system->terms == 1 &&
         !incremental_potential_kind(&at->E, 0)->closed_form))
        return false;
    for (int i = 0; i < 2 * system->nodes; i++)
        at->p[i] = at->E.u_tilde[i];
    for (int t = 0; t < system->terms; t++) {
        const TermKind *kind = incremental_potential_kind(&at->E, t);
        if (!kind->closed_form)
            return false;
        kind->closed_form(&system->term[t], &place, at->E.weight, at->E.u_tilde,
                          at->p);
    }
    for (int i = 0; i < 2 * system->nodes; i++) {
        if (!system->pinned || !system->pinned[i / 2])
            at->u[i] = at->p[i];
        at->x[i] = at->E.x_n[i] + at->u[i];
        sum += 0 * at->x[i];
    }
    *status = sum == 0 ? STATUS_OK : STATUS_NOT_FINITE;
    return true;
}
