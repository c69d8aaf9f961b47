/* square_pen.h - the layers from which square_picture.c draws a body of springs
 * or triangles: springs, nodes, faces, outlines, obstacles, contact forces. */
#pragma once

#include "model/contact.h"
#include "picture/plot.h"

/* A run on the stage, and how it is drawn; sizes in units of the paper. */
typedef struct SquarePen {
    Plot *stage;
    const Simulation *simulation; /* simulation of the stage */
    const System *system;
    const double *x, *v; /* [2n] m, m/s */
    double spacing; /* pixels between nodes at rest; more if nodes flew apart */
    double width;   /* width of a spring */
    double node_radius;
    double shade_strain;    /* strain of the lightest shade of faces */
    double colour_range;    /* strain of the end colours; 0: no colours */
    bool shows_plastic;     /* colours show plastic strain */
    const double *ep;       /* [springs] plastic strain; NULL: no plasticity */
    const Contact *contact; /* NULL: the scene has no contact */
    bool shows_projected;   /* springs with a projected block are coloured */
    unsigned fixed_body_mask; /* bit b: body b is pinned everywhere and drawn
                                 like a wall; 0 for a single body */
} SquarePen;

SquarePen square_pen_create(Plot *stage, int run);

/* Draws one spring. */
void square_draw_spring(const SquarePen *pen, int s, double width,
                        Colour colour);

/* Draws all unbroken springs, or all nodes except those of a fine mesh. */
void square_draw_springs(const SquarePen *pen);
void square_draw_nodes(const SquarePen *pen);

/* Draws a fine mesh as shaded faces of a few pixels; folded cells are dark. */
void square_draw_faces(const SquarePen *pen);

/* Fills the unbroken cells in a pale colour, folded ones in red.  A neo-Hookean
 * body instead has its triangles filled, darker if smaller than at rest.
 * Returns the number of folded cells.
 *   all  false: fills only the folded cells */
int square_fill_cells(const SquarePen *pen, bool all);

/* Draws the outline at positions x; NULL: the rest shape. */
void square_draw_outline(const SquarePen *pen, const double *x, bool dashed,
                         Colour colour);

/* Draws a ghost: a dashed outline, and faint springs if the mesh is coarse. */
void square_draw_ghost(const SquarePen *pen, const double *x, Colour colour);

/* Draws the walls and balls of a run.  If there are several runs, walls are
 * thin slabs, which do not cover each other. */
void square_draw_obstacles(const SquarePen *pen);

/* If the first wall slopes, writes its coefficient of friction as a multiple of
 * the slope, below the wall and right of the body. */
void square_draw_mu_label(const SquarePen *pen);

/* Draws the forces of contact and friction of all runs as arrows that end at
 * their nodes, with their scale in the legend.  A disc marks a node that
 * friction holds, a ring a node that slides. */
void square_draw_forces(const SquarePen *pen, int runs);
