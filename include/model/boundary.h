/* boundary.h - the boundary of all that is solid, and which of its points come
 * near which of its edges.
 *
 *     d-----c      A cell gives both triangles of a diagonal where both are
 *     |   / |      solid (their three springs are whole): abd and cdb, else bca
 *     | /   |      and dac; else abd or cdb alone.  A side that has one
 *     a-----b      triangle is an edge; its ends, and nodes of no triangle, are
 *                  points.  Springs without triangles are threads: nothing
 *                  meets them.
 *
 * What is solid only becomes less as springs break: where no cell turns over,
 * edges that a break brings to light cross none.
 *
 * Boxes hold what points and edges pass; the edges' are sorted by their left
 * side, and a point looks from the widest edge before it to its own right side.
 */
#ifndef ELASTO_BOUNDARY_H
#define ELASTO_BOUNDARY_H

#include "model/square_mesh.h"
#include "model/system.h"

/* m, what a point or an edge fills on its way; the coordinate along which all
 * together are longer comes first. */
typedef struct Box2 {
    double low[2], high[2];
    int edge; /* whose it is, a spring; -1 of points */
} Box2;

typedef struct Boundary {
    SquareMesh shape;
    unsigned version;     /* of the system, that it is of */
    int points, edges;    /* how many */
    int *point;           /* [nodes] nodes */
    Box2 *box;            /* [springs] of the edges, sorted */
    Box2 *way;            /* [nodes] of the points */
    unsigned char *sides; /* [springs] triangles on it */
    unsigned char *role;  /* [nodes] */
    /* The way that the boxes are of: from x along alpha p less its mean, and
     * this much more around; widest of the edges' boxes. */
    bool known, moves; /* whether it is the present one; p counts */
    double *x, *p;     /* [2n] */
    double alpha, mean[2], margin, widest;
    bool upright;     /* the boxes' first coordinate is y */
    bool listed;      /* there was room for what is near: of point i it is */
    int *near, *last; /* near[last[i - 1]] and on, until near[last[i]] */
} Boundary;

/* Bytes of all arrays; and puts them there. */
size_t boundary_bytes(const SquareMesh *mesh);
void boundary_lay_out(const SquareMesh *mesh, void *bytes, Boundary *boundary);

/* Makes the boxes of x [2n] along alpha p [2n], NULL: of x alone, each wider by
 * `margin`, m, at all sides; and finds the boundary, if springs have changed.
 */
void boundary_sort(Boundary *boundary, const System *system, const double *x,
                   const double *p, double alpha, double margin);

/* The next edge that point i (a number of `point`) may meet.
 *   place  in/out, 0: before the first
 * Returns a spring; or -1, and place is 0 again. */
int boundary_next(const Boundary *boundary, const System *system, int i,
                  int *place);

#endif
