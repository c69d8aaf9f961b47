/* landscape_scene.h - search directions on a map (slide: 2D illustration).
 *
 * One free node between two pinned ones, too close for its springs; the map
 * is the incremental potential E over the position of the free node.  Where
 * the springs are short E is not convex: Newton's direction can point uphill
 * there, the projected one never does.
 */
#ifndef ELASTO_LANDSCAPE_SCENE_H
#define ELASTO_LANDSCAPE_SCENE_H

#include "scenes/scene.h"

/* h = 0.2 s, and a start from which Newton without projection goes uphill. */
void landscape_defaults(Options *options);

/* Node 0 is free, at options.start; nodes 1 and 2 are pinned. */
Status create_landscape(Simulation *simulation, const NewtonSettings *settings);

/* One Newton iteration on the parts of E that are on the map: of Algorithm 3,
 * or without projection and line search of Algorithm 1, which tests |g|. */
Status step_landscape(Simulation *simulation);

/* The direction from the present iterate, as the methods now want it. */
void aim_landscape(Simulation *simulation);

/* E at position (x, y) of the free node, of the parts on the map, J s^2. */
double landscape_value(const Simulation *simulation, double x, double y);

/* Of E only the parts that are named (enum LandscapePart), J s^2. */
double landscape_part_value(const Simulation *simulation, unsigned parts,
                            double x, double y);

/* Handle 0 is x_tilde, handle 1 the iterate: Newton starts anew from there. */
int landscape_handles(const Simulation *simulation,
                      double at[SCENE_MAX_HANDLES][2]);
void landscape_drag(Simulation *simulation, int handle, double x, double y);

/* Inertia and elasticity on the map; one of them at least is on.  Newton goes
 * on from where it is with those that are. */
int landscape_switches(const Simulation *simulation,
                       Switch out[SCENE_MAX_SWITCHES]);
void landscape_flip(Simulation *simulation, int number);

/* In how many directions the parts of E on the map bend down there, or do not
 * bend: 0 where the Hessian, not projected, is positive definite (Newton's
 * direction is downhill with and without projection), 1 as at a saddle, 2 as at
 * a maximum. */
int landscape_bends_down(const Simulation *simulation, double x, double y);

/* p = -H^-1 g from the iterate with this filter, m, for the parts of E on the
 * map, whatever the run's own filter is.  Returns grad E . p, J s^2, NaN where
 * H has no inverse. */
double landscape_direction(const Simulation *simulation, Filter filter,
                           double p[2]);

#endif
