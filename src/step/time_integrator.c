#include "step/time_integrator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "step/methods.h"
#include "step/prescribed.h"

const IntegratorMethod integrator_methods[] = {
    {"backward-euler", "backward Euler", 1, .implicit = true, .at_end = true,
     .damps = true, .step = backward_euler_step},
    {"forward-euler", "forward Euler", 1, .step = forward_euler_step},
    {"symplectic-euler", "symplectic Euler", 1, .step = symplectic_euler_step},
    {"verlet", "velocity Verlet", 2, .memory = 1, .step = verlet_step},
    {"bdf2", "BDF2", 2, .implicit = true, .damps = true, .memory = 2,
     .step = bdf2_step},
    {"midpoint", "implicit midpoint", 2, .implicit = true,
     .step = midpoint_step},
    {"sdirk2", "SDIRK2", 2, .implicit = true, .damps = true,
     .step = sdirk2_step},
    {"avf", "average vector field", 2, .implicit = true, .averaged = true,
     .step = avf_step},
    {"avf4", "AVF, 4th order", 4, .implicit = true, .averaged = true,
     .step = avf4_step},
    {.name = NULL},
};

const IntegratorMethod *integrator_method(const char *name)
{
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        if (strcmp(row->name, name) == 0)
            return row;
    return NULL;
}

const Term *integrator_method_refuses(const IntegratorMethod *method,
                                      const System *system)
{
    for (int t = 0; t < system->terms; t++) {
        const TermKind *kind = system->term[t].kind;
        if ((method->averaged && kind->value && !kind->averaged) ||
            (kind->end_of_step && !method->at_end))
            return &system->term[t];
    }
    return NULL;
}

Status time_integrator_create(const IntegratorMethod *method, System *system,
                              const NewtonSettings *settings, const double *x,
                              const double *v, TimeIntegrator *integrator)
{
    *integrator =
        (TimeIntegrator){.method = method, .system = system, .h = settings->h};
    size_t size = 2 * (size_t)system->nodes;
    if (system_check(system, x) || !all_finite(v, size) ||
        !isfinite(settings->h) || !(settings->h > 0) ||
        !(settings->tolerance > 0) ||
        integrator_method_refuses(method, system) ||
        (system->pin_v && !method->at_end))
        return STATUS_INVALID_INPUT;
    integrator->x = calloc((4 + (size_t)method->memory) * size, sizeof *x);
    integrator->newton =
        method->implicit ? calloc(1, sizeof *integrator->newton) : NULL;
    if (!integrator->x || (method->implicit && !integrator->newton))
        return STATUS_OUT_OF_MEMORY;
    integrator->v = integrator->x + size;
    integrator->new_x = integrator->v + size;
    integrator->new_v = integrator->new_x + size;
    integrator->memory = integrator->new_v + size;
    memcpy(integrator->x, x, size * sizeof *x);
    memcpy(integrator->v, v, size * sizeof *v);
    NewtonSettings own = *settings;
    own.averaged = method->averaged;
    return method->implicit ? newton_create(system, &own, integrator->newton)
                            : STATUS_OK;
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

Status time_integrator_step(TimeIntegrator *integrator)
{
    integrator->status = STATUS_OK;
    integrator->moves = prescribed_begin(integrator);
    if (system_begin(integrator->system, integrator->x, integrator->v,
                     integrator->h))
        time_integrator_forget(integrator, false);
    Status failure = integrator->method->step(integrator);
    if (failure)
        return integrator->status = failure;
    integrator->steps++;
    integrator->clock += integrator->h;
    if (integrator->moves)
        integrator->work +=
            prescribed_work(integrator, integrator->newton->at.E.weight);
    if (system_end(integrator->system, integrator->x, integrator->v,
                   integrator->h))
        time_integrator_forget(integrator, false);
    if (integrator->status)
        integrator->unconverged++;
    return integrator->status;
}

/* u_tilde += weight g */
static void add_gravity(TimeIntegrator *integrator, double weight)
{
    const System *system = integrator->system;
    for (int i = 0; i < 2 * system->nodes; i++)
        integrator->newton->u_tilde[i] += weight * system->gravity[i % 2];
}

Status time_integrator_minimise(TimeIntegrator *integrator, const double *x_n,
                                double weight)
{
    if (system_has_gravity(integrator->system))
        add_gravity(integrator, weight);
    integrator->newton->step = integrator->steps + 1;
    Status status =
        integrator->moves
            ? prescribed_minimise(integrator, x_n, weight)
            : newton_minimise(integrator->newton, x_n, NULL, weight);
    if (!status_is_unconverged(status))
        return status;
    integrator->status = status;
    return STATUS_OK;
}

/* Verlet remembers the acceleration; the others' memory is of motion alone. */
void time_integrator_forget(TimeIntegrator *integrator, bool rebuild)
{
    if (!integrator->newton)
        integrator->remembers = false;
    else if (rebuild)
        newton_rebuild(integrator->newton);
    else
        newton_forget(integrator->newton);
}

Status time_integrator_accept(TimeIntegrator *integrator, const double *new_x,
                              const double *new_v)
{
    size_t size = 2 * (size_t)integrator->system->nodes;
    if (!all_finite(new_x, size) || !all_finite(new_v, size))
        return STATUS_NOT_FINITE;
    memcpy(integrator->x, new_x, size * sizeof *new_x);
    memcpy(integrator->v, new_v, size * sizeof *new_v);
    return STATUS_OK;
}
