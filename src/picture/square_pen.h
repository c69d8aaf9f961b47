/* square_pen.h - springs, nodes, outlines and cells of a square, as they are
 * drawn: what square_picture.c puts its layers together from.
 */
#ifndef ELASTO_SQUARE_PEN_H
#define ELASTO_SQUARE_PEN_H

#include "model/contact.h"
#include "picture/marks.h"
#include "scenes/simulation.h"

/* What does not change from spring to spring. */
typedef struct SpringPen {
    Paper *paper;
    const Stage *stage;
    const Pane *pane;
    const double *x;        /* [2n] m */
    double *at;             /* [2n] pixels; NULL: not enough memory */
    double spacing;         /* pixels, of two nodes at rest */
    double width;           /* pixels */
    double range;           /* of the strains; 0: all blue */
    double strain;          /* of the shades of faces, all blue */
    bool plastic;           /* the colour is the plastic strain ... */
    const double *ep;       /* [springs] of each; NULL: springs do not flow */
    const Contact *contact; /* NULL: there is nothing to touch */
    bool projected;         /* springs whose block was changed are lit */
} SpringPen;

/* For this run of the stage's pane; the places of its nodes stand on the paper
 * until another pen is made. */
SpringPen square_pen(Paper *paper, const Stage *stage, const Show *show,
                     int run);

/* All springs but the broken ones. */
void square_pen_springs(const SpringPen *pen, const System *system);

/* The cells of a fine square as shaded faces, those that have folded over dark,
 * and its outline; of cells below a pixel, larger ones in their place. */
void square_pen_faces(const SpringPen *pen, const SquareMesh *mesh);

/* Radius of the nodes' discs, pixels. */
double square_pen_radius(const SpringPen *pen, bool bare);

/* Discs at all nodes; those that the springs hide are left out. */
void square_pen_nodes(const SpringPen *pen, const System *system, bool bare);

/* The outline of the square at x. */
void square_outline(Paper *paper, const Stage *stage, const SquareMesh *mesh,
                    const double *x, bool dashed, Colour colour);

/* All springs of a small square, faintly, and its outline in dashes. */
void square_ghost(Paper *paper, const Stage *stage,
                  const Simulation *simulation, const double *x, Colour colour);

/* Cells whose four sides are whole are filled lightly, if all are asked for;
 * those that have turned over in another colour.  Returns how many have. */
int square_pen_cells(const SpringPen *pen, const Simulation *simulation,
                     bool all);

#endif
