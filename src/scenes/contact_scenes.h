/* contact_scenes.h - scenes of the square that no options describe: several
 * blocks, moving walls, moving pins, cut springs.
 */
#ifndef ELASTO_CONTACT_SCENES_H
#define ELASTO_CONTACT_SCENES_H

#include "run/body.h"

/* Three blocks on slopes, with 0.5, 0.9 and 1.1 times the friction of the
 * options.  With the friction of the options a block just stays at rest. */
Status create_slope(Simulation *simulation);

/* A ceiling comes down on the square and goes up again. */
Obstacle make_squeeze_ceiling(const Options *options);
Status create_squeeze(Simulation *simulation);

/* Two sides are pulled apart; a slit in the middle opens and runs. */
Status create_tear(Simulation *simulation);

/* A beam with a notch lies on two balls; a heavy third ball falls on it. */
Obstacle make_bend_ball(const Options *options);
Status create_bend(Simulation *simulation);

#endif
