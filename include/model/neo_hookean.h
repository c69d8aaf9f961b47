/* neo_hookean.h - a solid of triangles in the place of springs (lesson
 * "Inversion-Free Elasticity" of the lecture's author).
 *
 *     d-----c     d-----c     Each cell is cut into two triangles, by one or
 *     |   / |     | \   |     the other diagonal in turn.  F maps a triangle's
 *     | /   |     |   \ |     rest shape to its shape, J = det F:
 *     a-----b     a-----b       W = A0 (mu/2 (|F|^2 - 2) - mu ln J
 *                                       + lambda/2 (ln J)^2)
 *
 * F = [e1 e2]/l with the two legs e1, e2 from the right angle, which have the
 * length l at rest.  F = F+ + F- is a rotation times a number, and what shears
 * (area.h): J = (|F+|^2 - |F-|^2)/2, and the stress is
 *   dW/dF = A0 (s F+ + (2 mu - s) F-),  s = (mu (J - 1) + lambda ln J)/J.
 * A triangle has no torque but for rounding of this stress: that of
 * mu F - mu F^-T + ... would be as large as mu, which turns light bodies of
 * stiff material.
 *
 * A flat triangle, J = 0, has infinite energy: none ever turns over, whereas
 * springs do not know inside from outside.  Lame's numbers in plane strain:
 * mu = E/(2 (1 + nu)), lambda = E nu/((1 + nu) (1 - 2 nu)).  Below nu = 0
 * lambda is negative, and W has no lower bound: such numbers are not taken.
 */
#ifndef ELASTO_NEO_HOOKEAN_H
#define ELASTO_NEO_HOOKEAN_H

#include "model/square_mesh.h"
#include "model/system.h"

/* The term's data. */
typedef struct NeoHookean {
    int triangles;
    double area;       /* m^2, A0 of each */
    double mu, lambda; /* J/m^2, Pa times a thickness of 1 m */
    int (*node)[3];    /* [triangles] the right angle's, then anticlockwise */
} NeoHookean;

/* sum of W over the triangles; data: NeoHookean.  Its option's numbers are: 1
 * for triangles, Young's modulus E in Pa, Poisson's ratio nu.  The springs
 * leave the list of terms; in the system stay the triangles' sides. */
extern const TermKind neo_hookean_energy;

/* Its data, or NULL: the system is one of springs. */
static inline const NeoHookean *neo_hookean_of(const System *system)
{
    return system_term_data(system, &neo_hookean_energy);
}

#endif
