/* pull_energy.h - a node that is drawn to a point: P(x) = k/2 |x_i - o|^2.
 *
 * Central field: o = 0; with k = m omega2 the node has the acceleration -omega2
 * x.  Hand: a spring without rest length that is far stiffer than those of the
 * square.  Its end o goes ahead of the node, step by step, towards the mouse:
 * what it does in a step is its work, and between steps it stores nothing.
 */
#ifndef ELASTO_PULL_ENERGY_H
#define ELASTO_PULL_ENERGY_H

#include "model/system.h"

extern const TermKind central_field, hand_energy;

/* The data of both. */
typedef struct Pull {
    int node;         /* that is pulled */
    double k;         /* J/m^2 */
    double target[2]; /* m, o */
    /* Of a hand: */
    double mouse[2]; /* m, where it wants the node; */
    double strength; /* J/m^2, how strongly it insists; */
    double cell;     /* m, side of a cell, and */
    double side;     /* m, of the body that it pulls at */
} Pull;

/* Adds a pull of one of these kinds, or changes the one that there is.
 * Returns OK, OUT_OF_MEMORY. */
Status pull_set(System *system, const TermKind *kind, const Pull *pull);

/* Before a step of h s from x, v [2] of its node with the mass m, kg: its k and
 * target.  The node then goes a part of the way, half of it at most, and in
 * short steps so much that the distance falls by e in 0.06 s; but not beyond
 * half a cell or, where cells are small, half a side in a second: at twice that
 * the cells at a corner turn over.
 *   free  [2] m/s^2, the node's acceleration without the hand, of an explicit
 *         method, in which the force has to be that which leads there; NULL:
 *         an implicit one, in which a stiff spring does */
void hand_begin_step(Pull *hand, const double *x, const double *v, double m,
                     double h, const double *free);

/* J, the work it did in a step from x to y [2]. */
double hand_work(const Pull *hand, const double *x, const double *y);

#endif
