/* contact_scenes.h - the last slides: contact, inelasticity, fracture.
 *
 * Each scene is a row of options and, where the command line has no words for
 * it, what moves or what is cut.
 */
#ifndef ELASTO_CONTACT_SCENES_H
#define ELASTO_CONTACT_SCENES_H

#include "model/contact.h"
#include "scenes/simulation.h"

/* A square tumbles down between two walls. */
void drop_defaults(Options *options);

/* Three blocks on slopes; friction, which the option gives for the second
 * number below as what just holds, is 0.5, 0.9 and 1.1 times that. */
void slope_defaults(Options *options);
Status create_slope(Simulation *simulation, const NewtonSettings *settings);

/* A ceiling comes down on the square and goes up again. */
void squeeze_defaults(Options *options);
Obstacle squeeze_ceiling(const Options *options);
Status create_squeeze(Simulation *simulation, const NewtonSettings *settings);

/* Springs that flow: a ball leaves its mark. */
void dent_defaults(Options *options);

/* Both sides are drawn apart; a slit in the middle opens and runs. */
void tear_defaults(Options *options);
Status create_tear(Simulation *simulation, const NewtonSettings *settings);

/* A beam with a notch lies on two balls, and a heavy third falls on it. */
void bend_defaults(Options *options);
Obstacle bend_ball(const Options *options);
Status create_bend(Simulation *simulation, const NewtonSettings *settings);

#endif
