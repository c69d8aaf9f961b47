/* square_picture.h - the springs and nodes of a square, and what a step does
 * to them.
 *
 * From the ground up: obstacles, rest shape, ghosts, folded cells, springs
 * (broken ones are gone), nodes, pins, directions and forces as arrows, what
 * the mouse holds.
 */
#ifndef ELASTO_SQUARE_PICTURE_H
#define ELASTO_SQUARE_PICTURE_H

#include "picture/picture.h"

extern const Picture square_picture;

/* The node, spring or edge of the paused square under a pixel. */
Pick square_pick(const Show *show, const Plot *stage, double x, double y);

/* A range for the colours: half the strain of the start, at least 5 %. */
double square_picture_strain_range(const Simulation *simulation);

#endif
