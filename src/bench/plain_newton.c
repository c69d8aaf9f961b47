#include "bench/plain_newton.h"

#include <cholmod.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "model/inertia_energy.h"
#include "model/mass_spring_energy.h"

/* What the functions of one step share; arrays are [2n]. */
typedef struct PlainStep {
    const System *system;
    double h;
    double *x;       /* the iterate */
    double *x_tilde; /* x_n + h v_n */
    double *p;       /* search direction */
    double *trial;   /* x + alpha p */
    cholmod_common common;
    PlainCounters *counters;
} PlainStep;

static double plain_clock(void)
{
    struct timespec now;
    timespec_get(&now, TIME_UTC);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* E(x) = |x - x_tilde|_M^2 / 2 + h^2 P(x) (slide: IP_val) */
static double plain_value(const PlainStep *step, const double *x)
{
    const System *system = step->system;
    return inertia_energy_value(system->nodes, x, step->x_tilde, system->m) +
           step->h * step->h *
               mass_spring_energy_value(system->springs, x, system->e,
                                        system->l2, system->k);
}

/* g = grad E(x) (slide: IP_grad) */
static void plain_gradient(const PlainStep *step, double *g)
{
    const System *system = step->system;
    for (int i = 0; i < 2 * system->nodes; i++)
        g[i] = 0;
    inertia_energy_gradient(system->nodes, step->x, step->x_tilde, system->m,
                            g);
    mass_spring_energy_gradient(system->springs, step->x, system->e, system->l2,
                                system->k, step->h * step->h, g);
}

/* One more triplet; CHOLMOD wants one triangle only. */
static void plain_entry(cholmod_triplet *T, int row, int column, double value)
{
    if (row > column)
        return;
    ((int *)T->i)[T->nnz] = row;
    ((int *)T->j)[T->nnz] = column;
    ((double *)T->x)[T->nnz] = value;
    T->nnz++;
}

/* The 4x4 block [[H, -H], [-H, H]] of one spring, projected as it is. */
static void plain_spring(const PlainStep *step, int s, cholmod_triplet *T)
{
    const System *system = step->system;
    int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
    int place[4] = {i, i + 1, j, j + 1};
    double d[2] = {step->x[i] - step->x[j], step->x[i + 1] - step->x[j + 1]};
    double H[3], block[16];
    spring_hessian(d, system->l2[s], system->k[s], H);
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            block[4 * r + c] = (r / 2 == c / 2 ? 1 : -1) * H[r % 2 + c % 2];
    make_psd(block);
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            plain_entry(T, place[r], place[c],
                        step->h * step->h * block[4 * r + c]);
}

/* The Hessian from its triplets, sorted and summed (slide: IP_hess). */
static cholmod_sparse *plain_hessian(PlainStep *step)
{
    const System *system = step->system;
    size_t size = 2 * (size_t)system->nodes;
    size_t count = size + 16 * (size_t)system->springs;
    cholmod_triplet *T = cholmod_allocate_triplet(size, size, count, 1,
                                                  CHOLMOD_REAL, &step->common);
    if (!T)
        return NULL;
    for (int i = 0; i < 2 * system->nodes; i++)
        plain_entry(T, i, i, system->m[i / 2]);
    for (int s = 0; s < system->springs; s++)
        plain_spring(step, s, T);
    cholmod_sparse *A = cholmod_triplet_to_sparse(T, 0, &step->common);
    cholmod_free_triplet(&T, &step->common);
    return A;
}

/* Pattern, numbers, solution: x = A^-1 b (slide: spsolve).  NULL: no memory.
 * What is not positive definite leaves NaN or nonsense, as in the slides. */
static cholmod_dense *plain_solve(PlainStep *step, cholmod_sparse *A,
                                  cholmod_dense *b)
{
    cholmod_dense *x = NULL;
    double start = plain_clock();
    cholmod_factor *L = cholmod_analyze(A, &step->common);
    double analysed = plain_clock(), factored = analysed;
    if (L) {
        cholmod_factorize(A, L, &step->common);
        factored = plain_clock();
        x = cholmod_solve(CHOLMOD_A, L, b, &step->common);
    }
    cholmod_free_factor(&L, &step->common);
    step->counters->factorisations++;
    step->counters->seconds_analysis += analysed - start;
    step->counters->seconds_factor += factored - analysed;
    step->counters->seconds_solve += plain_clock() - factored;
    return x;
}

/* p = -H^-1 g (slide: search_dir) */
static Status plain_direction(PlainStep *step)
{
    size_t size = 2 * (size_t)step->system->nodes;
    double start = plain_clock();
    cholmod_dense *x = NULL, *b = cholmod_allocate_dense(
                                 size, 1, size, CHOLMOD_REAL, &step->common);
    cholmod_sparse *A = plain_hessian(step);
    if (A && b) {
        double *g = b->x;
        plain_gradient(step, g);
        for (size_t i = 0; i < size; i++)
            g[i] = -g[i];
        step->counters->seconds_assembly += plain_clock() - start;
        x = plain_solve(step, A, b);
    }
    if (x)
        memcpy(step->p, x->x, size * sizeof *step->p);
    Status status = x ? STATUS_OK : STATUS_OUT_OF_MEMORY;
    cholmod_free_dense(&x, &step->common);
    cholmod_free_dense(&b, &step->common);
    cholmod_free_sparse(&A, &step->common);
    return status;
}

/* max over nodes of |p_x| + |p_y|, over h (slide: LA.norm(p, inf) / h) */
static double plain_residual(const PlainStep *step)
{
    double largest = 0;
    for (int i = 0; i < 2 * step->system->nodes; i += 2) {
        double sum = fabs(step->p[i]) + fabs(step->p[i + 1]);
        if (!(sum <= largest))
            largest = sum;
    }
    return largest / step->h;
}

/* x = x + alpha p, alpha halved while that raises E (Algorithm 2).  The slides'
 * loop would not end where rounding hides the decrease; this one does. */
static Status plain_search(PlainStep *step)
{
    enum { MAX_HALVINGS = 64 };
    size_t size = 2 * (size_t)step->system->nodes;
    double start = plain_clock(), E = plain_value(step, step->x), alpha = 1;
    int halvings = 0;
    for (; halvings <= MAX_HALVINGS; halvings++, alpha /= 2) {
        for (size_t i = 0; i < size; i++)
            step->trial[i] = step->x[i] + alpha * step->p[i];
        if (plain_value(step, step->trial) <= E)
            break;
    }
    if (halvings <= MAX_HALVINGS)
        memcpy(step->x, step->trial, size * sizeof *step->x);
    step->counters->iterations++;
    step->counters->seconds_search += plain_clock() - start;
    return halvings <= MAX_HALVINGS ? STATUS_OK : STATUS_LINE_SEARCH_LIMIT;
}

/* Algorithm 3 (slide: step_forward), from x_n to the minimiser. */
static Status plain_minimise(PlainStep *step, double tolerance,
                             int max_iterations)
{
    Status status = plain_direction(step);
    double residual = status ? 0 : plain_residual(step);
    for (int i = 0; !status && residual > tolerance; i++) {
        if (i == max_iterations)
            return STATUS_ITERATION_LIMIT;
        status = plain_search(step);
        if (!status)
            status = plain_direction(step);
        if (!status)
            residual = plain_residual(step);
    }
    return status || isfinite(residual) ? status : STATUS_NOT_FINITE;
}

Status plain_newton_step(const System *system, double h, double tolerance,
                         int max_iterations, double *x, double *v,
                         PlainCounters *counters)
{
    size_t size = 2 * (size_t)system->nodes;
    double *work = malloc(4 * size * sizeof *work);
    if (!work)
        return STATUS_OUT_OF_MEMORY;
    PlainStep step = {.system = system,
                      .h = h,
                      .x = work,
                      .x_tilde = work + size,
                      .p = work + 2 * size,
                      .trial = work + 3 * size,
                      .counters = counters};
    cholmod_start(&step.common);
    step.common.print = 0;
    for (size_t i = 0; i < size; i++) {
        step.x[i] = x[i];
        step.x_tilde[i] = x[i] + h * v[i];
    }
    Status status = plain_minimise(&step, tolerance, max_iterations);
    if (!status || status_is_unconverged(status))
        for (size_t i = 0; i < size; i++) {
            v[i] = (step.x[i] - x[i]) / h;
            x[i] = step.x[i];
        }
    cholmod_finish(&step.common);
    free(work);
    return status;
}
