#include "solve/newton_parts.h"

#include <math.h>

Status line_search_backtrack(EnergyDifference difference, const void *function,
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

/* u_trial = u + alpha p, and x_trial there.  Returns whether the terms allow
 * it; rounding may say no where the reach of p said yes. */
static bool try_step(Newton *newton, double alpha)
{
    const Iterate *at = &newton->at;
    double *u = newton->u_trial, *x = newton->x_trial;
    for (int i = 0; i < 2 * newton->system->nodes; i++) {
        u[i] = at->u[i] + alpha * at->p[i];
        x[i] = at->E.x_n[i] + u[i];
    }
    return incremental_potential_allowed(&at->E, u, x);
}

/* alpha = 1, or the largest that contact leaves of it; halved while E(x + alpha
 * p) > E(x), and while the terms do not allow the place or E itself contradicts
 * the change. */
Status step_length(Newton *newton)
{
    NewtonRecord *record = &newton->record;
    record->alpha = incremental_potential_reach(&newton->at);
    Along along = incremental_potential_along(&newton->at);
    Status status = STATUS_OK;
    record->slope = along.smooth.q[0];
    record->trials = 0;
    for (bool allowed = false; !allowed && !status;) {
        int trials = 0;
        if (newton->settings.search == LINE_SEARCH_BACKTRACK)
            status = line_search_backtrack(along_difference, &along,
                                           &record->alpha, &trials);
        record->trials += trials;
        record->change = along_difference(&along, record->alpha);
        allowed = status || (try_step(newton, record->alpha) &&
                             rounding_confirms(newton));
        if (!allowed)
            record->alpha /= 2;
        if (!allowed && record->alpha < 1e-300)
            status = STATUS_LINE_SEARCH_LIMIT;
    }
    newton->counters.trials += record->trials;
    if (!status)
        return STATUS_OK;
    record->alpha = record->change = 0;
    if (!isfinite(record->slope))
        return STATUS_NOT_FINITE;
    if (rounding_hides(newton, record->slope))
        return STATUS_ROUNDING_LIMIT;
    return record->slope > 0 ? STATUS_NOT_DESCENT : status;
}
