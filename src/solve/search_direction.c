#include "solve/search_direction.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* The search for negative curvature ends after so many iterations, or where the
 * squared remainder has this share of the random numbers' it began with. */
enum { CURVATURE_MAX_ITERATIONS = 200 };
static const double NO_CURVATURE = 1e-16;

/* Conjugate gradients reduce the squared remainder to this part of the first.
 */
static const double ALL_DIGITS = 1e-28;

/* Shifts that are tried: 1e-15, 1e-13, ... 1e-5 of the largest entry. */
enum { SHIFT_TRIES = 6 };

/* A shift changes few directions, so conjugate gradients need few solves. */
enum { CONJUGATE_MAX_SOLVES = 59 };

Status search_direction_create(const System *system, SearchDirection *search)
{
    size_t size = 2 * (size_t)system->nodes;
    *search = (SearchDirection){.system = system};
    search->b = calloc(5 * size, sizeof *search->b);
    if (!search->b)
        return STATUS_OUT_OF_MEMORY;
    search->r = search->b + size;
    search->z = search->r + size;
    search->q = search->z + size;
    search->d = search->q + size;
    return STATUS_OK;
}

static void free_matrix(SearchDirection *search)
{
    cholesky_free(search->cholesky);
    search->cholesky = NULL;
    sparse_free(&search->A);
    free(search->slot);
    search->slot = NULL;
}

void search_direction_free(SearchDirection *search)
{
    if (!search)
        return;
    free_matrix(search);
    free(search->b);
    *search = (SearchDirection){0};
}

/* Pattern and symbolic analysis: once, and again only when the system's
 * pattern or the kind of factor is another. */
static Status analyse(SearchDirection *search)
{
    free_matrix(search);
    search->pattern = search->system->pattern;
    Status status = incremental_potential_pattern(search->system, &search->A,
                                                  &search->slot);
    return status ? status
                  : cholesky_create(&search->A, search->kind,
                                    search->system->order != NULL,
                                    &search->cholesky);
}

Status search_direction_assemble(SearchDirection *search, const Iterate *at,
                                 Filter filter, int *projected)
{
    CholeskyKind kind =
        filter == FILTER_NONE ? CHOLESKY_INDEFINITE : CHOLESKY_DEFINITE;
    bool known = search->cholesky && search->kind == kind &&
                 search->pattern == search->system->pattern;
    search->kind = kind;
    search->filter = filter == FILTER_ON_DEMAND ? FILTER_NONE : filter;
    Status status = known ? STATUS_OK : analyse(search);
    *projected = status ? 0
                        : incremental_potential_hessian(
                              at, search->filter, search->slot, &search->A);
    return status;
}

/* The largest entry of the diagonal; its slots come first. */
static double largest_diagonal(const SearchDirection *search)
{
    double largest = 0;
    for (int t = 0; t < 2 * search->system->nodes; t++)
        largest = fmax(largest, search->A.value[search->slot[t]]);
    return largest;
}

void search_direction_add_masses(SearchDirection *search, double times)
{
    double rounding = 1e-13 * largest_diagonal(search);
    for (int t = 0; t < 2 * search->system->nodes; t++)
        search->A.value[search->slot[t]] +=
            times * search->system->m[t / 2] + rounding;
}

Status search_direction_factor(SearchDirection *search, int *tries)
{
    search->shift = 0;
    *tries = 1;
    Status status = cholesky_factor(search->cholesky);
    if (status != STATUS_NOT_POSITIVE_DEFINITE || search->filter == FILTER_NONE)
        return status;
    double shift = 1e-15 * largest_diagonal(search);
    for (int i = 0; i < SHIFT_TRIES && status == STATUS_NOT_POSITIVE_DEFINITE;
         i++, shift *= 100) {
        for (int t = 0; t < 2 * search->system->nodes; t++)
            search->A.value[search->slot[t]] += shift - search->shift;
        search->shift = shift;
        ++*tries;
        status = cholesky_factor(search->cholesky);
    }
    return status;
}

/* z = (H + shift I)^-1 r, both in the order of the nodes. */
static Status apply_factor(SearchDirection *search, const double *r, double *z)
{
    const int *order = search->system->order;
    double *b = search->b;
    for (int i = 0; i < search->system->nodes; i++) {
        int place = order ? order[i] : i;
        b[2 * place] = r[2 * i];
        b[2 * place + 1] = r[2 * i + 1];
    }
    Status status = cholesky_solve(search->cholesky, b, b);
    if (status)
        return status;
    for (int i = 0; i < search->system->nodes; i++) {
        int place = order ? order[i] : i;
        z[2 * i] = b[2 * place];
        z[2 * i + 1] = b[2 * place + 1];
    }
    return STATUS_OK;
}

/* a . b */
static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* The state of conjugate gradients for H p = -g, preconditioned with a factor
 * (Golub, Van Loan: 11.5): directions d, residual r = -g - H p, z = factor^-1
 * r. H is applied spring by spring: that keeps small masses which the assembled
 * matrix has lost to rounding. */
typedef struct ConjugateGradients {
    const Iterate *at;
    Filter filter;
    double enough;    /* part of the first r.z at which they end */
    double rz, first; /* r.z, squared size of the residual, and the first */
    double curvature; /* d.H d of the last direction */
} ConjugateGradients;

/* One step along the next direction, z being known.  Returns false where there
 * is nothing left to gain, or E bends down along d. */
static bool conjugate_step(SearchDirection *search, ConjugateGradients *state)
{
    int n = 2 * search->system->nodes;
    double *r = search->r, *z = search->z, *q = search->q, *d = search->d;
    double *p = state->at->p;
    double last = state->rz;
    state->rz = dot(n, r, z);
    state->curvature = 0;
    if (last == 0)
        state->first = state->rz;
    if (!(state->rz > state->enough * state->first))
        return false;
    for (int i = 0; i < n; i++)
        d[i] = z[i] + (last == 0 ? 0 : state->rz / last * d[i]);
    incremental_potential_product(state->at, state->filter, d, q);
    state->curvature = dot(n, d, q);
    double alpha = state->rz / state->curvature;
    if (!(state->curvature > 0) || !(alpha > 0) || !isfinite(alpha))
        return false; /* E bends down, or rounding hides how it bends */
    for (int i = 0; i < n; i++) {
        p[i] += alpha * d[i];
        r[i] -= alpha * q[i];
    }
    return true;
}

/* r = -g - H p */
Status search_direction_judge(SearchDirection *search, const Iterate *at,
                              double *error)
{
    const System *system = search->system;
    double *r = search->r, *z = search->z;
    incremental_potential_product(at, search->filter, at->p, search->q);
    for (int i = 0; i < 2 * system->nodes; i++)
        r[i] = -at->g[i] - search->q[i];
    *error = system_inverse_mass_norm(system, r);
    if (search->filter != FILTER_NONE)
        return STATUS_OK;
    /* H - M may be indefinite: twice what the factor says is lacking. */
    Status status = apply_factor(search, r, z);
    double square = 0;
    for (int i = 0; i < 2 * system->nodes; i++)
        square += system->m[i / 2] * z[i] * z[i];
    *error = 2 * sqrt(square);
    return status;
}

/* p holds what the shifted factor makes of g: conjugate gradients improve it.
 */
static Status refine(SearchDirection *search, const Iterate *at)
{
    ConjugateGradients state = {at, search->filter, .enough = ALL_DIGITS};
    Status status = STATUS_OK;
    for (int i = 0; i < 2 * search->system->nodes; i++) {
        search->z[i] = at->p[i]; /* factor^-1 (-g) already */
        at->p[i] = search->d[i] = 0;
        search->r[i] = -at->g[i];
    }
    for (int solves = 0; !status && conjugate_step(search, &state) &&
                         solves < CONJUGATE_MAX_SOLVES;
         solves++)
        status = apply_factor(search, search->r, search->z);
    return status;
}

Status search_direction_solve(SearchDirection *search, const Iterate *at)
{
    Status status = apply_factor(search, at->g, at->p);
    for (int i = 0; i < 2 * search->system->nodes; i++)
        at->p[i] = -at->p[i];
    return status || search->shift == 0 ? status : refine(search, at);
}

/* Random numbers of -1 ... 1, the same ones always; 0 for pinned nodes. */
static void random_numbers(const System *system, double *r)
{
    uint64_t state = 1;
    for (int i = 0; i < 2 * system->nodes; i++) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        r[i] = (double)(int64_t)state / 9223372036854775808.0;
    }
    system_clear_pinned(system, r);
}

Status search_direction_bends_down(SearchDirection *search, const Iterate *at,
                                   bool *found)
{
    int n = 2 * search->system->nodes;
    ConjugateGradients state = {at, FILTER_NONE, .enough = NO_CURVATURE};
    Status status = STATUS_OK;
    random_numbers(search->system, search->r);
    for (int k = 0; k < CURVATURE_MAX_ITERATIONS && !status; k++) {
        status = apply_factor(search, search->r, search->z);
        if (!status && !conjugate_step(search, &state))
            break;
    }
    *found = !status && state.curvature < 0;
    double sign = dot(n, search->d, at->g) > 0 ? -1 : 1;
    for (int i = 0; i < n && *found; i++)
        at->p[i] = sign * search->d[i];
    return status;
}
