/* tangent_scene.h - Newton's method in one dimension (slides: Newton's method,
 * and the step as a minimisation).
 *
 * One mass on one spring along a line, the other end held at 0:
 *   E(x) = m/2 (x - x_tilde)^2 + h^2 l2 k/2 (x^2/l2 - 1)^2
 *   g(x) = E'(x) = m (x - x_tilde) + 2 h^2 k x (x^2/l2 - 1)
 * Where the tangent of g is zero the parabola that touches E is lowest: both
 * are the next iterate.
 */
#ifndef ELASTO_TANGENT_SCENE_H
#define ELASTO_TANGENT_SCENE_H

#include "scenes/scene.h"

/* h = 0.3 s, start at 2.5 m, no line search; tolerance 1e-10 on |p|. */
void tangent_defaults(Options *options);

/* Node 0 is the point (x, E(x)). */
Status create_tangent(Simulation *simulation, const NewtonSettings *settings);

/* Handle 0 is the iterate, handle 1 is x_tilde, both by their x alone; Newton
 * starts anew. */
int tangent_handles(const Simulation *simulation,
                    double at[SCENE_MAX_HANDLES][2]);
void tangent_drag(Simulation *simulation, int handle, double x, double y);

#endif
