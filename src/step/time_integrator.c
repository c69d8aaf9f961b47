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
        if ((method->averaged && kind->value && !kind->averages) ||
            (kind->end_of_step && !method->at_end))
            return true;
    }
    return false;
}

Status time_integrator_create(const IntegratorMethod *method, System *system,
                              const NewtonSettings *settings, const double *x,
                              const double *v, TimeIntegrator *integrator)
{
    size_t size = 2 * (size_t)system->nodes;
    *integrator = (TimeIntegrator){
        .method = method, .system = system, .size = size, .h = settings->h};
    if (system_check(system, x) || !all_finite(v, size) ||
        !isfinite(settings->h) || !(settings->h > 0) ||
        !(settings->tolerance > 0) ||
        integrator_method_refuses(method, system) ||
        (system->pin_v && !method->at_end))
        return STATUS_INVALID_INPUT;
    integrator->x = calloc((4 + (size_t)method->memory) * size, sizeof *x);
    if (!integrator->x)
        return STATUS_OUT_OF_MEMORY;
    integrator->v = integrator->x + size;
    integrator->new_x = integrator->v + size;
    integrator->new_v = integrator->new_x + size;
    integrator->memory = integrator->new_v + size;
    memcpy(integrator->x, x, size * sizeof *x);
    memcpy(integrator->v, v, size * sizeof *v);
    if (!method->implicit)
        return STATUS_OK;
    NewtonSettings own = *settings;
    own.averaged = method->averaged;
    integrator->newton = calloc(1, sizeof *integrator->newton);
    return integrator->newton ? newton_create(system, &own, integrator->newton)
                              : STATUS_OUT_OF_MEMORY;
}

void time_integrator_free(TimeIntegrator *integrator)
{
    if (!integrator)
        return;
    newton_free(integrator->newton);
    free(integrator->newton);
    free(integrator->x);
    *integrator = (TimeIntegrator){0};
}

/* Where the hand pulls in this step. */
static void begin_hand(TimeIntegrator *integrator)
{
    System *system = integrator->system;
    Pull *hand = hand_energy_of(system);
    double *free = NULL;
    if (!hand)
        return;
    size_t i = 2 * (size_t)hand->node;
    if (!integrator->newton) {
        hand->k = 0;
        system_acceleration(system, integrator->x, integrator->new_x);
        free = integrator->new_x + i;
        integrator->memory_h = 0; /* it was another force */
    }
    hand_follow(hand, integrator->x + i, integrator->v + i,
                system->m[hand->node], integrator->h, free);
    system_changed(system, false);
}

/* All stages are over, or one failed. */
static Status end_step(TimeIntegrator *integrator, Status failure)
{
    size_t both = 2 * integrator->size; /* v is behind x, new_v behind new_x */
    if (!failure && !all_finite(integrator->new_x, both)) {
        integrator->memory_h = 0;
        failure = STATUS_NOT_FINITE;
    }
    if (failure)
        return integrator->status = failure;
    const Pull *hand = hand_energy_of(integrator->system);
    if (hand)
        integrator->work += hand_work(hand, integrator->x + 2 * hand->node,
                                      integrator->new_x + 2 * hand->node);
    memcpy(integrator->x, integrator->new_x, both * sizeof(double));
    integrator->steps++;
    integrator->clock += integrator->h;
    if (integrator->moves)
        integrator->work +=
            prescribed_work(integrator, integrator->newton->at.E.weight);
    System *system = integrator->system;
    for (int t = 0; t < system->terms; t++)
        if (system->term[t].kind->end)
            system->term[t].kind->end(&system->term[t], system, integrator->x,
                                      integrator->v, integrator->h);
    return integrator->status;
}

/* The minimisation of the present stage begins. */
static Status begin_stage(TimeIntegrator *integrator)
{
    const System *system = integrator->system;
    Newton *newton = integrator->newton;
    integrator->x_n = integrator->x;
    integrator->method->aim(integrator);
    if (system_has_gravity(system))
        for (size_t i = 0; i < integrator->size; i++)
            newton->u_tilde[i] += integrator->weight * system->gravity[i % 2];
    newton->step = integrator->steps + 1;
    return integrator->moves ? prescribed_start(integrator)
                             : newton_start(newton, integrator->x_n, NULL,
                                            integrator->weight);
}

/* From a minimisation that is over to the next one, to the end where none is
 * left. */
static Status go_on(TimeIntegrator *integrator, Status status)
{
    while (status != STATUS_RUNNING) {
        newton_finish(integrator->newton);
        status = integrator->newton->status;
        if (integrator->moves && prescribed_goes_on(integrator, &status)) {
            status = prescribed_start(integrator);
            continue;
        }
        if (status && !status_is_unconverged(status))
            return end_step(integrator, status);
        if (status)
            integrator->status = status;
        integrator->method->land(integrator);
        if (++integrator->stage == integrator->method->stages)
            return end_step(integrator, STATUS_OK);
        status = begin_stage(integrator);
    }
    return STATUS_RUNNING;
}

Status time_integrator_begin(TimeIntegrator *integrator)
{
    System *system = integrator->system;
    Status status = STATUS_OK;
    integrator->status = STATUS_OK;
    integrator->stage = 0;
    if (integrator->newton)
        integrator->newton->change = 0;
    integrator->moves = prescribed_begin(integrator);
    for (int t = 0; t < system->terms && !status; t++)
        if (system->term[t].kind->begin)
            status = system->term[t].kind->begin(&system->term[t], system,
                                                 integrator->x, integrator->v,
                                                 integrator->h);
    if (status)
        return end_step(integrator, status);
    begin_hand(integrator);
    if (integrator->newton)
        return go_on(integrator, begin_stage(integrator));
    integrator->method->land(integrator);
    return end_step(integrator, STATUS_OK);
}

Status time_integrator_iterate(TimeIntegrator *integrator)
{
    return go_on(integrator, newton_iterate(integrator->newton));
}

Status time_integrator_step(TimeIntegrator *integrator)
{
    Status status = time_integrator_begin(integrator);
    while (status == STATUS_RUNNING)
        status = time_integrator_iterate(integrator);
    return status;
}

/* A Newton object of its own: nothing that the run remembers is touched. */
Status time_integrator_balances(const TimeIntegrator *integrator,
                                double distance, bool *balances)
{
    const System *system = integrator->system;
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
    for (size_t i = 0; i < integrator->size && !status; i++)
        newton.u_tilde[i] = weight * system->gravity[i % 2];
    if (!status)
        status = newton_start(&newton, integrator->x, NULL, weight);
    *balances = status == STATUS_OK || status == STATUS_NOT_A_MINIMUM ||
                newton.bends_down;
    bool decided = *balances || status == STATUS_RUNNING;
    newton_free(&newton);
    return decided ? STATUS_OK : status;
}
