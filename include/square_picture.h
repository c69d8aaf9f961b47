/* square_picture.h - the springs and the discs of a square.
 */
#ifndef ELASTO_SQUARE_PICTURE_H
#define ELASTO_SQUARE_PICTURE_H

#include "paper.h"
#include "simulation.h"

/* Springs drawn, and those left out because they would be below 2 pixels. */
typedef struct SpringCount {
    long drawn, skipped;
} SpringCount;

/* Draws run 0 so that the square as it starts fills 57 % of the paper, and
 * discs of radius 0.1 side/segments at its nodes.
 *   strain_range  springs are coloured from -range to range; 0: all blue */
SpringCount square_picture_draw(Paper *paper, const Simulation *simulation,
                                double strain_range);

/* A range for the colours: half the strain of the start, at least 5 %. */
double square_picture_strain_range(const Simulation *simulation);

#endif
