/* square_pen.h - a body of a square's scene as it is drawn: springs, nodes,
 * faces, outlines, and what obstacles do to it; what square_picture.c puts its
 * layers together from.
 */
#ifndef ELASTO_SQUARE_PEN_H
#define ELASTO_SQUARE_PEN_H

#include "model/contact.h"
#include "picture/plot.h"

/* One run of a pane, and what does not change from spring to spring.  Widths
 * and radii in units of the paper. */
typedef struct SpringPen {
    Plot *stage;
    const Simulation *simulation; /* the stage's */
    const Pane *pane;
    const System *system;
    const double *x, *v;    /* [2n] m, m/s */
    double spacing;         /* pixels, of two nodes at rest; where they have
                               flown away, of as many over all that is seen */
    double width;           /* of a spring */
    double radius;          /* of a node */
    double strain;          /* of the shades of faces, all blue */
    double range;           /* of the colours of strains; 0: all blue, */
    Colour below, above;    /* and at its ends */
    bool plastic;           /* they are of the plastic strain ... */
    const double *ep;       /* [springs] of each; NULL: springs do not flow */
    const Contact *contact; /* NULL: there is nothing to touch */
    EvalPoint contacts;     /* the place that tells of them */
    bool projected;         /* springs whose block was changed are lit */
    unsigned fixed;         /* bit b: of several bodies b has pins alone, and is
                               drawn as walls are */
} SpringPen;

SpringPen square_pen(Plot *stage, int run);

/* All springs but the broken ones, one in a colour of its own; discs at all
 * nodes but those that the springs hide. */
void square_spring(const SpringPen *pen, int s, double width, Colour colour);
void square_springs(const SpringPen *pen);
void square_nodes(const SpringPen *pen);

/* The cells of a fine square as shaded faces, those that have folded over dark,
 * and its outline; of cells below some pixels, larger ones in their place. */
void square_faces(const SpringPen *pen);

/* Cells whose springs are whole are filled lightly, if all are asked for; those
 * that have turned over in another colour.  Returns how many have. */
int square_cells(const SpringPen *pen, bool all);

/* The outline of the square at x, NULL: at rest; of a small one all springs
 * faintly, and it in dashes. */
void square_outline(const SpringPen *pen, const double *x, bool dashed,
                    Colour colour);
void square_ghost(const SpringPen *pen, const double *x, Colour colour);

/* ---- contact: it follows from positions and velocities alone, so that a state
 * from the history is drawn as it was when it was new ---------------------- */

/* The contacts of a run: for (ElementIterator at = square_contacts(pen);
 * elements_next(&at);) square_touch(pen, &at.element). */
ElementIterator square_contacts(const SpringPen *pen);

/* One of them as it is now, with the normal force of now. */
typedef struct Touch {
    int node;
    double force[2]; /* N, on the node, friction included */
    bool rough;      /* it has friction ... */
    bool slides;     /* ... and is faster than eps_v */
} Touch;
Touch square_touch(const SpringPen *pen, const Element *element);

/* Walls and balls of a run.  Several runs have theirs as slabs, so that they
 * stay apart. */
void square_contact_obstacles(const SpringPen *pen);

/* Under a run's first wall, right of what lies on it, if the wall has a slope:
 * its coefficient of friction as a part of the slope. */
void square_contact_words(const SpringPen *pen);

/* Forces of contact and friction of all runs as arrows that end at their nodes,
 * the longest, up to a round number, some ems long; a disc where friction holds
 * a node, a ring where it slides; and what they mean. */
void square_contact_forces(const SpringPen *pen, int runs);

#endif
