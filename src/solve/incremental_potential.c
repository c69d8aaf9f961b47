/* incremental_potential.c - E(x) and its derivatives, summed over the terms. */
#include "solve/incremental_potential.h"

#include <math.h>
#include <string.h>

#include "model/inertia_energy.h"

static EvalPoint make_weighted_eval_point(const IncrementalPotential *E,
                                          const double *u, const double *x)
{
    EvalPoint at = make_eval_point(E->system, E->x_n, u, x);
    at.weight = E->weight;
    return at;
}

double incremental_potential_value(const IncrementalPotential *E,
                                   const double *u, const double *x)
{
    EvalPoint at = make_weighted_eval_point(E, u, x);
    double P = 0;
    for (const TermKind *kind; (kind = eval_point_next_term(&at));)
        if (kind->potential)
            P += kind->potential(&at);
    return inertia_energy_value(E->system->nodes, u, E->u_tilde, E->system->m) +
           E->weight * P;
}

void incremental_potential_gradient(const IncrementalPotential *E,
                                    const double *u, const double *x, double *g)
{
    const System *system = E->system;
    EvalPoint at = make_weighted_eval_point(E, u, x);
    for (int i = 0; i < 2 * system->nodes; i++)
        g[i] = 0;
    inertia_energy_gradient(system->nodes, u, E->u_tilde, system->m, g);
    for (const TermKind *kind; (kind = eval_point_next_term(&at));)
        if (kind->gradient)
            kind->gradient(&at, g);
    system_zero_pinned_entries(system, g);
}

/* Adds the triplets of the masses and of all terms. */
static void add_term_triplets(const System *system, Triplets *triplets)
{
    EvalPoint at = make_eval_point(system, NULL, NULL, NULL);
    for (int i = 0; i < system->nodes; i++)
        add_diagonal_triplets(system, i, triplets);
    for (const TermKind *kind; (kind = eval_point_next_term(&at));)
        if (kind->add_triplets)
            kind->add_triplets(&at, triplets);
}

Status incremental_potential_create_hessian(const System *system, Sparse *A)
{
    int masses = 2 * system->nodes;
    Triplets triplets = {.matrix_size = masses};
    *A = (Sparse){0};
    add_term_triplets(system, &triplets);
    Status status = triplets_allocate(&triplets);
    if (!status) {
        add_term_triplets(system, &triplets);
        status = sparse_create(&triplets, A);
    }
    /* Terms' entries in rows or columns of pinned nodes are dropped: their slot
     * becomes the unused last value of A.  In this loop the diagonal entry, the
     * first one of its column, is 1 if the column belongs to a pinned node. */
    for (int t = 0; t < triplets.count && !status; t++)
        if (t < masses)
            A->value[A->slot[t]] = system->is_pinned[t / 2];
        else if (A->value[A->column_start[triplets.row[t]]] != 0 ||
                 A->value[A->column_start[triplets.column[t]]] != 0)
            A->slot[t] = A->entries;
    triplets_free(&triplets);
    return status;
}

/* Adds to `out` the terms' Hessians, values of a matrix, or, if q is given,
 * their products with q, a vector.  Returns how many blocks were projected. */
static int add_term_hessians(const Iterate *iterate, Projection projection,
                             const int *slot, const double *q, double *out)
{
    EvalPoint at =
        make_weighted_eval_point(&iterate->E, iterate->u, iterate->x);
    int projected = 0;
    for (const TermKind *kind; (kind = eval_point_next_term(&at));)
        if (kind->hessian)
            projected += kind->hessian(&at, projection, &slot, q, out);
    return projected;
}

Status incremental_potential_extend_pattern(const Iterate *iterate, bool *grown)
{
    EvalPoint at =
        make_weighted_eval_point(&iterate->E, iterate->u, iterate->x);
    Status status = STATUS_OK;
    *grown = false;
    for (const TermKind *kind; !status && (kind = eval_point_next_term(&at));)
        if (kind->extend_pattern)
            status = kind->extend_pattern(&at, grown);
    return status;
}

int incremental_potential_hessian(const Iterate *at, Projection projection,
                                  Sparse *A)
{
    const System *system = at->E.system;
    memset(A->value, 0, ((size_t)A->entries + 1) * sizeof *A->value);
    inertia_energy_hessian(system->nodes, system->m, A->slot, A->value);
    return add_term_hessians(at, projection, A->slot + 2 * system->nodes, NULL,
                             A->value);
}

int incremental_potential_apply_hessian(const Iterate *at,
                                        Projection projection, const double *q,
                                        double *y)
{
    const System *system = at->E.system;
    for (int i = 0; i < 2 * system->nodes; i++)
        y[i] = system->m[i / 2] * q[i];
    int projected = add_term_hessians(at, projection, NULL, q, y);
    system_zero_pinned_entries(system, y);
    return projected;
}

/* The slope g.p contains all terms; the inertia energy adds only to the
 * coefficient of alpha^2. */
LineEnergy make_line_energy(const Iterate *iterate)
{
    const System *system = iterate->E.system;
    const double *g = iterate->g, *p = iterate->p;
    EvalPoint at =
        make_weighted_eval_point(&iterate->E, iterate->u, iterate->x);
    LineEnergy along = {.iterate = iterate};
    double *q = along.polynomial.q;
    for (int i = 0; i < 2 * system->nodes; i++) {
        q[0] += g[i] * p[i];
        q[1] += 0.5 * system->m[i / 2] * p[i] * p[i];
    }
    for (const TermKind *kind; (kind = eval_point_next_term(&at));) {
        if (kind->line_polynomial)
            kind->line_polynomial(&at, p, q + 1);
        along.has_remainder = along.has_remainder || kind->taylor_remainder;
    }
    return along;
}

double line_energy_difference(const void *function, double alpha)
{
    const LineEnergy *along = function;
    double sum = quartic_value(&along->polynomial, alpha);
    if (!along->has_remainder)
        return sum;
    const Iterate *iterate = along->iterate;
    EvalPoint at =
        make_weighted_eval_point(&iterate->E, iterate->u, iterate->x);
    for (const TermKind *kind; (kind = eval_point_next_term(&at));)
        if (kind->taylor_remainder)
            sum += kind->taylor_remainder(&at, iterate->p, alpha);
    return sum;
}

double incremental_potential_max_alpha(const Iterate *at)
{
    EvalPoint point = make_weighted_eval_point(&at->E, at->u, at->x);
    return fmin(1, system_max_alpha(point, at->p, false));
}

bool incremental_potential_is_feasible(const IncrementalPotential *E,
                                       const double *u, const double *x)
{
    return system_is_feasible(make_weighted_eval_point(E, u, x));
}

void incremental_potential_absorb_pulls(const Iterate *iterate, double *m,
                                        double *u_tilde)
{
    const System *system = iterate->E.system;
    EvalPoint at =
        make_weighted_eval_point(&iterate->E, iterate->u, iterate->x);
    bool pulls = false;
    for (int t = 0; t < system->term_count; t++)
        pulls = pulls || system->term[t].kind->is_diagonal;
    for (int i = 0; i < system->nodes; i++)
        m[2 * i] = m[2 * i + 1] = system->m[i];
    memcpy(u_tilde, iterate->E.u_tilde,
           2 * (size_t)system->nodes * sizeof *u_tilde);
    if (!pulls)
        return;
    for (int i = 0; i < 2 * system->nodes; i++) {
        iterate->g[i] = 0;
        iterate->p[i] = 1;
    }
    for (const TermKind *kind; (kind = eval_point_next_term(&at));) {
        if (!kind->is_diagonal)
            continue;
        kind->gradient(&at, iterate->g);
        kind->hessian(&at, PROJECTION_NONE, NULL, iterate->p, m);
    }
    for (int i = 0; i < 2 * system->nodes; i++)
        if (m[i] != system->m[i / 2]) {
            double away = iterate->u[i] - u_tilde[i];
            double g = system->m[i / 2] * away + iterate->g[i];
            u_tilde[i] = iterate->u[i] - g / m[i];
        }
}

bool incremental_potential_is_diagonal(const IncrementalPotential *E)
{
    const System *system = E->system;
    for (int t = 0; t < system->term_count; t++)
        if (system->term[t].kind->potential &&
            !system->term[t].kind->is_diagonal)
            return false;
    return true;
}
