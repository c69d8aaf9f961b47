/* landscape_picture.h - contours of E over the position of the free node, and
 * Newton's path on them.
 */
#ifndef ELASTO_LANDSCAPE_PICTURE_H
#define ELASTO_LANDSCAPE_PICTURE_H

#include "picture/paper.h"
#include "scenes/simulation.h"

/* Contours with their values, where E is not convex, the springs, the path
 * with directions and step lengths, the direction from here.
 *   text  numbers, axes and legend too */
void landscape_picture_draw(Paper *paper, const Simulation *simulation,
                            bool text);

/* From a pixel of such a picture to metres; false: beside the map.
 *   point  [2] m, out, where it is true */
bool landscape_picture_pick(const Paper *paper, bool text, double x, double y,
                            double *point);

#endif
