/* neo_hookean.h - neo-Hookean energy of a solid of triangles, which replaces
 * the springs (lesson "Inversion-Free Elasticity" of the lecture's author).
 *
 *     d-----c     d-----c     Each cell is cut into two triangles; neighbouring
 *     |   / |     | \   |     cells use different diagonals.  F maps the rest
 *     | /   |     |   \ |     shape of a triangle to its shape, and J = det F:
 *     a-----b     a-----b       W = A0 (mu/2 (|F|^2 - 2) - mu ln J
 *                                       + lambda/2 (ln J)^2)
 *
 * F = [e1 e2]/l, where the legs e1 and e2 start at the right angle and have the
 * length l at rest.  F = F+ + F- (area.h): F+ is a rotation times a number, F-
 * a reflection times a number.  Then J = (|F+|^2 - |F-|^2)/2 and dW/dF = A0 (s
 * F+ + (2 mu - s) F-),  s = (mu (J - 1) + lambda ln J)/J. In this form the
 * rounding errors are proportional to the stress, so a triangle has almost no
 * torque.  The usual form mu F - mu F^-T + ... has rounding errors proportional
 * to mu, whose torque would turn light bodies of stiff material.
 *
 * A flat triangle, J = 0, has infinite energy, so no triangle turns over.
 * Lame's parameters in plane strain: mu = E/(2 (1 + nu)), lambda = E nu/((1 +
 * nu) (1 - 2 nu)).  Options refuse nu < 0: W would have no lower bound. */
#pragma once

#include "model/elements.h"
#include "model/square_mesh.h"

typedef struct NeoHookean {
    Triangles triangles; /* two in each cell, right angle at node a */
    double mu, lambda;   /* J/m^2: Lame's parameters times a thickness of 1 m */
} NeoHookean;

/* The sum of W over the triangles; data: NeoHookean.  configure reads three
 * options: 1 for triangles, Young's modulus E in Pa, and Poisson's ratio nu.
 * The term replaces mass_spring_energy; the sides of the triangles stay in the
 * system as springs, which are drawn. */
extern const TermKind neo_hookean_energy;

/* Returns the data of the term; NULL: the system consists of springs. */
static inline const NeoHookean *get_neo_hookean(const System *system)
{
    return system_term_data(system, &neo_hookean_energy);
}
