/* square_scenes.h - the stretched square of the slides, and the same square
 * under conditions in which Newton needs the projection.
 */
#ifndef ELASTO_SQUARE_SCENES_H
#define ELASTO_SQUARE_SCENES_H

#include "scenes/simulation.h"

/* The square at rest but for a horizontal stretch, without velocity: nodes of
 * mass density side^2 / nodes, springs of squared rest length |d|^2. */
Status create_square(Simulation *simulation, const NewtonSettings *settings);

/* The book's remark: h = 0.02 s and a stretch of 0.5 without projection. */
void unprojected_defaults(Options *options);

#endif
