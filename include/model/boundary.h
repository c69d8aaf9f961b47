/* boundary.h - the boundary of the bodies, and a search for edges near a point.
 *
 *     d-----c      A triangle is solid if its three springs are whole.  A cell
 *     |   / |      counts as the two triangles abd and cdb if both are solid,
 *     | /   |      else as bca and dac if both are solid, else as abd or cdb
 *     a-----b      alone.  An edge of the boundary is a side with one solid
 *                  triangle.  The points are the ends of the edges and the
 *                  nodes without a solid triangle.  Springs without a solid
 *                  triangle (threads) are no edges.
 *
 * Springs only break, so solid triangles only become fewer.  As long as no cell
 * turns over, the edges that a break exposes cross no other edge.
 *
 * Search: a box holds what a point or an edge covers on its way.  The boxes of
 * the edges are sorted by their left side.  A point visits the edges from the
 * first one that may reach it to the right side of its own box. */
#pragma once

#include "model/square_mesh.h"
#include "model/system.h"

/* The rectangle that a point or an edge covers on its way, m.  Coordinate 0 is
 * the one along which the bodies are longer (Boundary.sorts_by_y). */
typedef struct SweptBox {
    double low[2], high[2];
    int edge_spring; /* spring of the edge; -1: the box of a point */
} SweptBox;

typedef struct Boundary {
    SquareMesh mesh;
    unsigned system_version; /* System.version when the boundary was found */
    int point_count, edge_count; /* numbers of points and edges */
    int *point_node;             /* [nodes] node of each point */
    SweptBox *edge_box;          /* [springs] boxes of the edges, sorted */
    SweptBox *point_box;         /* [nodes] box of the point at each node */
    unsigned char
        *spring_triangle_count; /* [springs] count of solid triangles */
    unsigned char *node_role;   /* [nodes] bits: in a triangle, on an edge */

    /* Motion for which the boxes were made: from x by alpha (p - mean_p). */
    bool has_valid_boxes; /* the boxes are those of the present boundary */
    bool is_swept;        /* the boxes cover the way along p, not x alone */
    double *x, *p;     /* [2n] m, start and motion; free(x) frees all arrays */
    double alpha;      /* the boxes cover the motion alpha p */
    double mean_p[2];  /* m, mean of p over the points; a motion that all points
                          share brings none closer to an edge */
    double box_margin; /* m, added to each box at all sides */
    double max_box_width; /* m, largest width of an edge's box (coordinate 0) */
    bool sorts_by_y;      /* coordinate 0 of the boxes is y, not x */
    bool has_all_near_edges; /* near_edge had room for all near edges */
    int *near_edge;     /* [8 * nodes] springs of near edges, point by point */
    int *near_list_end; /* [nodes] end of each point's edges in near_edge */
} Boundary;

/* Allocates the arrays; free(boundary->x) frees all.  OK or OUT_OF_MEMORY. */
Status boundary_create(const SquareMesh *mesh, Boundary *boundary);

/* Finds the boundary again if springs have changed, and the near edges of each
 * point on the way from x to x + alpha p.
 *   x       [2n] m, in
 *   p       [2n] m, in; NULL: no motion
 *   margin  m, added to each box at all sides */
void boundary_update(Boundary *boundary, const System *system, const double *x,
                     const double *p, double alpha, double margin);

/* Returns the next edge that point i, 0 ... point_count-1, may meet.
 *   cursor  in/out, 0 before the first edge and after the last one
 * Returns the spring of the edge; -1 after the last edge. */
int boundary_near_edge(const Boundary *boundary, const System *system, int i,
                       int *cursor);
