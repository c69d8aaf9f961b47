/* self_contact.h - contact of bodies with each other and with themselves
 * (lesson "Filter Line Search and Self-Contact" of the lecture's author; Li et
 * al. 2020).
 *
 *            o x_p             A point p of the boundary has the distance d to
 *            | d               an edge of which it is not an end:
 *     x_0 o--+----o x_1          W = c f(d^2/d_hat^2), f of barrier.h.
 *            r                 With q = x_p - x_0 and e = x_1 - x_0
 *                                d^2 = ((e x q)^2 + o^2)/|e|^2,
 *                                o = max(0, -q.e, (q - e).e)
 *
 * o/|e| is how far p is beyond an end of the edge, so one formula has all three
 * cases.  c = A d_hat kappa/16, where A is the length of boundary for each
 * point. A point near a vertex has W with both edges of the vertex, as in the
 * lesson: on a straight boundary the force at a vertex is twice the force
 * between two.
 *
 * The matrix has blocks for the pairs that may be near in this step.  Further
 * pairs that come near during the step get blocks then
 * (TermKind.extend_pattern). */
#pragma once

#include "model/boundary.h"
#include "model/contact.h"

/* A point and an edge that have a block in the Hessian. */
typedef struct PointEdgePair {
    int node, edge_spring; /* numbers of the node and of the edge's spring */
} PointEdgePair;

typedef struct SelfContact {
    double d_hat; /* m, distance at which the barrier begins */
    double c;     /* J, factor on the barrier of a point and an edge */
    double mu;    /* coefficient of friction mu */
    Boundary boundary;
    int pair_count;       /* number of pairs in this step */
    int pair_capacity;    /* number of pairs for which `pair` has room */
    int start_pair_count; /* number of pairs at the start of this step */
    PointEdgePair *pair;  /* [pair_capacity] start pairs (sorted), new pairs */
} SelfContact;

/* Barrier energy of all points p near edges; data: SelfContact.  An Element is
 * a near pair: a = x_p - x_0, b = x_1 - x_0, s = (distance/d_hat)^2, n the unit
 * vector from the edge to p, r in [0, 1] the place on the edge nearest to p. */
extern const TermKind self_contact_energy;

/* Adds the term or changes its numbers.
 *   barrier   that of a node and an obstacle; SelfContact.c is 1/8 of its c
 *   friction  coefficient of friction mu
 * Returns OK or OUT_OF_MEMORY. */
Status self_contact_configure(System *system, const SquareMesh *mesh,
                              const Barrier *barrier, double friction);

/* Returns the data of the term; NULL: the system has no self-contact. */
SelfContact *get_self_contact(const System *system);
