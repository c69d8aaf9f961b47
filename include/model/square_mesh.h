/* square_mesh.h - mesh of the square (slide square_mesh.py): nodes, springs,
 * cells, triangles, outline and sides.  A mesh has one or more equal bodies;
 * their nodes, springs and cells are stored one body after another.
 *
 * A body has (columns+1) (rows+1) nodes on a grid centred at the origin.  Node
 * i*(rows+1)+j is column i, row j, counted from the lower left.  The springs of
 * a body are in this order: horizontal, vertical, the two diagonals of each
 * cell. Only multigrid uses these numbers directly. */
#pragma once

#include <stdbool.h>

enum {
    SQUARE_MESH_MAX_SEGMENTS = 4096,
    SQUARE_MESH_MAX_BODIES = 16,
    SQUARE_MESH_MAX_CELLS = SQUARE_MESH_MAX_SEGMENTS * SQUARE_MESH_MAX_SEGMENTS
};

typedef struct SquareMesh {
    int columns;    /* number of segments a side; of columns in a beam */
    int rows;       /* number of rows of cells */
    int bodies;     /* number of bodies */
    double side;    /* m, width of a body */
    double spacing; /* m, distance of neighbouring nodes, side/columns */
    int nodes;      /* n, number of nodes of all bodies */
    int springs;    /* number of springs of all bodies */
    int cells;      /* number of cells of all bodies; four triangles each */
    int outline_edge_count; /* number of outer edges of all bodies */
} SquareMesh;

/* Returns twice the signed area of the triangle a b p (m^2): positive if p is
 * left of the line from a to b. */
static inline double twice_signed_area(const double *a, const double *b,
                                       const double *p)
{
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/* Sides of a body; square_mesh_get_node_sides adds them up. */
enum { MESH_LEFT = 1, MESH_RIGHT = 2, MESH_BOTTOM = 4, MESH_TOP = 8 };

/* Returns the mesh with these numbers.
 *   columns  of cells, 1 ... SQUARE_MESH_MAX_SEGMENTS
 *   rows     of cells; equal to columns: a square, else a beam of square cells
 *   side     m, width of a body
 *   bodies   1 ... SQUARE_MESH_MAX_BODIES */
SquareMesh square_mesh_create(int columns, int rows, double side, int bodies);

/* Writes the two nodes of each spring.  e [2 springs] out. */
void square_mesh_list_springs(const SquareMesh *shape, int *e);

/* Writes the place of each node in the elimination order.  By nested dissection
 * a Cholesky factor has O(n log n) entries.  order [n] out. */
void square_mesh_order_nodes(const SquareMesh *shape, int *order);

/* Returns the body that has a node. */
int square_mesh_find_body(const SquareMesh *shape, int node);

/* Writes the position of node i at rest.  x [2] m, out. */
void square_mesh_rest_position(const SquareMesh *shape, int i, double x[2]);

/* Returns the sum of the sides on which node i lies, MESH_LEFT + ... */
int square_mesh_get_node_sides(const SquareMesh *shape, int i);

/* Writes the nodes and springs of cell c, 0 ... cells-1.
 *   node    [4] out, its corners a b c d, anticlockwise from the lower left
 *   spring  [6] out: ab bc dc ad ac bd */
void square_mesh_get_cell(const SquareMesh *shape, int c, int node[4],
                          int spring[6]);

/* Writes the triangle t = 4 c + k: corner k of cell c and its two neighbours.
 *   node  [3] out, anticlockwise from the corner
 *   side  [3] out, springs node[0]-node[1], node[1]-node[2], node[2]-node[0] */
void square_mesh_get_triangle(const SquareMesh *shape, int t, int node[3],
                              int side[3]);

/* Returns the first of the cells cell ... end-1 that contains a point, or -1.
 * Contact tests nodes only, and would not notice a small ball inside a cell.
 *   x   [2n] m, in, positions of the nodes
 *   at  [2] m, in, the point */
int square_mesh_find_cell(const SquareMesh *shape, const double *x,
                          const double *at, int cell, int end);

/* Writes the corners of the square patch, `cells` cells wide, whose lower left
 * cell is c; patches at the right and upper side may be smaller.  The patches
 * cover the square once.  Returns whether a patch begins at c.
 *   node  [4] out, anticlockwise from the lower left */
bool square_mesh_get_cell_patch(const SquareMesh *shape, int c, int cells,
                                int node[4]);

/* Writes the nodes of edge k of the outline, 0 ... outline_edge_count - 1.  The
 * edges of a body go anticlockwise from its lower left corner. */
void square_mesh_get_outline_edge(const SquareMesh *shape, int k, int node[2]);
