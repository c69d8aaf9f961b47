/* dial_scene.h - the minimiser of E for every time step h (slide: optimisation
 * time integration, inertia against elasticity).
 *
 * The map of landscape_scene.h with x_tilde held: at h = 0 only inertia counts
 * and the minimiser is x_tilde; the longer the step, the more elasticity
 * counts, and the minimiser walks to where the springs are at rest.
 */
#ifndef ELASTO_DIAL_SCENE_H
#define ELASTO_DIAL_SCENE_H

#include "scenes/landscape_scene.h"

/* h = 0.005 s, from which the scene turns the dial. */
void dial_defaults(Options *options);

Status create_dial(Simulation *simulation, const NewtonSettings *settings);

/* Turns the dial: h times 10^(1/10), up to 10 s; node 0 is the minimiser. */
Status step_dial(Simulation *simulation);

/* The minimiser for this h, m, to which the one before leads: projected Newton
 * from `point`.  point [2] in/out */
void dial_minimise(const Simulation *simulation, double h, double point[2]);

/* Handle 0 is x_tilde: the whole walk follows. */
int dial_handles(const Simulation *simulation, double at[SCENE_MAX_HANDLES][2]);
void dial_drag(Simulation *simulation, int handle, double x, double y);

#endif
