/* contact_scenes.h - what the command line has no words for: what moves, what
 * is cut.
 */
#ifndef ELASTO_CONTACT_SCENES_H
#define ELASTO_CONTACT_SCENES_H

#include "run/body.h"


/* Three blocks on slopes; friction, which the option gives for the second
 * number below as what just holds, is 0.5, 0.9 and 1.1 times that. */
Status create_slope(Simulation *simulation);

/* A ceiling comes down on the square and goes up again. */
Obstacle squeeze_ceiling(const Options *options);
Status create_squeeze(Simulation *simulation);

/* Both sides are drawn apart; a slit in the middle opens and runs. */
Status create_tear(Simulation *simulation);

/* A beam with a notch lies on two balls, and a heavy third falls on it. */
Obstacle bend_ball(const Options *options);
Status create_bend(Simulation *simulation);

#endif
