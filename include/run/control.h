/* control.h - what a step is a function of: all that somebody decides about a
 * run, its options, which nodes are pinned, and what a hand holds; and the
 * state before it.
 */
#ifndef ELASTO_CONTROL_H
#define ELASTO_CONTROL_H

#include <stddef.h>
#include <stdint.h>

#include "run/simulation.h"

/* Never changed once it is made: all that need it share it. */
typedef struct Control {
    int users; /* counted; 0: freed */
    Options options;
    int hand;     /* the node that it holds; -1: none */
    int push;     /* Number of the obstacle that the hand holds; -1: none. */
    double at[2]; /* m, where it pulls it */
    int nodes;
    unsigned char pinned[]; /* [nodes] 1: it never moves */
} Control;

/* What a simulation has now; the same once more.  One user, who may change it
 * as long as it is alone.  NULL: no memory. */
Control *control_of(const Simulation *simulation);
Control *control_copy(const Control *from);

/* Whether the hand holds a node or an obstacle. */
bool control_holds(const Control *control);

/* [2] m, where a ground or, behind those, a ball of the options is. */
double *obstacle_at(Options *options, int number);

/* at [2] m, out: where a run has this obstacle now, as the options count it. */
void simulation_obstacle(const Simulation *simulation, int run, int number,
                         double at[2]);

/* Gives the obstacle with this number the place in the options that it has now
 * in the simulation, unless its runs differ in that. */
void control_keep_place(Control *control, int number,
                        const Simulation *simulation);

/* One user more, one less; NULL is accepted. */
const Control *control_keep(const Control *control);
void control_drop(const Control *control);

/* From now on the simulation is one with this control; scene, mesh and start
 * must be those that it has.  What this does to the energy is booked as work.
 * Returns as simulation_create; after a failure only simulation_free is
 * allowed. */
Status simulation_use(Simulation *simulation, const Control *control);

/* ---- the state ----------------------------------------------------------- */

/* All that a step changes, as bytes: positions, velocities, what integrators
 * and terms remember, counters; of the lecture's small scenes what they show,
 * too, and of those that show iterations the minimisation that is under way. */

/* Returns how many bytes it has.  bytes: out, or NULL. */
size_t state_save(const Simulation *simulation, void *bytes);

/* As it was when these bytes were saved.  Springs that are whole, and walls,
 * have the numbers of the simulation's options.
 *   bytes  in, of a simulation with the same system */
void state_restore(const void *bytes, Simulation *simulation);

/* 64 bits of steps, positions and velocities of all runs (FNV-1a): equal
 * states have equal hashes. */
uint64_t state_hash(const Simulation *simulation, uint64_t seed);

/* The seed of the first of several simulations. */
#define STATE_HASH_SEED UINT64_C(14695981039346656037)

#endif
