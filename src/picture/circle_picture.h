/* circle_picture.h - integrators on the circle: trails, radius over time.
 */
#ifndef ELASTO_CIRCLE_PICTURE_H
#define ELASTO_CIRCLE_PICTURE_H

#include "picture/hud.h"
#include "picture/paper.h"

/* The exact circle of radius 1 m, and the trail of each run. */
void circle_picture_draw(Paper *paper, const Simulation *simulation,
                         const Hud *hud);

/* Lower left: radius over time.  Lower right: which colour is which run, and
 * its radius. */
void circle_picture_panels(Paper *paper, const Simulation *simulation,
                           const Hud *hud);

#endif
