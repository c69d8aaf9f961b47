/* search_direction.h - p = -H^-1 g (slide: search_dir), H the Hessian of the
 * incremental potential: pattern, slots and symbolic analysis once, then
 * assemble, factor and solve as often as wanted.
 *
 * Where h^2 k outweighs the masses by more than the 16 digits of a double, H
 * has no Cholesky factor in floating point.  Then H + shift I is factored, and
 * conjugate gradients on H itself, applied spring by spring, remove what the
 * shift has changed.
 */
#ifndef ELASTO_SEARCH_DIRECTION_H
#define ELASTO_SEARCH_DIRECTION_H

#include "solve/cholesky.h"
#include "solve/incremental_potential.h"

typedef struct SearchDirection {
    const System *system;  /* not owned */
    Filter filter;         /* of the Hessian in A */
    CholeskyKind kind;     /* what cholesky was made for, */
    unsigned pattern;      /* and of which pattern of the system */
    Sparse A;              /* Hessian, one triangle, in elimination order */
    int *slot;             /* place of each triplet in A */
    Cholesky *cholesky;    /* NULL: no matrix was needed yet */
    double shift;          /* kg, on the diagonal of what was factored */
    double *b;             /* [2n] right-hand side in elimination order */
    double *r, *z, *q, *d; /* [2n] of conjugate gradients */
} SearchDirection;

/* Returns OK, OUT_OF_MEMORY; free it in any case.  No matrix is made yet. */
Status search_direction_create(const System *system, SearchDirection *search);
void search_direction_free(SearchDirection *search);

/* Makes A and its analysis, unless it has them for this kind and pattern, and
 * fills A with the Hessian of E at u, x.
 *   filter     NONE: the Hessian as it is, for a factor L D L^T, which allows
 *              negative eigenvalues; ON_DEMAND: as it is, for one that does not
 *   projected  out, blocks projected
 * Returns OK, TOO_LARGE, OUT_OF_MEMORY. */
Status search_direction_assemble(SearchDirection *search, const Iterate *at,
                                 Filter filter, int *projected);

/* A += times M, and what rounding may have taken from semi-definite A. */
void search_direction_add_masses(SearchDirection *search, double times);

/* Factors A, with a shift if it must: only a filtered A is known to be
 * semi-definite but for rounding, so only that is shifted.  tries out,
 * factorisations made. Returns OK, NOT_POSITIVE_DEFINITE, NOT_FINITE,
 * OUT_OF_MEMORY. */
Status search_direction_factor(SearchDirection *search, int *tries);

/* at->p = -H^-1 at->g with the last factor.  Where that has a shift, E, u and x
 * must be those it was assembled for.
 * Returns OK, NOT_FINITE, SINGULAR. */
Status search_direction_solve(SearchDirection *search, const Iterate *at);

/* Looks for negative curvature: conjugate gradients on the Hessian at u, x as
 * it is, from random numbers, preconditioned with the last factor.  Writes over
 * p.
 *   found  out; p is then a direction with p.H p < 0 and p.g <= 0
 * Returns OK, NOT_FINITE. */
Status search_direction_bends_down(SearchDirection *search, const Iterate *at,
                                   bool *found);

/* How well at->p solves H p = -g for the Hessian of the last assembly, applied
 * term by term.
 *   error  out, kg^(1/2) m, a bound of |p - exact|_M: |g + H p|_(M^-1) where
 *          H - M is positive semi-definite; else as far as the factor can tell
 * Returns as search_direction_solve. */
Status search_direction_judge(SearchDirection *search, const Iterate *at,
                              double *error);

#endif
