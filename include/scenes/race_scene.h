/* race_scene.h - run time against error, measured while one looks on.
 *
 * The stretched square is followed for a fixed time by several methods with
 * several time steps each; every run is one point: how far the worst node is
 * from where it belongs, and how long the run took.  Where it belongs is what
 * velocity Verlet says with a time step 64 times finer than any of theirs.  An
 * explicit run goes on after that, unmeasured: with a time step that is too
 * long it may be accurate for a while, and explodes later.
 */
#ifndef ELASTO_RACE_SCENE_H
#define ELASTO_RACE_SCENE_H

#include "scenes/scene.h"

#define RACE_TIME 0.064 /* s, that every run covers */

enum { RACE_METHODS = 6, RACE_STEP_SIZES = 7 };

/* Steps that explicit runs go on, and how often the energy at their end may be
 * that at the start. */
enum { RACE_LONGER = 2048, RACE_ENERGY = 2 };

/* Stretch 1.1, where the motion is no chaos. */
void race_defaults(Options *options);

Status create_race(Simulation *simulation, const NewtonSettings *settings);

/* One run more; done after RACE_METHODS x RACE_STEP_SIZES of them.  The methods
 * take turns, each from its longest time step to its shortest. */
Status step_race(Simulation *simulation);

/* The quickest run so far that reaches the error, m, and stays stable, of
 * explicit or of implicit methods; NULL: there is none. */
const RacePoint *race_quickest(const Race *race, double error, bool implicit);

/* The method of column i, 0 ... RACE_METHODS - 1. */
const IntegratorMethod *race_method(int i);

#endif
