#include "solve/newton_parts.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* Iterations for which projection on demand clamps after it had to. */
enum { CLAMPS_AFTER_FAILURE = 4 };

/* Shifts that are tried: 1e-15, 1e-13, ... 1e-5 of the largest entry.  A shift
 * changes few directions, so conjugate gradients need few solves to reduce the
 * squared remainder to ALL_DIGITS of the first. */
enum { SHIFT_TRIES = 6, CONJUGATE_MAX_SOLVES = 59 };
static const double ALL_DIGITS = 1e-28;

/* The search for negative curvature ends after so many iterations, or where the
 * squared remainder has this share of the random numbers' it began with. */
enum { CURVATURE_MAX_ITERATIONS = 200 };
static const double NO_CURVATURE = 1e-16;

/* The test of the slides projects, and so it also passes where E bends down.
 * By some masses that is an instability that grows as fast as the step can
 * follow; by more than this many times M the place is far from any minimum of
 * E, and it is not called one. */
static const double MASSES_DOWN = 100;

/* A step's start is judged without a factor where the gradient's bound is at
 * most so many tolerances: that is a square at rest.  So many products with the
 * Hessian are let to decide. */
static const double NEAR_REST = 100;
enum { PRODUCTS_AT_REST = 60 };

/* Saddles that one minimisation leaves, and how far: the first trial moves the
 * node that moves most by this share of a spring. */
enum { MAX_SADDLES = 30 };
static const double FIRST_TRIAL = 0.1;

/* ---- the Hessian and its factor ---- */

void direction_free_matrix(SearchDirection *search)
{
    cholesky_free(search->cholesky);
    search->cholesky = NULL;
    sparse_free(&search->A);
    free(search->slot);
    search->slot = NULL;
}

/* A = the Hessian at x.  Pattern and symbolic analysis: once, and again only
 * when the system's pattern or the kind of factor is another, or x wants more.
 * Filter NONE: for a factor L D L^T, which allows negative eigenvalues;
 * ON_DEMAND: as it is, for one that does not. projected  out, blocks projected
 * Returns OK, TOO_LARGE, OUT_OF_MEMORY. */
static Status assemble(Newton *newton, Filter filter, int *projected)
{
    SearchDirection *search = &newton->search;
    const System *system = newton->system;
    CholeskyKind kind =
        filter == FILTER_NONE ? CHOLESKY_INDEFINITE : CHOLESKY_DEFINITE;
    bool grown;
    Status status = incremental_potential_grow(&newton->at, &grown);
    *projected = 0;
    if (!status && (!search->cholesky || search->kind != kind || grown ||
                    search->pattern != system->pattern)) {
        direction_free_matrix(search);
        search->pattern = system->pattern;
        search->kind = kind;
        status =
            incremental_potential_pattern(system, &search->A, &search->slot);
        if (!status)
            status = cholesky_create(&search->A, kind, &search->cholesky);
    }
    search->filter = filter == FILTER_ON_DEMAND ? FILTER_NONE : filter;
    if (!status)
        *projected = incremental_potential_hessian(&newton->at, search->filter,
                                                   search->slot, &search->A);
    return status;
}

/* The largest entry of the diagonal; its slots come first. */
static double largest_diagonal(const Newton *newton)
{
    const SearchDirection *search = &newton->search;
    double largest = 0;
    for (int t = 0; t < 2 * newton->system->nodes; t++)
        largest = fmax(largest, search->A.value[search->slot[t]]);
    return largest;
}

/* Factors A; with a shift if it must: only a filtered A is known to be
 * semi-definite but for rounding, so only that is shifted.  Returns OK,
 * NOT_POSITIVE_DEFINITE, NOT_FINITE, OUT_OF_MEMORY. */
static Status factor(Newton *newton)
{
    SearchDirection *search = &newton->search;
    search->shift = 0;
    for (int tries = 0;; tries++) {
        newton->counters.factorisations++;
        Status status = cholesky_factor(search->cholesky);
        if (status != STATUS_NOT_POSITIVE_DEFINITE || tries == SHIFT_TRIES ||
            search->filter == FILTER_NONE)
            return status;
        double shift =
            tries > 0 ? 100 * search->shift : 1e-15 * largest_diagonal(newton);
        for (int t = 0; t < 2 * newton->system->nodes; t++)
            search->A.value[search->slot[t]] += shift - search->shift;
        search->shift = shift;
    }
}

/* Assembles and factors the Hessian at x as the filter says.  Projection on
 * demand first tries it as it is; after a failure it clamps, and goes on to do
 * so for some iterations. */
static Status newton_factor(Newton *newton)
{
    NewtonRecord *record = &newton->record;
    Filter filter = newton->settings.filter;
    if (filter == FILTER_ON_DEMAND && newton->clamps > 0) {
        newton->clamps--;
        filter = FILTER_CLAMP;
    }
    Status status = assemble(newton, filter, &record->projected);
    if (!status)
        status = factor(newton);
    record->factorised = true;
    record->shift = newton->search.shift;
    newton->counters.projected += record->projected;
    if (filter != FILTER_ON_DEMAND || status != STATUS_NOT_POSITIVE_DEFINITE)
        return status;
    newton->clamps = CLAMPS_AFTER_FAILURE;
    return newton_factor(newton);
}

/* z = (H + shift I)^-1 r, both in the order of the nodes.
 * Returns OK, NOT_FINITE, SINGULAR. */
static Status apply_factor(Newton *newton, const double *r, double *z)
{
    const int *order = newton->system->order;
    double *b = newton->search.b;
    for (int i = 0; i < newton->system->nodes; i++) {
        int place = order[i];
        b[2 * place] = r[2 * i];
        b[2 * place + 1] = r[2 * i + 1];
    }
    Status status = cholesky_solve(newton->search.cholesky, b, b);
    for (int i = 0; i < newton->system->nodes && !status; i++) {
        int place = order[i];
        z[2 * i] = b[2 * place];
        z[2 * i + 1] = b[2 * place + 1];
    }
    return status;
}

/* ---- conjugate gradients ---- */

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
 * r.  H is applied term by term: that keeps small masses which the assembled
 * matrix has lost to rounding. */
typedef struct ConjugateGradients {
    Filter filter;
    double enough;    /* part of the first r.z at which they end */
    double rz, first; /* r.z, squared size of the residual, and the first */
    double curvature; /* d.H d of the last direction */
} ConjugateGradients;

/* One step along the next direction, z being known.  Returns false where there
 * is nothing left to gain, or E bends down along d. */
static bool conjugate_step(Newton *newton, ConjugateGradients *state)
{
    const SearchDirection *search = &newton->search;
    int n = 2 * newton->system->nodes;
    double *r = search->r, *z = search->z, *q = search->q, *d = search->d;
    double *p = newton->at.p;
    double last = state->rz;
    state->rz = dot(n, r, z);
    state->curvature = 0;
    if (last == 0)
        state->first = state->rz;
    if (!(state->rz > state->enough * state->first))
        return false;
    for (int i = 0; i < n; i++)
        d[i] = z[i] + (last == 0 ? 0 : state->rz / last * d[i]);
    incremental_potential_product(&newton->at, state->filter, d, q);
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

/* p = -H^-1 g (slide: search_dir) with the last factor.  Where that has a
 * shift, conjugate gradients improve p.  Returns OK, NOT_FINITE, SINGULAR. */
static Status newton_solve(Newton *newton)
{
    const Iterate *at = &newton->at;
    const SearchDirection *search = &newton->search;
    int n = 2 * newton->system->nodes;
    newton->counters.solves++;
    Status status = apply_factor(newton, at->g, at->p);
    for (int i = 0; i < n; i++)
        at->p[i] = -at->p[i];
    if (status || search->shift == 0)
        return status;
    ConjugateGradients state = {search->filter, .enough = ALL_DIGITS};
    for (int i = 0; i < n; i++) {
        search->z[i] = at->p[i]; /* factor^-1 (-g) already */
        at->p[i] = search->d[i] = 0;
        search->r[i] = -at->g[i];
    }
    for (int solves = 0; !status && conjugate_step(newton, &state) &&
                         solves < CONJUGATE_MAX_SOLVES;
         solves++)
        status = apply_factor(newton, search->r, search->z);
    return status;
}

/* How well p solves H p = -g, H applied term by term.
 *   error  out, kg^(1/2) m, a bound of |p - exact|_M: |g + H p|_(M^-1) where
 *          H - M is positive semi-definite; else twice what the factor says is
 *          lacking
 * Returns as newton_solve. */
static Status judge(Newton *newton, double *error)
{
    const SearchDirection *search = &newton->search;
    const System *system = newton->system;
    const Iterate *at = &newton->at;
    double *r = search->r, *z = search->z, square = 0;
    incremental_potential_product(at, search->filter, at->p, search->q);
    for (int i = 0; i < 2 * system->nodes; i++)
        r[i] = -at->g[i] - search->q[i];
    *error = system_inverse_mass_norm(system, r);
    if (search->filter != FILTER_NONE)
        return STATUS_OK;
    Status status = apply_factor(newton, r, z);
    for (int i = 0; i < 2 * system->nodes; i++)
        square += system->m[i / 2] * z[i] * z[i];
    *error = 2 * sqrt(square);
    return status;
}

/* ---- the test of Algorithm 3 ---- */

/* max over nodes of |p_x| + |p_y|, over h; NaN where p has one. */
static double newton_residual(const Newton *newton)
{
    const double *p = newton->at.p;
    double largest = 0;
    for (int i = 0; i < 2 * newton->system->nodes; i += 2) {
        double sum = fabs(p[i]) + fabs(p[i + 1]);
        if (!(sum <= largest))
            largest = sum;
    }
    return largest / newton->settings.h;
}

/* m/s, the largest residual of a direction with |p|_M = 1: each node has
 * m |p_i|^2 <= |p|_M^2, and |p_x| + |p_y| <= sqrt(2) |p_i|. */
static double residual_per_norm(const Newton *newton)
{
    return sqrt(2 / newton->rounding.lightest) / newton->settings.h;
}

/* The test of Algorithm 3 for a direction that is at most error away, in the
 * norm of the masses, from what it should be. */
static Status newton_test(const Newton *newton, double error)
{
    double residual = newton->residual + residual_per_norm(newton) * error;
    return residual <= newton->tolerance ? STATUS_OK : STATUS_RUNNING;
}

/* The test by conjugate gradients, with the masses as their preconditioner:
 * r.z is then the square of what p can lack (judge), and they end where that
 * decides the test.  Returns OK (it is passed), RUNNING (or not known). */
static Status test_at_rest(Newton *newton)
{
    const SearchDirection *search = &newton->search;
    int n = 2 * newton->system->nodes;
    double error = 0, away = 0;
    ConjugateGradients state = {newton->settings.filter, .enough = 0};
    newton->search.filter = state.filter; /* the judge's, too */
    for (int i = 0; i < n; i++) {
        search->r[i] = -newton->at.g[i];
        newton->at.p[i] = search->d[i] = 0;
    }
    for (int k = 0; k < PRODUCTS_AT_REST && away <= error; k++) {
        for (int i = 0; i < n; i++)
            search->z[i] = search->r[i] / newton->system->m[i / 2];
        if (!conjugate_step(newton, &state))
            break;
        newton->residual = newton_residual(newton);
        away = fabs(newton->residual - newton->tolerance);
        error = residual_per_norm(newton) *
                system_inverse_mass_norm(newton->system, search->r);
    }
    newton->kind = RESIDUAL_ESTIMATE;
    Status status = judge(newton, &error);
    return status ? status : newton_test(newton, error);
}

/* The gradient at x; no factor there is known yet. */
static void take_gradient(Newton *newton)
{
    const Iterate *at = &newton->at;
    incremental_potential_gradient(&at->E, at->u, at->x, at->g);
    newton->record.factorised = false;
    newton->record.projected = 0;
    newton->record.shift = 0;
}

/* Gradient and direction at x, and the test of Algorithm 3.
 * Returns OK (converged), RUNNING, or a failure. */
static Status direction_at(Newton *newton)
{
    take_gradient(newton);
    /* The projected Hessian is M plus something positive semi-definite, so
     * |p|_M <= |g|_(M^-1).  Where this bound passes the test, p itself would:
     * no factorisation is needed.  (On demand, where the Hessian as it is may
     * be less than M, the test is that of the projected one here.) */
    if (newton->settings.filter != FILTER_NONE) {
        newton->kind = RESIDUAL_BOUND;
        newton->residual =
            residual_per_norm(newton) *
            system_inverse_mass_norm(newton->system, newton->at.g);
        if (newton_test(newton, 0) == STATUS_OK)
            return STATUS_OK;
    }
    if (newton->record.iteration < 0 && !newton->rounding.blurred &&
        filter_projects(newton->settings.filter) &&
        newton->residual <= NEAR_REST * newton->tolerance &&
        test_at_rest(newton) == STATUS_OK)
        return STATUS_OK;
    Status status = newton_factor(newton);
    if (!status)
        status = newton_solve(newton);
    if (status)
        return status;
    newton->residual = newton_residual(newton);
    if (!isfinite(newton->residual))
        return STATUS_NOT_FINITE;
    /* Where springs outweigh the masses so much that a factor is not exact, the
     * test is passed only by a direction that is known well enough: with the
     * bound of what H p = -g lacks.  (What rounding has done to g itself is not
     * in this: no direction knows it.) */
    bool exact = !newton->rounding.blurred && newton->search.shift == 0;
    double error = 0;
    newton->kind = exact ? RESIDUAL_VALUE : RESIDUAL_ESTIMATE;
    if (!exact && newton_test(newton, 0) == STATUS_OK)
        status = judge(newton, &error);
    return status ? status : newton_test(newton, error);
}

/* ---- ends that are no minima ---- */

Status direction_bends_up(Newton *newton, double times)
{
    const SearchDirection *search = &newton->search;
    int projected;
    bool seen =
        newton->record.factorised && /* it has a factor as it is */
        (search->filter == FILTER_NONE || newton->record.projected == 0);
    if (newton->settings.filter == FILTER_NONE || seen ||
        incremental_potential_concave(&newton->at, newton->x_trial) < times)
        return STATUS_OK;
    Status status = assemble(newton, FILTER_ON_DEMAND, &projected);
    if (status)
        return status;
    double rounding = 1e-13 * largest_diagonal(newton);
    for (int t = 0; t < 2 * newton->system->nodes; t++)
        search->A.value[search->slot[t]] +=
            (times - 1) * newton->system->m[t / 2] + rounding;
    status = factor(newton);
    return status == STATUS_NOT_POSITIVE_DEFINITE ? STATUS_NOT_A_MINIMUM
                                                  : status;
}

Status direction_judges_end(Newton *newton)
{
    /* Of a large square the factor that tells takes longer than multigrid's
     * whole step: it has to be asked for. */
    if (newton->working == SOLVER_MULTIGRID && !newton->settings.minimum &&
        newton->system->segments > AUTO_NEWTON_SEGMENTS)
        return STATUS_OK;
    return direction_bends_up(newton,
                              newton->settings.minimum ? 1 : 1 + MASSES_DOWN);
}

/* The gradient is known: p along negative curvature of the Hessian as it is, if
 * that is found; else as anywhere.  It is looked for by conjugate gradients
 * from random numbers of -1 ... 1, the same ones always, preconditioned with
 * the factor.  Returns RUNNING or a failure. */
static Status leave_saddle(Newton *newton)
{
    const System *system = newton->system;
    const SearchDirection *search = &newton->search;
    const int n = 2 * system->nodes;
    double *p = newton->at.p, *d = search->d, largest = 0, l2 = INFINITY;
    ConjugateGradients state = {FILTER_NONE, .enough = NO_CURVATURE};
    Status status = newton_factor(newton);
    uint64_t random = 1;
    for (int i = 0; i < n; i++) {
        random = random * 6364136223846793005u + 1442695040888963407u;
        search->r[i] = (double)(int64_t)random / 9223372036854775808.0;
    }
    system_clear_pinned(system, search->r);
    int most = newton->saddles < MAX_SADDLES ? CURVATURE_MAX_ITERATIONS : 0;
    for (int k = 0; k < most && !status; k++) {
        status = apply_factor(newton, search->r, search->z);
        if (!status && !conjugate_step(newton, &state))
            break;
    }
    bool found = state.curvature < 0;
    if (!status && !found)
        status = newton_solve(newton);
    if (status || !found)
        return status ? status : STATUS_RUNNING;
    for (int i = 0; i < n; i++)
        largest = fmax(largest, fabs(d[i]));
    for (int s = 0; s < system->springs; s++)
        l2 = fmin(l2, system->l2[s]);
    double scale = FIRST_TRIAL * (system->springs ? sqrt(l2) : 1) / largest;
    if (dot(n, d, newton->at.g) > 0) /* p goes downhill */
        scale = -scale;
    for (int i = 0; i < n; i++)
        p[i] = scale * d[i];
    newton->saddles++;
    newton->counters.saddles++;
    return STATUS_RUNNING;
}

/* ---- what the loop calls ---- */

Status direction_next(Newton *newton)
{
    Status status = direction_at(newton);
    if (status == STATUS_OK)
        status = direction_judges_end(newton);
    newton->bends_down = status == STATUS_NOT_A_MINIMUM;
    return newton->bends_down ? leave_saddle(newton) : status;
}

Status direction_from_saddle(Newton *newton)
{
    take_gradient(newton);
    newton->bends_down = true;
    return leave_saddle(newton);
}

Status direction_first(Newton *newton)
{
    /* g is 0 but for rounding, compared with the force of a spring that is
     * compressed to nothing. */
    double most = 1e-12 * newton->at.E.weight * newton->rounding.force;
    Status status = direction_next(newton);
    for (int i = 0; i < 2 * newton->system->nodes && !status; i++)
        if (!(fabs(newton->at.g[i]) <= most))
            return STATUS_OK;
    /* Where the gradient vanishes, any curvature downwards tells. */
    return status ? status : direction_bends_up(newton, 1);
}
