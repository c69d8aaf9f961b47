/* pull_energy.h - pull of one node to a point o: P(x) = k/2 |x_i - o|^2.
 *
 * Central field: o = 0 and k = m omega2, so the acceleration is -omega2 x.
 * Hand: the mouse pulls a node by a spring of rest length 0, far stiffer than
 * the springs of the square.  Before each step its end o moves ahead of the
 * node towards the mouse.  The change of P in the step is the work of the hand;
 * no energy is stored between steps. */
#pragma once

#include "model/system.h"

extern const TermKind central_field, hand_energy;

/* Data of central_field, and of hand_energy. */
typedef struct NodePull {
    int node;         /* pulled node i */
    double k;         /* J/m^2, stiffness */
    double target[2]; /* m, o */

    /* The following members are for the hand alone. */
    double mouse_xy[2]; /* m, position of the mouse */
    double mouse_k;     /* J/m^2, stiffness with which the mouse pulls */
    double cell_size;   /* m, side of a cell of the pulled body */
    double body_side;   /* m, side of the pulled body */
} NodePull;

/* Adds the term or changes its data.  Returns OK or OUT_OF_MEMORY. */
Status pull_configure(System *system, const TermKind *kind,
                      const NodePull *pull);

/* Sets k and target of the hand before a step.  The node moves part of the way
 * to the mouse: the distance falls by the factor e in 0.06 s, in one step by at
 * most half.  A step moves the node by at most half a cell or, if cells are
 * small, half a body's side a second; twice this speed turns corner cells over.
 *   x, v  [2] m, m/s, in, position and velocity of the node
 *   m, h  kg, mass of the node; s, time step
 *   free  [2] m/s^2, in, for an explicit integrator: acceleration of the node
 *         without the hand.  NULL: implicit integrator */
void hand_begin_step(NodePull *hand, const double *x, const double *v, double m,
                     double h, const double *free);

/* Returns the hand's work (J) as its node moves from x [2] to y [2] m. */
double hand_work(const NodePull *hand, const double *x, const double *y);
