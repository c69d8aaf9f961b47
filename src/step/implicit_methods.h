/* implicit_methods.h - second-order steps over the same minimisation as
 * backward Euler: min |u - u_tilde|_M^2 / 2 + w P(x_n + u), with another
 * target, another weight and another velocity.
 */
#ifndef ELASTO_IMPLICIT_METHODS_H
#define ELASTO_IMPLICIT_METHODS_H

#include "step/time_integrator.h"

/* BDF2 (Gear 1971): (3 x_(n+1) - 4 x_n + x_(n-1)) / (2h) = v_(n+1), the same
 * for v and a.  The first step is backward Euler. */
Status bdf2_step(TimeIntegrator *integrator);

/* Implicit midpoint: the unknown is y = (x_n + x_(n+1)) / 2.  Conserves
 * quadratic invariants, damps nothing. */
Status midpoint_step(TimeIntegrator *integrator);

/* Two stages of a diagonally implicit Runge-Kutta method, L-stable (Alexander
 * 1977), g = 1 - 1/sqrt(2). */
Status sdirk2_step(TimeIntegrator *integrator);

#endif
