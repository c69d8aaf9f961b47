#include "newton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "plane_search.h"

/* Matrices of at most this many rows are factored column by column: below it
 * dense blocks are too small to pay (measured at 4 ... 64 segments). */
enum { SIMPLICIAL_MAX_ROWS = 700 };

/* After this many iterations without a smaller residual, rounding may be all
 * that is left. */
enum { STAGNANT_ITERATIONS = 20 };

/* Updates for which the lagged solver keeps a factor: more iterations against
 * fewer factorisations; 16 ... 64 measured about the same. */
enum { MAX_FACTOR_AGE = 16 };

/* Wall-clock time, s; only differences mean something. */
static double clock_seconds(void)
{
    struct timespec now;
    timespec_get(&now, TIME_UTC);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

Status newton_create(const System *system, const NewtonSettings *settings,
                     Newton *newton)
{
    *newton = (Newton){.settings = *settings, .system = system, .age = -1};
    size_t size = 2 * (size_t)system->nodes;
    double **vectors[] = {&newton->u, &newton->x, &newton->u_tilde, &newton->g,
                          &newton->p, &newton->r, &newton->b};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        *vectors[i] = calloc(size, sizeof(double));
        if (!*vectors[i])
            return STATUS_OUT_OF_MEMORY;
    }
    return STATUS_OK;
}

/* The matrix, its slots and its factor. */
static void newton_free_matrix(Newton *newton)
{
    cholesky_free(newton->cholesky);
    newton->cholesky = NULL;
    sparse_free(&newton->A);
    free(newton->slot);
    newton->slot = NULL;
}

void newton_free(Newton *newton)
{
    if (!newton)
        return;
    newton_free_matrix(newton);
    free(newton->u);
    free(newton->x);
    free(newton->u_tilde);
    free(newton->g);
    free(newton->p);
    free(newton->r);
    free(newton->b);
    *newton = (Newton){0};
}

/* What kind of factor the matrix needs. */
static CholeskyKind factor_kind(const Newton *newton)
{
    if (newton->settings.filter == FILTER_NONE)
        return CHOLESKY_INDEFINITE;
    return 2 * newton->system->nodes <= SIMPLICIAL_MAX_ROWS
               ? CHOLESKY_SIMPLICIAL
               : CHOLESKY_SUPERNODAL;
}

/* Pattern, slots and symbolic analysis: once, and again only when a key
 * changes the filter. */
static Status newton_analyse(Newton *newton)
{
    CholeskyKind kind = factor_kind(newton);
    if (newton->cholesky && newton->kind == kind)
        return STATUS_OK;
    newton_free_matrix(newton);
    newton->kind = kind;
    Triplets triplets;
    Status status = incremental_potential_pattern(newton->system, &triplets);
    if (!status) {
        newton->slot = malloc((size_t)triplets.count * sizeof(int));
        status = newton->slot
                     ? sparse_create(&triplets, cholesky_triangle(kind),
                                     &newton->A, newton->slot)
                     : STATUS_OUT_OF_MEMORY;
    }
    triplets_free(&triplets);
    if (!status) {
        incremental_potential_drop_pinned(newton->system, &newton->A,
                                          newton->slot);
        status = cholesky_create(
            &newton->A, kind, newton->system->order != NULL, &newton->cholesky);
    }
    if (status)
        newton_free_matrix(newton);
    return status;
}

/* max over nodes of |p_x| + |p_y|, over h; NaN where p has one. */
static double newton_residual(const Newton *newton, const double *p)
{
    double largest = 0;
    for (int i = 0; i < 2 * newton->system->nodes; i += 2) {
        double sum = fabs(p[i]) + fabs(p[i + 1]);
        if (!(sum <= largest))
            largest = sum;
    }
    return largest / newton->settings.h;
}

/* The projected Hessian is M plus something positive semi-definite, so
 * |p|_M^2 <= g^T M^-1 g, and each node has m |p_i|^2 <= |p|_M^2.  Where this
 * bound passes the test, p itself would: no factorisation is needed. */
static double newton_residual_bound(const Newton *newton)
{
    const System *system = newton->system;
    double sum = 0, lightest = INFINITY;
    for (int i = 0; i < system->nodes; i++) {
        double gx = newton->g[2 * i], gy = newton->g[2 * i + 1];
        sum += (gx * gx + gy * gy) / system->m[i];
        lightest = fmin(lightest, system->m[i]);
    }
    return sqrt(2 * sum / lightest) / newton->settings.h;
}

/* b = -g in elimination order, or p back from it. */
static void negate_into_order(const Newton *newton, const double *g, double *b)
{
    const int *order = newton->system->order;
    for (int i = 0; i < newton->system->nodes; i++) {
        int place = order ? order[i] : i;
        b[2 * place] = -g[2 * i];
        b[2 * place + 1] = -g[2 * i + 1];
    }
}

static void copy_from_order(const Newton *newton, const double *b, double *p)
{
    const int *order = newton->system->order;
    for (int i = 0; i < newton->system->nodes; i++) {
        int place = order ? order[i] : i;
        p[2 * i] = b[2 * place];
        p[2 * i + 1] = b[2 * place + 1];
    }
}

/* Assembles and factors the Hessian at x. */
static Status newton_factor(Newton *newton)
{
    NewtonCounters *counters = &newton->counters;
    Status status = newton_analyse(newton);
    newton->age = -1;
    if (status)
        return status;
    double start = clock_seconds();
    newton->record.projected = incremental_potential_hessian(
        &newton->E, newton->u, newton->x, newton->settings.filter, newton->slot,
        &newton->A);
    double assembled = clock_seconds();
    status = cholesky_factor(newton->cholesky);
    newton->age = status ? -1 : 0;
    newton->record.factorised = true;
    counters->projected += newton->record.projected;
    counters->factorisations++;
    counters->seconds_assembly += assembled - start;
    counters->seconds_factor += clock_seconds() - assembled;
    return status;
}

/* p = -H^-1 g (slide: search_dir). */
static Status newton_solve(Newton *newton)
{
    double start = clock_seconds();
    negate_into_order(newton, newton->g, newton->b);
    Status status = cholesky_solve(newton->cholesky, newton->b, newton->b);
    if (!status)
        copy_from_order(newton, newton->b, newton->p);
    newton->counters.solves++;
    newton->counters.seconds_solve += clock_seconds() - start;
    return status;
}

/* The lagged solver looks for its step in a plane. */
static bool uses_plane(const Newton *newton)
{
    return newton->settings.solver == SOLVER_LAGGED &&
           newton->settings.search == LINE_SEARCH_BACKTRACK;
}

/* Whether the lagged solver goes on with the factor it has. */
static bool factor_may_serve(const Newton *newton)
{
    return newton->settings.solver == SOLVER_LAGGED &&
           newton->settings.filter == FILTER_CLAMP && newton->age >= 0 &&
           newton->age < MAX_FACTOR_AGE;
}

/* p and its residual with the present factor.  Returns RUNNING, OK (the test
 * is passed), or a failure. */
static Status newton_solve_and_test(Newton *newton)
{
    Status status = newton_solve(newton);
    if (status)
        return status;
    newton->residual = newton_residual(newton, newton->p);
    if (!isfinite(newton->residual))
        return STATUS_NOT_FINITE;
    return newton->residual <= newton->settings.tolerance ? STATUS_OK
                                                          : STATUS_RUNNING;
}

/* Gradient and direction at x, and the test of Algorithm 3.  What an old
 * factor calls converged is judged again with a new one.
 * Returns OK (converged), RUNNING, or a failure. */
static Status newton_direction(Newton *newton)
{
    double start = clock_seconds();
    incremental_potential_gradient(&newton->E, newton->u, newton->x, newton->g);
    newton->counters.gradients++;
    newton->counters.seconds_assembly += clock_seconds() - start;
    newton->record.factorised = false;
    newton->record.projected = 0;
    if (newton->settings.filter == FILTER_CLAMP) {
        newton->residual = newton_residual_bound(newton);
        if (newton->residual <= newton->settings.tolerance) {
            newton->counters.skipped++;
            return STATUS_OK;
        }
    }
    if (factor_may_serve(newton)) {
        Status status = newton_solve_and_test(newton);
        if (status)
            return status;
    }
    Status status = newton_factor(newton);
    return status ? status : newton_solve_and_test(newton);
}

/* Every spring's block is at least -2 c (|x_i|^2 + |x_j|^2), where -c is the
 * lower eigenvalue of its H; so masses that outweigh these sums make the
 * Hessian positive definite, without any factorisation. */
static bool masses_outweigh_springs(const Newton *newton, double *sum)
{
    const System *system = newton->system;
    for (int i = 0; i < system->nodes; i++)
        sum[i] = 0;
    for (int s = 0; s < system->springs; s++) {
        int i = system->e[2 * s], j = system->e[2 * s + 1];
        double dx = newton->x[2 * i] - newton->x[2 * j];
        double dy = newton->x[2 * i + 1] - newton->x[2 * j + 1];
        double missing = system->l2[s] - (dx * dx + dy * dy);
        if (!(missing > 0))
            continue;
        double c = newton->E.weight * 2 * system->k[s] / system->l2[s];
        sum[i] += 2 * c * missing;
        sum[j] += 2 * c * missing;
    }
    for (int i = 0; i < system->nodes; i++)
        if (!(sum[i] < system->m[i]))
            return false;
    return true;
}

/* A start whose gradient passes the test by itself may be a maximum or a
 * saddle, such as all nodes in one point.  There the Hessian as it is, not
 * projected, has no Cholesky factor. */
static Status newton_check_minimum(Newton *newton)
{
    if (newton->settings.filter != FILTER_CLAMP ||
        masses_outweigh_springs(newton, newton->b))
        return STATUS_OK;
    Status status = newton_analyse(newton);
    if (status)
        return status;
    incremental_potential_hessian(&newton->E, newton->u, newton->x, FILTER_NONE,
                                  newton->slot, &newton->A);
    newton->counters.factorisations++;
    status = cholesky_factor(newton->cholesky);
    return status == STATUS_NOT_POSITIVE_DEFINITE ? STATUS_NOT_A_MINIMUM
                                                  : status;
}

/* Without springs E is quadratic and its Hessian diagonal: the minimiser is
 * u = (u_tilde - w x_n) / (1 + w), w = weight omega2 (averaged: 1 + w/2), and
 * no matrix is needed. */
static Status minimise_without_springs(Newton *newton)
{
    const System *system = newton->system;
    double w = newton->E.weight * system->omega2;
    double stiffness = newton->averaged ? 1 + 0.5 * w : 1 + w, sum = 0;
    for (int i = 0; i < 2 * system->nodes; i++) {
        double x_n = newton->E.x_n[i];
        if (!system->pinned || !system->pinned[i / 2])
            newton->u[i] = (newton->u_tilde[i] - w * x_n) / stiffness;
        newton->x[i] = x_n + newton->u[i];
        sum += 0 * newton->x[i];
    }
    newton->residual = 0;
    return sum == 0 ? STATUS_OK : STATUS_NOT_FINITE;
}

Status newton_start(Newton *newton, const double *x_n, double weight)
{
    size_t size = 2 * (size_t)newton->system->nodes;
    memcpy(newton->r, newton->u_tilde, size * sizeof *newton->r);
    newton->E = (IncrementalPotential){newton->system, weight, x_n,
                                       newton->u_tilde, newton->averaged};
    memset(newton->u, 0, size * sizeof *newton->u);
    memcpy(newton->x, x_n, size * sizeof *newton->x);
    if (newton->record.iteration < 0)
        newton->age = -1; /* no update last time: expect the same, and test
                             with a new factor at once */
    newton->record = (NewtonRecord){.step = newton->step, .iteration = -1};
    newton->best = INFINITY;
    newton->stagnant = 0;
    newton->counters.minimisations++;
    if (newton->system->springs == 0)
        return newton->status = minimise_without_springs(newton);
    long skipped = newton->counters.skipped;
    newton->status = newton_direction(newton);
    if (newton->counters.skipped > skipped)
        newton->status = newton_check_minimum(newton);
    return newton->status;
}

/* q(alpha), as line_search calls it. */
static double quartic_difference(const void *function, double alpha)
{
    return quartic_value(function, alpha);
}

/* What rounding can make of a decrease: a few units in the last place of E. */
static bool hidden_by_rounding(const Newton *newton, double change)
{
    double E = incremental_potential_scale(&newton->E, newton->u, newton->x);
    return fabs(change) <= 4 * 2.220446049250313e-16 * E;
}

/* Step length along p (Algorithm 2). */
static Status search_line(Newton *newton)
{
    NewtonRecord *record = &newton->record;
    Quartic along = incremental_potential_along(
        &newton->E, newton->u, newton->x, newton->g, newton->p);
    Status status = STATUS_OK;
    record->slope = along.q[0];
    record->alpha = 1;
    record->trials = 0;
    if (newton->settings.search == LINE_SEARCH_BACKTRACK)
        status = line_search_backtrack(quartic_difference, &along,
                                       &record->alpha, &record->trials);
    record->change = quartic_value(&along, record->alpha);
    return status;
}

/* r = alpha p + beta r, the lowest point in the plane of p and the last
 * update r. */
static Status search_plane(Newton *newton)
{
    NewtonRecord *record = &newton->record;
    double at[2];
    PlaneQuartic plane = incremental_potential_in_plane(
        &newton->E, newton->u, newton->x, newton->g, newton->p, newton->r);
    Status status = plane_minimise(&plane, at, &record->trials);
    record->slope = plane.c[0];
    record->alpha = at[0];
    record->change = plane_value(&plane, at[0], at[1]);
    for (int i = 0; i < 2 * newton->system->nodes; i++)
        newton->r[i] = at[0] * newton->p[i] + at[1] * newton->r[i];
    return status;
}

/* The way to go from x, into the record, and why there is none. */
static Status newton_search(Newton *newton)
{
    double start = clock_seconds();
    Status status =
        uses_plane(newton) ? search_plane(newton) : search_line(newton);
    newton->counters.trials += newton->record.trials;
    newton->counters.seconds_search += clock_seconds() - start;
    if (!status)
        return STATUS_OK;
    newton->record.alpha = 0;
    newton->record.change = 0;
    if (hidden_by_rounding(newton, newton->record.slope))
        return STATUS_ROUNDING_LIMIT;
    return newton->record.slope > 0 ? STATUS_NOT_DESCENT : status;
}

/* u += alpha p (or r, from the plane), x = x_n + u.  Returns false, with
 * nothing changed, where the result would not be finite. */
static bool newton_update(Newton *newton)
{
    bool plane = uses_plane(newton);
    const double *way = plane ? newton->r : newton->p;
    double alpha = plane ? 1 : newton->record.alpha, sum = 0;
    int size = 2 * newton->system->nodes;
    for (int i = 0; i < size; i++)
        sum += 0 * (newton->E.x_n[i] + (newton->u[i] + alpha * way[i]));
    if (!(sum == 0))
        return false;
    for (int i = 0; i < size; i++) {
        newton->u[i] += alpha * way[i];
        newton->x[i] = newton->E.x_n[i] + newton->u[i];
    }
    newton->counters.iterations++;
    if (newton->age >= 0)
        newton->age++;
    return true;
}

/* Whether the loop may go on after an iteration that did not converge. */
static Status newton_limits(Newton *newton)
{
    if (newton->residual < newton->best) {
        newton->best = newton->residual;
        newton->stagnant = 0;
    } else if (++newton->stagnant >= STAGNANT_ITERATIONS &&
               hidden_by_rounding(newton, newton->record.change)) {
        return STATUS_ROUNDING_LIMIT;
    }
    if (newton->record.iteration + 1 >= newton->settings.max_iterations)
        return STATUS_ITERATION_LIMIT;
    return STATUS_RUNNING;
}

Status newton_iterate(Newton *newton)
{
    NewtonRecord *record = &newton->record;
    if (newton->status != STATUS_RUNNING)
        return newton->status;
    double start = clock_seconds();
    record->iteration++;
    record->residual = newton->residual;
    Status status = newton_search(newton);
    if (!status && !newton_update(newton))
        status = STATUS_NOT_FINITE;
    NewtonRecord done = *record;
    if (!status)
        status = newton_direction(newton);
    done.seconds = clock_seconds() - start;
    done.status = status;
    if (newton->settings.observer &&
        !newton->settings.observer(newton->settings.user, &done))
        status = STATUS_INTERRUPTED;
    if (status == STATUS_RUNNING)
        status = newton_limits(newton);
    return newton->status = status;
}

Status newton_minimise(Newton *newton, const double *x_n, double weight)
{
    Status status = newton_start(newton, x_n, weight);
    while (status == STATUS_RUNNING)
        status = newton_iterate(newton);
    return status;
}
