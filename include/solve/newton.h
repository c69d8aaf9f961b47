/* newton.h - projected Newton with line search, the minimiser of a time step
 * (slides: Algorithm 3).
 *
 * newton_start sets the function and the start; newton_minimise is the loop.
 * Each pass through the loop leaves a record for the log, the window and the
 * tests.  The observer of the records may pause the loop, and the next call of
 * newton_minimise continues it. */
#pragma once

#include "solve/line_search.h"
#include "solve/cholesky.h"
#include "solve/incremental_potential.h"

typedef enum Solver {
    SOLVER_NEWTON,    /* directions by a Cholesky factor, as on the slides */
    SOLVER_MULTIGRID, /* directions without a factor, on square grids */
    SOLVER_COUNT,
    SOLVER_AUTO = SOLVER_COUNT /* multigrid on large grids, else newton */
} Solver;

/* Most segments for which AUTO takes newton, whose iterates are those of the
 * slides.  Multigrid is twice as fast at 8 segments, at least four times
 * from 12. */
enum { AUTO_NEWTON_MAX_SEGMENTS = 8 };

/* How well the residual of a direction p is known. */
typedef enum ResidualKind {
    RESIDUAL_EXACT,   /* p solves H p = -g up to rounding */
    RESIDUAL_ESTIMATE /* p solves H p = -g up to a bounded linear residual */
} ResidualKind;

typedef struct NewtonRecord {
    long step_number; /* number of the time step, from 1 */
    int iteration;    /* number from 0; -1: prescribed motion ended the step */
    double residual;  /* m/s, max over nodes of |p_x| + |p_y|, over h */
    ResidualKind residual_kind; /* how well the residual is known */
    double alpha;               /* step length along p; 0: no step along p */
    int trials;                 /* number of step lengths that were tried */
    double slope;         /* J s^2, grad E . p; below 0: p leads downhill */
    double energy_change; /* J s^2, change of E by the update */
    int projected_blocks; /* number of blocks of H that projection changed */
    int negative_pivots;  /* number of negative pivots of the Hessian that gave
                             p; 0 for a projected Hessian */
    bool has_new_factor;  /* a new factor was computed, or failed */
    double shift;         /* kg, added to the diagonal of the Hessian */
    double seconds;       /* computing time of the iteration */
    Status status; /* RUNNING, or how the iteration ended the minimisation */
    Solver solver; /* NEWTON or MULTIGRID */
    double x_before[2]; /* m, node of a one-node scene before the update */
    double x_after[2];  /* m, node of a one-node scene after the update */
} NewtonRecord;

/* Called after each iteration.  Returns false to pause the loop. */
typedef bool (*NewtonObserver)(void *user, const NewtonRecord *record);

typedef struct NewtonSettings {
    double h; /* s, time step, by which |p| is divided in the residual */
    double tolerance;        /* m/s, epsilon of the slides */
    Solver solver;           /* how the minimiser is found */
    Projection projection;   /* how negative eigenvalues are replaced */
    LineSearch line_search;  /* how the step length is found */
    int max_iterations;      /* limit of iterations (status ITERATION_LIMIT) */
    NewtonObserver observer; /* called after each iteration; NULL: none */
    void *user_data;         /* argument of the observer */
} NewtonSettings;

/* Counts of the work since the object was made. */
typedef struct NewtonCounters {
    long updates;          /* number of updates of x */
    long factorisations;   /* number of factorisations of the Hessian */
    long linear_solves;    /* p solved or refined with a factor of H */
    long projected_blocks; /* number of projected blocks of factored Hessians */
    long v_cycles;         /* number of V-cycles of multigrid */
    long tile_sweeps;      /* number of sweeps of multigrid's tiles (tiles.h) */
    long indefinite_convergences; /* minimisations whose last p came from a
                                     Hessian with negative pivots: perhaps they
                                     converged to a maximum */
    long newton_takeovers; /* number of minimisations that Newton took over */
} NewtonCounters;

/* Adds each member of counters to sum. */
void newton_counters_add(const NewtonCounters *counters, NewtonCounters *sum);

/* The Hessian and its factor, and vectors of [2n] (direction.c).  Pattern,
 * slots and symbolic analysis are kept until the pattern changes.
 *
 * Where h^2 k outweighs the masses by more than the 16 digits of a double, H
 * has no Cholesky factor in floating point.  Then H + shift I is factored, and
 * conjugate gradients on H itself, applied spring by spring, correct p. */
typedef struct FactoredHessian {
    Projection projection;             /* projection of the Hessian in A */
    CholeskyKind factor_kind;          /* kind of factor that cholesky holds */
    unsigned analysed_pattern_version; /* System.pattern_version at the symbolic
                                          analysis */
    Sparse A;                  /* Hessian, one triangle, in elimination order */
    Cholesky *cholesky;        /* factor of A; NULL: not created yet */
    double shift;              /* kg, added to the diagonal before factoring */
    double moved_since_factor; /* m, bound of displacements since factoring */
    double *b;                 /* right-hand side in elimination order */
    double *r, *z, *q, *d;     /* vectors of conjugate gradients */
} FactoredHessian;

/* Data for the rounding errors of a minimisation (rounding.c). */
typedef struct RoundingChecks {
    unsigned bounds_version; /* 1 + System.version of min_mass, max_stiffness
                                and shortest_spring; 0: not computed yet */
    double min_mass;         /* kg, the smallest mass */
    double max_stiffness;    /* J/m^2, the largest max_stiffness of a term */
    double shortest_spring;  /* m, rest length; 1 without springs */
    bool is_stiff; /* P's weight times max_stiffness > 1e5 min_mass; a decrease
                      of E is then computed twice */
    bool factor_is_inexact; /* P's weight times max_stiffness > 1e10 min_mass:
                               the residual is only an estimate */
    double start_energy;    /* J s^2, E at the start; NAN: not needed */
    double energy_limit; /* J s^2, upper limit of E: its value at the start plus
                            rounding; INFINITY: no limit */
    double E;            /* J s^2, E at the iterate for
                            energy_confirms_change; NAN: not evaluated yet */
    double E_trial;      /* J s^2, E at the end of the trial step */
    double best_residual;    /* m/s, smallest residual of this minimisation */
    int stagnant_iterations; /* iterations since the smallest residual */
} RoundingChecks;

typedef struct Multigrid Multigrid;

typedef struct Newton {
    NewtonSettings settings; /* may be changed between minimisations */
    NewtonCounters counters;
    NewtonRecord record; /* record of the last iteration */
    Status status;       /* RUNNING, or how the minimisation ended */
    long step_number;    /* number of the time step, for the records */
    double tolerance;    /* m/s, limit of the residual in this minimisation */
    const System *system;
    double *memory;  /* memory that holds all arrays */
    Iterate iterate; /* E, u, x, g, p */
    double *u_tilde; /* [2n] m, x_tilde - x_n, written by the integrator */
    /* [2n] m, point that the line search tries.  When the observer is called
     * after an update: the iterate before the update. */
    double *u_trial, *x_trial;
    FactoredHessian factored_hessian; /* the Hessian and its factor */
    bool has_gradient;                /* has the gradient at x in iterate.g */
    bool meets_tolerance;        /* p of the last iteration passes the test */
    int clamped_iterations_left; /* number of next ones that must clamp H */
    RoundingChecks rounding;
    Multigrid *multigrid; /* data of multigrid; NULL: not created yet */
    Solver active_solver; /* solver of the next iteration: NEWTON, MULTIGRID */
    const char *refusal_reason; /* why multigrid refused to work, or NULL */
    double change_sum;          /* J s^2, sum of the updates' changes of E */
    double change_abs_sum;      /* J s^2, sum of the absolute changes of E */
    double total_energy_change; /* J s^2, sum over minimisations: E at the end
                                   minus E at the start; reset by the caller */
} Newton;

/* Allocates the minimiser of a system, which must outlive the object.  Returns
 * OK, OUT_OF_MEMORY; free with newton_free in any case. */
Status newton_create(const System *system, const NewtonSettings *settings,
                     Newton *newton);
void newton_free(Newton *newton);

/* Starts to minimise |u - u_tilde|_M^2/2 + weight P(x_n + u), with
 * newton->u_tilde filled by the caller.
 *   x_n        [2n] m, in; must stay valid until the end
 *   u          [2n] m, in, the start; NULL: 0.  Pinned nodes stay there
 *   tolerance  m/s, tolerance of this minimisation */
void newton_start(Newton *newton, const double *x_n, const double *u,
                  double weight, double tolerance);

/* Runs the loop of Algorithm 3 from newton_start or a pause to the end or the
 * next pause.  At least one update is made, if one lowers E.  u and x are the
 * last iterate; with a line search E is not higher there than at the start.
 * Returns RUNNING after a pause; OK if the last p passed the test, or if a
 * bound shows that the next p is negligible; otherwise how the minimisation
 * failed. */
Status newton_minimise(Newton *newton);

/* Large squares take longer for an update and get fewer of them, at least
 * MIN_ITERATION_LIMIT, so that a step ends within seconds. */
enum { MAX_NODE_UPDATES = 250000, MIN_ITERATION_LIMIT = 1000 };

/* Returns the limit of iterations: max_iterations, or less on large squares. */
static inline int newton_iteration_limit(const Newton *newton)
{
    int most = MAX_NODE_UPDATES / newton->system->nodes;
    most = most > MIN_ITERATION_LIMIT ? most : MIN_ITERATION_LIMIT;
    return most < newton->settings.max_iterations
               ? most
               : newton->settings.max_iterations;
}
