/* term.h - one summand of the potential: P(x) is the sum of a system's terms.
 *
 * A System holds a list of terms.  A term that a scene lacks is not in its list
 * and costs nothing.  The source file of a term defines a constant TermKind, or
 * two for similar terms.  The functions loop over whole arrays, so a term costs
 * one indirect call a pass.
 *
 * A function pointer that is NULL means: this term adds nothing here.  Terms
 * need not regard pins: the caller clears pinned nodes in g and the Hessian. */
#pragma once

#include "base/sparse.h"
#include "model/psd.h"

typedef struct System System;
typedef struct TermKind TermKind;
typedef struct ElementKind ElementKind;
typedef struct EnergyTerm EnergyTerm;
struct SquareMesh;

/* Positions, weight and spring data for which a term is evaluated. */
typedef struct EvalPoint {
    const System *system;
    const EnergyTerm *term; /* evaluated term; NULL: none is selected yet */
    double weight; /* s^2, factor on derivatives of P: h^2 for implicit Euler */
    const double *x_n; /* [2n] m, positions at the start of the step */
    const double *u; /* [2n] m, displacement x - x_n; NULL: outside of a step */
    const double *x; /* [2n] m, current positions, x_n + u */
    const struct Damping *damping; /* damping of this step; NULL: none */
    const double *k;  /* [springs] J/m^2, stiffness in this step (damping.h) */
    const double *l2; /* [springs] m^2, squared rest length in this step */
} EvalPoint;

/* Returns a point with weight 1 and no term selected. */
EvalPoint make_eval_point(const System *system, const double *x_n,
                          const double *u, const double *x);

/* Selects the next term of the system's list and returns its kind; after the
 * last term selects none and returns NULL. */
const TermKind *eval_point_next_term(EvalPoint *at);

/* The argument of begin_step and end_step. */
typedef struct TermStep {
    System *system;
    EnergyTerm *term;
    const double *x; /* [2n] m, positions at the start or end of the step */
    const double *v; /* [2n] m/s, velocities at the start or end of the step */
    double h;        /* s, time step */
} TermStep;

struct TermKind {
    /* Name in messages, such as "friction".  NULL: no message names it. */
    const char *name;

    /* Adds the term, or changes its numbers if it is in the list.  `number` is
     * the field of the term's option in Options; the fields behind it may be
     * read, too.  At least one is not 0.  NULL: a term that needs further
     * arguments.  Returns OK or OUT_OF_MEMORY. */
    Status (*configure)(System *system, const struct SquareMesh *mesh,
                        const double *number);

    /* Columns of the energy ledger: for potential(), and for the energy that
     * the term dissipates (system_add_loss).  NULL: no such column. */
    const char *energy_name, *loss_name;

    /* Order of the list.  Equal ranks keep the order in which they were added.
     * Sums and end_step thus keep their order when a term is added later. */
    enum TermRank {
        RANK_FORCE, /* springs, triangles, fields: the usual rank */
        RANK_DAMPING,
        RANK_CONTACT,
        RANK_FRICTION,
        RANK_CELLS,
        RANK_FRACTURE, /* after all terms that lose energy when springs break */
        RANK_HAND,
    } rank;

    /* Kind of the elements, if the term is a sum over elements (elements.h).
     * The functions from potential to taylor_remainder, without extend_pattern
     * and line_polynomial, are then those of elements.c.  A term without
     * elements has an energy at every x (elements_are_feasible). */
    const ElementKind *element;

    /* Returns P(x) >= 0 in joules, not multiplied by weight.  NULL: the term
     * has no energy and none of the functions up to taylor_remainder. */
    double (*potential)(const EvalPoint *at);

    /* Adds weight grad P(x) to g [2n].  Explicit integrators call it with
     * weight -1 and u NULL to collect forces. */
    void (*gradient)(const EvalPoint *at, double *g);

    /* Appends the triplets of the Hessian, by add_block_triplets or
     * add_diagonal_triplets.  In a step only extend_pattern adds triplets.
     * NULL: the Hessian is 0. */
    void (*add_triplets)(const EvalPoint *at, Triplets *triplets);

    /* Appends the triplets that the Hessian at x needs and the pattern lacks,
     * for example of bodies that came near each other during the step; *grown
     * is then set to true.  The triplets so far keep their places.  NULL: never
     * needed.  Returns OK or OUT_OF_MEMORY. */
    Status (*extend_pattern)(const EvalPoint *at, bool *grown);

    /* Adds weight times the projected Hessian of P at x, or its product with q.
     *   slot  in/out, slots of the term's triplets, moved on to those of the
     *         next term; NULL if q is given
     *   q     [2n] in; NULL: the Hessian itself is added
     *   out   Hessian q is added to out [2n], or triplet t to out[(*slot)[t]]
     * CLAMP and ABS make each block positive semi-definite; NONE and ON_DEMAND
     * leave it.  Returns the number of blocks that the projection changed. */
    int (*hessian)(const EvalPoint *at, Projection projection, const int **slot,
                   const double *q, double *out);

    /* Adds the coefficients of alpha^2, alpha^3 and alpha^4 of weight
     * P(x + alpha p) to q [3].  NULL: no part of P is such a polynomial. */
    void (*line_polynomial)(const EvalPoint *at, const double *p, double q[3]);

    /* Returns weight (P(x + alpha p) - P(x) - alpha grad P.p), less what
     * line_polynomial has added, without cancellation.  NULL: 0. */
    double (*taylor_remainder)(const EvalPoint *at, const double *p,
                               double alpha);

    /* Freezes what stays constant during the step from x and v, for example the
     * normal forces of friction.  Calls system_mark_changed if it changed
     * arrays of the system or of a term.  Returns OK or OUT_OF_MEMORY. */
    Status (*begin_step)(const TermStep *step);

    /* Applies what an accepted step to x and v changes for good: plastic
     * strain, broken springs.  Books the energy lost (system_add_loss), and
     * calls system_mark_changed like begin_step. */
    void (*end_step)(const TermStep *step);

    /* Returns an estimate of the Hessian's largest eigenvalue at rest (J/m^2),
     * for springs the largest k; if is_diagonal, an upper bound. */
    double (*max_stiffness)(const EvalPoint *at);

    /* Frees the allocations that data points to, not data itself. */
    void (*free)(void *data);

    bool is_diagonal;    /* P is a sum of c/2 |x_i - o|^2, o fixed points, so
                            its Hessian is a diagonal matrix; c > 0 */
    bool is_external;    /* has forces that move the centre of mass */
    bool depends_on_x_n; /* P depends on x_n too; rotating a body changes P */
    bool supports_all_integrators; /* works with every integrator; other terms
                                      only with backward Euler */
};

struct EnergyTerm {
    const TermKind *kind;
    void *data; /* numbers and arrays of the kind, one piece of malloc; the
                   kind's `free` frees further pieces */
};

/* Appends the triplets of block (i, j): xx xy yx yy, or xx xy yy if i = j. */
void add_block_triplets(const System *system, int i, int j, Triplets *triplets);

/* Appends the triplets xx and yy of node i. */
void add_diagonal_triplets(const System *system, int i, Triplets *triplets);
