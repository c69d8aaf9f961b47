#include "step/methods.h"

#include <string.h>

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

/* Keeps u = x_(n+1) - x_n and v_n for the next step. */
static void bdf2_remember(TimeIntegrator *integrator, const double *v_n)
{
    size_t size = 2 * (size_t)integrator->system->nodes;
    memcpy(integrator->memory, integrator->newton->at.u, size * sizeof *v_n);
    memcpy(integrator->memory + size, v_n, size * sizeof *v_n);
    integrator->remembers = true;
}

/* With du = x_n - x_(n-1): u_tilde = du/3 + (2h/9) (4 v_n - v_(n-1)),
 * w = (4/9) h^2, v = (3u - du) / (2h). */
Status bdf2_step(TimeIntegrator *integrator)
{
    Newton *newton = integrator->newton;
    double h = integrator->h, *v = integrator->v, *v_n = integrator->new_x;
    int size = 2 * integrator->system->nodes;
    const double *du = integrator->memory, *v_old = du + size;
    memcpy(v_n, v, (size_t)size * sizeof *v_n);
    if (!integrator->remembers) {
        Status status = backward_euler_step(integrator);
        if (!status)
            bdf2_remember(integrator, v_n);
        return status;
    }
    for (int i = 0; i < size; i++)
        newton->u_tilde[i] = du[i] / 3 + 2 * h / 9 * (4 * v[i] - v_old[i]);
    Status status =
        time_integrator_minimise(integrator, integrator->x, 4 * h * h / 9);
    if (status)
        return status;
    for (int i = 0; i < size; i++)
        integrator->new_v[i] = (3 * newton->at.u[i] - du[i]) / (2 * h);
    status =
        time_integrator_accept(integrator, newton->at.x, integrator->new_v);
    if (!status)
        bdf2_remember(integrator, v_n);
    return status;
}

/* With u = y - x_n: u_tilde = h v_n/2, w = h^2/4, x = x_n + 2u,
 * v = 4u/h - v_n. */
Status midpoint_step(TimeIntegrator *integrator)
{
    Newton *newton = integrator->newton;
    double h = integrator->h;
    int size = 2 * integrator->system->nodes;
    for (int i = 0; i < size; i++)
        newton->u_tilde[i] = 0.5 * h * integrator->v[i];
    Status status =
        time_integrator_minimise(integrator, integrator->x, 0.25 * h * h);
    if (status)
        return status;
    for (int i = 0; i < size; i++) {
        integrator->new_x[i] = integrator->x[i] + 2 * newton->at.u[i];
        integrator->new_v[i] = 4 * newton->at.u[i] / h - integrator->v[i];
    }
    return time_integrator_accept(integrator, integrator->new_x,
                                  integrator->new_v);
}

/* Stage 1: u_tilde = g h v_n gives the velocity s = u/(g h) and the
 * acceleration a = (s - v_n)/(g h) at t_n + g h.  Stage 2: u_tilde =
 * (1-g) h s + g h (v_n + (1-g) h a), v = (u - (1-g) h s)/(g h).  w = g^2 h^2
 * in both. */
Status sdirk2_step(TimeIntegrator *integrator)
{
    const double g = 0.29289321881345248; /* 1 - 1/sqrt(2) */
    Newton *newton = integrator->newton;
    double h = integrator->h, gh = g * h, rest = (1 - g) * h;
    const double *v = integrator->v;
    double *s = integrator->new_v;
    int size = 2 * integrator->system->nodes;
    for (int i = 0; i < size; i++)
        newton->u_tilde[i] = gh * v[i];
    Status status =
        time_integrator_minimise(integrator, integrator->x, gh * gh);
    if (status)
        return status;
    for (int i = 0; i < size; i++) {
        s[i] = newton->at.u[i] / gh;
        double a = (s[i] - v[i]) / gh;
        newton->u_tilde[i] = rest * s[i] + gh * (v[i] + rest * a);
    }
    status = time_integrator_minimise(integrator, integrator->x, gh * gh);
    if (status)
        return status;
    for (int i = 0; i < size; i++)
        integrator->new_v[i] = (newton->at.u[i] - rest * s[i]) / gh;
    return time_integrator_accept(integrator, newton->at.x, integrator->new_v);
}
