/* newton.h - projected Newton (slides: Algorithm 3, and Algorithm 1 inside).
 *
 * A resumable object: newton_start, then newton_iterate until it returns
 * something else than RUNNING, then newton_finish; newton_minimise does all
 * three.  Each iteration leaves a record, which log, window and tests read.
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

/* Up to so many segments AUTO takes newton: factors are as good there, and the
 * iterates are those of the slides. */
enum { AUTO_NEWTON_SEGMENTS = 32 };

/* What is known of a residual: p solved for it; p up to a remainder, as from
 * conjugate gradients; or only that it is not above. */
typedef enum ResidualKind {
    RESIDUAL_VALUE,
    RESIDUAL_ESTIMATE,
    RESIDUAL_BOUND
} ResidualKind;

/* What one Newton iteration did; or, with iteration -1, how a minimisation
 * ended whose end no iteration tells: at its start, or as it was finished. */
typedef struct NewtonRecord {
    long step;         /* time step, from 1 */
    int iteration;     /* in this minimisation, from 0; -1: see above */
    double residual;   /* m/s, max over nodes |p_x| + |p_y|, over h: of the p
                          that this iteration follows; with -1, at the end */
    ResidualKind kind; /* of it */
    double alpha;      /* step length along p; 0: none was found */
    int trials;        /* energies the line search looked at */
    double slope;      /* grad E . p, J s^2: < 0 is downhill */
    double change;     /* of E, J s^2: by alpha p; multigrid: by all it did */
    int projected;     /* blocks of the Hessian that were projected */
    bool factorised;   /* false: multigrid, or a bound passed the test */
    double shift;      /* kg, what the diagonal needed to be factored */
    double seconds;    /* this iteration took */
    Status status;     /* RUNNING, or how the minimisation ended here */
    Solver solver;     /* who made it: NEWTON or MULTIGRID */
    double from[2];    /* where it started and where it led, in scenes with a */
    double to[2];      /* single unknown point; 0 elsewhere */
} NewtonRecord;

/* Called after each iteration, and after each minimisation whose end no
 * iteration tells; false asks to stop (INTERRUPTED). */
typedef bool (*NewtonObserver)(void *user, const NewtonRecord *record);

typedef struct NewtonSettings {
    double h;                /* s, divides the residual */
    double tolerance;        /* m/s */
    Solver solver;           /* how the minimiser is found */
    Filter filter;           /* what is done with negative eigenvalues */
    LineSearch search;       /* how the step length is found */
    bool minimum;            /* a saddle is no end: it is left */
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
    long saddles;    /* left along negative curvature */
    long taken_back; /* minimisations that multigrid began, but did not end */
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
    Filter filter;         /* of the Hessian in A */
    CholeskyKind kind;     /* what cholesky was made for, */
    unsigned pattern;      /* and of which pattern of the system */
    Sparse A;              /* Hessian, one triangle, in elimination order */
    int *slot;             /* place of each triplet in A */
    Cholesky *cholesky;    /* NULL: no matrix was needed yet */
    double shift;          /* kg, on the diagonal of what was factored */
    double *b;             /* right-hand side in elimination order */
    double *r, *z, *q, *d; /* of conjugate gradients */
} SearchDirection;

/* What guards the digits of a minimisation (rounding.c). */
typedef struct Rounding {
    unsigned known;  /* 1 + the system's version that the next three are of */
    double lightest; /* kg, the smallest mass */
    double stiffest; /* J/m^2, the largest curvature of a term */
    double force;    /* J/m, the largest of a spring without a length */
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
    Status status;       /* RUNNING, or how it ended */
    long step;           /* copied into the records */
    bool rough; /* set by the caller: the next minimisation is but a guess */
    double tolerance;  /* m/s, of this one: that of the settings, or looser */
    double residual;   /* of p at the present iterate, m/s */
    ResidualKind kind; /* of it */
    const System *system;
    Iterate at;      /* E, u, x, g, p; u holds all arrays, in one piece */
    double *u_tilde; /* [2n] m, what the integrator writes: x_tilde - x_n */
    double *u_trial, *x_trial; /* [2n] m, where a step may lead; workspaces */
    SearchDirection search;    /* the Hessian and its factor */
    int clamps;      /* iterations that on-demand projection still clamps */
    int saddles;     /* that this minimisation has left */
    bool bends_down; /* the test is passed, but at no minimum */
    Rounding rounding;
    Multigrid *multigrid; /* NULL: was not needed yet */
    Solver working;       /* NEWTON or MULTIGRID: who makes this step */
    bool lent;            /* NEWTON works, until multigrid's saddle is left */
    const char *refusal;  /* why multigrid does not, though wanted; or NULL */
    double sum, size;     /* J s^2, of the changes in this minimisation; and of
                             their sizes */
    double change; /* J s^2, E at the end - E at the start, of all minimisations
                      since somebody has set it to 0 */
} Newton;

/* Allocates for this system, which must outlive the object.
 * Returns OK, OUT_OF_MEMORY; free with newton_free in any case. */
Status newton_create(const System *system, const NewtonSettings *settings,
                     Newton *newton);
void newton_free(Newton *newton);

/* Begins to minimise |u - u_tilde|_M^2/2 + weight P(x_n + u), with
 * newton->u_tilde filled by the caller; computes the first direction.
 *   x_n  [2n] m, in; must stay valid until the end
 *   u    [2n] m, where to begin, NULL: 0; pinned nodes keep theirs
 * Returns RUNNING, OK (it is the minimiser), or how it failed. */
Status newton_start(Newton *newton, const double *x_n, const double *u,
                    double weight);

/* One iteration: step length, update, next direction, test.
 * Returns RUNNING, OK (converged), or how it failed; u and x are then the last
 * iterate, where E is not higher than at the start. */
Status newton_iterate(Newton *newton);

/* After the end: moves the centre of mass to where it belongs exactly; u and x
 * are then ready for the integrator.  Where that shows that E has risen, all
 * nodes move alike, and the status becomes ROUNDING_LIMIT.  Nothing to do after
 * a failure. */
void newton_finish(Newton *newton);

/* newton_start, newton_iterate until the end, newton_finish. */
Status newton_minimise(Newton *newton, const double *x_n, const double *u,
                       double weight);

/* Iterations after which a minimisation ends: max_iterations, or on squares of
 * more than a few cells fewer. */
int newton_most_iterations(const Newton *newton);

#endif
