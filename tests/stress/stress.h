/* stress.h - whether every step keeps the promise: it ends; it is converged,
 * or its status says why not; the state is finite and the incremental
 * potential not higher than before.  What judges shares no formula with the
 * solver: energy in extended precision, gradient, Hessian and direction in
 * quadruple precision where the compiler has it.
 */
#ifndef ELASTO_STRESS_H
#define ELASTO_STRESS_H

#include "oracle.h"

/* ---- exact formulas (stress_exact.c) ----------------------------------- */

/* A minimisation, and for how long walls have moved in this step, s. */
typedef struct Moment {
    IncrementalPotential E;
    double moved;
} Moment;

/* E of all terms at x_n + u, which is not rounded, by oracle.c; J s^2 */
long double wide_energy(const Moment *moment, const double *u);

/* Error of E at x_n + u that rounding of the coordinates, and of the slope
 * along `way`, can cause; J s^2 */
long double wide_noise(const Moment *moment, const double *u,
                       const double *way);

typedef enum LargeVerdict {
    LARGE_PASSED,
    LARGE_FAILED,
    LARGE_UNDECIDED /* too close to the tolerance, or too slow */
} LargeVerdict;

/* The test of Algorithm 3 with clamped blocks, at u of a minimisation, without
 * a matrix.  tolerance in m/s */
LargeVerdict large_judge(const IncrementalPotential *E, const double *u,
                         double h, double tolerance);

/* ---- judging steps (stress_watch.c) ------------------------------------ */

typedef enum Verdict {
    VERDICT_CONVERGED, /* the judge's own test was passed, too */
    VERDICT_REPORTED,  /* not converged, and the status says so */
    VERDICT_WRONG,     /* a promise was broken */
    VERDICTS
} Verdict;

/* Of cases, steps by verdict and by status, residuals computed again (judged)
 * and those of them where rounding is larger than the tolerance (blurred). */
typedef struct Tally {
    long cases, wrong, updates, steps[VERDICTS], judged, undecided;
    long statuses[STATUS_COUNT];
} Tally;

/* Watches one run: nothing is behind a wall or turned, E is raised by no update
 * and by no step, a residual is solved for again where a step says that it
 * converged. */
typedef struct Watch {
    TimeIntegrator *run;
    Tally *tally;       /* counters of all watches */
    bool residuals;     /* solve again where a step says it converged */
    bool springs;       /* the system has springs alone */
    double *x, *v;      /* [2n] before the step */
    double *x_n;        /* [2n] where the present minimisation started */
    double *u;          /* [2n] m, last iterate of the minimisation */
    double *way;        /* [2n] workspace */
    long double start;  /* E at u = 0 */
    long double energy; /* E at u */
    int updates;        /* updates of the present minimisation so far */
    double tolerance;   /* m/s, as the step began */
    long crossings;     /* crossings of edges as the step began */
    bool wrong;         /* in this step */
    bool flat;          /* a cell was, as E was looked at last */
    char reason[512];   /* first broken promise */
    Status status;      /* status of the last step */
} Watch;

/* The run must stay where it is; its Newton's observer becomes the watch.
 * Returns false without memory. */
bool watch_create(TimeIntegrator *run, Tally *tally, Watch *watch);
void watch_free(Watch *watch);

/* After a change of the system: the run made anew, with its x, v and h. */
Status watch_restart(TimeIntegrator *run);

/* One step, judged. */
Verdict watch_step(Watch *watch);

/* ---- random scenes (stress_scenes.c) ----------------------------------- */

enum { STRESS_LINE = 512 };

/* Calls `take` with each row of tests/data/stress.txt below "= NAME" until it
 * returns false; returns what the last call did. */
bool stress_rows(const char *name, bool (*take)(void *user, char *row),
                 void *user);

/* So many steps of a command line, which may end with the word "shaken N",
 * judged; reason [512] out where one was WRONG; tally in/out. */
Verdict stress_run(const char *line, int steps, Tally *tally, char *reason);

/* The line that runs. */
extern char stress_present[STRESS_LINE];

/* So many random scenes; the first that is WRONG ends them.  kinds are letters,
 * of which the scenes have one after the other:
 *   s  squares over all that the command line allows: h to 1e6 s, k to 1e15
 *      J/m^2, density from 1e-9 kg/m^2, so h^2 k/m to 1e34; where they are
 *      shaken no squares any more
 *   f  springs that flow, half of them without hardening, h to 1e4 s
 *   c, t, b, w  contact, friction, cells, flow, fracture, damping and what
 *      moves: scenes that fall and are pressed, tear, bend; a square among
 *      walls
 *   m, n  two to six bodies of springs, or of triangles, that are thrown at
 *      each other, squeezed and pinned
 *   k  solids of triangles: moduli to 1e13 Pa, density from 1e-6 kg/m^2, h to
 *      1 s, tolerances from 1e-9 m/s
 *   l  large squares */
bool stress_scenes(const char *kinds, uint64_t seed, long count, int steps,
                   Tally *tally, char *reason);

/* Processor time that is left until SIGPROF; 0: as much as it takes. */
void stress_limit(long seconds);

typedef struct StressCase {
    const char *name;
    bool slow; /* only in `make stress` */
    /* Returns false, with a reason [512], where something is wrong. */
    bool (*run)(Tally *tally, char *reason);
} StressCase;

extern const StressCase stress_cases[]; /* ends with a NULL name */

#endif
