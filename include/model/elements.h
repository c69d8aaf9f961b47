/* elements.h - terms that are sums over elements of a few nodes.
 *
 * An element's energy W depends on one or two vectors a, b, each a weighted
 * sum of the positions of up to three nodes:
 *
 *   node and wall       a = x_i
 *   node and free ball  a = x_i - x_ball
 *   triangle            a = x_j - x_i,  b = x_k - x_i
 *   point and edge      a = x_p - x_0,  b = x_1 - x_0
 *
 * The source of a term says what W, its gradient and its Hessian are in (a, b);
 * the loops over the elements, the way to the nodes and the entries of the
 * matrix are here.
 */
#ifndef ELASTO_ELEMENTS_H
#define ELASTO_ELEMENTS_H

#include "model/system.h"

/* Part of a gap or an area that one step of the minimisation may use up. */
#define ELEMENT_LIMIT 0.9

/* One of them, at one place. */
typedef struct Element {
    int nodes, vectors; /* 1 ... 3, 1 or 2 */
    int node[3];
    const double (*weight)[3]; /* [vectors] of the nodes in a and in b */
    int block;                 /* it has the entries of this block */
    int from; /* whom it is from, a number of the term: contact's obstacle */
    int more; /* > 0: get is asked for the same i again, and goes on there */
    double factor;  /* of gradient and Hessian: 1, or w where the term's
                       functions leave it out */
    double v[4];    /* m, a and b, for terms that want them */
    double s;       /* what W is about: a gap, an area, a way */
    double n[2], r; /* what else the term's functions want to know */
} Element;

/* a and b, or how they change: v [4] out, of x or p [2n]. */
static inline void element_vectors(const Element *element, const double *x,
                                   double v[4])
{
    for (int m = 0; m < element->vectors; m++) {
        v[2 * m] = v[2 * m + 1] = 0;
        for (int k = 0; k < element->nodes; k++) {
            const double *at = x + 2 * element->node[k];
            v[2 * m] += element->weight[m][k] * at[0];
            v[2 * m + 1] += element->weight[m][k] * at[1];
        }
    }
}

/* What a term says.  Elements are counted from 0. */
struct ElementKind {
    /* Looks for elements before they are counted: those at x, and with p [2n]
     * those that come up until x + alpha p.  NULL: all are known. */
    void (*prepare)(const EvalPoint *at, const double *p, double alpha);
    int (*count)(const EvalPoint *at);

    /* Element i at x.  Returns false where there is nothing, or W is 0 and
     * stays so while a and b change by less than `way`, m, each. */
    bool (*get)(const EvalPoint *at, int i, double way, Element *element);

    /* The blocks of the matrix, each with all entries of 1 to 3 nodes: how many
     * there are; the nodes of one, out, and how many.  x is not known. */
    int (*block_count)(const EvalPoint *at);
    int (*block_nodes)(const EvalPoint *at, int block, int node[3]);

    /* W, J, and its gradient g [4] out; H [4][4] out, projected (TermKind's
     * hessian), returns whether it was changed. */
    double (*value)(const EvalPoint *at, const Element *element);
    void (*gradient)(const EvalPoint *at, const Element *element, double g[4]);
    bool (*hessian)(const EvalPoint *at, const Element *element,
                    Projection projection, double H[4][4]);

    /* Hv [4] = H v, out, where that has more digits than H itself; returns as
     * hessian.  NULL: it has not. */
    bool (*product)(const EvalPoint *at, const Element *element,
                    Projection projection, const double v[4], double Hv[4]);

    /* With P [4], the change of a and b along p: W at alpha minus W minus
     * alpha grad W.P, J, without cancellation; and the alpha that uses up
     * ELEMENT_LIMIT of s, which must stay above 0, where W is not.  NULL: any s
     * will do. */
    double (*line_remainder)(const EvalPoint *at, const Element *element,
                             const double P[4], double alpha);
    double (*max_step)(const EvalPoint *at, const Element *element,
                       const double P[4]);

    /* Of what friction acts on: mu times the normal force, N.  It slides by
     * t.(da, db), t [4] out, on what goes along at `carry`, m/s, out. */
    double (*friction_limit)(const EvalPoint *at, const Element *element,
                             double t[4], double *carry);
};

/* From element to element: for (ElementIterator walk = elements_begin(at, NULL,
 * 0); elements_next(&walk);).  With p [2n] also those whose W begins until
 * alpha p.
 */
typedef struct ElementIterator {
    const EvalPoint *at;
    const ElementKind *kind;
    double way;
    int i, count;
    Element element;
} ElementIterator;

ElementIterator elements_begin(const EvalPoint *at, const double *p,
                               double alpha);
bool elements_next(ElementIterator *walk);

/* Functions of a TermKind with elements. */
double elements_value(const EvalPoint *at);
void elements_gradient(const EvalPoint *at, double *g);
long long elements_entries(const EvalPoint *at);
void elements_pattern(const EvalPoint *at, Triplets *triplets);
int elements_hessian(const EvalPoint *at, Projection projection,
                     const int *slot, const double *q, double *out);
double elements_line_remainder(const EvalPoint *at, const double *p,
                               double alpha);
double elements_max_step(const EvalPoint *at, const double *p);
bool elements_are_feasible(const EvalPoint *at);

/* All of them, for its row. */
#define ELEMENTS(kind)                                                         \
    .element = &(kind), .value = elements_value,                               \
    .gradient = elements_gradient, .entries = elements_entries,                \
    .pattern = elements_pattern, .hessian = elements_hessian,                  \
    .line_remainder = elements_line_remainder, .max_step = elements_max_step,  \
    .is_feasible = elements_are_feasible

#endif
