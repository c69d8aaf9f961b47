/* square_pen.h - the layers from which square_picture.c draws a body of springs
 * or triangles: springs, nodes, faces, outlines, obstacles, contact forces.
 */
#ifndef ELASTO_SQUARE_PEN_H
#define ELASTO_SQUARE_PEN_H

#include "model/contact.h"
#include "picture/plot.h"

/* A run on the stage, and how its springs and nodes are drawn.  Widths and
 * radii are in units of the paper. */
typedef struct SquarePen {
    Plot *stage;
    const Simulation *simulation; /* simulation of the stage */
    const System *system;
    const double *x, *v;    /* [2n] m, m/s */
    double spacing;         /* pixels between two nodes at rest, or more if the
                               nodes have flown apart */
    double width;           /* width of a spring */
    double radius;          /* radius of a node */
    double shade_strain;    /* strain of the lightest and darkest face */
    double colour_range;    /* strain of the end colours; 0: springs are blue */
    Colour below, above;    /* end colours at -colour_range, +colour_range */
    bool shows_plastic;     /* colours show plastic strain, not strain */
    const double *ep;       /* [springs] plastic strain; NULL: no plasticity */
    const Contact *contact; /* NULL: the scene has no contact */
    EvalPoint contact_at;   /* evaluation point of the contact term */
    bool shows_projected;   /* springs with a projected block are coloured */
    unsigned fixed_bodies;  /* bit b: body b is pinned everywhere and drawn like
                               a wall; 0 for a single body */
} SquarePen;

SquarePen square_pen_create(Plot *stage, int run);

/* Draws one spring. */
void square_spring(const SquarePen *pen, int s, double width, Colour colour);

/* Draws all unbroken springs, or all nodes; those of a fine mesh are left out,
 * as springs hide them. */
void square_springs(const SquarePen *pen);
void square_nodes(const SquarePen *pen);

/* Draws a fine mesh as shaded faces of at least a few pixels, with dark folded
 * cells and an outline. */
void square_faces(const SquarePen *pen);

/* Fills the unbroken cells in a pale colour, the folded ones in red; all false:
 * only the folded ones.  Of a solid fills the triangles.  Returns the number of
 * folded cells. */
int square_cells(const SquarePen *pen, bool all);

/* Draws the outline at positions x; NULL: the rest shape. */
void square_outline(const SquarePen *pen, const double *x, bool dashed,
                    Colour colour);

/* Draws a ghost at positions x: the dashed outline, and faint springs if there
 * are not many. */
void square_ghost(const SquarePen *pen, const double *x, Colour colour);

/* Draws walls and balls of a run.  With several runs walls are thin slabs,
 * which do not cover each other. */
void square_contact_obstacles(const SquarePen *pen);

/* Writes the coefficient of friction of a sloping first wall, as a multiple of
 * the slope, below the wall and right of the body. */
void square_contact_slope(const SquarePen *pen);

/* Draws the forces of contact and friction of all runs as arrows that end at
 * their nodes, with their scale in the legend.  A disc marks a node that
 * friction holds, a ring one that slides. */
void square_contact_forces(const SquarePen *pen, int runs);

#endif
