#include "solve/newton_parts.h"

#include <math.h>

#include "base/clock.h"

/* Iterations for which projection on demand clamps after it had to. */
enum { CLAMPS_AFTER_FAILURE = 4 };

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

/* Assembles and factors the Hessian at x, once. */
static Status factor_as(Newton *newton, Filter filter)
{
    NewtonCounters *counters = &newton->counters;
    double start = clock_now(), assembled;
    int projected, tries = 0;
    Status status = search_direction_assemble(&newton->search, &newton->at,
                                              filter, &projected);
    assembled = clock_now();
    if (!status)
        status = search_direction_factor(&newton->search, &tries);
    newton->record.factorised = true;
    newton->record.projected = projected;
    newton->record.shift = newton->search.shift;
    counters->projected += projected;
    counters->factorisations += tries;
    counters->seconds_assembly += assembled - start;
    counters->seconds_factor += clock_now() - assembled;
    return status;
}

/* As the filter says.  Projection on demand first tries the Hessian as it is;
 * after a failure it clamps, and goes on to do so for some iterations. */
static Status newton_factor(Newton *newton)
{
    if (newton->settings.filter != FILTER_ON_DEMAND)
        return factor_as(newton, newton->settings.filter);
    if (newton->clamps == 0) {
        Status status = factor_as(newton, FILTER_ON_DEMAND);
        if (status != STATUS_NOT_POSITIVE_DEFINITE)
            return status;
        newton->clamps = CLAMPS_AFTER_FAILURE;
    }
    newton->clamps--;
    return factor_as(newton, FILTER_CLAMP);
}

/* p = -H^-1 g (slide: search_dir). */
static Status newton_solve(Newton *newton)
{
    double start = clock_now();
    Status status = search_direction_solve(&newton->search, &newton->at);
    newton->counters.solves++;
    newton->counters.seconds_solve += clock_now() - start;
    return status;
}

/* The test of Algorithm 3 for a direction that is at most error away, in the
 * norm of the masses, from what it should be. */
static Status newton_test(const Newton *newton, double error)
{
    double residual = newton->residual + residual_per_norm(newton) * error;
    return residual <= newton->settings.tolerance ? STATUS_OK : STATUS_RUNNING;
}

/* p and its residual with the present factor.  Where springs outweigh the
 * masses so much that a factor is not exact, the test is passed only by a
 * direction that is known well enough: with the bound of what H p = -g lacks.
 * (What rounding has done to g itself is not in this: no direction knows it.)
 * Returns RUNNING, OK (the test is passed), or a failure. */
static Status newton_solve_and_test(Newton *newton)
{
    double error;
    Status status = newton_solve(newton);
    if (status)
        return status;
    newton->residual = newton_residual(newton);
    if (!isfinite(newton->residual))
        return STATUS_NOT_FINITE;
    status = newton_test(newton, 0);
    bool exact = !newton->rounding.blurred && newton->search.shift == 0;
    newton->kind = exact ? RESIDUAL_VALUE : RESIDUAL_ESTIMATE;
    if (status || exact)
        return status;
    status = search_direction_judge(&newton->search, &newton->at, &error);
    return status ? status : newton_test(newton, error);
}

/* Gradient and direction at x, and the test of Algorithm 3.
 * Returns OK (converged), RUNNING, or a failure. */
static Status direction_at(Newton *newton)
{
    double start = clock_now();
    incremental_potential_gradient(&newton->at.E, newton->at.u, newton->at.x,
                                   newton->at.g);
    newton->counters.gradients++;
    newton->counters.seconds_assembly += clock_now() - start;
    newton->record.factorised = false;
    newton->record.projected = 0;
    newton->record.shift = 0;
    /* The projected Hessian is M plus something positive semi-definite, so
     * |p|_M <= |g|_(M^-1).  Where this bound passes the test, p itself would:
     * no factorisation is needed.  (On demand, where the Hessian as it is may
     * be less than M, the test is that of the projected one here.) */
    if (newton->settings.filter != FILTER_NONE) {
        newton->kind = RESIDUAL_BOUND;
        newton->residual =
            residual_per_norm(newton) *
            system_inverse_mass_norm(newton->system, newton->at.g);
        if (newton_test(newton, 0) == STATUS_OK) {
            newton->counters.skipped++;
            return STATUS_OK;
        }
    }
    Status status = newton_factor(newton);
    return status ? status : newton_solve_and_test(newton);
}

/* Whether g is 0 but for rounding, compared with the force of a spring that is
 * compressed to nothing. */
static bool gradient_vanishes(const Newton *newton)
{
    double most = 1e-12 * newton->at.E.weight * newton->rounding.force;
    for (int i = 0; i < 2 * newton->system->nodes; i++)
        if (!(fabs(newton->at.g[i]) <= most))
            return false;
    return true;
}

/* Whether the Hessian as it is, with `times` M in place of M, is positive
 * definite: by bounds, and where they do not tell by its Cholesky factor.
 * Writes over x_trial.  Returns OK, NOT_A_MINIMUM, or a failure. */
static Status look_for_minimum(Newton *newton, double times)
{
    SearchDirection *search = &newton->search;
    int projected;
    if (newton->settings.filter == FILTER_NONE ||
        newton->at.E.weight * newton->rounding.concave < times ||
        incremental_potential_concave(&newton->at, newton->x_trial) < times)
        return STATUS_OK;
    Status status = search_direction_assemble(search, &newton->at,
                                              FILTER_ON_DEMAND, &projected);
    if (status)
        return status;
    search_direction_add_masses(search, times - 1);
    newton->counters.factorisations++;
    status = cholesky_factor(search->cholesky);
    return status == STATUS_NOT_POSITIVE_DEFINITE ? STATUS_NOT_A_MINIMUM
                                                  : status;
}

/* The test of the slides projects, and so it also passes where E bends down.
 * By some masses that is an instability that grows as fast as the step can
 * follow; by more than this many times M the place is far from any minimum of
 * E, and it is not called one. */
static const double MASSES_DOWN = 100;

Status direction_judges_end(Newton *newton)
{
    /* Of a large square the factor that tells takes longer than multigrid's
     * whole step: it has to be asked for. */
    if (newton->working == SOLVER_MULTIGRID && !newton->settings.minimum &&
        newton->system->segments > AUTO_NEWTON_SEGMENTS)
        return STATUS_OK;
    return look_for_minimum(newton,
                            newton->settings.minimum ? 1 : 1 + MASSES_DOWN);
}

/* Saddles that one minimisation leaves, and how far: the first trial moves the
 * node that moves most by this share of a spring. */
enum { MAX_SADDLES = 30 };
static const double FIRST_TRIAL = 0.1;

/* From where E bends down: p along negative curvature of the Hessian as it is,
 * if that is found; else as anywhere.  Returns RUNNING or a failure. */
static Status leave_saddle(Newton *newton)
{
    const System *system = newton->system;
    double *p = newton->at.p, largest = 0, l2 = INFINITY;
    bool found = false;
    Status status = newton_factor(newton);
    if (!status && newton->saddles < MAX_SADDLES)
        status =
            search_direction_bends_down(&newton->search, &newton->at, &found);
    if (!status && !found)
        status = newton_solve(newton);
    if (status || !found)
        return status ? status : STATUS_RUNNING;
    for (int i = 0; i < 2 * system->nodes; i++)
        largest = fmax(largest, fabs(p[i]));
    for (int s = 0; s < system->springs; s++)
        l2 = fmin(l2, system->l2[s]);
    double scale = FIRST_TRIAL * (system->springs ? sqrt(l2) : 1) / largest;
    for (int i = 0; i < 2 * system->nodes; i++)
        p[i] *= scale;
    newton->saddles++;
    newton->counters.saddles++;
    return STATUS_RUNNING;
}

Status direction_next(Newton *newton)
{
    Status status = direction_at(newton);
    if (status == STATUS_OK)
        status = direction_judges_end(newton);
    newton->bends_down = status == STATUS_NOT_A_MINIMUM;
    return newton->bends_down ? leave_saddle(newton) : status;
}

Status direction_first(Newton *newton)
{
    Status status = direction_next(newton);
    /* Where the gradient vanishes, any curvature downwards tells. */
    return status || !gradient_vanishes(newton) ? status
                                                : look_for_minimum(newton, 1);
}
