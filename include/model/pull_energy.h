/* pull_energy.h - nodes that are drawn to a point: P(x) = sum c_i/2 |x_i -
 * o|^2.
 *
 * Central field: c_i = m_i omega2 and o = 0; each node has the acceleration
 * -omega2 x.  Hand: one node, on a spring without rest length; moving the hand
 * changes P while x stays, and that is the work it does.
 */
#ifndef ELASTO_PULL_ENERGY_H
#define ELASTO_PULL_ENERGY_H

#include "model/system.h"

extern const TermKind central_field, hand_energy;

/* The data of both. */
typedef struct Pull {
    int node;         /* that is pulled; -1: all are, by their masses */
    double k;         /* J/m^2; for all: omega2, 1/s^2 */
    double target[2]; /* m, o */
} Pull;

/* Adds a pull of one of these kinds, or changes the one that there is.
 * Returns OK, OUT_OF_MEMORY, TOO_LARGE (no room in the list). */
Status pull_set(System *system, const TermKind *kind, const Pull *pull);

/* The same with the field; takes it away where omega2 is 0, 1/s^2. */
Status central_field_set(System *system, double omega2);

/* The hand of a system, or NULL; its target and k may be changed. */
Pull *hand_energy_of(const System *system);

#endif
