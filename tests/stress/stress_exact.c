/* stress_exact.c - the energy of a step by the oracle, and its rounding error.
 *
 * Conjugate gradients in extended precision test the residual of large squares.
 * Their direction p leaves r = -grad E - H p. The masses M are a lower bound of
 * the clamped H, so with norm^2 = r^T M^-1 r the error of p in the norm of M is
 * at most norm, of the residual sqrt(2/m)/h norm; m: least mass. */
#include "stress.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns E at x_n + u, not rounded, with its derivative along `direction`. */
static Jet evaluate_step_energy(const StepPotential *potential, const double *u,
                                const double *direction, Random *jitter)
{
    const IncrementalPotential *E = &potential->E;
    EvalPoint at = make_eval_point(E->system, E->x_n, u, NULL);
    Probe probe = {.at = &at,
                   .h = sqrtl(E->weight),
                   .p = direction,
                   .motion_time = potential->motion_time,
                   .jitter = jitter};
    at.weight = E->weight;
    return oracle_step_energy(&probe, E->u_tilde);
}

long double exact_energy(const StepPotential *potential, const double *u)
{
    return evaluate_step_energy(potential, u, NULL, NULL).f;
}

long double estimate_energy_noise(const StepPotential *potential,
                                  const double *u, const double *direction)
{
    const IncrementalPotential *E = &potential->E;
    Random jitter = {1};
    Jet exact = evaluate_step_energy(potential, u, direction, NULL);
    Real sum = LDBL_EPSILON * fabsl(exact.f);
    for (int round = 0; round < 3; round++) {
        Jet rounded = evaluate_step_energy(potential, u, direction, &jitter);
        sum += fabsl(rounded.f - exact.f) + fabsl(rounded.p - exact.p);
    }
    for (int i = 0; i < 2 * E->system->nodes; i++)
        sum += DBL_EPSILON * E->system->m[i / 2] *
               (fabsl(u[i]) + fabsl(E->u_tilde[i])) * fabs(direction[i]);
    return sum;
}

/* ---- residuals of large systems ---------------------------------------- */

enum { MAX_JUDGE_ITERATIONS = 20000 };

/* Allowed excess over the tolerance as a share of it, since u is rounded */
static const Real judge_margin = 1e-6L;

/* The gradient g [2n], and the blocks of the Hessian: the number of nodes of
 * each block, these nodes, and the entries of all blocks one after the other */
typedef struct HessianBlocks {
    Real *g, *entry;
    int (*node)[3], *node_counts;
    int block_count, entry_count,
        capacity; /* blocks; entries; allocated blocks */
} HessianBlocks;

static void store_block(void *blocks, const EnergyPart *block)
{
    HessianBlocks *to = blocks;
    int n = 2 * block->node_count;
    if (to->block_count == to->capacity) {
        size_t capacity = (size_t)(to->capacity = 2 * to->capacity + 1024);
        to->entry = realloc(to->entry, 36 * capacity * sizeof *to->entry);
        to->node = realloc(to->node, capacity * sizeof *to->node);
        to->node_counts =
            realloc(to->node_counts, capacity * sizeof *to->node_counts);
        CHECK(to->entry && to->node && to->node_counts);
    }
    to->node_counts[to->block_count] = block->node_count;
    memcpy(to->node[to->block_count++], block->node, sizeof block->node);
    memcpy(to->entry + to->entry_count, block->H,
           (size_t)(n * n) * sizeof *block->H);
    to->entry_count += n * n;
    for (int i = 0; i < n; i++)
        to->g[2 * block->node[i / 2] + i % 2] += block->g[i];
}

static void clear_pinned_entries(const System *system, Real *vector)
{
    for (int i = 0; i < 2 * system->nodes; i++)
        vector[i] = system->is_pinned[i / 2] ? 0 : vector[i];
}

/* Computes y = H d, which is 0 at pinned nodes. */
static void multiply_hessian(const System *system, const HessianBlocks *blocks,
                             const Real *d, Real *y)
{
    const Real *entry = blocks->entry;
    memset(y, 0, 2 * (size_t)system->nodes * sizeof *y);
    for (int b = 0; b < blocks->block_count; b++) {
        const int *node = blocks->node[b];
        int n = 2 * blocks->node_counts[b];
        for (int i = 0; i < n * n; i++)
            y[2 * node[i / n / 2] + i / n % 2] +=
                *entry++ * d[2 * node[i % n / 2] + i % n % 2];
    }
    clear_pinned_entries(system, y);
}

/* Returns the largest |p_x| + |p_y| of all nodes. */
static Real find_max_node_norm(int size, const Real *p)
{
    Real largest = 0;
    for (int i = 0; i < size; i += 2)
        largest = fmaxl(largest, fabsl(p[i]) + fabsl(p[i + 1]));
    return largest;
}

/* Returns r^T M^-1 r with the mass matrix M. */
static Real squared_norm_by_inverse_mass(const System *system, const Real *r)
{
    Real sum = 0;
    for (int i = 0; i < 2 * system->nodes; i++)
        sum += r[i] * r[i] / system->m[i / 2];
    return sum;
}

/* Runs conjugate gradients, preconditioned with the masses, until the test is
 * decided. p, r, d, y [2n] workspace; p starts as 0, r as -grad E. */
static TestVerdict run_cg_test(const System *system, Real h, Real tolerance,
                               const HessianBlocks *blocks, Real *p, Real *r,
                               Real *d, Real *y)
{
    Real lightest = INFINITY;
    int size = 2 * system->nodes;
    for (int i = 0; i < system->nodes; i++)
        if (!system->is_pinned[i])
            lightest = fminl(lightest, system->m[i]);
    Real now = squared_norm_by_inverse_mass(system, r), last = INFINITY;
    for (int k = 0; k < MAX_JUDGE_ITERATIONS; k++) {
        Real away = find_max_node_norm(size, p) / h - tolerance, bend = 0;
        Real error = sqrtl(2 / lightest) / h * sqrtl(now);
        if (away + error <= judge_margin * tolerance)
            return TEST_PASSED;
        if (away - error > judge_margin * tolerance)
            return TEST_FAILED;
        for (int i = 0; i < size; i++)
            d[i] = r[i] / system->m[i / 2] + now / last * d[i];
        multiply_hessian(system, blocks, d, y);
        for (int i = 0; i < size; i++)
            bend += d[i] * y[i];
        for (int i = 0; i < size; i++) {
            p[i] += now / bend * d[i];
            r[i] -= now / bend * y[i];
        }
        last = now;
        now = squared_norm_by_inverse_mass(system, r);
    }
    return TEST_UNDECIDED;
}

TestVerdict test_cg_residual(const IncrementalPotential *E, const double *u,
                             double h, double tolerance)
{
    size_t size = 2 * (size_t)E->system->nodes;
    Real *r = calloc(4 * size, sizeof *r);
    HessianBlocks blocks = {.g = r};
    CHECK(r != NULL);
    visit_E_parts(E, u, 1, store_block, &blocks);
    for (size_t i = 0; i < size; i++)
        r[i] = -r[i];
    clear_pinned_entries(E->system, r);
    TestVerdict verdict = run_cg_test(E->system, h, tolerance, &blocks,
                                      r + size, r, r + 2 * size, r + 3 * size);
    free(blocks.entry);
    free(blocks.node);
    free(blocks.node_counts);
    free(r);
    return verdict;
}
