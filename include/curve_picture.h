/* curve_picture.h - Newton in one variable: f, its quadratic model where the
 * last update began, and the iterates.
 */
#ifndef ELASTO_CURVE_PICTURE_H
#define ELASTO_CURVE_PICTURE_H

#include "paper.h"
#include "simulation.h"

void curve_picture_draw(Paper *paper, const Simulation *simulation);

#endif
