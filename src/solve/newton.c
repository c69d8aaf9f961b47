#include "solve/newton_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "solve/multigrid.h"

/* Algorithm 3 of the slides.  Like the course's Python it tests p before it
 * uses it, where the slide tests afterwards: one update less, the same
 * accuracy.
 *
 *     p = -H^-1 grad E                           (direction.c)
 *     while |p|_inf / h > tolerance
 *         alpha: backtracking line search        (line_search.c)
 *         x = x + alpha p
 *         p = -H^-1 grad E
 */

/* From u = 0 or another displacement; then p there, and the test. */
Status newton_start(Newton *newton, const double *x_n, const double *u,
                    double weight)
{
    Iterate *at = &newton->at;
    int size = 2 * newton->system->nodes;
    at->E =
        (IncrementalPotential){newton->system, weight, x_n, newton->u_tilde};
    for (int i = 0; i < size; i++) {
        at->u[i] = u ? u[i] : 0;
        at->x[i] = x_n[i] + at->u[i];
    }
    newton->tolerance = newton->settings.tolerance;
    if (newton->rough)
        newton->tolerance = 10 * newton->tolerance + 0.01;
    newton->rough = false;
    newton->saddles = 0;
    newton->clamps = 0;
    newton->lent = false;
    newton->sum = newton->size = 0;
    newton->record = (NewtonRecord){.step = newton->step, .iteration = -1};
    rounding_start(newton);
    newton->residual = 0;
    newton->kind = RESIDUAL_VALUE;
    newton->status = incremental_potential_solve(at);
    if (newton->status == STATUS_RUNNING)
        newton->status = multigrid_takes(newton) ? multigrid_start(newton)
                                                 : direction_first(newton);
    return newton->status;
}

/* u += alpha p, x = x_n + u, as they were tried.  Changes neither where the
 * result would not be finite, or E would rise for all the line search knows. */
static Status newton_update(Newton *newton)
{
    Iterate *at = &newton->at;
    size_t size = 2 * (size_t)newton->system->nodes;
    if (!all_finite(newton->x_trial, size))
        return STATUS_NOT_FINITE;
    if (newton->settings.search != LINE_SEARCH_NONE &&
        !rounding_is_low(newton, newton->u_trial, newton->x_trial)) {
        newton->record.alpha = newton->record.change = 0;
        return STATUS_ROUNDING_LIMIT;
    }
    memcpy(at->u, newton->u_trial, size * sizeof *at->u);
    memcpy(at->x, newton->x_trial, size * sizeof *at->x);
    newton->rounding.E = newton->rounding.E_trial;
    newton->counters.iterations++;
    return STATUS_OK;
}

/* Updates of larger squares take longer: they get fewer, so that a step takes
 * seconds at the most, but as many as this at least. */
enum { UPDATES_TIMES_NODES = 250000, LEAST_LIMIT = 1000 };

int newton_most_iterations(const Newton *newton)
{
    int most = UPDATES_TIMES_NODES / newton->system->nodes;
    most = most > LEAST_LIMIT ? most : LEAST_LIMIT;
    return most < newton->settings.max_iterations
               ? most
               : newton->settings.max_iterations;
}

/* What ends the loop besides the test: rounding, and the number of iterations.
 * Without a line search an end above the start is no success. */
static Status newton_limits(Newton *newton, Status status)
{
    if (status == STATUS_RUNNING)
        status = rounding_stagnation(newton);
    if (status == STATUS_RUNNING &&
        newton->record.iteration + 1 >= newton_most_iterations(newton))
        status = STATUS_ITERATION_LIMIT;
    if (newton->bends_down &&
        (status == STATUS_ROUNDING_LIMIT || status == STATUS_LINE_SEARCH_LIMIT))
        status = STATUS_NOT_A_MINIMUM;
    bool ended = status == STATUS_OK || status == STATUS_NOT_FINITE ||
                 status_is_unconverged(status);
    if (ended && newton->settings.search == LINE_SEARCH_NONE &&
        !rounding_is_low(newton, newton->at.u, newton->at.x))
        status = STATUS_DIVERGED;
    return status;
}

/* Adds the record's change of E, and shows it to the observer.  Returns its
 * status, or INTERRUPTED where the observer asks to stop. */
static Status tell(Newton *newton, const NewtonRecord *record)
{
    const NewtonSettings *settings = &newton->settings;
    newton->sum += record->change;
    newton->size += fabs(record->change);
    if (settings->observer && !settings->observer(settings->user, record))
        return STATUS_INTERRUPTED;
    return record->status;
}

Status newton_iterate(Newton *newton)
{
    if (newton->status != STATUS_RUNNING)
        return newton->status;
    double start = clock_now();
    NewtonRecord done;
    newton->record.iteration++;
    newton->record.residual = newton->residual;
    newton->record.kind = newton->kind;
    Status status;
    if (newton->working == SOLVER_MULTIGRID) {
        status = multigrid_iterate(newton, &done);
    } else {
        status = step_length(newton);
        if (!status)
            status = newton_update(newton);
        done = newton->record; /* what it tells of these two */
        if (!status)
            status =
                newton->lent ? multigrid_start(newton) : direction_next(newton);
        status = newton_limits(newton, status);
    }
    done.status = status;
    done.seconds = clock_now() - start;
    return newton->status = tell(newton, &done);
}

/* Moves the centre of mass to where u_tilde has it. */
static void move_centre(Newton *newton)
{
    const System *system = newton->system;
    const double *x_n = newton->at.E.x_n, *u_tilde = newton->u_tilde;
    double *u = newton->at.u, *x = newton->at.x;
    double mass = 0, missing[2] = {0, 0};
    for (int i = 0; i < system->nodes; i++) {
        mass += system->m[i];
        for (int c = 0; c < 2; c++)
            missing[c] += system->m[i] * (u_tilde[2 * i + c] - u[2 * i + c]);
    }
    double by[2] = {missing[0] / mass, missing[1] / mass};
    newton->sum -= 0.5 * (by[0] * missing[0] + by[1] * missing[1]);
    for (int i = 0; i < system->nodes; i++)
        for (int c = 0; c < 2; c++) {
            u[2 * i + c] += by[c];
            x[2 * i + c] = x_n[2 * i + c] + u[2 * i + c];
        }
}

/* Internal forces cannot move the centre of mass: at the minimum sum m u equals
 * sum m u_tilde.  The tolerance leaves a difference; to remove it moves all
 * nodes alike, lowers E, and conserves linear momentum to rounding.  The second
 * move removes the rounding errors of the first, which is long where springs
 * are stiff beyond the digits of the masses.  If E has risen even so, all nodes
 * make the centre's way from x_n instead; where contacts have so little way
 * left that even this rounding is too much, nothing is moved.
 *
 * The change of E is the sum of the changes, each of which is exact along its
 * line; or the difference of E at end and start, where E was so high in between
 * that the sum has lost more digits. */
void newton_finish(Newton *newton)
{
    const Iterate *at = &newton->at;
    const double first = newton->rounding.first;
    Status before = newton->status;
    bool usable = !before || status_is_unconverged(before);
    if (usable && system_is_free(newton->system)) {
        size_t bytes = 2 * (size_t)newton->system->nodes * sizeof *at->u;
        memcpy(newton->u_trial, at->u, bytes);
        memcpy(newton->x_trial, at->x, bytes);
        move_centre(newton);
        move_centre(newton);
        if (!incremental_potential_allowed(&at->E, at->u, at->x)) {
            memcpy(at->u, newton->u_trial, bytes);
            memcpy(at->x, newton->x_trial, bytes);
            newton->status = STATUS_ROUNDING_LIMIT;
            newton->size = INFINITY;
        } else if (before != STATUS_DIVERGED &&
                   !rounding_is_low(newton, at->u, at->x)) {
            for (int i = 0; i < 2 * newton->system->nodes; i++)
                at->u[i] = 0;
            move_centre(newton);
            newton->status = STATUS_ROUNDING_LIMIT;
            newton->size = INFINITY; /* the sum is that of another way */
        }
    }
    if (usable && (newton->record.iteration < 0 || newton->status != before)) {
        NewtonRecord end = {.step = newton->step, /* no iteration has told it */
                            .iteration = -1,
                            .residual = newton->residual,
                            .kind = newton->kind,
                            .status = newton->status};
        newton->status = tell(newton, &end);
    }
    double change = newton->sum;
    if (!isnan(first)) {
        double last = incremental_potential_value(&at->E, at->u, at->x);
        if (newton->size > fabs(first) + fabs(last))
            change = last - first;
    }
    newton->change += change;
}

Status newton_minimise(Newton *newton, const double *x_n, const double *u,
                       double weight)
{
    Status status = newton_start(newton, x_n, u, weight);
    while (status == STATUS_RUNNING)
        status = newton_iterate(newton);
    newton_finish(newton);
    return newton->status;
}

Status newton_create(const System *system, const NewtonSettings *settings,
                     Newton *newton)
{
    *newton = (Newton){.settings = *settings, .system = system};
    size_t size = 2 * (size_t)system->nodes;
    SearchDirection *search = &newton->search;
    double *next = newton->at.u = calloc(12 * size, sizeof *next);
    double **array[] = {&newton->at.x,    &newton->at.g,    &newton->at.p,
                        &newton->u_tilde, &newton->u_trial, &search->b,
                        &search->r,       &search->z,       &search->q,
                        &search->d,       &newton->x_trial};
    for (size_t i = 0; next && i < sizeof array / sizeof *array; i++)
        *array[i] = next += size;
    return next ? STATUS_OK : STATUS_OUT_OF_MEMORY;
}

void newton_free(Newton *newton)
{
    if (!newton)
        return;
    direction_free_matrix(&newton->search);
    multigrid_free(newton->multigrid);
    free(newton->at.u);
    *newton = (Newton){0};
}

/* All of them are long. */
void newton_counters_add(const NewtonCounters *counters, NewtonCounters *sum)
{
    const long *more = &counters->iterations;
    for (size_t i = 0; i < sizeof *sum / sizeof *more; i++)
        (&sum->iterations)[i] += more[i];
}
