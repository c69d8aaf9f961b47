/* overshoot_scene.h - Newton's method that overshoots (slides: Algorithm 1).
 *
 * f(x) = ln(e^x + e^-x) is convex with its minimum at 0, but from x = 2 the
 * update p = -f'/f'' = -sinh(2x)/2 leads to -11.6 and from there beyond all
 * numbers.  With the line search (Algorithm 2) it converges.
 */
#ifndef ELASTO_OVERSHOOT_SCENE_H
#define ELASTO_OVERSHOOT_SCENE_H

#include "scenes/simulation.h"

/* No line search; start x = 2; tolerance 1e-10 on |p|. */
void overshoot_defaults(Options *options);

/* Node 0 is the point (x, f(x)). */
Status create_overshoot(Simulation *simulation, const NewtonSettings *settings);

/* One Newton iteration. */
Status step_overshoot(Simulation *simulation);

/* f, f', f'' */
extern const ScalarFunction overshoot_function;

#endif
