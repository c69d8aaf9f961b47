/* newton.c - the loop of projected Newton with line search. */
#include "solve/newton_parts.h"

#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "solve/multigrid.h"

void newton_start(Newton *newton, const double *x_n, const double *u,
                  double weight, double tolerance)
{
    Iterate *at = &newton->iterate;
    int size = 2 * newton->system->nodes;
    at->E =
        (IncrementalPotential){newton->system, weight, x_n, newton->u_tilde};
    for (int i = 0; i < size; i++) {
        at->u[i] = u ? u[i] : 0;
        at->x[i] = x_n[i] + at->u[i];
    }
    newton->tolerance = tolerance;
    newton->status = STATUS_RUNNING;
    newton->record =
        (NewtonRecord){.step_number = newton->step_number, .iteration = -1};
    newton->has_gradient = false;
    newton->factored_hessian.moved_since_factor = INFINITY; /* no factor yet */
    newton->clamped_iterations_left = 0;
    newton->change_sum = newton->change_abs_sum = 0;
    rounding_prepare(newton);
    newton->active_solver =
        multigrid_accepts_problem(newton) ? SOLVER_MULTIGRID : SOLVER_NEWTON;
}

/* Makes the trial point, u + alpha p, the iterate.  The iterate stays if the
 * trial point is not finite or, with a line search, its E exceeds the limit. */
static Status update_iterate(Newton *newton)
{
    const bool is_finite =
        all_finite(newton->x_trial, 2 * (size_t)newton->system->nodes);
    if (!is_finite ||
        (newton->settings.line_search != LINE_SEARCH_NONE &&
         !energy_is_within_limit(newton, newton->u_trial, newton->x_trial))) {
        newton->record.alpha = newton->record.energy_change = 0;
        return is_finite ? STATUS_ROUNDING_LIMIT : STATUS_NOT_FINITE;
    }
    swap_iterates(newton);
    newton->factored_hessian.moved_since_factor +=
        newton->record.alpha * newton->record.residual * newton->settings.h;
    newton->rounding.E = newton->rounding.E_trial;
    newton->has_gradient = false;
    newton->counters.updates++;
    return STATUS_OK;
}

/* Decides, after the turn of a free body, whether the loop ends: p or a bound
 * of the next p passes the test, a failure, rounding, too many iterations.  If
 * p passes and rounding hides the decrease of E, the step has converged without
 * p.  Without a line search an end above the start is DIVERGED.
 *   status  in, result of direction, step length and update */
static Status test_convergence(Newton *newton, Status status)
{
    bool hidden = status == STATUS_ROUNDING_LIMIT;
    if (hidden || status == STATUS_OK)
        newton->record.energy_change += turn_free_body(newton);
    if (newton->meets_tolerance && (status == STATUS_OK || hidden))
        status = STATUS_OK;
    else if (status == STATUS_OK && next_direction_is_negligible(newton))
        status = STATUS_OK;
    else if (status == STATUS_OK)
        status = rounding_test_stagnation(newton);
    if (status == STATUS_RUNNING &&
        newton->record.iteration + 1 >= newton_iteration_limit(newton))
        status = STATUS_ITERATION_LIMIT;
    bool ended = status == STATUS_OK || status == STATUS_NOT_FINITE ||
                 status_is_unconverged(status);
    if (ended && newton->settings.line_search == LINE_SEARCH_NONE &&
        !energy_is_within_limit(newton, newton->iterate.u, newton->iterate.x))
        status = STATUS_DIVERGED;
    return status;
}

/* Adds the change of E in this minimisation to total_energy_change: the sum of
 * the updates' changes, each exact along its line, or, if E was so high in
 * between that the sum has lost more digits, E at the end - E at the start. */
static void add_energy_change(Newton *newton)
{
    const Iterate *at = &newton->iterate;
    const double first = newton->rounding.start_energy;
    double change = newton->change_sum;
    if (!isnan(first)) {
        double last = incremental_potential_value(&at->E, at->u, at->x);
        if (newton->change_abs_sum > fabs(first) + fabs(last))
            change = last - first;
    }
    newton->total_energy_change += change;
    newton->counters.indefinite_convergences +=
        newton->status == STATUS_OK && newton->record.negative_pivots > 0;
}

/* The four phases of an iteration are functions of direction.c, line_search.c
 * and this file.  Large squares use those of multigrid.c. */
static const NewtonPhases newton_phases = {find_direction, find_step_length,
                                           update_iterate, test_convergence};

/* Algorithm 3 of the slides:
 *
 *     do
 *         p = -H^-1 grad E, H projected
 *         alpha = backtracking line search
 *         x = x + alpha p
 *     while residual > tolerance, unless the next p is negligible
 *
 * The last p, too, is added to x, unless rounding hides that E falls along p.
 * The result is then 10 to 1e11 times more accurate.  The course's Python
 * tests p before the update of x, and throws the last p away. */
Status newton_minimise(Newton *newton)
{
    NewtonRecord *record = &newton->record;
    bool pauses = false;
    while (newton->status == STATUS_RUNNING && !pauses) {
        const NewtonPhases *phases = newton->active_solver == SOLVER_MULTIGRID
                                         ? &multigrid_phases
                                         : &newton_phases;
        double start = clock_now();
        *record = (NewtonRecord){.step_number = newton->step_number,
                                 .iteration = record->iteration + 1,
                                 .solver = newton->active_solver};

        /* Find the search direction p */
        Status status = phases->find_direction(newton);

        /* Find the step length alpha */
        if (status == STATUS_OK)
            status = phases->find_step_length(newton);

        /* Update x */
        if (status == STATUS_OK)
            status = phases->update_iterate(newton);

        /* Decide whether the loop ends; find_direction has tested p */
        record->status = newton->status =
            phases->test_convergence(newton, status);

        newton->change_sum += record->energy_change;
        newton->change_abs_sum += fabs(record->energy_change);
        record->seconds = clock_now() - start;
        pauses = newton->settings.observer &&
                 !newton->settings.observer(newton->settings.user_data, record);
    }
    if (newton->status != STATUS_RUNNING)
        add_energy_change(newton);
    return newton->status;
}

Status newton_create(const System *system, const NewtonSettings *settings,
                     Newton *newton)
{
    *newton = (Newton){.settings = *settings, .system = system};
    size_t size = 2 * (size_t)system->nodes;
    FactoredHessian *direction = &newton->factored_hessian;
    double *next = newton->memory = calloc(12 * size, sizeof *next);
    double **array[] = {
        &newton->iterate.u, &newton->iterate.x, &newton->iterate.g,
        &newton->iterate.p, &newton->u_tilde,   &newton->u_trial,
        &direction->b,      &direction->r,      &direction->z,
        &direction->q,      &direction->d,      &newton->x_trial};
    for (size_t i = 0; next && i < sizeof array / sizeof *array; i++)
        *array[i] = next + i * size;
    return next ? STATUS_OK : STATUS_OUT_OF_MEMORY;
}

void newton_free(Newton *newton)
{
    if (!newton)
        return;
    direction_free_matrix(&newton->factored_hessian);
    multigrid_free(newton->multigrid);
    free(newton->memory);
    *newton = (Newton){0};
}

/* NewtonCounters has members of type long only. */
void newton_counters_add(const NewtonCounters *counters, NewtonCounters *sum)
{
    const long *more = &counters->updates;
    for (size_t i = 0; i < sizeof *sum / sizeof *more; i++)
        (&sum->updates)[i] += more[i];
}
