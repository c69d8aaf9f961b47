/* average_vector_field.h - steps that conserve energy exactly:
 *   x_(n+1) = argmin |x - x_tilde|_M^2 / 2 + h^2/2 Phi(x - x_n),
 *   x_tilde = x_n + h v_n,   v_(n+1) = 2 (x_(n+1) - x_n)/h - v_n,
 * with Phi of avf_energy.h.  What Newton's tolerance leaves undone is all that
 * the energy can drift.
 */
#ifndef ELASTO_AVERAGE_VECTOR_FIELD_H
#define ELASTO_AVERAGE_VECTOR_FIELD_H

#include "step/time_integrator.h"

/* Order 2. */
Status avf_step(TimeIntegrator *integrator);

/* Order 4: five steps g h, g h, (1-4g) h, g h, g h with g = 1/(4 - 4^(1/3))
 * (Suzuki 1990). */
Status avf4_step(TimeIntegrator *integrator);

#endif
