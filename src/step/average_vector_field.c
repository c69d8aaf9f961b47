#include "step/methods.h"

#include <string.h>

/* One step of length h from new_x, new_v to new_x, new_v. */
static Status avf_substep(TimeIntegrator *integrator, double h)
{
    Newton *newton = integrator->newton;
    double *x = integrator->new_x, *v = integrator->new_v;
    int size = 2 * integrator->system->nodes;
    for (int i = 0; i < size; i++)
        newton->u_tilde[i] = h * v[i];
    Status status = time_integrator_minimise(integrator, x, 0.5 * h * h);
    if (status)
        return status;
    for (int i = 0; i < size; i++) {
        x[i] += newton->at.u[i];
        v[i] = 2 * newton->at.u[i] / h - v[i];
    }
    return STATUS_OK;
}

/* Substeps of the given shares of h, one after the other. */
static Status avf_compose(TimeIntegrator *integrator, const double *share,
                          int count)
{
    size_t bytes = 2 * (size_t)integrator->system->nodes * sizeof(double);
    memcpy(integrator->new_x, integrator->x, bytes);
    memcpy(integrator->new_v, integrator->v, bytes);
    for (int i = 0; i < count; i++) {
        Status status = avf_substep(integrator, share[i] * integrator->h);
        if (status)
            return status;
    }
    return time_integrator_accept(integrator, integrator->new_x,
                                  integrator->new_v);
}

Status avf_step(TimeIntegrator *integrator)
{
    const double whole = 1;
    return avf_compose(integrator, &whole, 1);
}

Status avf4_step(TimeIntegrator *integrator)
{
    const double g = 0.41449077179437571; /* 1/(4 - 4^(1/3)) */
    const double share[5] = {g, g, 1 - 4 * g, g, g};
    return avf_compose(integrator, share, 5);
}
