/* cells.h - cells that cannot turn over.
 *
 *     d-----c     Springs do not know inside from outside: a cell that was
 *     |\   /|     pushed through itself stays so.  Each cell's four corner
 *     |  X  |     triangles (any three nodes that are joined pairwise) get a
 *     |/   \|     barrier in the area: J = (e1 x e2)/(2 A0), e1 = x_b - x_a,
 *     a-----b     e2 = x_c - x_a, is 1 at rest and 0 when it is flat;
 *                 W = c f(J/J_hat), c = A0 k_c in J.
 *
 * J_hat = 0.4: no effect before a triangle is squeezed below 40 %.  The same
 * with |d| of all edges is in Smith et al.: Stable Neo-Hookean Flesh
 * Simulation, 2018; the eigenvectors of J's Hessian are from there too.
 */
#ifndef ELASTO_CELLS_H
#define ELASTO_CELLS_H

#include "model/square_mesh.h"
#include "model/system.h"

#define CELL_J_HAT 0.4

/* ---- the term -------------------------------------------------------- */

/* The term's data. */
typedef struct Cells {
    int triangles;
    int *node;   /* [3 triangles] a, b, c */
    int *spring; /* [3 triangles] its sides; it breaks with any of them */
    double area; /* m^2, A0 of all */
    double c;    /* J, A0 k_c */
} Cells;

/* sum of W over the triangles whose springs are whole; data: Cells. */
extern const TermKind cell_energy;

/* Adds all triangles of the mesh, or gives those that are there this stiffness,
 * J/m^2, k_c.  Returns OK, OUT_OF_MEMORY. */
Status cells_set(System *system, const SquareMesh *shape, double stiffness);

#endif
