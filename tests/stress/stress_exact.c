/* The energy of a step once more, in more digits than the solver has: averages
 * along the step by Gauss's two points, which are exact for the polynomials
 * that occur, plain sums over springs, and a dense L D L^T.
 */
#include "model/pull_energy.h"
#include "stress.h"

#include <float.h>
#include <math.h>

/* Where along the step from x_n to x_n + u the springs are looked at. */
static const long double gauss[2] = {0.2113248654051871177454256L,
                                     0.7886751345948128822545744L};

/* Coordinate c of x_i - x_j at x_n + t u, not rounded. */
static Wide wide_difference(const IncrementalPotential *E, const double *u,
                            int s, int c, Wide t)
{
    int i = 2 * E->system->e[2 * s] + c, j = 2 * E->system->e[2 * s + 1] + c;
    return (Wide)E->x_n[i] - E->x_n[j] + t * ((Wide)u[i] - u[j]);
}

/* E at x_n + u, not rounded, and its slope along `way`; averaged E takes the
 * forces at Gauss's points. */
static Jet energy(const IncrementalPotential *E, const double *u,
                  const double *way, Random *jitter)
{
    const System *system = E->system;
    Place place = place_at(system, E->x_n, u, NULL);
    Spot spot = {
        .at = &place, .h = sqrtl(E->weight), .p = way, .jitter = jitter};
    Jet sum = {0};
    place.averaged = true; /* at x_n + t u */
    for (int a = 0; a < (E->averaged ? 2 : 1); a++) {
        spot.t = E->averaged ? gauss[a] : 1;
        place.w = E->averaged ? E->weight / 2 : E->weight;
        Jet part = oracle_energy(&spot, NULL);
        sum.f += part.f / spot.t;
        sum.p += part.p / spot.t;
    }
    for (int i = 0; i < 2 * system->nodes; i++) {
        Real away = (Real)u[i] - E->u_tilde[i];
        sum.f += system->m[i / 2] * away * away / 2;
    }
    return sum;
}

long double wide_energy(const IncrementalPotential *E, const double *u)
{
    return energy(E, u, NULL, NULL).f;
}

long double wide_noise(const IncrementalPotential *E, const double *u,
                       const double *way)
{
    Random jitter = {1};
    Jet exact = energy(E, u, way, NULL);
    Real sum = LDBL_EPSILON * fabsl(exact.f);
    for (int round = 0; round < 3; round++) {
        Jet rounded = energy(E, u, way, &jitter);
        sum += fabsl(rounded.f - exact.f) + fabsl(rounded.p - exact.p);
    }
    for (int i = 0; i < 2 * E->system->nodes; i++)
        sum += DBL_EPSILON * E->system->m[i / 2] *
               (fabsl(u[i]) + fabsl(E->u_tilde[i])) * fabs(way[i]);
    return sum;
}

long double wide_potential(const System *system, const double *x)
{
    Place place = place_at(system, x, NULL, x);
    Spot spot = {.at = &place};
    place.w = 1;
    return oracle_energy(&spot, NULL).f;
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

/* Force [2] on node i and block [3] of one spring, both weighted. */
static void wide_spring(const IncrementalPotential *E, const double *u, int s,
                        Wide f[2], Wide H[3])
{
    Wide l2 = E->system->l2[s], k = E->system->k[s];
    f[0] = f[1] = H[0] = H[1] = H[2] = 0;
    for (int a = 0; a < (E->averaged ? 2 : 1); a++) {
        Wide t = E->averaged ? gauss[a] : 1;
        Wide share = E->weight * (E->averaged ? (Wide)0.5 : (Wide)1);
        Wide dx = wide_difference(E, u, s, 0, t);
        Wide dy = wide_difference(E, u, s, 1, t);
        Wide more = (dx * dx + dy * dy - l2) / l2;
        f[0] += share * 2 * k * more * dx;
        f[1] += share * 2 * k * more * dy;
        H[0] += share * t * 2 * k * (2 * dx * dx / l2 + more);
        H[1] += share * t * 2 * k * (2 * dx * dy / l2);
        H[2] += share * t * 2 * k * (2 * dy * dy / l2 + more);
    }
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

void wide_derivatives(const IncrementalPotential *E, const double *u,
                      Filter filter, Wide *g, Wide *H)
{
    const System *system = E->system;
    int n = 2 * system->nodes;
    Wide w = E->weight * (Wide)central_omega2(system);
    Wide way = E->averaged ? (Wide)0.5 : (Wide)1;
    for (int i = 0; i < n * n && H; i++)
        H[i] = 0;
    for (int i = 0; i < n; i++) {
        Wide m = system->m[i / 2], x = E->x_n[i] + way * u[i];
        g[i] = m * ((Wide)u[i] - E->u_tilde[i]) + w * m * x;
        if (H)
            H[n * i + i] = m + way * w * m;
    }
    for (int s = 0; s < system->springs; s++) {
        int end[2] = {2 * system->e[2 * s], 2 * system->e[2 * s + 1]};
        Wide f[2], block[3];
        wide_spring(E, u, s, f, block);
        if (filter == FILTER_CLAMP || filter == FILTER_ABS)
            cut_negative(block, filter == FILTER_ABS ? 0 : 1);
        for (int c = 0; c < 2; c++) {
            g[end[0] + c] += f[c];
            g[end[1] + c] -= f[c];
        }
        for (int t = 0; t < 16 && H; t++) {
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
