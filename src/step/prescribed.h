/* prescribed.h - walls and pinned nodes that move as they are told.
 *
 * Within a step they are put where they belong before E is minimised, not drawn
 * there by a stiff spring: their position is exact, and E has nothing stiff in
 * it.  Where the way would leave no room (a gap or a cell would end), half of
 * it is made first, then E is minimised, then the rest: each round begins at a
 * place that all terms allow.
 */
#ifndef ELASTO_PRESCRIBED_H
#define ELASTO_PRESCRIBED_H

#include "step/time_integrator.h"

/* Before a step: each obstacle's v is what its motion has for this step.
 * Returns whether anything moves. */
bool prescribed_begin(TimeIntegrator *run);

/* Puts things on their way, as far as there is room, and starts to minimise E
 * with u_tilde as target from there; roughly, where another part follows.
 * Returns as newton_start. */
Status prescribed_start(TimeIntegrator *run);

/* After one of its minimisations: whether another one follows.
 *   status  in: how it ended; out: how all of them did, BLOCKED where things
 *           could not be put where they belong */
bool prescribed_goes_on(TimeIntegrator *run, Status *status);

/* After a step was minimised: J, what those who moved things have done in it.
 */
double prescribed_work(const TimeIntegrator *run, double weight);

#endif
