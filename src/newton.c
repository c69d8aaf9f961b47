#include "newton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "plane_search.h"

/* After this many iterations without a smaller residual, rounding may be all
 * that is left. */
enum { STAGNANT_ITERATIONS = 20 };

/* Updates for which the lagged solver keeps a factor: more iterations against
 * fewer factorisations; 8 ... 16 measured about the same. */
enum { MAX_FACTOR_AGE = 12 };

/* Updates after which the lagged solver smooths: easy steps end before. */
enum { UPDATES_WITHOUT_SMOOTHING = 2 };

/* Iterations for which projection on demand clamps after it had to. */
enum { CLAMPS_AFTER_FAILURE = 4 };

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
    *newton = (Newton){.settings = *settings,
                       .system = system,
                       .lightest = INFINITY,
                       .age = -1};
    for (int i = 0; i < system->nodes; i++)
        newton->lightest = fmin(newton->lightest, system->m[i]);
    size_t size = 2 * (size_t)system->nodes;
    double **vectors[] = {&newton->u, &newton->x, &newton->u_tilde,
                          &newton->g, &newton->p, &newton->r};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        *vectors[i] = calloc(size, sizeof(double));
        if (!*vectors[i])
            return STATUS_OUT_OF_MEMORY;
    }
    return search_direction_create(system, &newton->search);
}

void newton_free(Newton *newton)
{
    if (!newton)
        return;
    search_direction_free(&newton->search);
    gauss_seidel_free(&newton->smoother);
    free(newton->u);
    free(newton->x);
    free(newton->u_tilde);
    free(newton->g);
    free(newton->p);
    free(newton->r);
    *newton = (Newton){0};
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

/* The largest residual that a direction with |p|_M = 1 can have: each node has
 * m |p_i|^2 <= |p|_M^2, and |p_x| + |p_y| <= sqrt(2) |p_i|. */
static double residual_per_norm(const Newton *newton)
{
    return sqrt(2 / newton->lightest) / newton->settings.h;
}

/* The projected Hessian is M plus something positive semi-definite, so
 * |p|_M <= |g|_(M^-1).  Where this bound passes the test, p itself would: no
 * factorisation is needed. */
static double newton_residual_bound(const Newton *newton)
{
    return residual_per_norm(newton) *
           system_inverse_mass_norm(newton->system, newton->g);
}

/* Assembles and factors the Hessian at x, once. */
static Status factor_as(Newton *newton, Filter filter, bool definite)
{
    NewtonCounters *counters = &newton->counters;
    double start = clock_seconds(), assembled;
    int projected, tries = 0;
    Status status =
        search_direction_assemble(&newton->search, &newton->E, newton->u,
                                  newton->x, filter, definite, &projected);
    assembled = clock_seconds();
    if (!status)
        status = search_direction_factor(&newton->search, &tries);
    newton->age = status ? -1 : 0;
    newton->record.factorised = true;
    newton->record.projected = projected;
    newton->record.shift = newton->search.shift;
    counters->projected += projected;
    counters->factorisations += tries;
    counters->shifted += newton->search.shift > 0;
    counters->seconds_assembly += assembled - start;
    counters->seconds_factor += clock_seconds() - assembled;
    return status;
}

/* As the filter says.  Projection on demand first tries the Hessian as it is;
 * after a failure it clamps, and goes on to do so for some iterations. */
static Status newton_factor(Newton *newton)
{
    Filter filter = newton->settings.filter;
    newton->age = -1;
    if (filter == FILTER_NONE)
        return factor_as(newton, FILTER_NONE, false);
    if (filter != FILTER_ON_DEMAND)
        return factor_as(newton, filter, true);
    if (newton->clamps == 0) {
        Status status = factor_as(newton, FILTER_NONE, true);
        if (status != STATUS_NOT_POSITIVE_DEFINITE)
            return status;
        newton->clamps = CLAMPS_AFTER_FAILURE;
    }
    newton->clamps--;
    return factor_as(newton, FILTER_CLAMP, true);
}

/* p = -H^-1 g (slide: search_dir). */
static Status newton_solve(Newton *newton)
{
    double start = clock_seconds();
    Status status =
        search_direction_solve(&newton->search, &newton->E, newton->u,
                               newton->x, newton->g, newton->p);
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

/* Whether the next test of Algorithm 3 is likely to be passed: in a step after
 * one without updates, or after a direction that was nearly short enough. */
static bool expects_convergence(const Newton *newton)
{
    if (newton->record.iteration < 0)
        return newton->resting;
    return newton->record.residual <= 10 * newton->settings.tolerance;
}

/* Whether the factor of an earlier iterate is worth a try: the lagged solver
 * takes its directions from it, and both may decide with it that the test is
 * passed. */
static bool factor_may_serve(const Newton *newton)
{
    if (newton->settings.filter == FILTER_NONE || newton->age < 0 ||
        newton->search.kind == CHOLESKY_INDEFINITE || newton->search.shift > 0)
        return false;
    if (newton->settings.solver == SOLVER_LAGGED)
        return newton->age < MAX_FACTOR_AGE;
    return newton->age <= 1 && expects_convergence(newton);
}

/* The test of Algorithm 3. */
static Status newton_test(const Newton *newton)
{
    return newton->residual <= newton->settings.tolerance ? STATUS_OK
                                                          : STATUS_RUNNING;
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
    return newton_test(newton);
}

/* Whether a direction with at most this error passes the test or does not,
 * wherever the exact one is. */
static bool test_is_decided(const void *user, const double *p, double error)
{
    const Newton *newton = user;
    double away = newton_residual(newton, p) - newton->settings.tolerance;
    return fabs(away) >= residual_per_norm(newton) * error;
}

/* The direction with the factor of an earlier iterate.  One that passes the
 * test is refined until the test can be decided for the Hessian at x, with the
 * error's bound on both sides.
 * Returns OK (passed), RUNNING (p can be used), or a failure; *decided is false
 * where only a new factor can tell. */
static Status direction_from_old_factor(Newton *newton, bool *decided)
{
    Status status = newton_solve_and_test(newton);
    *decided = status != STATUS_OK;
    if (status)
        return status;
    double error, start = clock_seconds();
    int solves;
    Filter filter =
        newton->settings.filter == FILTER_ABS ? FILTER_ABS : FILTER_CLAMP;
    status = search_direction_refine(
        &newton->search, &newton->E, newton->u, newton->x, filter, newton->g,
        test_is_decided, newton, newton->p, &error, &solves);
    newton->counters.solves += solves;
    newton->counters.seconds_solve += clock_seconds() - start;
    if (status)
        return status;
    newton->residual = newton_residual(newton, newton->p);
    *decided = test_is_decided(newton, newton->p, error);
    return newton_test(newton);
}

/* Gradient and direction at x, and the test of Algorithm 3.
 * Returns OK (converged), RUNNING, or a failure. */
static Status newton_direction(Newton *newton)
{
    double start = clock_seconds();
    incremental_potential_gradient(&newton->E, newton->u, newton->x, newton->g);
    newton->counters.gradients++;
    newton->counters.seconds_assembly += clock_seconds() - start;
    newton->record.factorised = false;
    newton->record.projected = 0;
    newton->record.shift = 0;
    if (newton->settings.filter != FILTER_NONE) {
        newton->residual = newton_residual_bound(newton);
        if (newton->residual <= newton->settings.tolerance) {
            newton->counters.skipped++;
            return STATUS_OK;
        }
    }
    if (factor_may_serve(newton)) {
        bool decided;
        Status status = direction_from_old_factor(newton, &decided);
        if (decided && !status)
            newton->counters.certified++;
        if (decided && (!status || newton->settings.solver == SOLVER_LAGGED))
            return status;
    }
    Status status = newton_factor(newton);
    return status ? status : newton_solve_and_test(newton);
}

/* Whether g is 0 but for rounding, compared with the force of a spring that is
 * compressed to nothing. */
static bool gradient_vanishes(const Newton *newton)
{
    const System *system = newton->system;
    double force = 0, largest = 0;
    for (int s = 0; s < system->springs; s++)
        force = fmax(force, system->k[s] * sqrt(system->l2[s]));
    for (int i = 0; i < 2 * system->nodes; i++)
        largest = fmax(largest, fabs(newton->g[i]));
    return largest <= 1e-12 * newton->E.weight * force;
}

/* Every spring's block is at least -2 c (|x_i|^2 + |x_j|^2), where -c is the
 * lower eigenvalue of its H; so masses that outweigh these sums make the
 * Hessian positive definite, without any factorisation.  sum [2n] out */
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

/* Where the gradient vanishes may be a maximum or a saddle, such as all nodes
 * in one point.  There the Hessian as it is, not projected, has a negative
 * eigenvalue: a pivot of L D L^T that is not positive. */
static Status newton_check_minimum(Newton *newton)
{
    if (newton->settings.filter == FILTER_NONE || !gradient_vanishes(newton) ||
        masses_outweigh_springs(newton, newton->p))
        return STATUS_OK;
    int projected;
    Status status =
        search_direction_assemble(&newton->search, &newton->E, newton->u,
                                  newton->x, FILTER_NONE, false, &projected);
    if (!status)
        status = cholesky_factor(newton->search.cholesky);
    newton->age = -1;
    newton->counters.factorisations++;
    if (!status && cholesky_negative_pivots(newton->search.cholesky) > 0)
        return STATUS_NOT_A_MINIMUM;
    return status;
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
    newton->resting = newton->record.iteration < 0;
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

/* What rounding can make of a decrease: a few units in the last place of E. */
static bool hidden_by_rounding(const Newton *newton, double change)
{
    double E = incremental_potential_scale(&newton->E, newton->u, newton->x);
    return isfinite(E) && fabs(change) <= 4 * 2.220446049250313e-16 * E;
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
    if (status) { /* r so long that rounding hides what p alone can do */
        status = search_line(newton);
        at[0] = record->alpha;
        at[1] = 0;
    }
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
    if (!isfinite(newton->record.slope))
        return STATUS_NOT_FINITE;
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

/* What a factor of long ago knows badly, stiffnesses that have changed from one
 * spring to the next, a few sweeps over the nodes put right.  The way they go
 * is a part of the last update. */
static Status newton_smooth(Newton *newton)
{
    if (!uses_plane(newton) || newton->averaged ||
        newton->settings.filter == FILTER_NONE ||
        newton->record.iteration < UPDATES_WITHOUT_SMOOTHING)
        return STATUS_OK;
    double start = clock_seconds(), change;
    if (!newton->smoother.group) {
        Status status = gauss_seidel_create(newton->system, &newton->smoother);
        if (status)
            return status;
    }
    incremental_potential_gradient(&newton->E, newton->u, newton->x, newton->g);
    int trials = gauss_seidel_smooth(&newton->smoother, &newton->E, newton->g,
                                     newton->u, newton->x, newton->p, &change);
    for (int i = 0; i < 2 * newton->system->nodes; i++)
        newton->r[i] += newton->p[i];
    newton->record.change += change;
    newton->record.trials += trials;
    newton->counters.trials += trials;
    newton->counters.gradients++;
    newton->counters.smoothings++;
    newton->counters.seconds_smoothing += clock_seconds() - start;
    return STATUS_OK;
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
    if (!status)
        status = newton_smooth(newton);
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

/* Springs cannot move the centre of mass: at the minimum sum m u equals
 * sum m u_tilde.  What the tolerance has left of the difference is moved, which
 * lowers E, and linear momentum is conserved to rounding. */
void newton_finish(Newton *newton)
{
    const System *system = newton->system;
    double mass = 0, missing[2] = {0, 0};
    if (system->pinned || system->omega2 > 0 ||
        (newton->status && !status_is_unconverged(newton->status)))
        return;
    for (int i = 0; i < system->nodes; i++) {
        mass += system->m[i];
        for (int c = 0; c < 2; c++)
            missing[c] += system->m[i] *
                          (newton->u_tilde[2 * i + c] - newton->u[2 * i + c]);
    }
    for (int i = 0; i < 2 * system->nodes; i++) {
        newton->u[i] += missing[i % 2] / mass;
        newton->x[i] = newton->E.x_n[i] + newton->u[i];
    }
}

Status newton_minimise(Newton *newton, const double *x_n, double weight)
{
    Status status = newton_start(newton, x_n, weight);
    while (status == STATUS_RUNNING)
        status = newton_iterate(newton);
    newton_finish(newton);
    return status;
}
