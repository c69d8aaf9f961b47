/* The energy of a step once more, in more digits than the solver has: plain
 * sums over springs, and a dense L D L^T.
 *
 * Squares that are too large for that are judged by conjugate gradients in
 * extended precision, which know their error: M is a lower bound of the clamped
 * Hessian, so |p - exact|_M <= |r|_(M^-1), and the residual is at most
 * sqrt(2/m)/h |r|_(M^-1) away from that of p.
 */
#include "model/pull_energy.h"
#include "stress.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Coordinate c of x_i - x_j at x_n + u, not rounded. */
static Wide wide_difference(const IncrementalPotential *E, const double *u,
                            int s, int c)
{
    int i = 2 * E->system->e[2 * s] + c, j = 2 * E->system->e[2 * s + 1] + c;
    return (Wide)E->x_n[i] - E->x_n[j] + ((Wide)u[i] - u[j]);
}

/* E at x_n + u, not rounded, with its derivative along `way`. */
static Jet energy(const Moment *moment, const double *u, const double *way,
                  Random *jitter)
{
    const IncrementalPotential *E = &moment->E;
    EvalPoint at = eval_point_at(E->system, E->x_n, u, NULL);
    Spot spot = {.at = &at,
                 .h = sqrtl(E->weight),
                 .p = way,
                 .moved = moment->moved,
                 .jitter = jitter};
    at.weight = E->weight;
    return oracle_step(&spot, E->u_tilde);
}

long double wide_energy(const Moment *moment, const double *u)
{
    return energy(moment, u, NULL, NULL).f;
}

long double wide_noise(const Moment *moment, const double *u, const double *way)
{
    const IncrementalPotential *E = &moment->E;
    Random jitter = {1};
    Jet exact = energy(moment, u, way, NULL);
    Real sum = LDBL_EPSILON * fabsl(exact.f);
    for (int round = 0; round < 3; round++) {
        Jet rounded = energy(moment, u, way, &jitter);
        sum += fabsl(rounded.f - exact.f) + fabsl(rounded.p - exact.p);
    }
    for (int i = 0; i < 2 * E->system->nodes; i++)
        sum += DBL_EPSILON * E->system->m[i / 2] *
               (fabsl(u[i]) + fabsl(E->u_tilde[i])) * fabs(way[i]);
    return sum;
}

static Wide wide_abs(Wide a)
{
    return a < 0 ? -a : a;
}

/* Two Newton steps from the root in extended precision. */
static Wide wide_root(Wide a)
{
    if (!(a > 0))
        return 0;
    Wide root = sqrtl((long double)a);
    root = (root + a / root) / 2;
    return (root + a / root) / 2;
}

/* (H share + |H|)/(share + 1) with |H| = (H^2 + |det H| I)/(|a| + |b|), a, b
 * the eigenvalues of H: share 1 cuts the negative ones, 0 mirrors them. */
static void cut_negative(Wide H[3], int share)
{
    Wide mean = (H[0] + H[2]) / 2, half = (H[0] - H[2]) / 2;
    Wide radius = wide_root(half * half + H[1] * H[1]);
    Wide sum = wide_abs(mean + radius) + wide_abs(mean - radius);
    Wide det = wide_abs((mean + radius) * (mean - radius));
    if (!(sum > 0))
        return;
    Wide xx = H[0] * H[0] + H[1] * H[1] + det;
    Wide xy = H[1] * (H[0] + H[2]);
    Wide yy = H[2] * H[2] + H[1] * H[1] + det;
    H[0] = (share * H[0] + xx / sum) / (share + 1);
    H[1] = (share * H[1] + xy / sum) / (share + 1);
    H[2] = (share * H[2] + yy / sum) / (share + 1);
}

/* Force [2] on node i and block [3] of one spring, both weighted, the block
 * projected. */
static void wide_spring(const IncrementalPotential *E, const double *u, int s,
                        Projection projection, Wide f[2], Wide H[3])
{
    Wide l2 = E->system->l2[s], k = E->system->k[s];
    Wide dx = wide_difference(E, u, s, 0), dy = wide_difference(E, u, s, 1);
    Wide more = (dx * dx + dy * dy - l2) / l2, factor = E->weight * 2 * k;
    f[0] = factor * more * dx;
    f[1] = factor * more * dy;
    H[0] = factor * (2 * dx * dx / l2 + more);
    H[1] = factor * (2 * dx * dy / l2);
    H[2] = factor * (2 * dy * dy / l2 + more);
    if (projection == PROJECTION_CLAMP || projection == PROJECTION_ABS)
        cut_negative(H, projection == PROJECTION_ABS ? 0 : 1);
}

/* The rows and columns of pinned nodes become those of the unit matrix. */
static void wide_pin(const System *system, Wide *g, Wide *H)
{
    int n = 2 * system->nodes;
    for (int r = 0; r < n && system->pinned; r++) {
        if (!system->pinned[r / 2])
            continue;
        g[r] = 0;
        for (int c = 0; c < n && H; c++)
            H[n * r + c] = H[n * c + r] = r == c;
    }
}

/* What draws coordinate i to points: k (x - o); returns k, J/m^2. */
static Wide wide_pull(const System *system, int i, Wide x, Wide *force)
{
    Wide sum = 0;
    *force = 0;
    for (int t = 0; t < system->terms; t++) {
        const TermKind *kind = system->term[t].kind;
        const Pull *pull = system->term[t].data;
        if (kind != &central_field && kind != &hand_energy)
            continue;
        Wide k = pull->node == i / 2 ? pull->k : 0;
        sum += k;
        *force += k * (x - pull->target[i % 2]);
    }
    return sum;
}

/* The same with the springs' blocks [3 springs] in the place of H, behind what
 * is its diagonal besides, [2n]; NULL: none. */
static void wide_blocks(const IncrementalPotential *E, const double *u,
                        Projection projection, Wide *g, Real *blocks)
{
    const System *system = E->system;
    for (int i = 0; i < 2 * system->nodes; i++) {
        Wide m = system->m[i / 2], force;
        Wide k = wide_pull(system, i, (Wide)E->x_n[i] + u[i], &force);
        g[i] = m * ((Wide)u[i] - E->u_tilde[i]) + E->weight * force;
        if (blocks)
            *blocks++ = (Real)(m + E->weight * k);
    }
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * s;
        Wide f[2], block[3];
        wide_spring(E, u, s, projection, f, block);
        for (int c = 0; c < 2; c++) {
            g[2 * e[0] + c] += f[c];
            g[2 * e[1] + c] -= f[c];
        }
        for (int t = 0; t < 3 && blocks; t++)
            blocks[3 * s + t] = (Real)block[t];
    }
    wide_pin(system, g, NULL);
}

void wide_derivatives(const IncrementalPotential *E, const double *u,
                      Projection projection, Wide *g, Wide *H)
{
    const System *system = E->system;
    int n = 2 * system->nodes;
    Wide force;
    wide_blocks(E, u, projection, g, NULL);
    if (!H)
        return;
    for (int i = 0; i < n * n; i++)
        H[i] = 0;
    for (int i = 0; i < n; i++)
        H[i * (n + 1)] =
            system->m[i / 2] + E->weight * wide_pull(system, i, 0, &force);
    for (int s = 0; s < system->springs; s++) {
        int end[2] = {2 * system->e[2 * s], 2 * system->e[2 * s + 1]};
        Wide f[2], block[3];
        wide_spring(E, u, s, projection, f, block);
        for (int t = 0; t < 16; t++) {
            int r = end[t / 8] + t / 4 % 2, c = end[t / 2 % 2] + t % 2;
            Wide value = block[t / 4 % 2 + t % 2];
            H[n * r + c] += t / 8 == t / 2 % 2 ? value : -value;
        }
    }
    wide_pin(system, g, H);
}

bool wide_factor(int n, Wide *H, int *negative)
{
    *negative = 0;
    for (int c = 0; c < n; c++) {
        Wide pivot = H[n * c + c];
        if (!(wide_abs(pivot) > 0))
            return false;
        *negative += pivot < 0;
        for (int r = c + 1; r < n; r++) {
            if (H[n * r + c] == 0)
                continue;
            Wide factor = H[n * r + c] / pivot;
            for (int i = c + 1; i <= r; i++)
                H[n * r + i] -= factor * H[n * i + c];
        }
    }
    for (int c = 0; c < n; c++)
        for (int r = c + 1; r < n; r++)
            H[n * r + c] /= H[n * c + c];
    return true;
}

void wide_solve(int n, const Wide *H, Wide *b)
{
    for (int r = 0; r < n; r++)
        for (int c = 0; c < r; c++)
            b[r] -= H[n * r + c] * b[c];
    for (int r = 0; r < n; r++)
        b[r] /= H[n * r + r];
    for (int r = n - 1; r >= 0; r--)
        for (int c = r + 1; c < n; c++)
            b[r] -= H[n * c + r] * b[c];
}

double wide_residual(int n, const Wide *p, double h)
{
    Wide largest = 0;
    for (int i = 0; i < n; i += 2) {
        Wide sum = wide_abs(p[i]) + wide_abs(p[i + 1]);
        largest = sum > largest ? sum : largest;
    }
    return (double)(largest / h);
}

double wide_direction(const IncrementalPotential *E, const double *u,
                      Projection projection, double h, Real *p)
{
    enum { MOST = 50 };
    int n = 2 * E->system->nodes, negative;
    Wide g[MOST], H[MOST * MOST];
    CHECK(n <= MOST);
    wide_derivatives(E, u, projection, g, H);
    CHECK(wide_factor(n, H, &negative));
    wide_solve(n, H, g);
    for (int i = 0; i < n; i++)
        p[i] = -(Real)g[i];
    return wide_residual(n, g, h);
}

/* ---- too large for a matrix -------------------------------------------- */

enum { MAX_JUDGE_ITERATIONS = 20000 };

/* Below this share of the tolerance rounding of u says nothing. */
static const Real judge_margin = 1e-6L;

/* y = H d, 0 where nodes are pinned; blocks: of wide_blocks. */
static void product(const System *system, const Real *blocks, const Real *d,
                    Real *y)
{
    for (int i = 0; i < 2 * system->nodes; i++)
        y[i] = *blocks++ * d[i];
    for (int s = 0; s < system->springs; s++) {
        int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
        Real q0 = d[i] - d[j], q1 = d[i + 1] - d[j + 1];
        for (int c = 0; c < 2; c++) {
            Real f = blocks[3 * s + c] * q0 + blocks[3 * s + c + 1] * q1;
            y[i + c] += f;
            y[j + c] -= f;
        }
    }
    for (int i = 0; i < 2 * system->nodes && system->pinned; i++)
        y[i] = system->pinned[i / 2] ? 0 : y[i];
}

/* max over nodes |p_x| + |p_y| */
static Real largest_step(int size, const Real *p)
{
    Real largest = 0;
    for (int i = 0; i < size; i += 2)
        largest = fmaxl(largest, fabsl(p[i]) + fabsl(p[i + 1]));
    return largest;
}

/* |r|_(M^-1)^2 */
static Real inverse_square(const System *system, const Real *r)
{
    Real sum = 0;
    for (int i = 0; i < 2 * system->nodes; i++)
        sum += r[i] * r[i] / system->m[i / 2];
    return sum;
}

/* Conjugate gradients, with the masses as preconditioner, until the test is
 * decided.  p, r, d, y [2n] workspace; p is 0, r is -grad E. */
static LargeVerdict decide(const System *system, Real h, Real tolerance,
                           const Real *blocks, Real *p, Real *r, Real *d,
                           Real *y)
{
    Real lightest = INFINITY;
    int size = 2 * system->nodes;
    for (int i = 0; i < system->nodes; i++)
        if (!system->pinned || !system->pinned[i])
            lightest = fminl(lightest, system->m[i]);
    Real now = inverse_square(system, r), last = INFINITY;
    for (int k = 0; k < MAX_JUDGE_ITERATIONS; k++) {
        Real away = largest_step(size, p) / h - tolerance, bend = 0;
        Real error = sqrtl(2 / lightest) / h * sqrtl(now);
        if (away + error <= judge_margin * tolerance)
            return LARGE_PASSED;
        if (away - error > judge_margin * tolerance)
            return LARGE_FAILED;
        for (int i = 0; i < size; i++)
            d[i] = r[i] / system->m[i / 2] + now / last * d[i];
        product(system, blocks, d, y);
        for (int i = 0; i < size; i++)
            bend += d[i] * y[i];
        for (int i = 0; i < size; i++) {
            p[i] += now / bend * d[i];
            r[i] -= now / bend * y[i];
        }
        last = now;
        now = inverse_square(system, r);
    }
    return LARGE_UNDECIDED;
}

LargeVerdict large_judge(const IncrementalPotential *E, const double *u,
                         double h, double tolerance)
{
    size_t size = 2 * (size_t)E->system->nodes;
    size_t entries = size + 3 * (size_t)E->system->springs;
    Wide *g = malloc(size * sizeof *g);
    Real *blocks = calloc(4 * size + entries, sizeof *blocks);
    LargeVerdict verdict = LARGE_UNDECIDED;
    if (g && blocks) {
        Real *r = blocks + entries;
        wide_blocks(E, u, PROJECTION_CLAMP, g, blocks);
        for (size_t i = 0; i < size; i++)
            r[i] = -(Real)g[i];
        verdict = decide(E->system, h, tolerance, blocks, r + size, r,
                         r + 2 * size, r + 3 * size);
    }
    free(g);
    free(blocks);
    return verdict;
}
