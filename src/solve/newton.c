#include "solve/newton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solve/newton_direction.h"
#include "solve/plane_search.h"

/* After this many iterations without a smaller residual, rounding may be all
 * that is left. */
enum { STAGNANT_ITERATIONS = 20 };

/* Updates after which the lagged solver smooths: easy steps end before. */
enum { UPDATES_WITHOUT_SMOOTHING = 2 };

Status newton_create(const System *system, const NewtonSettings *settings,
                     Newton *newton)
{
    *newton = (Newton){.settings = *settings, .system = system};
    newton_forget(newton);
    size_t size = 2 * (size_t)system->nodes;
    double **vectors[] = {&newton->at.u, &newton->at.x, &newton->u_tilde,
                          &newton->at.g, &newton->at.p, &newton->r};
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
    free(newton->at.u);
    free(newton->at.x);
    free(newton->u_tilde);
    free(newton->at.g);
    free(newton->at.p);
    free(newton->r);
    *newton = (Newton){0};
}

void newton_forget(Newton *newton)
{
    const System *system = newton->system;
    newton->lightest = INFINITY;
    for (int i = 0; i < system->nodes; i++)
        newton->lightest = fmin(newton->lightest, system->m[i]);
    newton->stiffest = system_stiffest(system);
    newton->age = -1;
    newton->clamps = 0;
    newton->record.iteration = 0; /* no step was at rest */
    newton->resting = false;
    gauss_seidel_free(&newton->smoother);
}

void newton_rebuild(Newton *newton)
{
    newton_forget(newton);
    search_direction_rebuild(&newton->search);
}

/* The lagged solver looks for its step in a plane. */
static bool uses_plane(const Newton *newton)
{
    return newton->settings.solver == SOLVER_LAGGED &&
           newton->settings.search == LINE_SEARCH_BACKTRACK &&
           incremental_potential_has_plane(newton->system);
}

/* No term, or a single one that knows its minimiser: no matrix is needed. */
static bool has_closed_form(const Newton *newton)
{
    const System *system = newton->system;
    if (system->terms == 0)
        return true;
    return system->terms == 1 &&
           incremental_potential_kind(&newton->at.E, 0)->closed_form;
}

static Status minimise_in_closed_form(Newton *newton)
{
    const System *system = newton->system;
    const IncrementalPotential *E = &newton->at.E;
    Place at = {system, E->x_n, newton->at.u, newton->at.x};
    double sum = 0;
    memcpy(newton->at.p, newton->u_tilde,
           2 * (size_t)system->nodes * sizeof *newton->at.p);
    if (system->terms > 0)
        incremental_potential_kind(E, 0)->closed_form(
            &system->term[0], &at, E->weight, newton->u_tilde, newton->at.p);
    for (int i = 0; i < 2 * system->nodes; i++) {
        if (!system->pinned || !system->pinned[i / 2])
            newton->at.u[i] = newton->at.p[i];
        newton->at.x[i] = E->x_n[i] + newton->at.u[i];
        sum += 0 * newton->at.x[i];
    }
    newton->residual = 0;
    return sum == 0 ? STATUS_OK : STATUS_NOT_FINITE;
}

/* Where springs outweigh the masses beyond the digits of a double, the gradient
 * may be rounding, and along a far direction its slope anything.  Only there
 * each update is held to what E really is, and nothing is smoothed. */
static void prepare_check(Newton *newton)
{
    const IncrementalPotential *E = &newton->at.E;
    newton->margin = -1;
    if (E->weight * newton->stiffest <= 1e16 * newton->lightest)
        return;
    newton->start = incremental_potential_value(E, newton->at.u, newton->at.x);
    newton->energy = newton->start;
    newton->margin =
        1e-12 * incremental_potential_scale(E, newton->at.u, newton->at.x);
}

Status newton_start(Newton *newton, const double *x_n, double weight)
{
    return newton_start_from(newton, x_n, NULL, weight);
}

Status newton_start_from(Newton *newton, const double *x_n, const double *u,
                         double weight)
{
    size_t size = 2 * (size_t)newton->system->nodes;
    memcpy(newton->r, newton->u_tilde, size * sizeof *newton->r);
    newton->at.E =
        (IncrementalPotential){newton->system, weight, x_n, newton->u_tilde,
                               newton->settings.averaged};
    memset(newton->at.u, 0, size * sizeof *newton->at.u);
    memcpy(newton->at.x, x_n, size * sizeof *newton->at.x);
    for (size_t i = 0; u && i < size; i++) {
        newton->at.u[i] = u[i];
        newton->at.x[i] = x_n[i] + u[i];
    }
    newton->resting = newton->record.iteration < 0;
    newton->record = (NewtonRecord){.step = newton->step, .iteration = -1};
    newton->best = INFINITY;
    newton->stagnant = 0;
    newton->counters.minimisations++;
    prepare_check(newton);
    if (has_closed_form(newton))
        return newton->status = minimise_in_closed_form(newton);
    long skipped = newton->counters.skipped;
    newton->status = newton_direction(newton);
    if (newton->counters.skipped > skipped)
        newton->status = newton_check_minimum(newton);
    return newton->status;
}

/* What rounding can make of a decrease: a few units in the last place of E. */
static bool hidden_by_rounding(const Newton *newton, double change)
{
    double E =
        incremental_potential_scale(&newton->at.E, newton->at.u, newton->at.x);
    return isfinite(E) && fabs(change) <= 4 * 2.220446049250313e-16 * E;
}

/* Whether the terms allow u + alpha p; rounding may say no where the reach of
 * p said yes.  Writes over r. */
static bool is_allowed(Newton *newton, double alpha)
{
    const Iterate *at = &newton->at;
    if (!incremental_potential_is_limited(&at->E))
        return true;
    for (int i = 0; i < 2 * newton->system->nodes; i++) {
        newton->r[i] = at->u[i] + alpha * at->p[i];
        at->x[i] = at->E.x_n[i] + newton->r[i];
    }
    bool allowed = incremental_potential_allowed(&at->E, newton->r, at->x);
    for (int i = 0; i < 2 * newton->system->nodes; i++)
        at->x[i] = at->E.x_n[i] + at->u[i];
    return allowed;
}

/* Step length along p (Algorithm 2), from the largest one on that all terms
 * allow. */
static Status search_line(Newton *newton)
{
    NewtonRecord *record = &newton->record;
    record->alpha = incremental_potential_reach(&newton->at);
    Along along = incremental_potential_along(&newton->at, record->alpha);
    Status status = STATUS_OK;
    record->slope = along.smooth.q[0];
    record->trials = 0;
    for (bool allowed = false; !allowed && !status;) {
        int trials = 0;
        if (newton->settings.search == LINE_SEARCH_BACKTRACK)
            status = line_search_backtrack(along_difference, &along,
                                           &record->alpha, &trials);
        record->trials += trials;
        allowed = status || is_allowed(newton, record->alpha);
        if (!allowed)
            record->alpha /= 2;
        if (!allowed && record->alpha < 1e-300)
            status = STATUS_LINE_SEARCH_LIMIT;
    }
    record->change = along_difference(&along, record->alpha);
    return status;
}

/* r = alpha p + beta r, the lowest point in the plane of p and the last
 * update r. */
static Status search_plane(Newton *newton)
{
    NewtonRecord *record = &newton->record;
    double at[2];
    PlaneQuartic plane = incremental_potential_in_plane(&newton->at, newton->r);
    Status status = plane_minimise(&plane, at, &record->trials);
    record->slope = plane.c[0];
    record->alpha = at[0];
    record->change = plane_value(&plane, at[0], at[1]);
    if (status) { /* r so long that rounding hides what p alone can do */
        int trials = record->trials;
        status = search_line(newton);
        record->trials += trials;
        at[0] = record->alpha;
        at[1] = 0;
    }
    for (int i = 0; i < 2 * newton->system->nodes; i++)
        newton->r[i] = at[0] * newton->at.p[i] + at[1] * newton->r[i];
    return status;
}

/* The way to go from x, into the record, and why there is none. */
static Status newton_search(Newton *newton)
{
    double start = newton_clock();
    Status status =
        uses_plane(newton) ? search_plane(newton) : search_line(newton);
    newton->counters.trials += newton->record.trials;
    newton->counters.seconds_search += newton_clock() - start;
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

/* Whether E is as low at u + alpha way as the line search says it is.  Writes
 * over g, and over spare [2n]. */
static bool energy_holds(Newton *newton, const double *way, double alpha,
                         double *spare)
{
    if (newton->margin < 0)
        return true;
    for (int i = 0; i < 2 * newton->system->nodes; i++) {
        newton->at.g[i] = newton->at.u[i] + alpha * way[i];
        spare[i] = newton->at.E.x_n[i] + newton->at.g[i];
    }
    double energy =
        incremental_potential_value(&newton->at.E, newton->at.g, spare);
    if (!(energy <= newton->energy + newton->margin))
        return false;
    newton->energy = energy;
    return true;
}

/* u += alpha p (or r, from the plane), x = x_n + u.  Changes neither where the
 * result would not be finite, or E would rise for all the line search knows. */
static Status newton_update(Newton *newton)
{
    bool plane = uses_plane(newton);
    const double *way = plane ? newton->r : newton->at.p;
    double alpha = plane ? 1 : newton->record.alpha, sum = 0;
    int size = 2 * newton->system->nodes;
    for (int i = 0; i < size; i++)
        sum += 0 * (newton->at.E.x_n[i] + (newton->at.u[i] + alpha * way[i]));
    if (!(sum == 0))
        return STATUS_NOT_FINITE;
    if (newton->settings.search == LINE_SEARCH_BACKTRACK &&
        !energy_holds(newton, way, alpha, plane ? newton->at.p : newton->r)) {
        newton->record.alpha = newton->record.change = 0;
        return STATUS_ROUNDING_LIMIT;
    }
    for (int i = 0; i < size; i++) {
        newton->at.u[i] += alpha * way[i];
        newton->at.x[i] = newton->at.E.x_n[i] + newton->at.u[i];
    }
    newton->counters.iterations++;
    if (newton->age >= 0)
        newton->age++;
    return STATUS_OK;
}

/* What a factor of long ago knows badly, stiffnesses that have changed from one
 * spring to the next, a few sweeps over the nodes put right.  The way they go
 * is a part of the last update. */
static Status newton_smooth(Newton *newton)
{
    if (!uses_plane(newton) || newton->settings.averaged ||
        newton->margin >= 0 || newton->settings.filter == FILTER_NONE ||
        newton->record.iteration < UPDATES_WITHOUT_SMOOTHING)
        return STATUS_OK;
    double start = newton_clock(), change;
    if (!newton->smoother.group) {
        Status status = gauss_seidel_create(newton->system, &newton->smoother);
        if (status)
            return status;
    }
    incremental_potential_gradient(&newton->at.E, newton->at.u, newton->at.x,
                                   newton->at.g);
    int trials =
        gauss_seidel_smooth(&newton->smoother, &newton->at.E, newton->at.g,
                            newton->at.u, newton->at.x, newton->at.p, &change);
    for (int i = 0; i < 2 * newton->system->nodes; i++)
        newton->r[i] += newton->at.p[i];
    newton->record.change += change;
    newton->record.trials += trials;
    newton->counters.trials += trials;
    newton->counters.gradients++;
    newton->counters.smoothings++;
    newton->counters.seconds_smoothing += newton_clock() - start;
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
    double start = newton_clock();
    record->iteration++;
    record->residual = newton->residual;
    Status status = newton_search(newton);
    if (!status)
        status = newton_update(newton);
    if (!status)
        status = newton_smooth(newton);
    NewtonRecord done = *record;
    if (!status)
        status = newton_direction(newton);
    done.seconds = newton_clock() - start;
    done.status = status;
    if (newton->settings.observer &&
        !newton->settings.observer(newton->settings.user, &done))
        status = STATUS_INTERRUPTED;
    if (status == STATUS_RUNNING)
        status = newton_limits(newton);
    return newton->status = status;
}

/* Moves the centre of mass to where u_tilde has it. */
static void move_centre(Newton *newton)
{
    const System *system = newton->system;
    double mass = 0, missing[2] = {0, 0};
    for (int i = 0; i < system->nodes; i++) {
        mass += system->m[i];
        for (int c = 0; c < 2; c++)
            missing[c] += system->m[i] * (newton->u_tilde[2 * i + c] -
                                          newton->at.u[2 * i + c]);
    }
    for (int i = 0; i < 2 * system->nodes; i++) {
        newton->at.u[i] += missing[i % 2] / mass;
        newton->at.x[i] = newton->at.E.x_n[i] + newton->at.u[i];
    }
}

/* Springs alone cannot move the centre of mass: at the minimum sum m u equals
 * sum m u_tilde.  What the tolerance has left of the difference is moved, which
 * lowers E, and linear momentum is conserved to rounding; moved twice, because
 * where springs have hidden the masses the first way is long, and so are its
 * rounding errors.  Where these have cost the square its shape, it keeps the
 * one that it had. */
void newton_finish(Newton *newton)
{
    if (!system_is_free(newton->system) ||
        (newton->status && !status_is_unconverged(newton->status)))
        return;
    for (int i = 0; i < 2; i++)
        move_centre(newton);
    if (newton->margin < 0 || incremental_potential_value(
                                  &newton->at.E, newton->at.u, newton->at.x) <=
                                  newton->start + newton->margin)
        return;
    for (int i = 0; i < 2 * newton->system->nodes; i++)
        newton->at.u[i] = 0;
    move_centre(newton);
    newton->status = STATUS_ROUNDING_LIMIT;
}

Status newton_minimise(Newton *newton, const double *x_n, double weight)
{
    return newton_minimise_from(newton, x_n, NULL, weight);
}

Status newton_minimise_from(Newton *newton, const double *x_n, const double *u,
                            double weight)
{
    Status status = newton_start_from(newton, x_n, u, weight);
    while (status == STATUS_RUNNING)
        status = newton_iterate(newton);
    newton_finish(newton);
    return newton->status;
}
