/* tiles.h - where folds run: minimisation node by node between directions of
 * the whole square.
 *
 * When the square buckles, a dislocation of some ten nodes runs along a row,
 * less than a cell for each Newton direction of the whole square.  Tiles of
 * 4 x 16 nodes relax by vertex block descent (Chen, Liu, Yang, Yuksel 2024):
 * each node in turn makes Newton's step for itself alone, with its 2x2 block of
 * the Hessian as it is.  Where E bends up there, a fold is followed that the
 * clamped Hessian sees as flat.  Along such a step E is a quartic with known
 * coefficients.  The step may therefore be longer by a factor without a rise of
 * E, and the decrease of E in each tile is known.
 */
#ifndef ELASTO_TILES_H
#define ELASTO_TILES_H

#include "solve/grid.h"

typedef struct Tiles {
    const Grid *grid;
    int high, wide;   /* tiles */
    double *activity; /* [tiles] what a tile may lower E by, < 0 */
    double *change;   /* [tiles] by its last sweep */
    int *chosen;      /* [tiles] those that relax next */
    long sweeps;      /* sweeps of tiles since the object was made */
} Tiles;

void tiles_lay_out(const Grid *grid, Memory *memory, Tiles *tiles);

/* Relaxes all tiles once, then those that lower E most, until none stands out
 * or they lower it by less than the pace.
 *   pace  < 0, change of E by a sweep that is worth it
 * Returns by how much E has changed, <= 0. */
double tiles_relax(Tiles *tiles, double pace);

#endif
