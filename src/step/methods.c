/* methods.c - the time integrators, and their table. */
#include "step/time_integrator.h"

#include <string.h>

/* ---- explicit methods: the acceleration a(x) = g - M^-1 grad P(x), no matrix.
 * Stable only while h is small against the fastest oscillation; forward Euler
 * never is without damping. */

/* v_(n+1) = v_n + h a(x_n) */
static void kick_velocities(TimeIntegrator *run)
{
    double *new_v = run->new_v;
    system_acceleration(run->system, run->x, new_v);
    for (size_t i = 0; i < run->x_length; i++)
        new_v[i] = run->v[i] + run->h * new_v[i];
}

/* x_(n+1) = x_n + h v */
static void drift_positions(TimeIntegrator *run, const double *v)
{
    for (size_t i = 0; i < run->x_length; i++)
        run->new_x[i] = run->x[i] + run->h * v[i];
}

/* Drifts with the velocity of t_n.  Order 1. */
static void forward_euler_set_x_v(TimeIntegrator *run)
{
    kick_velocities(run);
    drift_positions(run, run->v);
}

/* Drifts with the velocity of t_(n+1).  Order 1. */
static void symplectic_euler_set_x_v(TimeIntegrator *run)
{
    kick_velocities(run);
    drift_positions(run, run->new_v);
}

/* Velocity Verlet: x_(n+1) = x_n + h v_n + h^2/2 a_n,
 * v_(n+1) = v_n + h/2 (a_n + a_(n+1)).  Order 2, symplectic; a_(n+1) is
 * remembered, so a step costs one evaluation. */
static void verlet_set_x_v(TimeIntegrator *run)
{
    double *a = run->history, h = run->h;
    double *new_x = run->new_x, *new_v = run->new_v;
    if (run->history_h == 0)
        system_acceleration(run->system, run->x, a);
    for (size_t i = 0; i < run->x_length; i++) {
        new_v[i] = run->v[i] + 0.5 * h * a[i];
        new_x[i] = run->x[i] + h * new_v[i];
    }
    system_acceleration(run->system, new_x, a);
    for (size_t i = 0; i < run->x_length; i++)
        new_v[i] += 0.5 * h * a[i];
    run->history_h = h;
}

/* ---- implicit methods: min |u - u_tilde|_M^2 / 2 + w P(x_n + u), u = x - x_n,
 * each with its own target, weight and velocity. */

/* u_tilde = h v, the path at the velocity v in the time h. */
static void set_drift_target(TimeIntegrator *run, double h, const double *v,
                             double weight)
{
    run->weight = weight;
    for (size_t i = 0; i < run->x_length; i++)
        run->newton->u_tilde[i] = h * v[i];
}

/* The implicit Euler step of the slides (Algorithm 3): u_tilde = h v_n,
 * w = h^2, v_(n+1) = u/h.  Order 1.  E(x1) <= E(x0) says
 * M|v1-v0|^2/2 + P(x1) <= M|v0|^2/2 + P(x0).  The method damps where P is
 * convex from x0 to x1.  Elsewhere the total energy M|v1|^2/2 + P(x1) may rise:
 * a long step may lead a body to the other side of another one. */
static void backward_euler_set_target(TimeIntegrator *run)
{
    double h = run->h;
    set_drift_target(run, h, run->v, h * h);
}

static void backward_euler_set_x_v(TimeIntegrator *run)
{
    const Iterate *end = &run->newton->iterate;
    double h = run->h;
    memcpy(run->new_x, end->x, run->x_length * sizeof *run->new_x);
    for (size_t i = 0; i < run->x_length; i++)
        run->new_v[i] = end->u[i] / h;
}

/* BDF2 (Gear 1971): (3 x_(n+1) - 4 x_n + x_(n-1)) / (2h) = v_(n+1), the same
 * for v and a.  With du = x_n - x_(n-1): u_tilde = du/3 + (2h/9) (4 v_n -
 * v_(n-1)), w = (4/9) h^2, v_(n+1) = (3u - du) / (2h).  Order 2.  du and v_n
 * are remembered; the first step, and each step after the history was lost or h
 * has changed, is backward Euler. */
static void bdf2_set_target(TimeIntegrator *run)
{
    double h = run->h, *v = run->v;
    double *du = run->history, *v_old = du + run->x_length;
    if (run->history_h != h) {
        backward_euler_set_target(run);
        return;
    }
    run->weight = 4 * h * h / 9;
    for (size_t i = 0; i < run->x_length; i++)
        run->newton->u_tilde[i] = du[i] / 3 + 2 * h / 9 * (4 * v[i] - v_old[i]);
}

static void bdf2_set_x_v(TimeIntegrator *run)
{
    const Iterate *end = &run->newton->iterate;
    double h = run->h, *v = run->v;
    double *du = run->history, *v_old = du + run->x_length;
    if (run->history_h != h)
        backward_euler_set_x_v(run);
    for (size_t i = 0; run->history_h == h && i < run->x_length; i++) {
        run->new_x[i] = end->x[i];
        run->new_v[i] = (3 * end->u[i] - du[i]) / (2 * h);
    }
    memcpy(du, end->u, run->x_length * sizeof *du);
    memcpy(v_old, v, run->x_length * sizeof *v_old);
    run->history_h = h;
}

/* Two stages of a diagonally implicit Runge-Kutta method, L-stable (Alexander
 * 1977), g = 1 - 1/sqrt(2).  Stage 1: u_tilde = g h v_n gives the velocity
 * s = u/(g h) and the acceleration a = (s - v_n)/(g h) at t_n + g h.  Stage 2:
 * u_tilde = (1-g) h s + g h (v_n + (1-g) h a), v_(n+1) = (u - (1-g) h s)/(g h).
 * w = g^2 h^2 in both.  Order 2. */
static const double SDIRK_G = 0.29289321881345248; /* 1 - 1/sqrt(2) */

static void sdirk2_set_target(TimeIntegrator *run)
{
    double h = run->h, gh = SDIRK_G * h, rest = (1 - SDIRK_G) * h;
    const double *v = run->v, *s = run->new_v;
    if (run->stage == 0) {
        set_drift_target(run, gh, v, gh * gh);
        return;
    }
    run->weight = gh * gh;
    for (size_t i = 0; i < run->x_length; i++) {
        double a = (s[i] - v[i]) / gh;
        run->newton->u_tilde[i] = rest * s[i] + gh * (v[i] + rest * a);
    }
}

static void sdirk2_set_x_v(TimeIntegrator *run)
{
    const Iterate *end = &run->newton->iterate;
    double h = run->h, gh = SDIRK_G * h, rest = (1 - SDIRK_G) * h;
    double *s = run->new_v;
    bool first = run->stage == 0;
    for (size_t i = 0; i < run->x_length; i++) {
        run->new_x[i] = end->x[i];
        s[i] = (first ? end->u[i] : end->u[i] - rest * s[i]) / gh;
    }
}

/* Implicit midpoint: the unknown is half way, u_tilde = (h/2) v_n,
 * w = (h/2)^2, x_(n+1) = x_n + 2 u, v_(n+1) = 4 u/h - v_n.  Order 2; conserves
 * quadratic invariants, damps nothing. */
static void midpoint_set_target(TimeIntegrator *run)
{
    double half = 0.5 * run->h;
    set_drift_target(run, half, run->v, half * half);
}

static void midpoint_set_x_v(TimeIntegrator *run)
{
    const double *u = run->newton->iterate.u;
    for (size_t i = 0; i < run->x_length; i++) {
        run->new_x[i] = run->x[i] + 2 * u[i];
        run->new_v[i] = 4 * u[i] / run->h - run->v[i];
    }
}

const IntegratorMethod integrator_methods[] = {
    {"backward-euler", "backward Euler", 1, .supports_all_terms = true,
     .is_damped = true, .stages = 1, .set_target = backward_euler_set_target,
     .set_x_v = backward_euler_set_x_v},
    {"symplectic-euler", "symplectic Euler", 1,
     .set_x_v = symplectic_euler_set_x_v},
    {"forward-euler", "forward Euler", 1, .set_x_v = forward_euler_set_x_v},
    {"verlet", "velocity Verlet", 2, .history_arrays = 1,
     .set_x_v = verlet_set_x_v},
    {"midpoint", "implicit midpoint", 2, .stages = 1,
     .set_target = midpoint_set_target, .set_x_v = midpoint_set_x_v},
    {"bdf2", "BDF2", 2, .is_damped = true, .only_by_name = true,
     .history_arrays = 2, .stages = 1, .set_target = bdf2_set_target,
     .set_x_v = bdf2_set_x_v},
    {"sdirk2", "SDIRK2", 2, .is_damped = true, .only_by_name = true,
     .stages = 2, .set_target = sdirk2_set_target, .set_x_v = sdirk2_set_x_v},
    {.name = NULL},
};
