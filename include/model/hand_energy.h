/* hand_energy.h - a hand that pulls one node: P(x) = k/2 |x_i - target|^2.
 *
 * The spring between the node and the place of the hand has no length at rest.
 * Moving the hand changes P while x stays: that is the work it does.
 */
#ifndef ELASTO_HAND_ENERGY_H
#define ELASTO_HAND_ENERGY_H

#include "model/system.h"

extern const TermKind hand_energy;

typedef struct HandEnergy {
    int node;         /* i */
    double k;         /* J/m^2 */
    double target[2]; /* m */
} HandEnergy;

/* The hand takes a node, or another one.  Returns OK, INVALID_INPUT (there is
 * no such node), OUT_OF_MEMORY, TOO_LARGE (no room in the list). */
Status hand_energy_set(System *system, const HandEnergy *hand);

/* It lets go; nothing where there is no hand. */
void hand_energy_remove(System *system);

/* The hand of a system, or NULL; its target and k may be changed. */
HandEnergy *hand_energy_of(const System *system);

/* P(x), J; 0 where there is no hand.  x [2n] m, in. */
double hand_energy_value(const System *system, const double *x);

#endif
