/* state.h - the state of a simulation as bytes: saved, restored, hashed.
 *
 * All that a step changes: positions, velocities, what integrators and terms
 * remember, counters; of the lecture's small scenes what they show, too, and of
 * those that show iterations the minimisation that is under way.
 */
#ifndef ELASTO_STATE_H
#define ELASTO_STATE_H

#include <stddef.h>
#include <stdint.h>

#include "scenes/simulation.h"

/* Bytes of a saved state. */
size_t state_bytes(const Simulation *simulation);

/* bytes [state_bytes] out. */
void state_save(const Simulation *simulation, void *bytes);

/* As it was when these bytes were saved.  Springs that are whole, and walls,
 * have the numbers of the simulation's options.
 *   bytes  [state_bytes] in, of a simulation with the same system */
void state_restore(const void *bytes, Simulation *simulation);

/* 64 bits of steps, positions and velocities of all runs (FNV-1a): equal
 * states have equal hashes. */
uint64_t state_hash(const Simulation *simulation, uint64_t seed);

/* The seed of the first of several simulations. */
#define STATE_HASH_SEED UINT64_C(14695981039346656037)

#endif
