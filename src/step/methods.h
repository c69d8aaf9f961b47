/* methods.h - the step functions of all time integrators: each moves x and v of
 * the integrator from t_n to t_n + h.  Returns OK, or a failure after which x
 * and v are those of t_n.
 */
#ifndef ELASTO_METHODS_H
#define ELASTO_METHODS_H

#include "step/time_integrator.h"

/* ---- explicit_methods.c: one evaluation of the acceleration
 * a(x) = -M^-1 grad P(x), no matrix.  Stable only while h is small against the
 * fastest oscillation; forward Euler never is without damping. */

/* x_(n+1) = x_n + h v_n,  v_(n+1) = v_n + h a(x_n).  Order 1. */
Status forward_euler_step(TimeIntegrator *integrator);

/* v_(n+1) = v_n + h a(x_n),  x_(n+1) = x_n + h v_(n+1).  Order 1. */
Status symplectic_euler_step(TimeIntegrator *integrator);

/* Velocity Verlet: half a kick, a drift, half a kick.  Order 2, symplectic;
 * a(x_(n+1)) is remembered, so a step costs one evaluation. */
Status verlet_step(TimeIntegrator *integrator);

/* ---- implicit_methods.c: min |u - u_tilde|_M^2 / 2 + w P(x_n + u), each with
 * its own target, weight and velocity. */

/* The implicit Euler step of the slides (Algorithm 3):
 *   x_(n+1) = argmin |x - x_tilde|_M^2 / 2 + h^2 P(x),
 *   x_tilde = x_n + h v_n,   v_(n+1) = (x_(n+1) - x_n) / h.
 * Order 1; damps, never gains: M|v1-v0|^2/2 + P(x1) <= M|v0|^2/2 + P(x0). */
Status backward_euler_step(TimeIntegrator *integrator);

/* BDF2 (Gear 1971): (3 x_(n+1) - 4 x_n + x_(n-1)) / (2h) = v_(n+1), the same
 * for v and a.  Order 2.  The first step is backward Euler. */
Status bdf2_step(TimeIntegrator *integrator);

/* Implicit midpoint: the unknown is y = (x_n + x_(n+1)) / 2.  Order 2;
 * conserves quadratic invariants, damps nothing. */
Status midpoint_step(TimeIntegrator *integrator);

/* Two stages of a diagonally implicit Runge-Kutta method, L-stable (Alexander
 * 1977), g = 1 - 1/sqrt(2).  Order 2. */
Status sdirk2_step(TimeIntegrator *integrator);

/* ---- average_vector_field.c: conserves energy exactly; what Newton's
 * tolerance leaves undone is all that it can drift.
 *   x_(n+1) = argmin |x - x_tilde|_M^2 / 2 + h^2/2 Phi(x - x_n),
 *   x_tilde = x_n + h v_n,   v_(n+1) = 2 (x_(n+1) - x_n)/h - v_n,
 * with Phi of avf_energy.h. */

/* Order 2. */
Status avf_step(TimeIntegrator *integrator);

/* Order 4: five steps g h, g h, (1-4g) h, g h, g h with g = 1/(4 - 4^(1/3))
 * (Suzuki 1990). */
Status avf4_step(TimeIntegrator *integrator);

#endif
