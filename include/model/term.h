/* term.h - one summand of the potential: P(x) = sum of a scene's terms.
 *
 * A scene's System holds a list of terms; what a scene lacks is not in its
 * list.  Every function goes over whole arrays: a term costs one indirect call
 * and its loop stays tight.  A term is one source file with one row of
 * functions (a TermKind); a function that is NULL has nothing to add there.
 * Terms need not look at pins: whoever calls them takes the gradient of pinned
 * nodes out of g and their entries out of the Hessian.
 */
#ifndef ELASTO_TERM_H
#define ELASTO_TERM_H

#include "base/sparse.h"
#include "model/psd.h"

typedef struct System System;
typedef struct TermKind TermKind;
typedef struct ElementKind ElementKind;
typedef struct Term Term;
struct SquareMesh;

/* Where and with what a term is evaluated. */
typedef struct EvalPoint {
    const System *system;
    const Term *term;  /* term that is evaluated; NULL: none is selected yet */
    double weight;     /* s^2, factor on everything that is added to an array;
                          h^2 for implicit Euler */
    const double *x_n; /* [2n] m, start of the step */
    const double *u;   /* [2n] m, displacement from x_n; NULL: no step */
    const double *x;   /* [2n] m, x_n + u */
    const struct Damping *damping; /* damping of this step; NULL: none */
    const double *k, *l2; /* [springs] stiffness and rest length of this step:
                             those of the system, or what damping makes of
                             them */
} EvalPoint;

/* A point with w = 1 and no term selected. */
EvalPoint eval_point_at(const System *system, const double *x_n,
                        const double *u, const double *x);

/* Selects term t of the system's list; returns its functions.  A loop over
 * 0 <= t < system->terms evaluates all terms. */
const TermKind *eval_point_term(EvalPoint *at, int t);

/* A step's begin or end. */
typedef struct TermStep {
    System *system;
    Term *term;
    const double *x, *v; /* [2n] m, m/s */
    double h;            /* s */
} TermStep;

struct TermKind {
    /* In messages; NULL: no option brings it. */
    const char *name;

    /* Puts the term in with the numbers of its option, of which one at least is
     * not 0, or gives them to the one that is there; NULL: it asks for more
     * than these.  Returns OK, OUT_OF_MEMORY. */
    Status (*set)(System *system, const struct SquareMesh *mesh,
                  const double *number);

    /* What the ledger calls the energy that it stores, and what it takes out
     * for good (system_book_loss); NULL: neither. */
    const char *energy, *loss;

    /* In the list it stands behind all with the same or a smaller number: sums
     * and steps' ends keep their order, however late a term comes. */
    enum TermPlace {
        PLACE_FORCE, /* springs, fields, what is not named here */
        PLACE_DAMPING,
        PLACE_CONTACT,
        PLACE_FRICTION,
        PLACE_CELLS,
        PLACE_FRACTURE, /* it takes the energy of all the others */
        PLACE_HAND,
    } place;

    /* Where the term is a sum over elements: what one of them is (elements.h),
     * which gives the functions from here down to allowed, but along. */
    const ElementKind *element;

    /* P(x), J, without w.  NULL: the term has no energy, only begin, end or
     * bounds, and none of the functions of one. */
    double (*value)(const EvalPoint *at);

    /* g += w grad P.  g [2n] in/out.  Explicit methods use it too, with w = -1
     * and at->x alone (u NULL). */
    void (*gradient)(const EvalPoint *at, double *g);

    /* The entries of the Hessian, the same ones all step long but for grow: how
     * many, and the triplets in rows and columns of the matrix
     * (term_add_block). A force that is the same everywhere has none: these and
     * hessian are NULL.
     */
    long long (*entries)(const EvalPoint *at);
    void (*pattern)(const EvalPoint *at, Triplets *triplets);

    /* Where x wants entries that the matrix lacks (bodies that come near each
     * other inside a step): there are more from now on, and *grown is true; no
     * others change their places in the pattern.  NULL: never.  Returns OK,
     * OUT_OF_MEMORY. */
    Status (*grow)(const EvalPoint *at, bool *grown);

    /* out[slot[t]] += w entry t of the Hessian at x; or, where q is given,
     * out += w Hessian q, without a matrix: out and q are then [2n].  Each
     * block is projected: with CLAMP and ABS what is added must be positive
     * semi-definite; NONE and ON_DEMAND mean the Hessian as it is.  Returns how
     * many blocks were changed by the projection. */
    int (*hessian)(const EvalPoint *at, Projection projection, const int *slot,
                   const double *q, double *out);

    /* What w P(x + alpha p) is along a line, without its terms of degree 0 and
     * 1: the slope of all terms together is g.p.
     *   along      adds the exact coefficients of alpha^2, alpha^3, alpha^4 to
     *              q [3]: of a term that is no polynomial, of the part that is
     *              one.  NULL: no part is.
     *   remainder  the rest, where there is one: w [P(x + alpha p) - P(x)
     *              - alpha grad P.p] without cancellation, minus what along
     *              gave; asked once for each trial.  NULL: a polynomial of
     *              degree 4 or less in x. */
    void (*line_polynomial)(const EvalPoint *at, const double *p, double q[3]);
    double (*line_remainder)(const EvalPoint *at, const double *p,
                             double alpha);

    /* The largest alpha that p may be followed, > 0 (contact, cells); NULL, or
     * infinite: any up to 1.  Backtracking starts at the smallest of all terms
     * and 1. */
    double (*max_step)(const EvalPoint *at, const double *p);

    /* Whether x is a place where the energy exists: every distance and area
     * > 0.  Asked after rounding, for starts and for updates; NULL: always. */
    bool (*is_feasible)(const EvalPoint *at);

    /* Before a step, from x_n and v_n [2n]: what it freezes (the normal forces
     * of friction).  After a step to x, v [2n] was accepted: what it changes
     * for good (plastic lengths, broken springs); it books what that cost in
     * system_book_loss.  Both say so (system_mark_changed) where arrays of the
     * system or of a term have changed, or entries of the Hessian: factors and
     * bounds that were made with them are then dropped.  begin returns OK,
     * OUT_OF_MEMORY. */
    Status (*begin_step)(const TermStep *step);
    void (*end_step)(const TermStep *step);

    /* Bound of the curvature's size at rest, J/m^2.  A bound that is not finite
     * is refused. */
    double (*curvature_bound)(const EvalPoint *at);
    /* Frees what data points to; NULL: nothing. */
    void (*free)(void *data);

    bool diagonal; /* quadratic, and each node stands alone: c/2 |x - o|^2 */
    bool internal; /* its forces add up to 0: the centre of mass is free */
    bool backward_euler_only; /* right only where x_(n+1) is the minimiser
                         itself: in backward Euler; other methods refuse it by
                         name */
};

struct Term {
    const TermKind *kind;
    void *data; /* the kind's own numbers and arrays, in one piece of malloc;
                   what is not in it, free frees */
};

/* Triplets of the 2x2 block of nodes i and j: xx xy yx yy, and on the diagonal
 * (i = j) only xx xy yy. */
void term_add_block(const System *system, int i, int j, Triplets *triplets);

/* Triplets xx and yy of node i alone. */
void term_add_diagonal(const System *system, int i, Triplets *triplets);

#endif
