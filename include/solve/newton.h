/* newton.h - projected Newton with line search, the minimiser of a time step
 * (slides: Algorithm 3).
 *
 * newton_start says what is to be minimised and where to begin; newton_minimise
 * is the loop.  Each pass through the loop leaves a record for the log, the
 * window and the tests.  The observer of the records may pause the loop, which
 * the next call of newton_minimise continues.
 */
#ifndef ELASTO_NEWTON_H
#define ELASTO_NEWTON_H

#include "solve/line_search.h"
#include "solve/cholesky.h"
#include "solve/incremental_potential.h"

typedef enum Solver {
    SOLVER_NEWTON,    /* Algorithm 3: a new factor for each direction */
    SOLVER_MULTIGRID, /* its minimum without a factor, on square grids */
    SOLVER_COUNT,
    SOLVER_AUTO = SOLVER_COUNT /* multigrid on large grids, else newton */
} Solver;

/* Up to so many segments AUTO takes newton, whose iterates are those of the
 * slides.  Multigrid is twice as fast there, and four times from 12 on. */
enum { AUTO_NEWTON_SEGMENTS = 8 };

/* How well the residual of a direction p is known. */
typedef enum ResidualKind {
    RESIDUAL_VALUE,   /* p solves H p = -g up to rounding */
    RESIDUAL_ESTIMATE /* p solves it up to a known remainder */
} ResidualKind;

/* One iteration of the loop. */
typedef struct NewtonRecord {
    long step;         /* time step, from 1 */
    int iteration;     /* of this minimisation, from 0 */
    double residual;   /* m/s, max over nodes of |p_x| + |p_y|, over h */
    ResidualKind kind; /* how well the residual is known */
    double alpha;      /* step length along p; 0: x has not moved */
    int trials;        /* energies that the line search looked at */
    double slope;      /* grad E . p, J s^2; below 0: p leads downhill */
    double change;     /* change of E by the update, J s^2 */
    int projected;     /* blocks of the Hessian that were projected */
    int negative;      /* negative pivots of the Hessian, without projection */
    bool factorised;   /* false: multigrid, or a diagonal Hessian */
    double shift;      /* kg, added to the diagonal to factor it */
    double seconds;    /* computing time of the iteration */
    Status status;     /* RUNNING, or how the minimisation ended here */
    Solver solver;     /* NEWTON or MULTIGRID */
    double from[2];    /* start of the update, in scenes with one moving point;
                          0 elsewhere */
    double to[2];      /* end of the update, alike */
} NewtonRecord;

/* Called after each iteration.  Returns false to pause the loop. */
typedef bool (*NewtonObserver)(void *user, const NewtonRecord *record);

typedef struct NewtonSettings {
    double h;                /* s, divides the residual */
    double tolerance;        /* m/s, epsilon of the slides */
    Solver solver;           /* how the minimiser is found */
    Projection projection;   /* what is done with negative eigenvalues */
    LineSearch search;       /* how the step length is found */
    int max_iterations;      /* at most; then ITERATION_LIMIT */
    NewtonObserver observer; /* or NULL */
    void *user;              /* passed to the observer */
} NewtonSettings;

/* What was done since the object was made.  Nothing reads it to decide. */
typedef struct NewtonCounters {
    long iterations; /* Newton updates */
    long factorisations;
    long solves;
    long projected;  /* blocks projected, summed over factorisations */
    long cycles;     /* of multigrid */
    long local;      /* its sweeps of tiles where folds run */
    long negative;   /* minimisations that ended where H has negative pivots */
    long taken_back; /* minimisations that multigrid began and Newton ended */
} NewtonCounters;

/* sum += counters */
void newton_counters_add(const NewtonCounters *counters, NewtonCounters *sum);

/* The Hessian and its factor, and vectors of [2n] (direction.c): pattern, slots
 * and symbolic analysis once, then assemble, factor and solve as often as
 * wanted.
 *
 * Where h^2 k outweighs the masses by more than the 16 digits of a double, H
 * has no Cholesky factor in floating point.  Then H + shift I is factored, and
 * conjugate gradients on H itself, applied spring by spring, remove what the
 * shift has changed. */
typedef struct SearchDirection {
    Projection projection; /* of the Hessian in A */
    CholeskyKind kind;     /* what cholesky was made for, */
    unsigned pattern;      /* and of which pattern of the system */
    Sparse A;              /* Hessian, one triangle, in elimination order */
    int *slot;             /* place of each triplet in A */
    Cholesky *cholesky;    /* NULL: no matrix was needed yet */
    double shift;          /* kg, on the diagonal of what was factored */
    double moved;          /* m, bound of a node's way since it was factored */
    double *b;             /* right-hand side in elimination order */
    double *r, *z, *q, *d; /* of conjugate gradients */
} SearchDirection;

/* What guards the digits of a minimisation (rounding.c). */
typedef struct Rounding {
    unsigned known;  /* 1 + the system's version that the next three are of */
    double lightest; /* kg, the smallest mass */
    double stiffest; /* J/m^2, the largest curvature of a term */
    double shortest; /* m, the shortest spring at rest; 1 without springs */
    bool stiff;      /* w stiffest > 1e5 lightest: slopes are looked at twice */
    bool blurred;    /* w stiffest > 1e10 lightest: factors are not exact */
    double first;    /* J s^2, E at the start; NAN: it can only fall */
    double most;     /* J s^2, E may be, as at the start; INFINITY: any */
    double E;        /* J s^2, at the iterate; NAN: not asked for yet */
    double E_trial;  /* J s^2, where a step may lead */
    double best;     /* m/s, smallest residual of this minimisation */
    int stagnant;    /* iterations since it was the smallest */
} Rounding;

typedef struct Multigrid Multigrid;

typedef struct Newton {
    NewtonSettings settings; /* may be changed between iterations */
    NewtonCounters counters;
    NewtonRecord record; /* of the last iteration */
    Status status;       /* RUNNING, or how the minimisation ended */
    long step;           /* copied into the records */
    double tolerance;    /* m/s, of this minimisation */
    const System *system;
    double *memory;  /* block of all arrays */
    Iterate at;      /* E, u, x, g, p */
    double *u_tilde; /* [2n] m, x_tilde - x_n, written by the integrator */
    double *u_trial, *x_trial; /* [2n] m, end of a trial step; after an update
                                  the iterate before it */
    SearchDirection search;    /* the Hessian and its factor */
    bool has_gradient;         /* g is the gradient at x */
    bool passes;               /* p of the last iteration passes the test */
    int clamps; /* iterations for which on-demand projection still clamps */
    Rounding rounding;
    Multigrid *multigrid;  /* NULL: was not needed yet */
    Solver working;        /* NEWTON or MULTIGRID, in this minimisation */
    const char *refusal;   /* why multigrid does not work, though wanted */
    double change_sum;     /* J s^2, changes of E in this minimisation */
    double change_abs_sum; /* J s^2, their absolute values */
    double change; /* J s^2, E at the end - E at the start, of all minimisations
                      since somebody has set it to 0 */
} Newton;

/* Allocates for this system, which must outlive the object.
 * Returns OK, OUT_OF_MEMORY; free with newton_free in any case. */
Status newton_create(const System *system, const NewtonSettings *settings,
                     Newton *newton);
void newton_free(Newton *newton);

/* Says what is minimised: |u - u_tilde|_M^2/2 + weight P(x_n + u), with
 * newton->u_tilde filled by the caller.
 *   x_n        [2n] m, in; must stay valid until the end
 *   u          [2n] m, in, where to begin; NULL: 0.  Pinned nodes keep theirs
 *   tolerance  m/s, of this minimisation */
void newton_start(Newton *newton, const double *x_n, const double *u,
                  double weight, double tolerance);

/* The loop of Algorithm 3, from newton_start or a pause to the end or the next
 * pause.  At least one update is made, unless none lowers E.
 * Returns RUNNING after a pause; OK (the last p passed the test and was used);
 * or how it failed.  u and x are the last iterate, where E is not higher than
 * at the start. */
Status newton_minimise(Newton *newton);

/* Iterations after which a minimisation ends: max_iterations, or fewer on large
 * squares. */
int newton_most_iterations(const Newton *newton);

#endif
