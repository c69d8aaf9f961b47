/* curve_picture.h - Newton in one variable: f, its quadratic model where the
 * last update began, the minimum of the model, and the iterates.
 */
#ifndef ELASTO_CURVE_PICTURE_H
#define ELASTO_CURVE_PICTURE_H

#include "picture/paper.h"
#include "scenes/simulation.h"

/* text  numbers, axes and legend too */
void curve_picture_draw(Paper *paper, const Simulation *simulation, bool text);

#endif
