/* Squares too large for a dense judge: what multigrid calls converged is judged
 * by conjugate gradients in extended precision, which know their error.  M is
 * a lower bound of the clamped Hessian, so |p - exact|_M <= |r|_(M^-1), and the
 * residual is at most sqrt(2/m)/h |r|_(M^-1) away from that of p.
 */
#include "stress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/pull_energy.h"

enum { MAX_JUDGE_ITERATIONS = 20000 };

/* Below this share of the tolerance rounding of u says nothing. */
static const long double judge_margin = 1e-6L;

/* A step problem in extended precision. */
typedef struct LargeProblem {
    const Newton *newton;
    int size;
    long double *x;             /* [2n] x_n + u, not rounded */
    long double *p, *r, *d, *y; /* [2n] */
} LargeProblem;

static bool held(const LargeProblem *problem, int i)
{
    const System *system = problem->newton->system;
    return system->pinned && system->pinned[i / 2];
}

/* x_i - x_j */
static void large_spring(const LargeProblem *problem, const int *e,
                         long double d[2])
{
    for (int c = 0; c < 2; c++)
        d[c] = problem->x[2 * e[0] + c] - problem->x[2 * e[1] + c];
}

/* r = -grad E */
static void large_gradient(LargeProblem *problem)
{
    const Iterate *at = &problem->newton->at;
    const System *system = problem->newton->system;
    for (int i = 0; i < problem->size; i++)
        problem->r[i] =
            system->m[i / 2] * ((long double)at->E.u_tilde[i] - at->u[i]);
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * s;
        long double d[2];
        large_spring(problem, e, d);
        long double strain = (d[0] * d[0] + d[1] * d[1]) / system->l2[s] - 1;
        for (int c = 0; c < 2; c++) {
            long double f = 2 * at->E.weight * system->k[s] * strain * d[c];
            problem->r[2 * e[0] + c] -= f;
            problem->r[2 * e[1] + c] += f;
        }
    }
    const Pull *hand = hand_energy_of(system);
    for (int i = 2 * (hand ? hand->node : 0), c = 0; hand && c < 2; c++)
        problem->r[i + c] -= at->E.weight * (long double)hand->k *
                             (problem->x[i + c] - hand->target[c]);
    for (int i = 0; i < problem->size; i++)
        problem->r[i] = held(problem, i) ? 0 : problem->r[i];
}

/* y = H d, each spring's eigenvalues along and across it if they are > 0. */
static void large_product(LargeProblem *problem)
{
    const System *system = problem->newton->system;
    double weight = problem->newton->at.E.weight;
    for (int i = 0; i < problem->size; i++)
        problem->y[i] = system->m[i / 2] * problem->d[i];
    const Pull *hand = hand_energy_of(system);
    for (int i = 2 * (hand ? hand->node : 0), c = 0; hand && c < 2; c++)
        problem->y[i + c] += weight * hand->k * problem->d[i + c];
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * s;
        long double v[2], l2 = system->l2[s], q[2];
        large_spring(problem, e, v);
        long double v2 = v[0] * v[0] + v[1] * v[1];
        long double c = 2 * weight * system->k[s] / l2;
        long double along = fmaxl(c * (3 * v2 - l2), 0);
        long double across = fmaxl(c * (v2 - l2), 0);
        for (int i = 0; i < 2; i++)
            q[i] = problem->d[2 * e[0] + i] - problem->d[2 * e[1] + i];
        long double part = v2 > 0 ? (v[0] * q[0] + v[1] * q[1]) / v2 : 0;
        for (int i = 0; i < 2; i++) {
            long double f = across * (q[i] - part * v[i]) + along * part * v[i];
            problem->y[2 * e[0] + i] += f;
            problem->y[2 * e[1] + i] -= f;
        }
    }
    for (int i = 0; i < problem->size; i++)
        problem->y[i] = held(problem, i) ? 0 : problem->y[i];
}

static long double large_residual(const LargeProblem *problem)
{
    long double largest = 0;
    for (int i = 0; i < problem->size; i += 2)
        largest =
            fmaxl(largest, fabsl(problem->p[i]) + fabsl(problem->p[i + 1]));
    return largest / problem->newton->settings.h;
}

/* |r|_(M^-1)^2 */
static long double large_square(const LargeProblem *problem)
{
    long double sum = 0;
    for (int i = 0; i < problem->size; i++)
        sum +=
            problem->r[i] * problem->r[i] / problem->newton->system->m[i / 2];
    return sum;
}

/* Conjugate gradients, with the masses as preconditioner, until the test is
 * decided. */
static LargeVerdict decide(LargeProblem *problem)
{
    const System *system = problem->newton->system;
    long double tolerance = problem->newton->tolerance;
    long double lightest = INFINITY;
    for (int i = 0; i < system->nodes; i++)
        if (!held(problem, 2 * i))
            lightest = fminl(lightest, system->m[i]);
    large_gradient(problem);
    long double scale = sqrtl(2 / lightest) / problem->newton->settings.h;
    long double now = large_square(problem);
    for (int i = 0; i < problem->size; i++)
        problem->d[i] = problem->r[i] / system->m[i / 2];
    for (int k = 0; k < MAX_JUDGE_ITERATIONS; k++) {
        long double away = large_residual(problem) - tolerance;
        long double error = scale * sqrtl(now);
        if (away + error <= judge_margin * tolerance)
            return LARGE_PASSED;
        if (away - error > judge_margin * tolerance)
            return LARGE_FAILED;
        large_product(problem);
        long double bend = 0, last = now;
        for (int i = 0; i < problem->size; i++)
            bend += problem->d[i] * problem->y[i];
        for (int i = 0; i < problem->size; i++) {
            problem->p[i] += now / bend * problem->d[i];
            problem->r[i] -= now / bend * problem->y[i];
        }
        now = large_square(problem);
        for (int i = 0; i < problem->size; i++)
            problem->d[i] =
                problem->r[i] / system->m[i / 2] + now / last * problem->d[i];
    }
    return LARGE_UNDECIDED;
}

LargeVerdict large_judge(const Newton *newton)
{
    int size = 2 * newton->system->nodes;
    LargeProblem problem = {.newton = newton, .size = size};
    long double *memory = calloc(5 * (size_t)size, sizeof *memory);
    if (!memory)
        return LARGE_UNDECIDED;
    problem.x = memory;
    problem.p = memory + size;
    problem.r = memory + 2 * size;
    problem.d = memory + 3 * size;
    problem.y = memory + 4 * size;
    for (int i = 0; i < size; i++)
        problem.x[i] = (long double)newton->at.E.x_n[i] + newton->at.u[i];
    LargeVerdict verdict = decide(&problem);
    free(memory);
    return verdict;
}

/* What a run of steps has been judged to be. */
typedef struct LargeRun {
    Simulation simulation;
    Tally *tally;
    int wrong;
} LargeRun;

static bool judge_large_end(void *user, const NewtonRecord *record)
{
    LargeRun *run = user;
    if (record->status != STATUS_OK)
        return true;
    LargeVerdict verdict = large_judge(run->simulation.run[0].newton);
    run->tally->judged++;
    run->tally->blurred += verdict == LARGE_UNDECIDED;
    run->wrong += verdict == LARGE_FAILED;
    return true;
}

bool large_steps(const char *line, int steps, Tally *tally, char *reason)
{
    LargeRun run = {.tally = tally};
    char whole[300];
    snprintf(whole, sizeof whole, "%s --solver multigrid", line);
    simulation_from_line(whole, judge_large_end, &run, &run.simulation);
    bool failed = false;
    for (int i = 0; i < steps && !failed; i++) {
        Status status = simulation_step(&run.simulation);
        tally->statuses[status]++;
        failed = status && !status_is_unconverged(status);
        tally->steps[status ? VERDICT_REPORTED : VERDICT_CONVERGED]++;
    }
    if (failed || run.wrong > 0)
        snprintf(reason, 512, "%s: %d ends wrong, %s", whole, run.wrong,
                 status_name(run.simulation.status));
    simulation_free(&run.simulation);
    tally->cases++;
    tally->wrong += failed || run.wrong > 0;
    return !failed && run.wrong == 0;
}

bool large_squares(Tally *tally, char *reason)
{
    static const struct {
        const char *line;
        int steps;
    } rows[] = {
        {"--segments 33", 40},
        {"--segments 64", 20},
        {"--segments 64 --minimum", 14},
        {"--segments 97 --stretch 0.7", 6},
        {"--segments 128", 10},
        {"--segments 128 --timestep 0.0166", 6},
        {"--segments 48 --stretch 2.5", 8},
        {"--segments 48 --stretch 0.5 --timestep 0.02", 5},
        {"--segments 40 --stretch 0.1 --timestep 0.1", 4},
        {"--segments 40 --stiffness 1e9 --stretch 1.1", 5},
        {"--segments 40 --stiffness 1e3 --timestep 0.1", 8},
        {"--segments 40 --integrator bdf2", 12},
        {"--segments 40 --integrator midpoint --stretch 1.2", 12},
        {"--segments 40 --integrator sdirk2", 8},
        {"--segments 40 --tolerance 1e-6", 10},
        {"--segments 40 --tolerance 1", 14},
        {"--segments 36 --gravity 9.81 --pin top-corners --stretch 1 "
         "--timestep 0.01 --stiffness 1e4",
         15},
        {"--segments 35 --pin left --stretch 1.3", 12},
        {"--segments 33 --side 1e-3 --density 1e-3 --stiffness 1e-3", 6},
        {"--segments 33 --side 1e3 --stiffness 1e9", 6},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (!large_steps(rows[i].line, rows[i].steps, tally, reason))
            return false;
    return true;
}

bool random_large_squares(Tally *tally, char *reason)
{
    char line[STRESS_LINE];
    for (long i = 0; i < 80; i++) {
        stress_line("l", 12, i, line);
        if (!large_steps(line, 4, tally, reason))
            return false;
    }
    return true;
}
