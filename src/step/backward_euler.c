#include "step/backward_euler.h"

/* With u = x - x_n: u_tilde = h v_n, and v_(n+1) = u/h. */
Status backward_euler_step(TimeIntegrator *integrator)
{
    Newton *newton = integrator->newton;
    double h = integrator->h;
    int size = 2 * integrator->system->nodes;
    for (int i = 0; i < size; i++)
        newton->u_tilde[i] = h * integrator->v[i];
    Status status = time_integrator_minimise(integrator, integrator->x, h * h);
    if (status)
        return status;
    for (int i = 0; i < size; i++)
        integrator->new_v[i] = newton->at.u[i] / h;
    return time_integrator_accept(integrator, newton->at.x, integrator->new_v);
}
