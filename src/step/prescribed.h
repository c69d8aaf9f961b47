/* prescribed.h - motion of walls, pins and a pushed obstacle within a step.
 *
 * A step has one or several minimisations: prescribed_begin_motion_part moves
 * walls and pins as far as there is room and starts one,
 * prescribed_end_motion_part says whether another one follows. */
#pragma once

#include "step/time_integrator.h"

/* Gives each obstacle the mean velocity that its motion has in this step.
 * Returns whether anything moves. */
bool prescribed_begin_motion(TimeIntegrator *run);

/* Moves walls and pins as far as there is room, and starts to minimise E from
 * there.  Where another part of the way follows, the minimiser is only a guess,
 * and the tolerance is loose.  An obstacle that a hand moves stops where there
 * is no room; walls and pins go on. */
void prescribed_begin_motion_part(TimeIntegrator *run);

/* Ends the part of the way whose minimisation has ended.  Returns whether
 * another part follows.  After the last part, a status that differs from that
 * of the minimisation is reported to Newton's observer.
 *   status  in: how the minimisation ended; out: how the step ends, BLOCKED if
 *           it ended OK but walls or pins had no room for all their way */
bool prescribed_end_motion_part(TimeIntegrator *run, Status *status);

/* Returns the work of the prescribed motion in a step, J.  The pins' work is
 * their reaction, the gradient of E there, times their way.  The obstacles'
 * work is their force on the nodes, normal and of friction, times their way. */
double prescribed_compute_work(const TimeIntegrator *run);
