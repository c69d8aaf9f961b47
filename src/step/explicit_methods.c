#include "step/methods.h"

/* v_(n+1) = v_n + h a(x_n), into new_v. */
static void kick(TimeIntegrator *integrator)
{
    double *new_v = integrator->new_v;
    system_acceleration(integrator->system, integrator->x, new_v);
    for (int i = 0; i < 2 * integrator->system->nodes; i++)
        new_v[i] = integrator->v[i] + integrator->h * new_v[i];
}

/* x_(n+1) = x_n + h v, into new_x. */
static void drift(TimeIntegrator *integrator, const double *v)
{
    for (int i = 0; i < 2 * integrator->system->nodes; i++)
        integrator->new_x[i] = integrator->x[i] + integrator->h * v[i];
}

Status forward_euler_step(TimeIntegrator *integrator)
{
    kick(integrator);
    drift(integrator, integrator->v);
    return time_integrator_accept(integrator, integrator->new_x,
                                  integrator->new_v);
}

Status symplectic_euler_step(TimeIntegrator *integrator)
{
    kick(integrator);
    drift(integrator, integrator->new_v);
    return time_integrator_accept(integrator, integrator->new_x,
                                  integrator->new_v);
}

/* x_(n+1) = x_n + h v_n + h^2/2 a_n, v_(n+1) = v_n + h/2 (a_n + a_(n+1)) */
Status verlet_step(TimeIntegrator *integrator)
{
    double *a = integrator->memory, h = integrator->h;
    int size = 2 * integrator->system->nodes;
    if (!integrator->remembers)
        system_acceleration(integrator->system, integrator->x, a);
    integrator->remembers = false; /* until this step is accepted */
    for (int i = 0; i < size; i++) {
        integrator->new_v[i] = integrator->v[i] + 0.5 * h * a[i];
        integrator->new_x[i] = integrator->x[i] + h * integrator->new_v[i];
    }
    system_acceleration(integrator->system, integrator->new_x, a);
    for (int i = 0; i < size; i++)
        integrator->new_v[i] += 0.5 * h * a[i];
    Status status = time_integrator_accept(integrator, integrator->new_x,
                                           integrator->new_v);
    integrator->remembers = !status;
    return status;
}
