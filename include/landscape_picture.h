/* landscape_picture.h - contours of E over the position of the free node, and
 * Newton's path on them.
 */
#ifndef ELASTO_LANDSCAPE_PICTURE_H
#define ELASTO_LANDSCAPE_PICTURE_H

#include "paper.h"
#include "simulation.h"

/* Contours, springs, path and the present direction. */
void landscape_picture_draw(Paper *paper, const Simulation *simulation);

/* Lower left: which line is what. */
void landscape_picture_legend(Paper *paper);

/* From a pixel of the paper to metres.  point [2] out */
void landscape_picture_pick(const Paper *paper, double x, double y,
                            double *point);

#endif
