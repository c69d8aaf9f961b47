/* line_search.c - step length along p by backtracking (slide: Algorithm 2). */
#include "solve/newton_parts.h"

#include <math.h>

Status line_search_backtrack(EnergyFunction difference, const void *function,
                             double *alpha, int *trials)
{
    for (*trials = 0; *trials <= LINE_SEARCH_MAX_HALVINGS; *alpha /= 2) {
        ++*trials;
        if (difference(function, *alpha) <= 0)
            return STATUS_OK;
    }
    *alpha = 0;
    return STATUS_LINE_SEARCH_LIMIT;
}

typedef struct LineSearchContext {
    Newton *newton;
    LineEnergy energy;
} LineSearchContext;

/* Returns E(x + alpha p) - E(x), or 0 without a line search.  NaN: a term does
 * not allow the point x + alpha p, or energy_confirms_change rejects the
 * difference.  Writes the point to u_trial and x_trial, unless a line search
 * finds that E rises. */
static double trial_energy_difference(const void *function, double alpha)
{
    const LineSearchContext *search = function;
    Newton *newton = search->newton;
    const Iterate *at = &newton->iterate;
    double *u = newton->u_trial, *x = newton->x_trial;
    bool searches = newton->settings.line_search == LINE_SEARCH_BACKTRACK;
    double change = line_energy_difference(&search->energy, alpha);
    newton->record.energy_change = change;
    if (searches && !(change <= 0))
        return change;
    for (int i = 0; i < 2 * newton->system->nodes; i++) {
        u[i] = at->u[i] + alpha * at->p[i];
        x[i] = at->E.x_n[i] + u[i];
    }
    /* Rounding may make a point infeasible that the largest step allows. */
    bool allowed = incremental_potential_is_feasible(&at->E, u, x) &&
                   energy_confirms_change(newton);
    return !allowed ? NAN : searches ? change : 0;
}

Status find_step_length(Newton *newton)
{
    NewtonRecord *record = &newton->record;
    LineSearchContext search = {newton, make_line_energy(&newton->iterate)};
    record->alpha = incremental_potential_max_alpha(&newton->iterate);
    record->slope = search.energy.polynomial.q[0];
    Status status = line_search_backtrack(trial_energy_difference, &search,
                                          &record->alpha, &record->trials);
    if (newton->settings.line_search == LINE_SEARCH_NONE)
        record->trials = 0;
    if (!status)
        return STATUS_OK;
    record->energy_change = 0;
    if (!isfinite(record->slope))
        return STATUS_NOT_FINITE;
    if (is_below_roundoff(newton, record->slope))
        return STATUS_ROUNDING_LIMIT;
    return record->slope > 0 ? STATUS_NOT_DESCENT : status;
}
