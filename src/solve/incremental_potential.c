#include "solve/incremental_potential.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/inertia_energy.h"

/* Where P is asked: at x; or, averaged, between x_n and x. */
typedef struct Point {
    Place at;
    double t; /* at x_n + t u */
} Point;

static Point end_of(const IncrementalPotential *E, const double *u,
                    const double *x)
{
    Point end = {place_at(E->system, E->x_n, u, x), 1};
    end.at.w = E->weight;
    return end;
}

/* The average vector field (Rojas, Liu, Kavan: Average Vector Field Integration
 * for St. Venant-Kirchhoff Deformable Models, 2018) minimises with Phi in the
 * place of P, whose gradient is the force averaged along the way:
 *   Phi(u)      = integral of (P(x_n + t u) - P(x_n)) / t, t = 0 ... 1
 *   grad Phi(u) = integral of grad P(x_n + t u)
 *   Hess Phi(u) = integral of t Hess P(x_n + t u)
 * Springs make these cubic in t: two points of Gauss's rule are exact.
 *   k  0, 1, ...: which point
 * Returns false where there are no more. */
static bool next_point(const IncrementalPotential *E, const double *u,
                       const double *x, int k, Point *point)
{
    static const double gauss[2] = {0.21132486540518712, 0.78867513459481288};
    *point = end_of(E, u, x);
    if (!E->between)
        return k == 0;
    if (k == 2)
        return false;
    double *there = E->between + 2 * k * E->system->nodes;
    point->t = gauss[k];
    point->at.w *= 0.5;
    for (int i = 0; i < 2 * E->system->nodes; i++)
        there[i] = E->x_n[i] + point->t * u[i];
    point->at.x = there;
    return true;
}

/* E; or its size: inertia and w |P|, for Phi is 0 for u = 0, P is not. */
static double value(const IncrementalPotential *E, const double *u,
                    const double *x, bool size)
{
    Point point;
    double P = 0;
    for (int k = 0; next_point(E, u, x, k, &point); k++)
        for (const TermKind *kind; (kind = next_energy(&point.at));) {
            double value = kind->value(&point.at);
            Place start = point.at;
            start.x = E->x_n;
            if (E->between)
                value = 0.5 * (value - kind->value(&start)) / point.t;
            P += size ? fabs(value) : value;
        }
    return inertia_energy_value(E->system->nodes, u, E->u_tilde, E->system->m) +
           E->weight * P;
}

double incremental_potential_value(const IncrementalPotential *E,
                                   const double *u, const double *x)
{
    return value(E, u, x, false);
}

double incremental_potential_scale(const IncrementalPotential *E,
                                   const double *u, const double *x)
{
    IncrementalPotential at_end = *E;
    at_end.between = NULL;
    return value(&at_end, u, x, true);
}

void incremental_potential_gradient(const IncrementalPotential *E,
                                    const double *u, const double *x, double *g)
{
    const System *system = E->system;
    Point point;
    for (int i = 0; i < 2 * system->nodes; i++)
        g[i] = 0;
    inertia_energy_gradient(system->nodes, u, E->u_tilde, system->m, g);
    for (int k = 0; next_point(E, u, x, k, &point); k++)
        for (const TermKind *kind; (kind = next_energy(&point.at));)
            kind->gradient(&point.at, g);
    system_clear_pinned(system, g);
}

/* The masses on the diagonal, then the terms one after the other. */
Status incremental_potential_pattern(const System *system, Sparse *A,
                                     int **slot)
{
    Place at = place_at(system, NULL, NULL, NULL);
    Triplets triplets;
    int masses = 2 * system->nodes;
    long long count = masses;
    *A = (Sparse){0};
    *slot = NULL;
    for (const TermKind *kind; (kind = next_energy(&at));)
        count += kind->entries ? kind->entries(&at) : 0;
    Status status = triplets_create(masses, count, &triplets);
    for (int i = 0; i < system->nodes && !status; i++)
        term_add_diagonal(system, i, &triplets);
    for (const TermKind *kind; !status && (kind = next_energy(&at));)
        if (kind->pattern)
            kind->pattern(&at, &triplets);
    if (!status) {
        *slot = malloc((size_t)triplets.count * sizeof **slot);
        status =
            *slot ? sparse_create(&triplets, A, *slot) : STATUS_OUT_OF_MEMORY;
    }
    /* The terms' entries in rows or columns of pinned nodes are dropped.  A
     * column begins with its diagonal, which is 1 here where it is pinned. */
    for (int t = 0; t < triplets.count && !status; t++)
        if (t < masses)
            A->value[(*slot)[t]] = system->pinned[t / 2];
        else if (A->value[A->start[triplets.row[t]]] != 0 ||
                 A->value[A->start[triplets.column[t]]] != 0)
            (*slot)[t] = A->entries;
    triplets_free(&triplets);
    return status;
}

/* Adds all terms' Hessians to a matrix through its slots or, where q is given,
 * their products with it.  Returns how many blocks were projected. */
static int add_hessians(const Iterate *at, Filter filter, const int *slot,
                        const double *q, double *out)
{
    Point first, second;
    int projected = 0;
    next_point(&at->E, at->u, at->x, 0, &first);
    first.at.w *= first.t;
    if (next_point(&at->E, at->u, at->x, 1, &second)) {
        first.at.x_too = second.at.x;
        first.at.w_too = second.at.w * second.t;
    }
    for (const TermKind *kind; (kind = next_energy(&first.at));) {
        if (!kind->hessian)
            continue;
        projected += kind->hessian(&first.at, filter, slot, q, out);
        if (!q)
            slot += kind->entries(&first.at);
    }
    return projected;
}

Status incremental_potential_grow(const Iterate *at, bool *grown)
{
    Point end = end_of(&at->E, at->u, at->x);
    Status status = STATUS_OK;
    *grown = false;
    for (const TermKind *kind; !status && (kind = next_energy(&end.at));)
        if (kind->grow)
            status = kind->grow(&end.at, grown);
    return status;
}

int incremental_potential_hessian(const Iterate *at, Filter filter,
                                  const int *slot, Sparse *A)
{
    const System *system = at->E.system;
    memset(A->value, 0, ((size_t)A->entries + 1) * sizeof *A->value);
    inertia_energy_hessian(system->nodes, system->m, slot, A->value);
    return add_hessians(at, filter, slot + 2 * system->nodes, NULL, A->value);
}

void incremental_potential_product(const Iterate *at, Filter filter,
                                   const double *q, double *y)
{
    const System *system = at->E.system;
    for (int i = 0; i < 2 * system->nodes; i++)
        y[i] = system->m[i / 2] * q[i];
    add_hessians(at, filter, NULL, q, y);
    system_clear_pinned(system, y);
}

/* The inertia energy is quadratic; g.p is the slope of all terms. */
Along incremental_potential_along(const Iterate *at)
{
    const IncrementalPotential *E = &at->E;
    const System *system = E->system;
    Point point;
    Along along = {.at = at};
    double *q = along.smooth.q;
    for (int i = 0; i < 2 * system->nodes; i++) {
        q[0] += at->g[i] * at->p[i];
        q[1] += 0.5 * system->m[i / 2] * at->p[i] * at->p[i];
    }
    for (int k = 0; next_point(E, at->u, at->x, k, &point); k++) {
        double part[3] = {0}, t = point.t;
        for (const TermKind *kind; (kind = next_energy(&point.at));) {
            if (kind->along)
                kind->along(&point.at, at->p, E->between ? part : q + 1);
            along.rough = along.rough || kind->remainder || kind->allowed;
        }
        for (int i = 0; i < 3; i++, t *= point.t) /* 1/t at x_n + t u + t p */
            q[1 + i] += t * part[i];
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
    Place place = end_of(&at->E, at->u, at->x).at;
    for (const TermKind *kind; (kind = next_energy(&place));)
        if (kind->remainder)
            sum += kind->remainder(&place, at->p, alpha);
    return sum;
}

double incremental_potential_reach(const Iterate *at)
{
    return fmin(1, system_reach(end_of(&at->E, at->u, at->x).at, at->p, false));
}

bool incremental_potential_allowed(const IncrementalPotential *E,
                                   const double *u, const double *x)
{
    Place at = end_of(E, u, x).at;
    for (const TermKind *kind; (kind = next_energy(&at));)
        if (kind->allowed && !kind->allowed(&at))
            return false;
    return true;
}

double incremental_potential_concave(const Iterate *at, double *sum)
{
    const System *system = at->E.system;
    Point point;
    double largest = 0;
    for (int i = 0; i < system->nodes; i++)
        sum[i] = 0;
    for (int k = 0; next_point(&at->E, at->u, at->x, k, &point); k++) {
        point.at.w *= point.t;
        for (const TermKind *kind; (kind = next_energy(&point.at));)
            if (kind->concave)
                kind->concave(&point.at, sum);
    }
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
    Place place = end_of(&at->E, at->u, at->x).at;
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
        if (!system->pinned[i / 2])
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
