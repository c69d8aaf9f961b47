/* tiles.h - a direction from minimisation of E node by node.
 *
 * A square that buckles has folds: dislocations of some ten nodes.  A fold
 * moves along a row of cells, by less than a cell for each Newton direction of
 * the whole square.  Tiles of 4 x 16 nodes relax by vertex block descent (Chen,
 * Liu, Yang, Yuksel 2024): each node in turn makes Newton's step for itself
 * alone, with its 2x2 block of the Hessian, unclamped if the block is positive
 * definite.  A node can then follow a fold in directions in which a clamped
 * Hessian has no curvature from springs.  Along a node's step E is a quartic
 * with known coefficients: a longer step is made where E falls, and the
 * decrease of E in each tile is known.
 *
 * Tiles work in single precision on a copy of x.  Near the minimum, where
 * nodes move by less than the rounding of the copy, the copy stays unchanged,
 * and the springs' forces change with the nodes' displacements alone.
 * The result is a direction; the caller minimises E along it in doubles. */
#pragma once

#include "solve/grid.h"

typedef struct Tiles {
    const Grid *grid;
    int rows, columns;   /* number of rows and of columns of tiles */
    double *activity;    /* [tiles] change of E that a sweep may bring, < 0 */
    double *last_change; /* [tiles] change of E by the tile's last sweep */
    int *active_tiles;   /* [tiles] indices of the tiles that are swept next */
    bool has_tiny_moves; /* nodes move by less than the rounding of
                            Grid.float_x, which then stays unchanged */
    float *u;            /* [2 planes] displacements since the start */
    float *start_g;      /* [2 planes] grad E at the start if has_tiny_moves,
                            otherwise only the gradient of the masses' energy */
    long sweeps;         /* number of sweeps since the object was made */
} Tiles;

void tiles_init(const Grid *grid, ArrayArena *memory, Tiles *tiles);

/* Sweeps all tiles once, then in rounds those with the largest Tiles.activity,
 * until a sweep lowers E by less than the pace, or by little in comparison with
 * the sweeps before.
 *   pace  grid units, < 0, change of E for which a tile's sweep is worth its
 *         time
 *   p     [2 planes] out, displacements of the nodes
 * Returns the change of E, grid units, by the first sweep of all tiles. */
double tiles_relax(Tiles *tiles, double pace, double *p);
