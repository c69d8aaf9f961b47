#include "solve/lagged.h"

#include "base/clock.h"
#include "solve/plane_search.h"
#include "solve/step_length.h"

/* Updates after which the solver smooths: easy steps end before. */
enum { UPDATES_WITHOUT_SMOOTHING = 2 };

/* Updates for which it keeps a factor: more iterations against fewer
 * factorisations; 12 ... 48 measured about the same. */
enum { MAX_FACTOR_AGE = 32 };

bool lagged_has_plane(const Newton *newton)
{
    return newton->settings.solver == SOLVER_LAGGED &&
           newton->settings.search == LINE_SEARCH_BACKTRACK &&
           incremental_potential_has_plane(newton->system);
}

bool lagged_keeps_factor(const Newton *newton)
{
    return newton->settings.solver == SOLVER_LAGGED &&
           newton->settings.search == LINE_SEARCH_BACKTRACK &&
           newton->search.age < MAX_FACTOR_AGE;
}

Status lagged_search(Newton *newton)
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
        status = step_length_in_line(newton);
        record->trials += trials;
        at[0] = record->alpha;
        at[1] = 0;
    }
    for (int i = 0; i < 2 * newton->system->nodes; i++)
        newton->r[i] = at[0] * newton->at.p[i] + at[1] * newton->r[i];
    return status;
}

/* The way it goes is a part of the last update. */
Status lagged_smooth(Newton *newton)
{
    if (!lagged_has_plane(newton) || newton->settings.averaged ||
        newton->rounding.held || newton->settings.filter == FILTER_NONE ||
        newton->record.iteration < UPDATES_WITHOUT_SMOOTHING)
        return STATUS_OK;
    double start = clock_now(), change;
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
    newton->counters.seconds_smoothing += clock_now() - start;
    return STATUS_OK;
}
