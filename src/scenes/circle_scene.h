/* circle_scene.h - uniform circular motion (slide: stability of forward,
 * symplectic and backward Euler).
 *
 * One node, a = -w^2 x, w = 2 pi / s, from (1, 0) m with speed w: the exact
 * path is the unit circle.  A step multiplies the radius by sqrt(1 + (h w)^2)
 * (forward Euler) or its inverse (backward Euler); the symplectic path stays
 * on an ellipse with 1/sqrt(1 + h w/2) <= |x| <= 1/sqrt(1 - h w/2).
 */
#ifndef ELASTO_CIRCLE_SCENE_H
#define ELASTO_CIRCLE_SCENE_H

#include "scenes/simulation.h"

/* h = 0.02 s. */
void circle_defaults(Options *options);

/* Run 0 forward, 1 symplectic, 2 backward Euler; with --integrator that one. */
Status create_circle(Simulation *simulation, const NewtonSettings *settings);

#endif
