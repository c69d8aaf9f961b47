/* control.h - the inputs of a step: control (a user's decisions) and state. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "simulation/simulation.h"

/* Decisions of a user about a run.  A control that steps share is constant. */
typedef struct UserControl {
    int ref_count; /* number of references; without any the control is freed */
    Options options;
    int held_node;             /* node that the mouse holds; -1: none */
    int held_obstacle;         /* obstacle that the mouse holds; -1: none */
    double target[2];          /* place to which the hand pulls or pushes (m) */
    int nodes;                 /* number of nodes */
    unsigned char is_pinned[]; /* [nodes] 1: pinned, 0: free */
} UserControl;

/* Make a control from a simulation, with nothing held, or copy a control.  The
 * caller may change the result before control_retain.  NULL: no memory. */
UserControl *control_create(const Simulation *simulation);
UserControl *control_copy(const UserControl *from);

/* Whether the mouse holds a node or an obstacle. */
bool control_is_holding(const UserControl *control);

/* Finds the place of an obstacle in a run without the height
 * that the scene adds (body_find_added_height).
 *   at  [2] out, m */
void simulation_locate_obstacle(const Simulation *simulation, int run,
                                int number, double at[2]);

/* Copies an obstacle's place to the options if it is the same in all runs. */
void control_store_obstacle(UserControl *control, int number,
                            const Simulation *simulation);

/* Adds a reference, and returns the control; NULL is accepted. */
const UserControl *control_retain(const UserControl *control);

/* Removes a reference; the last one frees the control.  NULL is accepted. */
void control_release(const UserControl *control);

/* Gives a simulation a control from the next step on.  Scene, mesh and start of
 * the control must be those of the simulation.  The change of the energy is
 * booked as work.  Returns as simulation_create; after a failure only
 * simulation_free may follow. */
Status control_apply(Simulation *simulation, const UserControl *control);

/* Puts a node of run 0 at rest at (x, y), m, and books the change of energy.
 *   moves  false: only checks whether the node can be there
 * Returns OK, or INVALID_INPUT if there is no such node, an obstacle or a body
 * is in the way, or a cell would be turned over. */
Status simulation_move_node(Simulation *simulation, int node, double x,
                            double y, bool moves);

/* ---- the state ----------------------------------------------------------- */

/* The state is what a step depends on besides the control: positions,
 * velocities, memory of integrators and terms, step counts, scene data. */

/* Writes the state as bytes, unless `bytes` is NULL.  Returns their number. */
size_t state_save(const Simulation *simulation, void *bytes);

/* Restores a saved state.  Obstacles, plastic strains and the stiffnesses of
 * springs that can break or be switched get their saved values.  The control
 * has all other numbers, so control_apply comes first.
 *   bytes  in, from a simulation with the same system */
void state_restore(const void *bytes, Simulation *simulation);

/* Returns the hash (FNV-1a) of steps, positions and velocities of all runs.
 *   seed  STATE_HASH_SEED, or the hash of the previous simulation, if several
 *         are hashed together */
uint64_t state_hash(const Simulation *simulation, uint64_t seed);

#define STATE_HASH_SEED UINT64_C(14695981039346656037)
