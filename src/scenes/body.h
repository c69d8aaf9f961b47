/* body.h - the body that options describe: the square, or a beam of square
 * cells, where it begins, what it meets, and what becomes of its springs.
 */
#ifndef ELASTO_BODY_H
#define ELASTO_BODY_H

#include <stddef.h>

#include "model/contact.h"
#include "scenes/simulation.h"

/* The square, or of its rows the part that options->aspect says; without
 * arrays. */
SquareMesh body_shape(const Options *options);

/* Mesh, masses, springs and rest lengths (slide simulator.py): the mass of all
 * cells shared out evenly over the nodes; l2 = |d|^2 in the rest positions.
 * Gravity and pins.
 *   more          nodes that are not in the mesh, the last ones, with the mass
 *                 of the others and without springs
 *   mesh, system  out; free them in any case
 * Returns OK, INVALID_INPUT, TOO_LARGE, OUT_OF_MEMORY. */
Status body_create(const Options *options, int more, SquareMesh *mesh,
                   System *system);

/* Terms of contact, friction, plasticity, cells and fracture, as the options
 * have them.
 *   more, obstacle  obstacles that follow those of the options
 * Returns OK, TOO_LARGE, OUT_OF_MEMORY, INVALID_INPUT. */
Status body_add_terms(const Options *options, const SquareMesh *mesh, int more,
                      const Obstacle *obstacle, System *system);

/* A run of the body from where the options put it.
 *   more  [4 ...] m, m/s: position and velocity of each node that is not in the
 *         mesh; NULL: there is none
 *   run   out; free it in any case
 * Returns as time_integrator_create. */
Status body_start(const Options *options, const SquareMesh *mesh,
                  System *system, const NewtonSettings *settings,
                  const double *more, TimeIntegrator *run);

/* What the options ask for that only a step whose result is the minimiser
 * knows, in words; NULL: nothing. */
const char *body_needs_end_of_step(const Options *options);

/* Whether the body can begin where the options put it: obstacles make sense,
 * all gaps and cells are > 0.
 *   message  [size] out, one line after INVALID_INPUT */
Status body_check(const Options *options, char *message, size_t size);

#endif
