/* All time integrators: what they aim at and where they land, and the table of
 * them. */
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
static void forward_euler_land(TimeIntegrator *integrator)
{
    kick(integrator);
    drift(integrator, integrator->v);
}

/* Drifts with the velocity of t_(n+1).  Order 1. */
static void symplectic_euler_land(TimeIntegrator *integrator)
{
    kick(integrator);
    drift(integrator, integrator->new_v);
}

/* Velocity Verlet: x_(n+1) = x_n + h v_n + h^2/2 a_n,
 * v_(n+1) = v_n + h/2 (a_n + a_(n+1)).  Order 2, symplectic; a_(n+1) is
 * remembered, so a step costs one evaluation. */
static void verlet_land(TimeIntegrator *integrator)
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
}

/* ---- implicit methods: min |u - u_tilde|_M^2 / 2 + w P(x_n + u), u = x - x_n,
 * each with its own target, weight and velocity. */

/* u_tilde = h v: as far as v leads in the time h. */
static void aim_ahead(TimeIntegrator *integrator, double h, const double *v,
                      double weight)
{
    integrator->weight = weight;
    for (size_t i = 0; i < integrator->size; i++)
        integrator->newton->u_tilde[i] = h * v[i];
}

/* The implicit Euler step of the slides (Algorithm 3): u_tilde = h v_n,
 * w = h^2, v_(n+1) = u/h.  Order 1; damps, never gains:
 * M|v1-v0|^2/2 + P(x1) <= M|v0|^2/2 + P(x0). */
static void backward_euler_aim(TimeIntegrator *integrator)
{
    double h = integrator->h;
    aim_ahead(integrator, h, integrator->v, h * h);
}

static void backward_euler_land(TimeIntegrator *integrator)
{
    const Iterate *end = &integrator->newton->at;
    for (size_t i = 0; i < integrator->size; i++) {
        integrator->new_x[i] = end->x[i];
        integrator->new_v[i] = end->u[i] / integrator->h;
    }
}

/* BDF2 (Gear 1971): (3 x_(n+1) - 4 x_n + x_(n-1)) / (2h) = v_(n+1), the same
 * for v and a.  With du = x_n - x_(n-1): u_tilde = du/3 + (2h/9) (4 v_n -
 * v_(n-1)), w = (4/9) h^2, v_(n+1) = (3u - du) / (2h).  Order 2.  du and v_n
 * are remembered; the first step is backward Euler. */
static void bdf2_aim(TimeIntegrator *integrator)
{
    double h = integrator->h, *v = integrator->v;
    double *du = integrator->memory, *v_old = du + integrator->size;
    if (integrator->memory_h != h) {
        backward_euler_aim(integrator);
        return;
    }
    integrator->weight = 4 * h * h / 9;
    for (size_t i = 0; i < integrator->size; i++)
        integrator->newton->u_tilde[i] =
            du[i] / 3 + 2 * h / 9 * (4 * v[i] - v_old[i]);
}

static void bdf2_land(TimeIntegrator *integrator)
{
    const Iterate *end = &integrator->newton->at;
    double h = integrator->h, *v = integrator->v;
    double *du = integrator->memory, *v_old = du + integrator->size;
    if (integrator->memory_h != h)
        backward_euler_land(integrator);
    for (size_t i = 0; integrator->memory_h == h && i < integrator->size; i++) {
        integrator->new_x[i] = end->x[i];
        integrator->new_v[i] = (3 * end->u[i] - du[i]) / (2 * h);
    }
    memcpy(du, end->u, integrator->size * sizeof *du);
    memcpy(v_old, v, integrator->size * sizeof *v_old);
    integrator->memory_h = h;
}

/* Two stages of a diagonally implicit Runge-Kutta method, L-stable (Alexander
 * 1977), g = 1 - 1/sqrt(2).  Stage 1: u_tilde = g h v_n gives the velocity
 * s = u/(g h) and the acceleration a = (s - v_n)/(g h) at t_n + g h.  Stage 2:
 * u_tilde = (1-g) h s + g h (v_n + (1-g) h a), v_(n+1) = (u - (1-g) h s)/(g h).
 * w = g^2 h^2 in both.  Order 2. */
static const double SDIRK_G = 0.29289321881345248; /* 1 - 1/sqrt(2) */

static void sdirk2_aim(TimeIntegrator *integrator)
{
    double h = integrator->h, gh = SDIRK_G * h, rest = (1 - SDIRK_G) * h;
    const double *v = integrator->v, *s = integrator->new_v;
    if (integrator->stage == 0) {
        aim_ahead(integrator, gh, v, gh * gh);
        return;
    }
    integrator->weight = gh * gh;
    for (size_t i = 0; i < integrator->size; i++) {
        double a = (s[i] - v[i]) / gh;
        integrator->newton->u_tilde[i] = rest * s[i] + gh * (v[i] + rest * a);
    }
}

static void sdirk2_land(TimeIntegrator *integrator)
{
    const Iterate *end = &integrator->newton->at;
    double h = integrator->h, gh = SDIRK_G * h, rest = (1 - SDIRK_G) * h;
    double *s = integrator->new_v;
    bool first = integrator->stage == 0;
    for (size_t i = 0; i < integrator->size; i++) {
        integrator->new_x[i] = end->x[i];
        s[i] = (first ? end->u[i] : end->u[i] - rest * s[i]) / gh;
    }
}

/* ---- symmetric methods: what they aim at and where they land are numbers,
 *   u_tilde = a h v_n, w = b h^2, x_(n+1) = x_n + c u, v_(n+1) = 2 c u/h - v_n.
 *
 * Implicit midpoint: the unknown is half way, a = 1/2, b = 1/4, c = 2.  Order
 * 2; conserves quadratic invariants, damps nothing.
 *
 * Average vector field: a = 1, b = 1/2, c = 1, and P averaged over the step
 * (incremental_potential.c).  Order 2; conserves energy exactly: what Newton's
 * tolerance leaves undone is all that it can drift.
 *
 * Order 4 by composition (Suzuki 1990), g = 1/(4 - 4^(1/3)): five substeps of
 * g h, g h, (1 - 4g) h, g h, g h, each from where the one before has led. */
static double substep(const TimeIntegrator *integrator)
{
    const double g = 0.41449077179437571;
    double share = integrator->method->stages == 1 ? 1
                   : integrator->stage == 2        ? 1 - 4 * g
                                                   : g;
    return share * integrator->h;
}

static void symmetric_aim(TimeIntegrator *integrator)
{
    const IntegratorMethod *method = integrator->method;
    bool first = integrator->stage == 0;
    double h = substep(integrator);
    integrator->x_n = first ? integrator->x : integrator->new_x;
    aim_ahead(integrator, method->a * h,
              first ? integrator->v : integrator->new_v, method->b * h * h);
}

static void symmetric_land(TimeIntegrator *integrator)
{
    const double *u = integrator->newton->at.u, *x = integrator->x_n;
    const double *v =
        integrator->stage == 0 ? integrator->v : integrator->new_v;
    double c = integrator->method->c, h = substep(integrator);
    for (size_t i = 0; i < integrator->size; i++) {
        integrator->new_x[i] = x[i] + c * u[i];
        integrator->new_v[i] = 2 * c * u[i] / h - v[i];
    }
}

const IntegratorMethod integrator_methods[] = {
    {"backward-euler", "backward Euler", 1, .implicit = true, .at_end = true,
     .damps = true, .stages = 1, .aim = backward_euler_aim,
     .land = backward_euler_land},
    {"forward-euler", "forward Euler", 1, .land = forward_euler_land},
    {"symplectic-euler", "symplectic Euler", 1, .land = symplectic_euler_land},
    {"verlet", "velocity Verlet", 2, .memory = 1, .land = verlet_land},
    {"bdf2", "BDF2", 2, .implicit = true, .damps = true, .memory = 2,
     .stages = 1, .aim = bdf2_aim, .land = bdf2_land},
    {"midpoint", "implicit midpoint", 2, .implicit = true, .stages = 1,
     .a = 0.5, .b = 0.25, .c = 2, .aim = symmetric_aim, .land = symmetric_land},
    {"sdirk2", "SDIRK2", 2, .implicit = true, .damps = true, .stages = 2,
     .aim = sdirk2_aim, .land = sdirk2_land},
    {"avf", "average vector field", 2, .implicit = true, .averaged = true,
     .stages = 1, .a = 1, .b = 0.5, .c = 1, .aim = symmetric_aim,
     .land = symmetric_land},
    {"avf4", "AVF, 4th order", 4, .implicit = true, .averaged = true,
     .stages = 5, .a = 1, .b = 0.5, .c = 1, .aim = symmetric_aim,
     .land = symmetric_land},
    {.name = NULL},
};
