/* overshoot_scene.h - Newton's method that overshoots (slides: Algorithm 1).
 *
 * f(x) = ln(e^x + e^-x) is convex with its minimum at 0, but from x = 2 the
 * update p = -f'/f'' = -sinh(2x)/2 leads to -11.6 and from there beyond all
 * numbers.  With the line search (Algorithm 2) it converges.
 */
#ifndef ELASTO_OVERSHOOT_SCENE_H
#define ELASTO_OVERSHOOT_SCENE_H

#include "scenes/scene.h"

/* No line search; start x = 2; tolerance 1e-10 on |p|. */
void overshoot_defaults(Options *options);

/* Node 0 is the point (x, f(x)). */
Status create_overshoot(Simulation *simulation, const NewtonSettings *settings);

/* The same for any function of one variable; f is copied.  Both start at
 * options.start[0]. */
Status scalar_scene_create(Simulation *simulation,
                           const NewtonSettings *settings,
                           const ScalarFunction *f);

/* Begins anew at x. */
void scalar_scene_restart(Simulation *simulation, double x);

/* One Newton iteration. */
Status step_overshoot(Simulation *simulation);

/* Handle 0 is the iterate, by its x alone. */
int overshoot_handles(const Simulation *simulation,
                      double at[SCENE_MAX_HANDLES][2]);
void overshoot_drag(Simulation *simulation, int handle, double x, double y);

/* f, f', f'' */
extern const ScalarFunction overshoot_function;

#endif
