/* square_scenes.h - the stretched square of the slides, and the same square
 * under conditions in which Newton needs the projection.
 */
#ifndef ELASTO_SQUARE_SCENES_H
#define ELASTO_SQUARE_SCENES_H

#include "scenes/simulation.h"

/* The square: nodes of mass density side^2 / nodes, springs of squared rest
 * length |d|^2.  It starts stretched horizontally, then turned, then moved, all
 * nodes but the pinned ones with one velocity. */
Status create_square(Simulation *simulation, const NewtonSettings *settings);

/* The book's remark: h = 0.02 s and a stretch of 0.5 without projection. */
void unprojected_defaults(Options *options);

/* Algorithm 1 alone, without projection and line search: within the first step
 * E rises to 2e16 J s^2 and nodes fly 1.7 km (found by a scan of 2560 squares).
 * With either ingredient it does not. */
void explosion_defaults(Options *options);

/* Gravity on a soft square that hangs from its upper corners. */
void hang_defaults(Options *options);

#endif
