/* stress.h - whether every step keeps the promise: it ends; it is converged,
 * or its status says why not; the state is finite and the incremental
 * potential not higher than before.  What judges shares no formula with the
 * solver: energy in extended precision, gradient, Hessian and direction in
 * quadruple precision where the compiler has it.
 */
#ifndef ELASTO_STRESS_H
#define ELASTO_STRESS_H

#include "testing.h"

/* ---- exact formulas (stress_exact.c) ----------------------------------- */

/* E at x_n + u, which is not rounded, without the w P(x_n) that it starts
 * with; J s^2. */
long double wide_energy(const IncrementalPotential *E, const double *u);

/* P(x) and sum m |v|^2/2, J. */
long double wide_potential(const System *system, const double *x);
long double wide_kinetic(const System *system, const double *v);

/* Gradient [2n] and Hessian [2n 2n] of E, 0 and 1 for pinned nodes; negative
 * eigenvalues of each spring as the filter says. */
void wide_derivatives(const IncrementalPotential *E, const double *u,
                      Filter filter, Wide *g, Wide *H);

/* H becomes its factors L D L^T, without pivots; false: a pivot is 0.
 *   negative  out, how many pivots are below 0 */
bool wide_factor(int n, Wide *H, int *negative);

/* b = (L D L^T)^-1 b */
void wide_solve(int n, const Wide *H, Wide *b);

/* What rounding to doubles can do to the gradient: [2n] kg m, out. */
void rounding_of_gradient(const IncrementalPotential *E, const double *u,
                          long double *noise);

/* ---- judging steps (stress_watch.c) ------------------------------------ */

typedef enum Verdict {
    VERDICT_CONVERGED, /* and the test was passed when computed again */
    VERDICT_REPORTED,  /* not converged, and the status says so */
    VERDICT_WRONG,     /* a promise was broken */
    VERDICTS
} Verdict;

/* Watches one run. */
typedef struct Watch {
    TimeIntegrator *run;
    bool residuals;       /* solve again where a step says it converged */
    double *x, *v;        /* [2n] before the step */
    double *x_n;          /* [2n] where the present minimisation started */
    double *u;            /* [2n] m, last iterate of the minimisation */
    long double *noise;   /* [2n] workspace */
    Wide *g, *H;          /* [2n], [2n 2n] workspace */
    long double energy;   /* E at u */
    long double through;  /* kg m/s, momenta that passed through */
    long double earlier;  /* the largest of all steps */
    int updates;          /* of this minimisation */
    bool wrong;           /* in this step */
    char reason[512];     /* what was wrong first */
    Status status;        /* of the last step */
    long steps[VERDICTS]; /* how often each verdict */
    long judged;          /* residuals computed again */
    long blurred;         /* of them: rounding is larger than the tolerance */
    double worst;         /* residual over tolerance, where it is not */
} Watch;

/* The run must stay where it is; its Newton's observer becomes the watch.
 * Returns false without memory. */
bool watch_create(TimeIntegrator *run, Watch *watch);
void watch_free(Watch *watch);

/* One step, judged. */
Verdict watch_step(Watch *watch);

/* The first broken promise is remembered. */
void watch_blame(Watch *watch, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* ---- random scenes (stress_random.c) ----------------------------------- */

enum { WILD_NODES = 16, WILD_SPRINGS = 48 };

/* Everything a few steps depend on, as plain numbers. */
typedef struct Wild {
    int nodes, springs, steps, max_iterations;
    int e[2 * WILD_SPRINGS];
    double m[WILD_NODES], x[2 * WILD_NODES], v[2 * WILD_NODES];
    double l2[WILD_SPRINGS], k[WILD_SPRINGS];
    unsigned char pinned[WILD_NODES];
    double h, tolerance, omega2;
    int method; /* row of integrator_methods */
    Solver solver;
    Filter filter;
} Wild;

/* The random scene with this number.  From WILD_SQUARES on they are squares as
 * the command line makes them, over all it allows that matters: h to 1e6 s, k
 * to 1e15 J/m^2, density from 1e-9 kg/m^2, so h^2 k/m to 1e34. */
enum { WILD_SQUARES = 1000000000 };
void wild_create(uint64_t seed, long number, Wild *wild);

/* Its steps, judged; reason [512] out where one was WRONG; tally in/out. */
typedef struct Tally {
    long cases, wrong, steps[VERDICTS], judged, blurred;
    long statuses[STATUS_COUNT];
    double worst;
} Tally;

Verdict wild_run(const Wild *wild, Tally *tally, char *reason);

/* Makes a scene that fails smaller and rounder while it still fails. */
void wild_shrink(Wild *wild, bool (*fails)(const Wild *, void *), void *user);

/* The scene in numbers that can be read back exactly. */
void wild_print(const Wild *wild);

/* ---- the list of cases (stress_cases.c, stress_exact_cases.c) ---------- */

typedef struct StressCase {
    const char *name;
    bool slow; /* only in `make stress` */
    bool same; /* once more in other units or places: not in `make test` */
    /* Returns false, with a reason [512], where something is wrong. */
    bool (*run)(Tally *tally, char *reason);
} StressCase;

/* Random scenes of contact and what goes with it: 20 000, or some; other ones
 * with another seed. */
extern uint64_t stress_contact_seed;
bool stress_contact(Tally *tally, char *reason);
bool stress_contact_small(Tally *tally, char *reason);

/* Random squares of springs that flow; `judged` counts updates. */
bool stress_flow(Tally *tally, char *reason);
bool stress_flow_small(Tally *tally, char *reason);

extern const StressCase stress_cases[]; /* ends with a NULL name */

/* Adds what a watch saw. */
void tally_add(const Watch *watch, Tally *tally);

/* ---- the envelope (stress_envelope.c) ---------------------------------- */

enum { ENVELOPE_H = 25, ENVELOPE_K = 22, ENVELOPE_STRETCH = 8 };

/* Verdicts of the default square, three steps, at every place of the grid. */
typedef struct Envelope {
    char verdict[SOLVER_COUNT][ENVELOPE_STRETCH][ENVELOPE_K][ENVELOPE_H];
} Envelope;

double envelope_h(int i);       /* 1e-9 ... 1e3, half decades */
double envelope_k(int i);       /* 1e-6 ... 1e15 */
double envelope_stretch(int i); /* 1e-6 ... 1e6 */

/* One cell: 'c' converged; 'n' the stretched start passed the test of every
 * step, and nothing was done; 'r' reported otherwise; 'w' wrong. */
char envelope_cell(Solver solver, int stretch, int k, int h, Tally *tally,
                   char *reason);

bool envelope_write(const char *name, const Envelope *envelope);
bool envelope_read(const char *name, Envelope *envelope);
bool envelope_draw(const char *name, const Envelope *envelope);

/* Share of verdict c where the stretch is at least 0.1, and something was done.
 */
double envelope_share(const Envelope *envelope, Solver solver);

#endif
