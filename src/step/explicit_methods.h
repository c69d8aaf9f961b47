/* explicit_methods.h - steps without any minimisation: one evaluation of the
 * acceleration a(x) = -M^-1 grad P(x), no matrix.
 *
 * Stable only while h is small against the fastest oscillation; forward Euler
 * never is without damping.
 */
#ifndef ELASTO_EXPLICIT_METHODS_H
#define ELASTO_EXPLICIT_METHODS_H

#include "step/time_integrator.h"

/* x_(n+1) = x_n + h v_n,  v_(n+1) = v_n + h a(x_n).  Order 1. */
Status forward_euler_step(TimeIntegrator *integrator);

/* v_(n+1) = v_n + h a(x_n),  x_(n+1) = x_n + h v_(n+1).  Order 1. */
Status symplectic_euler_step(TimeIntegrator *integrator);

/* Velocity Verlet: half a kick, a drift, half a kick.  Order 2, symplectic;
 * a(x_(n+1)) is remembered, so a step costs one evaluation. */
Status verlet_step(TimeIntegrator *integrator);

#endif
