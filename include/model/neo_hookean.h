/* neo_hookean.h - a solid of triangles in the place of springs (lesson
 * "Inversion-Free Elasticity" of the lecture's author).
 *
 *     d-----c     d-----c     Each cell is cut into two triangles, by one or
 *     |   / |     | \   |     the other diagonal in turn.  F = [f1 f2] maps a
 *     | /   |     |   \ |     triangle's rest shape to its shape, J = det F:
 *     a-----b     a-----b       W = A0 (mu/2 (|F|^2 - 2) - mu ln J
 *                                       + lambda/2 (ln J)^2)
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
    double area;            /* m^2, A0 of each */
    double mu, lambda;      /* J/m^2, of an area */
    double (*weight)[2][3]; /* [triangles] 1/m, of its nodes in f1 and in f2 */
    int (*node)[3];         /* [triangles] anticlockwise at rest */
} NeoHookean;

/* sum of W over the triangles; data: NeoHookean.  Its option's numbers are: 1
 * for triangles, Young's modulus E in J/m^2, Poisson's ratio nu.  The springs
 * leave the list of terms; in the system stay the triangles' sides. */
extern const TermKind neo_hookean_energy;

/* Its data, or NULL: the system is one of springs. */
static inline const NeoHookean *solid_of(const System *system)
{
    return system_data(system, &neo_hookean_energy);
}

#endif
