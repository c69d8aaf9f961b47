/* gauss_seidel.h - smoothing: the incremental potential made smaller one node
 * at a time.
 *
 * A sweep goes through the nodes; each takes the projected Newton step of its
 * own two coordinates while all others stand still: nonlinear block
 * Gauss-Seidel (Ortega, Rheinboldt: Iterative Solution of Nonlinear Equations,
 * 7.4; for elastic bodies Chen et al.: Vertex Block Descent, 2024).  That
 * removes what is wrong between neighbours for a few gradients' time and leaves
 * what is wrong at large; an old factor of the Hessian does the opposite.
 * Together they are a two-level method, the factor in the place of the coarse
 * grid (Briggs et al.: A Multigrid Tutorial, chapter 3).
 *
 * Nodes are coloured so that no spring joins two of the same colour: those can
 * move in any order, several in each machine instruction.
 */
#ifndef ELASTO_GAUSS_SEIDEL_H
#define ELASTO_GAUSS_SEIDEL_H

#include "solve/incremental_potential.h"
#include "base/lanes.h"

/* One spring of each node of a group; c = 0 where a node has fewer than the
 * others. */
typedef struct SpringLanes {
    double l2[LANES]; /* m^2, rest length squared */
    double c[LANES];  /* J/m^4, 2 k / l2 */
    int other[LANES]; /* node at the other end */
} SpringLanes;

/* Nodes of one colour, which are moved together. */
typedef struct NodeLanes {
    int node[LANES]; /* the last again where a colour ends */
    int end;         /* past the last of their springs */
} NodeLanes;

typedef struct GaussSeidel {
    int groups;          /* of LANES nodes */
    NodeLanes *group;    /* [groups]; NULL: not created */
    SpringLanes *spring; /* [last group's end] */
} GaussSeidel;

/* Colours the nodes that are not pinned and lists their springs.
 * Returns OK, OUT_OF_MEMORY; free it in any case. */
Status gauss_seidel_create(const System *system, GaussSeidel *smoother);
void gauss_seidel_free(GaussSeidel *smoother);

/* One sweep over all nodes, the last first if backward.  E must not be
 * averaged.  Nothing promises that E falls.
 *   u, x  [2n] m, in/out: displacement and x_n + u; may end not finite */
void gauss_seidel_sweep(const GaussSeidel *smoother,
                        const IncrementalPotential *E, bool backward, double *u,
                        double *x);

/* Some sweeps, there and back, and the line search of Algorithm 2 along the
 * way they went.
 *   g       [2n] grad E, in
 *   u, x    [2n] m, in/out; unchanged where no way down was found
 *   s       [2n] m, out: the way gone
 *   change  J s^2, out: of E, <= 0
 * Returns the number of energies that the line search looked at. */
int gauss_seidel_smooth(const GaussSeidel *smoother,
                        const IncrementalPotential *E, const double *g,
                        double *u, double *x, double *s, double *change);

#endif
