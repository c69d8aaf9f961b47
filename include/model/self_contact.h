/* self_contact.h - bodies that touch each other and themselves (lesson "Filter
 * Line Search and Self-Contact" of the lecture's author; Li et al. 2020).
 *
 *            o x_p             A point p of the boundary keeps the distance d
 *            | d               to each edge that it is no end of:
 *     x_0 o--+----o x_1          W = c f(d^2/d_hat^2), f of barrier.h.
 *            r                 q = x_p - x_0, e = x_1 - x_0:
 *                                d^2 = ((e x q)^2 + o^2)/|e|^2,
 *                                o = max(0, -q.e, (q - e).e)
 *
 * o being how far p is past an end: one formula for all three cases.  c is
 * A d_hat kappa/16, A the length of boundary that a point stands for.  A vertex
 * counts with both its edges, as in the lesson: over an even boundary the force
 * is twice as large at each of its nodes as between two.  Pairs come and go, so
 * the matrix has entries for those that may be near in this step, and gets more
 * where others come near after all.
 */
#ifndef ELASTO_SELF_CONTACT_H
#define ELASTO_SELF_CONTACT_H

#include "model/boundary.h"
#include "model/contact.h"

/* A point and an edge that have a block of the matrix. */
typedef struct SelfPair {
    int node, edge;
} SelfPair;

/* The term's data. */
typedef struct SelfContact {
    double d_hat, c; /* m; J, of a point and an edge */
    double friction; /* mu */
    Boundary boundary;
    int pairs, room; /* blocks of this step; */
    int sorted;      /* those that were known at its start, */
    SelfPair *pair;  /* [room] sorted, and then the others */
} SelfContact;

/* sum of W over all points and edges; data: SelfContact.  Its elements are
 * those that are near: a is q, b is e, s is d^2/d_hat^2, n points from the edge
 * to p, r is the place on the edge, 0 ... 1. */
extern const TermKind self_contact_energy;

/* Adds the term, or gives it these numbers: of a node and an obstacle, and the
 * coefficient of friction.  Returns OK, OUT_OF_MEMORY. */
Status self_contact_set(System *system, const SquareMesh *mesh,
                        const Barrier *barrier, double friction);

/* The term's data, or NULL. */
SelfContact *self_contact_of(const System *system);

#endif
