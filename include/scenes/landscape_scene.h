/* landscape_scene.h - search directions on a map (slide: 2D illustration).
 *
 * One free node between two pinned ones, too close for its springs; the map
 * is the incremental potential E over the position of the free node.  Where
 * the springs are short E is not convex: Newton's direction can point uphill
 * there, the projected one never does.
 */
#ifndef ELASTO_LANDSCAPE_SCENE_H
#define ELASTO_LANDSCAPE_SCENE_H

#include "scenes/simulation.h"

/* h = 0.2 s, and a start from which Newton without projection goes uphill. */
void landscape_defaults(Options *options);

/* Node 0 is free, at options.start; nodes 1 and 2 are pinned. */
Status create_landscape(Simulation *simulation, const NewtonSettings *settings);

/* One Newton iteration. */
Status step_landscape(Simulation *simulation);

/* The direction from the present iterate, as the methods now want it. */
void aim_landscape(Simulation *simulation);

/* E at position (x, y) of the free node, J s^2. */
double landscape_value(const Simulation *simulation, double x, double y);

/* Whether the Hessian of E, not projected, is positive definite there: then
 * Newton's direction is downhill with and without projection. */
bool landscape_is_convex(const Simulation *simulation, double x, double y);

#endif
