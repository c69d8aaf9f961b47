/* stress.h - tests that every step keeps its promise: it ends; it converges, or
 * its status says why not; the state is finite and the incremental potential no
 * higher than before. The tests share no formula with the solver: energies have
 * extended precision, gradient, Hessian and direction quadruple precision where
 * the compiler has it. */
#ifndef ELASTO_STRESS_H
#define ELASTO_STRESS_H

#include "oracle.h"

/* ---- exact formulas (stress_exact.c) ----------------------------------- */

/* Incremental potential E of a step; time for which its walls have moved, s */
typedef struct StepPotential {
    IncrementalPotential E;
    double motion_time;
} StepPotential;

/* Returns E at x_n + u, not rounded, by oracle.c, J s^2. */
long double exact_energy(const StepPotential *potential, const double *u);

/* Estimates the rounding error of E at x_n + u, J s^2: the sum of the errors
 * that rounding causes in E and in its derivative along `direction`. */
long double estimate_energy_noise(const StepPotential *potential,
                                  const double *u, const double *direction);

typedef enum TestVerdict {
    TEST_PASSED,
    TEST_FAILED,
    TEST_UNDECIDED /* near the tolerance, or too many iterations */
} TestVerdict;

/* Tests whether |p|_inf / h at u is below the tolerance, m/s.  Conjugate
 * gradients without a matrix compute p from the clamped Hessian. */
TestVerdict test_cg_residual(const IncrementalPotential *E, const double *u,
                             double h, double tolerance);

/* ---- judging steps (stress_watch.c) ------------------------------------ */

typedef enum StepVerdict {
    VERDICT_CONVERGED, /* the oracle confirms that the step converged */
    VERDICT_REPORTED,  /* the step did not converge, and its status says so */
    VERDICT_WRONG,     /* the step failed a test */
    VERDICT_COUNT
} StepVerdict;

/* Counts of cases, wrong cases, updates, judged residuals, those of them that
 * rounding leaves undecided, and steps by verdict and by status. */
typedef struct VerdictTally {
    long cases, wrong_cases, updates, judged_residuals, undecided_tests;
    long steps_by_verdict[VERDICT_COUNT], steps_by_status[STATUS_COUNT];
} VerdictTally;

/* Watches one run: no node is behind a wall and no cell turned over, no update
 * and no step raises E, and residuals of converged steps are computed again. */
typedef struct RunWatch {
    TimeIntegrator *run;
    VerdictTally *tally;  /* counts of all watches */
    bool tests_residuals; /* residuals of converged steps are computed again */
    bool only_springs;    /* the system has no energy but springs and pulls */
    double *x, *v;        /* [2n] m and m/s, state before the step */
    double *x_n;          /* [2n] m, x_n of the present minimisation */
    double *u;            /* [2n] m, x - x_n at the last iterate */
    double *workspace;    /* [2n] */
    long double start_energy; /* J s^2, E at u = 0 */
    long double energy;       /* J s^2, E at u */
    int update_count;         /* updates of the present minimisation so far */
    double tolerance;         /* tolerance at the start of the step, m/s */
    long crossing_count; /* number of crossing edges at the start of the step */
    bool is_wrong;       /* the present step has failed a test */
    bool has_flat_cell;  /* a cell was flat when E was last computed */
    char reason[512];    /* first failed test of the step, in words */
    Status status;       /* status of the last step */
} RunWatch;

/* Starts to watch a run, whose address must not change and whose observer of
 * Newton becomes the watch. Returns false without memory. */
bool watch_create(TimeIntegrator *run, VerdictTally *tally, RunWatch *watch);
void watch_free(RunWatch *watch);

/* Creates a run anew, with its x, v and h, after a change of its system. */
Status restart_watched_run(TimeIntegrator *run);

/* Makes one step, tests it and returns the verdict. */
StepVerdict make_judged_step(RunWatch *watch);

/* ---- random scenes (stress_scenes.c) ----------------------------------- */

enum { STRESS_LINE_SIZE = 512 };

/* Calls `take` with each row of tests/data/stress.txt below "= NAME" until it
 * returns false; returns what the last call did. */
bool stress_read_rows(const char *name, bool (*take)(void *user, char *row),
                      void *user);

/* Makes and tests `steps` steps of a command line, which may end with "shaken
 * N".
 *   reason  [512] out, if the verdict is WRONG */
StepVerdict stress_run_line(const char *line, int steps, VerdictTally *tally,
                            char *reason);

/* Command line that runs now */
extern char stress_line[STRESS_LINE_SIZE];

/* Runs `count` random scenes; a wrong verdict ends the loop and returns false.
 * The letters of `kinds` are the kinds of the scenes, in turn:
 *   s  squares over all that the command line allows: h to 1e6 s, k to 1e15
 *      J/m^2, density from 1e-9 kg/m^2, so h^2 k/m to 1e34; half of them shaken
 *   f  springs that flow, half of them without hardening, h to 1e4 s
 *   c, t  squares that fall, slide or are pressed; squares that are torn
 *   b, w  bars that are bent; squares in a corner of two grounds
 *         (c, t, b and w: some flow, break or are damped)
 *   m, n  2 to 6 bodies of springs (m), triangles (n): thrown, squeezed, pinned
 *   k  solids of triangles: moduli to 1e13 Pa, density from 1e-6 kg/m^2, h to 1
 *      s, tolerances from 1e-9 m/s
 *   l  large squares */
bool stress_run_scenes(const char *kinds, uint64_t seed, long count, int steps,
                       VerdictTally *tally, char *reason);

/* Limits the processor time until SIGPROF, s; 0: no limit. */
void stress_set_time_limit(long seconds);

typedef struct StressCase {
    const char *name;
    bool is_slow; /* only in `make stress` */
    /* Runs the case; returns false and a reason [512] if a test fails. */
    bool (*run_case)(VerdictTally *tally, char *reason);
} StressCase;

extern const StressCase stress_cases[]; /* ends with a NULL name */

#endif
