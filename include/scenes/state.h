/* state.h - the state of a simulation as bytes: saved, restored, hashed.
 *
 * Only what a step changes: positions, velocities, what integrators and terms
 * remember, counters.  Scenes that show iterations of one minimisation have no
 * state of this kind: they are begun again and iterated to where they were.
 */
#ifndef ELASTO_STATE_H
#define ELASTO_STATE_H

#include <stddef.h>
#include <stdint.h>

#include "scenes/simulation.h"

/* Bytes of a saved state; 0: this scene has none. */
size_t state_size(const Simulation *simulation);

/* bytes [state_size] out. */
void state_save(const Simulation *simulation, void *bytes);

/* As it was when these bytes were saved.  Solvers forget what they remember
 * from step to step; see SIMULATION_FORGETS.
 *   bytes  [state_size] in, of a simulation with the same system and methods */
void state_restore(const void *bytes, Simulation *simulation);

/* 64 bits of steps, positions and velocities of all runs (FNV-1a): equal
 * states have equal hashes. */
uint64_t state_hash(const Simulation *simulation, uint64_t seed);

/* The seed of the first of several simulations. */
#define STATE_HASH_SEED UINT64_C(14695981039346656037)

#endif
