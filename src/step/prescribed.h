/* prescribed.h - within a step: walls and pins that move as prescribed, and an
 * obstacle that a hand pushes.
 *
 * A step has one or several minimisations: prescribed_start moves things as far
 * as there is room and starts one, prescribed_goes_on says whether another one
 * follows.
 */
#ifndef ELASTO_PRESCRIBED_H
#define ELASTO_PRESCRIBED_H

#include "step/time_integrator.h"

/* Gives each obstacle the velocity that its motion has in this step.  Returns
 * whether anything moves. */
bool prescribed_begin(TimeIntegrator *run);

/* Puts things on their way, as far as there is room, and starts to minimise E
 * with u_tilde as target from there.  Where another part follows, the minimiser
 * is only a guess, and the tolerance is loose.  What a hand moves stops where
 * there is no room, and all else goes on. */
void prescribed_start(TimeIntegrator *run);

/* Whether another minimisation follows the one that has ended.  The end of the
 * last one is reported to Newton's observer, where its status is another one.
 *   status  in: how the minimisation ended; out: how all of them did, BLOCKED
 *           where things could not be put where they belong */
bool prescribed_goes_on(TimeIntegrator *run, Status *status);

/* Work of the prescribed motion in a step, J.  That of the pins is their
 * reaction, which is the gradient of E there, times their way.  That of the
 * obstacles is the forces on the nodes, normal and of friction, times the
 * obstacle's way.
 *   weight  s^2, factor of P in E */
double prescribed_work(const TimeIntegrator *run, double weight);

#endif
