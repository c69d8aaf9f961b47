/* control.h - all that somebody decides about a run: its options, which nodes
 * are pinned, and what a hand holds.  With a state (state.h) it determines the
 * next state.
 */
#ifndef ELASTO_CONTROL_H
#define ELASTO_CONTROL_H

#include "scenes/simulation.h"

/* Never changed once it is made: all that need it share it. */
typedef struct Control {
    int users; /* counted; 0: freed */
    Options options;
    int hand;     /* the node that it holds; -1: none */
    double at[2]; /* m, where it pulls it */
    int nodes;
    unsigned char pinned[]; /* [nodes] 1: it never moves */
} Control;

/* What a simulation has now; the same once more.  One user, who may change it
 * as long as it is alone.  NULL: no memory. */
Control *control_of(const Simulation *simulation);
Control *control_copy(const Control *from);

/* [2] m, where a ground or, behind those, a ball of the options is. */
double *obstacle_at(Options *options, int number);

/* One user more, one less; NULL is accepted. */
const Control *control_keep(const Control *control);
void control_drop(const Control *control);

/* From now on the simulation is one with this control; scene, mesh and start
 * must be those that it has.  What this does to the energy is booked as work.
 * Returns as simulation_create; after a failure only simulation_free is
 * allowed. */
Status simulation_use(Simulation *simulation, const Control *control);

#endif
