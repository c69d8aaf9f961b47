/* backward_euler.h - the implicit Euler step of the slides (Algorithm 3):
 *   x_(n+1) = argmin |x - x_tilde|_M^2 / 2 + h^2 P(x),
 *   x_tilde = x_n + h v_n,   v_(n+1) = (x_(n+1) - x_n) / h.
 * Order 1; damps, never gains: M|v1-v0|^2/2 + P(x1) <= M|v0|^2/2 + P(x0).
 */
#ifndef ELASTO_BACKWARD_EULER_H
#define ELASTO_BACKWARD_EULER_H

#include "step/time_integrator.h"

Status backward_euler_step(TimeIntegrator *integrator);

#endif
