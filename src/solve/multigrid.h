/* multigrid.h - the minimiser of a time step on a square grid of springs,
 * without a factor of any matrix.
 *
 * Newton's method for E = |u - u_tilde|_M^2/2 + w P(x_n + u), whose directions
 * come from conjugate gradients on the clamped Hessian, preconditioned by one
 * multigrid V-cycle each (v_cycle.h); the step along one is exact, as E is a
 * quartic there.  Where folds run, tiles of nodes relax in between (tiles.h).
 * No update raises E.
 *
 * The test of Algorithm 3 needs p = -H^-1 g, which conjugate gradients know up
 * to a remainder r = -g - H p, here computed in double precision.  H - M is
 * positive semi-definite, so the error is at most |r|_(M^-1) in the norm of M,
 * and the residual, max over nodes of |p_x| + |p_y|, over h, is known up to
 * sqrt(2/m)/h |r|_(M^-1) with the smallest m.  The iteration goes on until that
 * decides the test, to either side; what is not decided is not converged.
 *
 * A step depends on nothing but what it is given.  Results have the same bits
 * for every width of registers and number of threads.
 */
#ifndef ELASTO_MULTIGRID_H
#define ELASTO_MULTIGRID_H

#include "solve/newton.h"

/* The parts of a time step; arrays as in system.h and square_mesh.h. */
typedef struct MultigridStep {
    unsigned version;            /* of m, pinned, k and l2: others, another */
    const double *x_n;           /* [2n] m */
    const double *u;             /* [2n] m, where to begin; NULL: 0 */
    const double *u_tilde;       /* [2n] m */
    const double *m;             /* [n] kg, > 0 */
    const unsigned char *pinned; /* [n], or NULL */
    const double *k, *l2;        /* [springs] J/m^2, >= 0; m^2, > 0 */
    double weight;               /* w, s^2 */
    double h;                    /* s, divides the residual */
    double tolerance;            /* m/s */
    bool is_free;                /* nothing acts on the centre of mass */
    NewtonCounters *counters;    /* where what is done is added up */
} MultigridStep;

/* What one iteration did; or, after multigrid_start, where it begins. */
typedef struct MultigridRecord {
    double residual; /* m/s, of p where it began: known up to what conjugate
                        gradients leave */
    double slope;    /* g.p, J s^2 */
    double alpha;    /* along p */
    double change;   /* of E, J s^2, by all it did */
    int trials;      /* points along p that were looked at */
    double after;    /* m/s, residual at the iterate that it led to: of an exact
                        p, up to a remainder that decided the test; or an upper
                        bound */
    bool decided;    /* which of both */
} MultigridRecord;

/* Allocates for segments x segments cells.
 *   threads  1, 2; 0: what the machine has (ELASTO_THREADS limits it)
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY (then *multigrid is NULL). */
Status multigrid_create(int segments, int threads, Multigrid **multigrid);
void multigrid_free(Multigrid *multigrid);

/* Begins a step.  Of its arrays u_tilde and pinned are needed until it ends.
 * Returns RUNNING, OK (the test is passed), or NOT_FINITE. */
Status multigrid_start(Multigrid *multigrid, const MultigridStep *step);

/* One iteration.  Returns RUNNING; OK (converged); or why it cannot go on:
 * LINE_SEARCH_LIMIT, NOT_DESCENT, NOT_FINITE.  u is then the last iterate,
 * where E is not higher than before. */
Status multigrid_iterate(Multigrid *multigrid);

/* u [2n] m, out: the present iterate; pinned nodes are not written. */
void multigrid_displacement(const Multigrid *multigrid, double *u);

const MultigridRecord *multigrid_record(const Multigrid *multigrid);

#endif
