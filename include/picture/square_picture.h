/* square_picture.h - the springs and the discs of a square; what Newton did;
 * its energies over time.
 */
#ifndef ELASTO_SQUARE_PICTURE_H
#define ELASTO_SQUARE_PICTURE_H

#include "picture/hud.h"
#include "picture/picture.h"

/* Draws run 0 so that the square as it starts (a squeezed one: as far as it
 * will spring) fills 57 % of the paper, and discs of radius 0.1 side/segments
 * at its nodes.
 *   strain_range  springs are coloured from -range to range; 0: all blue */
SpringCount square_picture_draw(Paper *paper, const Simulation *simulation,
                                double strain_range);

/* Upper right: what Newton did in the last step.  Lower left: the energies
 * over time.  Lower right: their numbers, and which colour is which strain.
 *   strain_range  as above; 0: springs are not coloured */
void square_picture_panels(Paper *paper, const Simulation *simulation,
                           const Hud *hud, double strain_range);

/* A range for the colours: half the strain of the start, at least 5 %. */
double square_picture_strain_range(const Simulation *simulation);

#endif
