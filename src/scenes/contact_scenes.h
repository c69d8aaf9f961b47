/* contact_scenes.h - scenes of the square that no options describe: several
 * blocks, moving walls, moving pins, cut springs.
 */
#ifndef ELASTO_CONTACT_SCENES_H
#define ELASTO_CONTACT_SCENES_H

#include "run/body.h"

/* Creates `slope`: three blocks on slopes, with 0.5, 0.9 and 1.1 times the
 * friction of the options, with which a block just stays at rest. */
Status create_slope(Simulation *simulation);

/* Returns the ceiling of `squeeze`, which presses the square and goes up. */
Obstacle make_squeeze_ceiling(const Options *options);
Status create_squeeze(Simulation *simulation);

/* Creates `tear`: two sides are pulled apart; a slit opens and runs. */
Status create_tear(Simulation *simulation);

/* Returns the heavy third ball of `bend`, which falls on a beam with a notch
 * that lies on two balls. */
Obstacle make_bend_ball(const Options *options);
Status create_bend(Simulation *simulation);

#endif
