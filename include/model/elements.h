/* elements.h - terms whose energy is a sum over elements of a few nodes.
 *
 * The energy W of an element depends on one or two vectors a and b.  Each
 * vector is a weighted sum of the positions of up to three nodes:
 *
 *   node and wall       a = x_i
 *   node and free ball  a = x_i - x_ball
 *   triangle            a = x_j - x_i,  b = x_k - x_i
 *   point and edge      a = x_p - x_0,  b = x_1 - x_0
 *
 * The source of a term has W, its gradient and its Hessian in (a, b).  Loops,
 * the step from (a, b) to the nodes and the matrix are in elements.c. */
#pragma once

#include "model/system.h"

/* Fraction of a gap or an area that one Newton update may use up. */
#define ELEMENT_LIMIT 0.9

/* An element is a group of one to three nodes with an energy W, such as a
 * triangle or a node near a wall, at given positions. */
typedef struct Element {
    int node_count;                 /* 1 ... 3 */
    int vector_count;               /* 1: W depends on a vector a; 2: a, b */
    int node[3];                    /* [node_count] */
    const double (*node_weight)[3]; /* [vector_count] weights of nodes */
    int block_index;   /* index of the block in the Hessian; -1: none yet */
    int partner_index; /* obstacle (contact) or spring of the edge
                          (self-contact) */
    int search_cursor; /* > 0: get_element(i) finds more elements from here */
    double derivative_factor; /* EvalPoint.weight; 1 if the kind's gradient
                                 and hessian contain this factor */
    double v[4];    /* m, the vectors a and b, if the kind uses them */
    double s;       /* argument of W: a gap, a ratio of areas or a slip */
    double n[2], r; /* further numbers, explained at each TermKind */
} Element;

/* Computes the element's vectors a and b, which are weighted sums of its nodes'
 * positions, or their change along a direction.
 *   x  [2n] m, in, positions or a direction
 *   v  [4] m, out, a and b */
static inline void element_compute_vectors(const Element *element,
                                           const double *x, double v[4])
{
    for (int m = 0; m < element->vector_count; m++) {
        v[2 * m] = v[2 * m + 1] = 0;
        for (int k = 0; k < element->node_count; k++) {
            const double *at = x + 2 * element->node[k];
            v[2 * m] += element->node_weight[m][k] * at[0];
            v[2 * m + 1] += element->node_weight[m][k] * at[1];
        }
    }
}

/* Triangles of equal rest area, for a term with a triangle as element; the
 * data of the term begin with this struct. */
typedef struct Triangles {
    int count;         /* number of triangles */
    double rest_area;  /* m^2, A0 of each triangle at rest */
    double inverse_J0; /* 1/m^2, 1/(2 A0); inverse_J0 (a x b) is 1 at rest */
    int (*node)[3]; /* [count] nodes a, b, c of each triangle, anticlockwise */
} Triangles;

/* The functions of one kind of element.  Elements are numbered from 0. */
struct ElementKind {
    /* Finds the elements at x and, with p [2n], on the way to x + alpha p; is
     * called before count_elements.  NULL: the elements never change. */
    void (*find_elements)(const EvalPoint *at, const double *p, double alpha);

    /* Number of elements. */
    int (*count_elements)(const EvalPoint *at);

    /* Computes element i at x.  Returns false if i has no element, or if W is 0
     * for all changes of a and of b by less than `way` (m). */
    bool (*get_element)(const EvalPoint *at, int i, double way,
                        Element *element);

    /* Number of dense blocks of the Hessian, each for 1 to 3 nodes.  The
     * number does not depend on x, so EvalPoint.x may be NULL. */
    int (*count_blocks)(const EvalPoint *at);

    /* Writes the nodes of a block of the Hessian, returns their number. */
    int (*get_block_nodes)(const EvalPoint *at, int block, int node[3]);

    /* Returns the energy W of the element, in joules. */
    double (*potential)(const EvalPoint *at, const Element *element);

    /* Writes the gradient of W in (a, b) to g. */
    void (*gradient)(const EvalPoint *at, const Element *element, double g[4]);

    /* Writes the projected Hessian of W in (a, b).  Returns whether an
     * eigenvalue was changed. */
    bool (*hessian)(const EvalPoint *at, const Element *element,
                    Projection projection, double H[4][4]);

    /* Writes Hv = H v with more digits than the numbers of H allow.  Returns
     * whether the projection changed H.  NULL: the product with H is enough. */
    bool (*apply_hessian)(const EvalPoint *at, const Element *element,
                          Projection projection, const double v[4],
                          double Hv[4]);

    /* Returns W((a, b) + alpha P) - W - alpha grad W.P in joules, computed
     * without cancellation.  P [4] is the change of (a, b) along p. */
    double (*taylor_remainder)(const EvalPoint *at, const Element *element,
                               const double P[4], double alpha);

    /* Returns the alpha along P at which about the fraction ELEMENT_LIMIT of
     * the gap or area is used up.  NULL: W exists for s <= 0, too. */
    double (*max_alpha)(const EvalPoint *at, const Element *element,
                        const double P[4]);

    /* Returns mu times the normal force (N), the largest force of friction.
     *   t      [4] out, tangent: the contact slides by t.(da, db)
     *   speed  m/s, out, speed of the obstacle along t
     * A kind without this function has no friction. */
    double (*friction_limit)(const EvalPoint *at, const Element *element,
                             double t[4], double *speed);
};

/* A loop over the elements that may have W > 0 at x and, with p [2n], on the
 * way to x + alpha p: begins with elements_begin(at, p, alpha), goes on while
 * elements_next(&walk). */
typedef struct ElementIterator {
    const EvalPoint *eval_point;
    const ElementKind *kind;
    double motion_bound;  /* m, limit of the change of a and b by alpha p */
    int i, element_count; /* present element: 0 ... element_count-1 */
    Element element;      /* present element */
} ElementIterator;

ElementIterator elements_begin(const EvalPoint *at, const double *p,
                               double alpha);
bool elements_next(ElementIterator *walk);

/* TermKind's functions for terms with elements (term.h). */
double elements_potential(const EvalPoint *at);
void elements_gradient(const EvalPoint *at, double *g);
void elements_add_triplets(const EvalPoint *at, Triplets *triplets);
int elements_hessian(const EvalPoint *at, Projection projection,
                     const int **slot, const double *q, double *out);
double elements_taylor_remainder(const EvalPoint *at, const double *p,
                                 double alpha);

/* Returns an alpha > 0 up to which the gaps and areas of all elements stay
 * positive along p.  INFINITY: no element limits alpha <= 1. */
double elements_max_alpha(const EvalPoint *at, const double *p);

/* Whether the energy P exists at x: kinds with max_alpha need Element.s > 0.
 * Iterates are tested, too, as rounding can close a gap. */
bool elements_are_feasible(const EvalPoint *at);

/* First members in the initialiser of each TermKind with elements. */
#define ELEMENTS(kind)                                                         \
    .element = &(kind), .potential = elements_potential,                       \
    .gradient = elements_gradient, .add_triplets = elements_add_triplets,      \
    .hessian = elements_hessian, .taylor_remainder = elements_taylor_remainder
