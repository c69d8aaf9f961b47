/* square_mesh.h - the square of masses and springs (slide square_mesh.py).
 *
 * (columns+1) (rows+1) nodes on a grid centred at the origin.  Node
 * i*(rows+1)+j is column i, row j, counted from the lower left.  Springs, in
 * this order: horizontal, vertical, then the two diagonals of each cell.
 */
#ifndef ELASTO_SQUARE_MESH_H
#define ELASTO_SQUARE_MESH_H

#include "base/status.h"

enum { SQUARE_MESH_MAX_SEGMENTS = 4096 };

typedef struct SquareMesh {
    int segments; /* segments per side; of a beam: columns of cells */
    int rows;     /* of cells */
    double side;  /* m */
    int nodes;    /* n = (segments+1) (rows+1) */
    int springs;  /* in a square 2 segments (segments+1) + 2 segments^2 */
    double *x;    /* [2n] m, rest positions: node i is x[2i], x[2i+1] */
    int *e;       /* [2 springs] nodes of each spring */
    int *order;   /* [n] place of node i in the elimination order, by nested
                     dissection: a Cholesky factor has O(n log n) entries */
} SquareMesh;

/* Builds the mesh.
 *   columns, rows  of cells, 1 ... SQUARE_MESH_MAX_SEGMENTS; equal: the square,
 *                  else a beam of square cells
 *   side           m, of all columns, finite and > 0
 *   mesh           out; free it with square_mesh_free, also after a failure
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
Status square_mesh_create(int columns, int rows, double side, SquareMesh *mesh);

/* Accepts NULL and a zeroed struct. */
void square_mesh_free(SquareMesh *mesh);

#endif
