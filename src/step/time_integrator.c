#include "step/time_integrator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/pull_energy.h"
#include "step/prescribed.h"

const IntegratorMethod *integrator_method(const char *name)
{
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        if (strcmp(row->name, name) == 0)
            return row;
    return NULL;
}

bool integrator_method_refuses(const IntegratorMethod *method,
                               const System *system)
{
    for (int t = 0; t < system->terms; t++) {
        const TermKind *kind = system->term[t].kind;
        if ((method->averaged && kind->remainder) ||
            (kind->end_of_step && !method->at_end))
            return true;
    }
    return false;
}

Status time_integrator_create(const IntegratorMethod *method, System *system,
                              const NewtonSettings *settings, const double *x,
                              const double *v, TimeIntegrator *run)
{
    size_t size = 2 * (size_t)system->nodes;
    *run = (TimeIntegrator){
        .method = method, .system = system, .size = size, .h = settings->h};
    if (system_check(system, x) || !all_finite(v, size) ||
        !isfinite(settings->h) || !(settings->h > 0) ||
        !(settings->tolerance > 0) ||
        integrator_method_refuses(method, system) ||
        (system->pin_v && !method->at_end))
        return STATUS_INVALID_INPUT;
    run->x = calloc((4 + (size_t)method->memory) * size, sizeof *x);
    if (!run->x)
        return STATUS_OUT_OF_MEMORY;
    run->v = run->x + size;
    run->new_x = run->v + size;
    run->new_v = run->new_x + size;
    run->memory = run->new_v + size;
    memcpy(run->x, x, size * sizeof *x);
    memcpy(run->v, v, size * sizeof *v);
    if (!method->implicit)
        return STATUS_OK;
    NewtonSettings own = *settings;
    own.averaged = method->averaged;
    run->newton = calloc(1, sizeof *run->newton);
    return run->newton ? newton_create(system, &own, run->newton)
                       : STATUS_OUT_OF_MEMORY;
}

void time_integrator_free(TimeIntegrator *run)
{
    newton_free(run->newton);
    free(run->newton);
    free(run->x);
    *run = (TimeIntegrator){0};
}

/* All stages are over, or one failed. */
static Status end_step(TimeIntegrator *run, Status failure)
{
    size_t both = 2 * run->size; /* v is behind x, new_v behind new_x */
    if (!failure && !all_finite(run->new_x, both)) {
        run->memory_h = 0;
        failure = STATUS_NOT_FINITE;
    }
    if (failure)
        return run->status = failure;
    const Pull *hand = system_data(run->system, &hand_energy);
    if (hand)
        run->work += hand_work(hand, run->x + 2 * hand->node,
                               run->new_x + 2 * hand->node);
    memcpy(run->x, run->new_x, both * sizeof(double));
    run->steps++;
    run->clock += run->h;
    if (run->moves)
        run->work += prescribed_work(run, run->newton->at.E.weight);
    System *system = run->system;
    for (int t = 0; t < system->terms; t++)
        if (system->term[t].kind->end)
            system->term[t].kind->end(
                &(TermStep){system, &system->term[t], run->x, run->v, run->h});
    return run->status;
}

/* The minimisation of the present stage begins. */
static Status begin_stage(TimeIntegrator *run)
{
    const System *system = run->system;
    Newton *newton = run->newton;
    run->x_n = run->x;
    run->method->aim(run);
    if (system_has_gravity(system))
        for (size_t i = 0; i < run->size; i++)
            newton->u_tilde[i] += run->weight * system->gravity[i % 2];
    newton->step = run->steps + 1;
    return run->moves ? prescribed_start(run)
                      : newton_start(newton, run->x_n, NULL, run->weight);
}

/* From a minimisation that is over to the next one, to the end where none is
 * left. */
static Status go_on(TimeIntegrator *run, Status status)
{
    while (status != STATUS_RUNNING) {
        newton_finish(run->newton);
        status = run->newton->status;
        if (run->moves && prescribed_goes_on(run, &status)) {
            status = prescribed_start(run);
            continue;
        }
        if (status && !status_is_unconverged(status))
            return end_step(run, status);
        if (status)
            run->status = status;
        run->method->land(run);
        if (++run->stage == run->method->stages)
            return end_step(run, STATUS_OK);
        status = begin_stage(run);
    }
    return STATUS_RUNNING;
}

Status time_integrator_begin(TimeIntegrator *run)
{
    System *system = run->system;
    Status status = STATUS_OK;
    run->status = STATUS_OK;
    run->stage = 0;
    if (run->newton)
        run->newton->change = 0;
    run->moves = prescribed_begin(run);
    for (int t = 0; t < system->terms && !status; t++)
        if (system->term[t].kind->begin)
            status = system->term[t].kind->begin(
                &(TermStep){system, &system->term[t], run->x, run->v, run->h});
    if (status)
        return end_step(run, status);
    Pull *hand = system_data(system, &hand_energy);
    if (hand) { /* where it pulls in this step */
        size_t i = 2 * (size_t)hand->node;
        if (!run->newton) {
            hand->k = 0;
            system_acceleration(system, run->x, run->new_x);
            run->memory_h = 0; /* it was another force */
        }
        hand_follow(hand, run->x + i, run->v + i, system->m[hand->node], run->h,
                    run->newton ? NULL : run->new_x + i);
        system_changed(system, false);
    }
    if (run->newton)
        return go_on(run, begin_stage(run));
    run->method->land(run);
    return end_step(run, STATUS_OK);
}

Status time_integrator_iterate(TimeIntegrator *run)
{
    return go_on(run, newton_iterate(run->newton));
}

Status time_integrator_step(TimeIntegrator *run)
{
    Status status = time_integrator_begin(run);
    while (status == STATUS_RUNNING)
        status = time_integrator_iterate(run);
    return status;
}

/* A Newton object of its own: nothing that the run remembers is touched. */
Status time_integrator_balances(const TimeIntegrator *run, double distance,
                                bool *balances)
{
    const System *system = run->system;
    double lightest = INFINITY, stiffest, force;
    for (int i = 0; i < system->nodes; i++)
        lightest = fmin(lightest, system->m[i]);
    system_bounds(system, &stiffest, &force);
    double weight = stiffest > 0 ? 0.99e10 * lightest / stiffest : 1;
    NewtonSettings settings = {.h = sqrt(weight),
                               .tolerance = distance / sqrt(weight),
                               .solver = SOLVER_AUTO,
                               .filter = FILTER_CLAMP,
                               .search = LINE_SEARCH_BACKTRACK};
    Newton newton;
    Status status = newton_create(system, &settings, &newton);
    for (size_t i = 0; i < run->size && !status; i++)
        newton.u_tilde[i] = weight * system->gravity[i % 2];
    if (!status)
        status = newton_start(&newton, run->x, NULL, weight);
    *balances = status == STATUS_OK || status == STATUS_NOT_A_MINIMUM ||
                newton.bends_down;
    bool decided = *balances || status == STATUS_RUNNING;
    newton_free(&newton);
    return decided ? STATUS_OK : status;
}
