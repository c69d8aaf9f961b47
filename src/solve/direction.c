#include "solve/newton_parts.h"

#include <math.h>

#include "base/clock.h"
#include "solve/residual_test.h"

/* Iterations for which projection on demand clamps after it had to. */
enum { CLAMPS_AFTER_FAILURE = 4 };

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

/* m/s, of a direction with |p|_M = 1, at most. */
static double largest_residual(const Newton *newton)
{
    return residual_per_norm(newton->rounding.lightest, newton->settings.h);
}

/* Assembles and factors the Hessian at x, once. */
static Status factor_as(Newton *newton, Filter filter, bool definite)
{
    NewtonCounters *counters = &newton->counters;
    double start = clock_now(), assembled;
    int projected, tries = 0;
    Status status = search_direction_assemble(&newton->search, &newton->at,
                                              filter, definite, &projected);
    assembled = clock_now();
    if (!status)
        status = search_direction_factor(&newton->search, &tries);
    newton->search.age = status ? -1 : 0;
    newton->record.factorised = true;
    newton->record.projected = projected;
    newton->record.shift = newton->search.shift;
    counters->projected += projected;
    counters->factorisations += tries;
    counters->shifted += newton->search.shift > 0;
    counters->seconds_assembly += assembled - start;
    counters->seconds_factor += clock_now() - assembled;
    return status;
}

/* As the filter says.  Projection on demand first tries the Hessian as it is;
 * after a failure it clamps, and goes on to do so for some iterations. */
static Status newton_factor(Newton *newton)
{
    Filter filter = newton->settings.filter;
    newton->search.age = -1;
    if (filter == FILTER_NONE)
        return factor_as(newton, FILTER_NONE, false);
    if (filter != FILTER_ON_DEMAND)
        return factor_as(newton, filter, true);
    if (newton->search.clamps == 0) {
        Status status = factor_as(newton, FILTER_NONE, true);
        if (status != STATUS_NOT_POSITIVE_DEFINITE)
            return status;
        newton->search.clamps = CLAMPS_AFTER_FAILURE;
    }
    newton->search.clamps--;
    return factor_as(newton, FILTER_CLAMP, true);
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

/* Whether the factor of the iterate before is worth a try: it may decide that
 * the test is passed, which is likely in a step after one without updates, and
 * after a direction that was nearly short enough. */
static bool factor_may_serve(const Newton *newton)
{
    const SearchDirection *search = &newton->search;
    if (newton->settings.filter == FILTER_NONE || search->age < 0 ||
        search->age > 1 || search->kind == CHOLESKY_INDEFINITE ||
        search->shift > 0 || newton->rounding.blurred)
        return false;
    return search->updates == 0
               ? search->resting
               : search->residual <= 10 * newton->settings.tolerance;
}

/* The test of Algorithm 3 for a direction that is at most error away, in the
 * norm of the masses, from what it should be. */
static Status newton_test(const Newton *newton, double error)
{
    double residual = newton->residual;
    if (error > 0)
        residual += largest_residual(newton) * error;
    return residual <= newton->settings.tolerance ? STATUS_OK : STATUS_RUNNING;
}

/* Where springs outweigh the masses so much that a factor is not exact, the
 * test is passed only by a direction that is known well enough: with the bound
 * of what H p = -g lacks.  (What rounding has done to g itself is not in this:
 * no direction knows it.) */
static Status newton_certify(Newton *newton)
{
    double error;
    Status status =
        search_direction_judge(&newton->search, &newton->at, &error);
    if (!status && newton->search.filter == FILTER_NONE) {
        /* H - M may be indefinite: the factor tells what is lacking */
        status = search_direction_correct(&newton->search);
        error = 2 * newton_residual(newton, newton->search.z) /
                largest_residual(newton);
    }
    return status ? status : newton_test(newton, error);
}

/* p and its residual with the present factor.  Returns RUNNING, OK (the test
 * is passed), or a failure. */
static Status newton_solve_and_test(Newton *newton)
{
    Status status = newton_solve(newton);
    if (status)
        return status;
    newton->residual = newton_residual(newton, newton->at.p);
    if (!isfinite(newton->residual))
        return STATUS_NOT_FINITE;
    status = newton_test(newton, 0);
    bool exact = !newton->rounding.blurred && newton->search.shift == 0;
    return status || exact ? status : newton_certify(newton);
}

/* Whether a direction with this residual and at most this error passes the test
 * or does not, wherever the exact one is. */
static bool is_decided(const Newton *newton, double residual, double error)
{
    return residual_decides(residual, largest_residual(newton) * error,
                            newton->settings.tolerance);
}

/* The same, as search_direction_refine asks it. */
static bool test_is_decided(const void *user, const double *p, double error)
{
    return is_decided(user, newton_residual(user, p), error);
}

/* More solves than this to refine a direction, and a new factor is cheaper. */
enum { REFINE_MAX_SOLVES = 6 };

/* Whether the test is passed by the direction with the factor of an earlier
 * iterate: it is refined until the test can be decided for the Hessian at x,
 * with the error's bound on both sides. */
static bool old_factor_passes(Newton *newton)
{
    double error;
    int solves;
    Filter filter =
        newton->settings.filter == FILTER_ABS ? FILTER_ABS : FILTER_CLAMP;
    if (newton_solve_and_test(newton) != STATUS_OK)
        return false;
    double start = clock_now();
    Status status = search_direction_refine(
        &newton->search, &newton->at, filter, REFINE_MAX_SOLVES,
        test_is_decided, newton, &error, &solves);
    newton->counters.solves += solves;
    newton->counters.seconds_solve += clock_now() - start;
    if (status)
        return false;
    newton->residual = newton_residual(newton, newton->at.p);
    return is_decided(newton, newton->residual, error) &&
           newton_test(newton, 0) == STATUS_OK;
}

/* Gradient and direction at x, and the test of Algorithm 3.
 *   alone  out: the gradient's size alone has passed it
 * Returns OK (converged), RUNNING, or a failure. */
static Status direction_at(Newton *newton, bool *alone)
{
    double start = clock_now();
    incremental_potential_gradient(&newton->at.E, newton->at.u, newton->at.x,
                                   newton->at.g);
    newton->counters.gradients++;
    newton->counters.seconds_assembly += clock_now() - start;
    *alone = false;
    newton->record.factorised = false;
    newton->record.projected = 0;
    newton->record.shift = 0;
    /* The projected Hessian is M plus something positive semi-definite, so
     * |p|_M <= |g|_(M^-1).  Where this bound passes the test, p itself would:
     * no factorisation is needed.  (On demand, where the Hessian as it is may
     * be less than M, the test is that of the projected one here.) */
    if (newton->settings.filter != FILTER_NONE) {
        newton->residual =
            largest_residual(newton) *
            system_inverse_mass_norm(newton->system, newton->at.g);
        *alone = newton_test(newton, 0) == STATUS_OK;
        newton->counters.skipped += *alone;
        if (*alone)
            return STATUS_OK;
    }
    if (factor_may_serve(newton) && old_factor_passes(newton)) {
        newton->counters.certified++;
        return STATUS_OK;
    }
    Status status = newton_factor(newton);
    return status ? status : newton_solve_and_test(newton);
}

/* Whether g is 0 but for rounding, compared with the force of a spring that is
 * compressed to nothing. */
static bool gradient_vanishes(const Newton *newton)
{
    double largest = 0, stiffest, force;
    for (int i = 0; i < 2 * newton->system->nodes; i++)
        largest = fmax(largest, fabs(newton->at.g[i]));
    system_bounds(newton->system, &stiffest, &force);
    return largest <= 1e-12 * newton->at.E.weight * force;
}

/* Whether the Hessian as it is, with `times` M in place of M, is known to be
 * positive definite without a factorisation.  Writes over r. */
static bool is_convex(Newton *newton, double times)
{
    return newton->at.E.weight * newton->rounding.concave < times ||
           incremental_potential_concave(&newton->at, newton->r) < times;
}

/* The same by a Cholesky factor where the bounds do not tell.
 * Returns OK, NOT_A_MINIMUM, or a failure. */
static Status look_for_minimum(Newton *newton, double times)
{
    SearchDirection *search = &newton->search;
    int projected;
    if (newton->settings.filter == FILTER_NONE || is_convex(newton, times))
        return STATUS_OK;
    Status status = search_direction_assemble(search, &newton->at, FILTER_NONE,
                                              true, &projected);
    if (status)
        return status;
    search_direction_add_masses(search, times - 1);
    search->age = -1;
    newton->counters.factorisations++;
    status = cholesky_factor(search->cholesky);
    return status == STATUS_NOT_POSITIVE_DEFINITE ? STATUS_NOT_A_MINIMUM
                                                  : status;
}

/* Saddles that one minimisation leaves, and how far: the first trial moves the
 * node that moves most by this share of a spring. */
enum { MAX_SADDLES = 30 };
static const double FIRST_TRIAL = 0.1;

/* The test of Algorithm 3 is passed on saddles, too.  Negative curvature of the
 * Hessian as it is is then the next direction.
 *   known  there is some
 * Returns OK (none was found), RUNNING, or a failure. */
static Status leave_saddle(Newton *newton, bool known)
{
    const System *system = newton->system;
    double *p = newton->at.p, largest = 0, l2 = INFINITY;
    bool found = false;
    if (newton->settings.filter == FILTER_NONE ||
        newton->saddles == MAX_SADDLES || is_convex(newton, 1))
        return STATUS_OK;
    Status status = newton->search.age < 0 ? newton_factor(newton) : STATUS_OK;
    if (!status)
        status = search_direction_bends_down(&newton->search, &newton->at,
                                             known, &found);
    if (status || !found)
        return status;
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

/* The test of the slides projects, and so it also passes where E bends down.
 * By some masses that is an instability that grows as fast as the step can
 * follow; by more than this many times M the place is far from any minimum of
 * E, and it is not called one. */
static const double MASSES_DOWN = 100;

Status direction_judges_end(Newton *newton)
{
    /* Of a large square the factor that tells takes longer than multigrid's
     * whole step; --minimum looks there. */
    if (newton->working == SOLVER_MULTIGRID &&
        newton->system->segments > AUTO_NEWTON_SEGMENTS)
        return STATUS_OK;
    return look_for_minimum(newton, 1 + MASSES_DOWN);
}

/* The test is passed.
 * Returns OK, RUNNING where E bends down and p leads on, or a failure. */
static Status end_here(Newton *newton)
{
    Status status =
        newton->settings.minimum ? leave_saddle(newton, false) : STATUS_OK;
    if (status == STATUS_OK)
        status = direction_judges_end(newton);
    if (status != STATUS_NOT_A_MINIMUM)
        return status;
    newton->search.bends_down = true;
    status = leave_saddle(newton, true);
    if (status)
        return status;
    status = newton_factor(newton); /* p is another one by now */
    if (!status)
        status = newton_solve(newton);
    return status ? status : STATUS_RUNNING;
}

Status direction_first(Newton *newton)
{
    SearchDirection *search = &newton->search;
    bool alone;
    search->resting = search->updates == 0;
    search->updates = 0;
    Status status = direction_at(newton, &alone);
    search->bends_down = false;
    newton->saddles = 0;
    bool vanishes =
        alone && !newton->settings.minimum && gradient_vanishes(newton);
    if (status == STATUS_OK)
        status = end_here(newton);
    /* Where the gradient vanishes, any curvature downwards tells. */
    return status || !vanishes ? status : look_for_minimum(newton, 1);
}

Status direction_next(Newton *newton)
{
    bool alone;
    newton->search.updates++;
    newton->search.residual = newton->residual;
    Status status = direction_at(newton, &alone);
    newton->search.bends_down = false;
    return status ? status : end_here(newton);
}
