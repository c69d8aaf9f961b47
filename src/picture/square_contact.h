/* square_contact.h - what bodies meet: walls and balls, the forces of contact
 * and friction, and which contacts stick.
 *
 * All of it follows from positions and velocities alone, so that a state from
 * the history is drawn as it was when it was new.
 */
#ifndef ELASTO_SQUARE_CONTACT_H
#define ELASTO_SQUARE_CONTACT_H

#include "picture/marks.h"
#include "scenes/simulation.h"

/* A run whose contacts are drawn. */
typedef struct ContactView {
    Paper *paper;
    const Stage *stage;
    const TimeIntegrator *run; /* its system and velocities */
    const double *x;           /* [2n] m, where its nodes are drawn */
    double h;                  /* s, the time step */
    double grip; /* its friction is this times the options'; 0: once */
    double node; /* pixels, radius of a node's disc */
} ContactView;

/* Whether runs have systems of their own, such as three slopes. */
bool square_contact_apart(const Simulation *simulation);

/* One contact as it is now. */
typedef struct Touch {
    double force[2]; /* N, on the node, friction included */
    bool rough;      /* it has friction ... */
    bool slides;     /* ... and is faster than eps_v */
} Touch;

/* What this obstacle does to this node, with the normal force of now; false:
 * nothing. */
bool square_contact_touch(const ContactView *view, int node, int obstacle,
                          Touch *touch);

/* Walls and balls of the run; thin walls: as slabs, so that those of several
 * runs stay apart. */
void square_contact_obstacles(const ContactView *view, bool thin);

/* The largest force that an obstacle and its friction put on a node, N. */
double square_contact_most(const ContactView *view);

/* These forces as arrows that end at their nodes, `most` some ems long; a disc
 * where friction holds a node, a ring where it slides. */
void square_contact_forces(const ContactView *view, double most);

/* What arrows, discs and rings mean. */
void square_contact_legend(const ContactView *view, double most,
                           Legend *legend);

/* The first wall's coefficient of friction as a part of the options' and of its
 * slope, and whether the body slides; false: it has no slope.  text [size] out
 */
bool square_contact_words(const ContactView *view, char *text, size_t size);

/* These words under the left end of that wall. */
void square_contact_label(const ContactView *view);

#endif
