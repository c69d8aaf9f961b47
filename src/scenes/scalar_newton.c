#include "scenes/scalar_newton.h"

#include <math.h>

/* The test, and p = -f'(x)/f''(x) */
Status scalar_newton_start(ScalarNewton *newton)
{
    ScalarValues f = scalar_at(&newton->f, newton->x);
    newton->g = f.first;
    newton->p = -f.first / f.second;
    newton->status = STATUS_RUNNING;
    if (fabs(newton->g) <= newton->tolerance)
        newton->status = STATUS_OK;
    else if (!isfinite(newton->p))
        newton->status = STATUS_DIVERGED;
    return newton->status;
}

/* f(x + alpha p) - f(x), as line_search calls it */
static double scalar_difference(const void *function, double alpha)
{
    const ScalarNewton *newton = function;
    return scalar_at(&newton->f, newton->x + alpha * newton->p).value -
           scalar_at(&newton->f, newton->x).value;
}

Status scalar_newton_iterate(ScalarNewton *newton, NewtonRecord *record)
{
    if (newton->status != STATUS_RUNNING)
        return newton->status;
    ScalarValues f = scalar_at(&newton->f, newton->x);
    *record = (NewtonRecord){
        .step = newton->iterations + 1,
        .iteration = newton->iterations,
        .residual = fabs(newton->g),
        .alpha = 1,
        .slope = f.first * newton->p,
        .factorised = true,
        .from = {newton->x, f.value},
    };
    Status status = STATUS_OK;
    if (newton->search == LINE_SEARCH_BACKTRACK)
        status = line_search_backtrack(scalar_difference, newton,
                                       &record->alpha, &record->trials);
    if (status) {
        newton->status = record->slope > 0 ? STATUS_NOT_DESCENT : status;
    } else {
        record->change = scalar_difference(newton, record->alpha);
        newton->x += record->alpha * newton->p;
        newton->iterations++;
        scalar_newton_start(newton);
    }
    record->to[0] = newton->x;
    record->to[1] = scalar_at(&newton->f, newton->x).value;
    record->status = newton->status;
    return newton->status;
}
