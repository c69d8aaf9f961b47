/* square_mesh.h - the square of masses and springs (slide square_mesh.py), and
 * its shape: cells, their triangles, the outline, the sides.  There may be
 * several alike: their nodes, springs and cells stand one body after another.
 *
 * (columns+1) (rows+1) nodes on a grid centred at the origin.  Node
 * i*(rows+1)+j is column i, row j, counted from the lower left.  Springs, in
 * this order: horizontal, vertical, then the two diagonals of each cell.  Who
 * wants the springs of a cell or the nodes of the outline asks here: nobody
 * else counts them out, but for multigrid and the grid's planes.
 */
#ifndef ELASTO_SQUARE_MESH_H
#define ELASTO_SQUARE_MESH_H

#include <stdbool.h>

enum {
    SQUARE_MESH_MAX_SEGMENTS = 4096,
    SQUARE_MESH_MAX_BODIES = 16,
    SQUARE_MESH_MAX_CELLS = SQUARE_MESH_MAX_SEGMENTS * SQUARE_MESH_MAX_SEGMENTS
};

typedef struct SquareMesh {
    int segments;   /* segments per side; of a beam: columns of cells */
    int rows;       /* of cells */
    int bodies;     /* so many of them; what follows is of all together */
    double side;    /* m */
    double spacing; /* m, between neighbours: side/segments */
    int nodes;      /* n = (segments+1) (rows+1), of each */
    int springs;    /* in a square 2 segments (segments+1) + 2 segments^2 */
    int cells;      /* segments rows; each has four triangles */
    int outline;    /* edges on it, 2 (segments + rows) */
} SquareMesh;

/* The sides that a node is on, added up. */
enum { MESH_LEFT = 1, MESH_RIGHT = 2, MESH_BOTTOM = 4, MESH_TOP = 8 };

/* Its numbers.
 *   columns, rows  of cells, 1 ... SQUARE_MESH_MAX_SEGMENTS; equal: the square,
 *                  else a beam of square cells
 *   side           m, of all columns
 *   bodies         1 ... SQUARE_MESH_MAX_BODIES */
SquareMesh square_mesh_create(int columns, int rows, double side, int bodies);

/* The nodes of each spring, e [2 springs] out; and the place of each node in
 * the elimination order, by nested dissection: a Cholesky factor has O(n log n)
 * entries.  order [n] out */
void square_mesh_list_springs(const SquareMesh *shape, int *e);
void square_mesh_order_nodes(const SquareMesh *shape, int *order);

/* The body of node i, which becomes its number there. */
int square_mesh_locate_body(const SquareMesh *shape, int *i);

/* Where node i is at rest, x [2] m, out; and the sides that it is on. */
void square_mesh_rest_position(const SquareMesh *shape, int i, double x[2]);
int square_mesh_get_sides(const SquareMesh *shape, int i);

/* What cell c, 0 ... cells-1, is made of.
 *   node    [4] out, its corners a b c d, anticlockwise from the lower left
 *   spring  [6] out: ab bc dc ad ac bd */
void square_mesh_get_cell(const SquareMesh *shape, int c, int node[4],
                          int spring[6]);

/* Triangle t = 4 c + k is corner k of cell c with the neighbours of that
 * corner.
 *   node  [3] out, anticlockwise from the corner
 *   side  [3] out, springs */
void square_mesh_get_triangle(const SquareMesh *shape, int t, int node[3],
                              int side[3]);

/* The first of the cells cell ... end - 1 that the point at [2] is in or on the
 * border of, m, where the nodes are at x [2n] m; -1: none.  Contact sees nodes
 * alone: a small ball may have none near it in a cell. */
int square_mesh_find_cell(const SquareMesh *shape, const double *x,
                          const double *at, int cell, int end);

/* Whether triangle t is one of the two that a cell is cut into, by one or the
 * other diagonal in turn: ac where column + row is even. */
bool square_mesh_is_half(const SquareMesh *shape, int t);

/* The corners of so many times so many cells of which c is the lower left one;
 * fewer at the edges.  node [4] out, anticlockwise.  Returns false where no
 * such patch begins at c: with all others they cover the square once. */
bool square_mesh_get_patch(const SquareMesh *shape, int c, int cells,
                           int node[4]);

/* Both nodes of edge k of the outlines, 0 ... outline-1: anticlockwise from the
 * lower left, one edge after another. */
void square_mesh_get_outline_edge(const SquareMesh *shape, int k, int node[2]);

#endif
