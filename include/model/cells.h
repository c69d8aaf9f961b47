/* cells.h - barrier energy that keeps cells from turning over.
 *
 *     d-----c     A spring has the same energy in a cell that is turned inside
 *     |\   /|     out, which therefore stays so.  The term gives each of the
 *     |  X  |     four corner triangles of a cell a barrier in its area.  With
 *     |/   \|     e1 = x_b - x_a and e2 = x_c - x_a,
 *     a-----b       J = (e1 x e2)/(2 A0)   1 at rest, 0 if flat
 *                   W = c f(J/J_hat)       J, c = A0 k_c, f of barrier.h
 *
 * J_hat is 0.4: a triangle with more than 40 % of its area has no force. */
#pragma once

#include "model/elements.h"
#include "model/square_mesh.h"

#define CELL_J_HAT 0.4 /* area over rest area at which the barrier begins */

typedef struct CellBarriers {
    Triangles triangles;    /* four triangles in each cell */
    int (*side_springs)[3]; /* [triangles.count] springs at the sides */
    double c;               /* J, A0 k_c */
} CellBarriers;

/* The sum of W over triangles without a broken spring; data: CellBarriers. */
extern const TermKind cell_energy;

/* Adds the term with all triangles of the mesh, or changes its stiffness.
 *   stiffness  J/m^2, k_c
 * Returns OK or OUT_OF_MEMORY. */
Status cells_configure(System *system, const SquareMesh *shape,
                       double stiffness);
