/* All time integrators: their step functions, and the table of them. */
#include "step/time_integrator.h"

#include <string.h>

/* ---- explicit methods: the acceleration a(x) = g - M^-1 grad P(x), no matrix.
 * Stable only while h is small against the fastest oscillation; forward Euler
 * never is without damping. */

/* v_(n+1) = v_n + h a(x_n) */
static void kick(TimeIntegrator *integrator)
{
    double *new_v = integrator->new_v;
    system_acceleration(integrator->system, integrator->x, new_v);
    for (size_t i = 0; i < integrator->size; i++)
        new_v[i] = integrator->v[i] + integrator->h * new_v[i];
}

/* x_(n+1) = x_n + h v */
static void drift(TimeIntegrator *integrator, const double *v)
{
    for (size_t i = 0; i < integrator->size; i++)
        integrator->new_x[i] = integrator->x[i] + integrator->h * v[i];
}

/* Drifts with the velocity of t_n.  Order 1. */
static Status forward_euler_step(TimeIntegrator *integrator)
{
    kick(integrator);
    drift(integrator, integrator->v);
    return STATUS_OK;
}

/* Drifts with the velocity of t_(n+1).  Order 1. */
static Status symplectic_euler_step(TimeIntegrator *integrator)
{
    kick(integrator);
    drift(integrator, integrator->new_v);
    return STATUS_OK;
}

/* Velocity Verlet: x_(n+1) = x_n + h v_n + h^2/2 a_n,
 * v_(n+1) = v_n + h/2 (a_n + a_(n+1)).  Order 2, symplectic; a_(n+1) is
 * remembered, so a step costs one evaluation. */
static Status verlet_step(TimeIntegrator *integrator)
{
    double *a = integrator->memory, h = integrator->h;
    double *new_x = integrator->new_x, *new_v = integrator->new_v;
    if (integrator->memory_h == 0)
        system_acceleration(integrator->system, integrator->x, a);
    for (size_t i = 0; i < integrator->size; i++) {
        new_v[i] = integrator->v[i] + 0.5 * h * a[i];
        new_x[i] = integrator->x[i] + h * new_v[i];
    }
    system_acceleration(integrator->system, new_x, a);
    for (size_t i = 0; i < integrator->size; i++)
        new_v[i] += 0.5 * h * a[i];
    integrator->memory_h = h;
    return STATUS_OK;
}

/* ---- implicit methods: min |u - u_tilde|_M^2 / 2 + w P(x_n + u), u = x - x_n,
 * each with its own target, weight and velocity. */

/* Minimises with u_tilde = h v: as far as v leads in the time h. */
static Status minimise_ahead(TimeIntegrator *integrator, const double *x_n,
                             double h, const double *v, double weight)
{
    for (size_t i = 0; i < integrator->size; i++)
        integrator->newton->u_tilde[i] = h * v[i];
    return time_integrator_minimise(integrator, x_n, weight);
}

/* The implicit Euler step of the slides (Algorithm 3): u_tilde = h v_n,
 * w = h^2, v_(n+1) = u/h.  Order 1; damps, never gains:
 * M|v1-v0|^2/2 + P(x1) <= M|v0|^2/2 + P(x0). */
static Status backward_euler_step(TimeIntegrator *integrator)
{
    const Iterate *end = &integrator->newton->at;
    double h = integrator->h;
    Status status =
        minimise_ahead(integrator, integrator->x, h, integrator->v, h * h);
    for (size_t i = 0; !status && i < integrator->size; i++) {
        integrator->new_x[i] = end->x[i];
        integrator->new_v[i] = end->u[i] / h;
    }
    return status;
}

/* BDF2 (Gear 1971): (3 x_(n+1) - 4 x_n + x_(n-1)) / (2h) = v_(n+1), the same
 * for v and a.  With du = x_n - x_(n-1): u_tilde = du/3 + (2h/9) (4 v_n -
 * v_(n-1)), w = (4/9) h^2, v_(n+1) = (3u - du) / (2h).  Order 2.  du and v_n
 * are remembered; the first step is backward Euler. */
static Status bdf2_step(TimeIntegrator *integrator)
{
    Newton *newton = integrator->newton;
    double h = integrator->h, *v = integrator->v;
    double *du = integrator->memory, *v_old = du + integrator->size;
    bool first = integrator->memory_h != h;
    for (size_t i = 0; !first && i < integrator->size; i++)
        newton->u_tilde[i] = du[i] / 3 + 2 * h / 9 * (4 * v[i] - v_old[i]);
    Status status = first ? backward_euler_step(integrator)
                          : time_integrator_minimise(integrator, integrator->x,
                                                     4 * h * h / 9);
    if (status)
        return status;
    for (size_t i = 0; !first && i < integrator->size; i++) {
        integrator->new_x[i] = newton->at.x[i];
        integrator->new_v[i] = (3 * newton->at.u[i] - du[i]) / (2 * h);
    }
    memcpy(du, newton->at.u, integrator->size * sizeof *du);
    memcpy(v_old, v, integrator->size * sizeof *v_old);
    integrator->memory_h = h;
    return STATUS_OK;
}

/* Implicit midpoint, the unknown is y = (x_n + x_(n+1)) / 2.  With u = y - x_n:
 * u_tilde = h v_n/2, w = h^2/4, x_(n+1) = x_n + 2u, v_(n+1) = 4u/h - v_n.
 * Order 2; conserves quadratic invariants, damps nothing. */
static Status midpoint_step(TimeIntegrator *integrator)
{
    const double *u = integrator->newton->at.u;
    const double *x = integrator->x, *v = integrator->v;
    double h = integrator->h;
    Status status = minimise_ahead(integrator, x, 0.5 * h, v, 0.25 * h * h);
    for (size_t i = 0; !status && i < integrator->size; i++) {
        integrator->new_x[i] = x[i] + 2 * u[i];
        integrator->new_v[i] = 4 * u[i] / h - v[i];
    }
    return status;
}

/* Two stages of a diagonally implicit Runge-Kutta method, L-stable (Alexander
 * 1977), g = 1 - 1/sqrt(2).  Stage 1: u_tilde = g h v_n gives the velocity
 * s = u/(g h) and the acceleration a = (s - v_n)/(g h) at t_n + g h.  Stage 2:
 * u_tilde = (1-g) h s + g h (v_n + (1-g) h a), v_(n+1) = (u - (1-g) h s)/(g h).
 * w = g^2 h^2 in both.  Order 2. */
static Status sdirk2_step(TimeIntegrator *integrator)
{
    const double g = 0.29289321881345248; /* 1 - 1/sqrt(2) */
    Newton *newton = integrator->newton;
    double h = integrator->h, gh = g * h, rest = (1 - g) * h;
    const double *x = integrator->x, *v = integrator->v;
    double *s = integrator->new_v;
    Status status = minimise_ahead(integrator, x, gh, v, gh * gh);
    for (size_t i = 0; !status && i < integrator->size; i++) {
        s[i] = newton->at.u[i] / gh;
        double a = (s[i] - v[i]) / gh;
        newton->u_tilde[i] = rest * s[i] + gh * (v[i] + rest * a);
    }
    if (!status)
        status = time_integrator_minimise(integrator, x, gh * gh);
    for (size_t i = 0; !status && i < integrator->size; i++) {
        integrator->new_x[i] = newton->at.x[i];
        integrator->new_v[i] = (newton->at.u[i] - rest * s[i]) / gh;
    }
    return status;
}

/* ---- average vector field: conserves energy exactly; what Newton's tolerance
 * leaves undone is all that it can drift. */

/* Substeps of the given shares of h, one after the other.  With Phi of
 * avf_energy.c in the place of P: u_tilde = h v, w = h^2/2, and v becomes
 * 2u/h - v. */
static Status avf_compose(TimeIntegrator *integrator, const double *share,
                          int count)
{
    const double *u = integrator->newton->at.u;
    double *x = integrator->new_x, *v = integrator->new_v;
    Status status = STATUS_OK;
    memcpy(x, integrator->x, integrator->size * sizeof *x);
    memcpy(v, integrator->v, integrator->size * sizeof *v);
    for (int part = 0; part < count && !status; part++) {
        double h = share[part] * integrator->h;
        status = minimise_ahead(integrator, x, h, v, 0.5 * h * h);
        for (size_t i = 0; i < integrator->size && !status; i++) {
            x[i] += u[i];
            v[i] = 2 * u[i] / h - v[i];
        }
    }
    return status;
}

/* Order 2. */
static Status avf_step(TimeIntegrator *integrator)
{
    return avf_compose(integrator, (const double[]){1}, 1);
}

/* Order 4 by composition (Suzuki 1990), g = 1/(4 - 4^(1/3)). */
static Status avf4_step(TimeIntegrator *integrator)
{
    const double g = 0.41449077179437571;
    return avf_compose(integrator, (const double[]){g, g, 1 - 4 * g, g, g}, 5);
}

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
