#include "testing.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/cells.h"
#include "model/contact.h"
#include "model/pull_energy.h"

void check_near(const char *what, long double got, long double expected,
                long double tolerance, const char *file, int line)
{
    if (fabsl(got - expected) <= tolerance)
        return;
    print_error("%s: got %.21Lg, expected %.21Lg, differs by %.3Lg, "
                "tolerance %.3Lg\n",
                what, got, expected, got - expected, tolerance);
    _fail(file, line);
}

void check_at_most(const char *what, long double got, long double limit,
                   const char *file, int line)
{
    if (got <= limit)
        return;
    print_error("%s: got %.21Lg, expected at most %.21Lg\n", what, got, limit);
    _fail(file, line);
}

void check_same_bits(const char *what, const double *got,
                     const double *expected, int count, const char *file,
                     int line)
{
    for (int i = 0; i < count; i++) {
        if (memcmp(got + i, expected + i, sizeof *got) == 0)
            continue;
        print_error("%s[%d]: got %a, expected the same bits as %a\n", what, i,
                    got[i], expected[i]);
        _fail(file, line);
    }
}

void check_status(const char *what, Status got, Status expected,
                  const char *file, int line)
{
    if (got == expected)
        return;
    print_error("%s: got %s, expected %s\n", what, status_name(got),
                status_name(expected));
    _fail(file, line);
}

void check_true(bool condition, const char *what, const char *file, int line)
{
    if (condition)
        return;
    print_error("not true: %s\n", what);
    _fail(file, line);
}

bool tests_are_long(void)
{
    const char *set = getenv("LONG");
    return set && *set;
}

/* SplitMix64 (Steele, Lea, Flood 2014). */
static uint64_t random_bits(Random *random)
{
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double random_uniform(Random *random, double low, double high)
{
    return low + (high - low) * (double)(random_bits(random) >> 11) * 0x1p-53;
}

double random_logarithmic(Random *random, double low, double high)
{
    return exp(random_uniform(random, log(low), log(high)));
}

int random_below(Random *random, int limit)
{
    return (int)(random_bits(random) % (uint64_t)limit);
}

/* |d|/l of a spring in this state. */
static double random_ratio(Random *random, SpringState state)
{
    switch (state) {
    case SPRINGS_STRETCHED:
        return random_uniform(random, 1.05, 2);
    case SPRINGS_COMPRESSED:
        return random_uniform(random, 0.3, 0.95);
    case SPRINGS_SHORT:
        return random_uniform(random, 0.1, 0.3);
    case SPRINGS_MIXED:
        return random_uniform(random, 0.1, 2);
    default:
        return random_logarithmic(random, 1e-9, 1e-7);
    }
}

void random_system(Random *random, SpringState state, System *system, double *x)
{
    int n = 3 + random_below(random, MAX_NODES - 2);
    int springs = n + random_below(random, MAX_SPRINGS - n + 1);
    CHECK_STATUS(system_create(n, springs, system), STATUS_OK);
    for (int i = 0; i < n; i++) {
        x[2 * i] = random_uniform(random, -1, 1);
        x[2 * i + 1] = random_uniform(random, -1, 1);
        system->m[i] = random_logarithmic(random, 1e-2, 1e2);
    }
    for (int s = 0; s < springs; s++) {
        int i = s < n ? s : random_below(random, n);
        int j = (i + 1 + random_below(random, n - 1)) % n;
        double length = hypot(x[2 * i] - x[2 * j], x[2 * i + 1] - x[2 * j + 1]);
        double rest = length / random_ratio(random, state);
        system->e[2 * s] = i;
        system->e[2 * s + 1] = j;
        system->l2[s] = rest * rest;
        system->k[s] = random_logarithmic(random, 1e-2, 1e2);
    }
}

static Dual dual_add(Dual a, Dual b)
{
    return (Dual){a.f + b.f, a.d1 + b.d1, a.d2 + b.d2, a.d12 + b.d12};
}

static Dual dual_multiply(Dual a, Dual b)
{
    return (Dual){a.f * b.f, a.f * b.d1 + a.d1 * b.f, a.f * b.d2 + a.d2 * b.f,
                  a.f * b.d12 + a.d1 * b.d2 + a.d2 * b.d1 + a.d12 * b.f};
}

/* factor a^2 */
static Dual dual_square(long double factor, Dual a)
{
    return dual_multiply((Dual){.f = factor}, dual_multiply(a, a));
}

/* Coordinate c, to be differentiated if it is i or j. */
static Dual dual_coordinate(long double value, int c, int i, int j)
{
    return (Dual){value, c == i, c == j, 0};
}

/* k/(2 l2) (|d|^2 - l2)^2 of one spring */
static Dual exact_spring(const System *system, const double *x, int s, int i,
                         int j)
{
    Dual length2 = {.f = -(long double)system->l2[s]};
    for (int axis = 0; axis < 2; axis++) {
        int a = 2 * system->e[2 * s] + axis;
        int b = 2 * system->e[2 * s + 1] + axis;
        Dual d = {(long double)x[a] - x[b], (a == i) - (b == i),
                  (a == j) - (b == j), 0};
        length2 = dual_add(length2, dual_square(1, d));
    }
    return dual_square(system->k[s] / (2 * (long double)system->l2[s]),
                       length2);
}

double central_omega2(const System *system)
{
    const Term *term = system_find_term(system, &central_field);
    return term ? ((const Pull *)term->data)->k : 0;
}

double smallest_gap(const System *system, const double *x)
{
    const Contact *contact = contact_of(system);
    double smallest = INFINITY;
    for (int k = 0; contact && k < contact->obstacles; k++)
        for (int i = 0; i < system->nodes; i++)
            if (contact_has_pair(contact, system, i, k))
                smallest = fmin(smallest, contact_pair_gap(contact, x, i, k).d);
    return smallest;
}

double smallest_cell(const System *system, const double *x)
{
    const Term *term = system_find_term(system, &cell_energy);
    const Cells *cells = term ? term->data : NULL;
    double smallest = INFINITY;
    for (int t = 0; cells && t < cells->triangles; t++) {
        const int *i = cells->node + 3 * t, *s = cells->spring + 3 * t;
        Corner corner = cell_corner(x + 2 * i[0], x + 2 * i[1], x + 2 * i[2],
                                    cells->area, cells->c);
        if (system->k[s[0]] > 0 && system->k[s[1]] > 0 && system->k[s[2]] > 0)
            smallest = fmin(smallest, corner.J);
    }
    return smallest;
}

/* Sum of squares above the diagonal. */
static double off_diagonal(const double a[16])
{
    double sum = 0;
    for (int r = 0; r < 4; r++)
        for (int c = r + 1; c < 4; c++)
            sum += a[4 * r + c] * a[4 * r + c];
    return sum;
}

/* A = J^T A J and Q = Q J with the rotation J in plane (r, c) that makes
 * A_rc = 0: t = tan of the smaller of the two possible angles. */
static void jacobi_rotate(double a[16], double q[16], int r, int c)
{
    double a_rc = a[4 * r + c];
    if (a_rc == 0)
        return;
    double theta = (a[5 * c] - a[5 * r]) / (2 * a_rc);
    double t = copysign(1, theta) / (fabs(theta) + hypot(1, theta));
    double cosine = 1 / hypot(1, t), sine = t * cosine;
    for (int i = 0; i < 4; i++) { /* columns r and c of A and of Q */
        double ar = a[4 * i + r], ac = a[4 * i + c];
        double qr = q[4 * i + r], qc = q[4 * i + c];
        a[4 * i + r] = cosine * ar - sine * ac;
        a[4 * i + c] = sine * ar + cosine * ac;
        q[4 * i + r] = cosine * qr - sine * qc;
        q[4 * i + c] = sine * qr + cosine * qc;
    }
    for (int i = 0; i < 4; i++) { /* rows r and c of A */
        double ar = a[4 * r + i], ac = a[4 * c + i];
        a[4 * r + i] = cosine * ar - sine * ac;
        a[4 * c + i] = sine * ar + cosine * ac;
    }
    a[4 * r + c] = a[4 * c + r] = 0;
}

/* A = Q L Q^T: the eigenvalues end on the diagonal of A, the eigenvectors in
 * the columns of Q.  Convergence is quadratic; 4x4 needs about 5 sweeps. */
static void jacobi_eigen(double a[16], double q[16])
{
    enum { MAX_SWEEPS = 30 };
    for (int i = 0; i < 16; i++)
        q[i] = i % 5 == 0;
    for (int sweep = 0; sweep < MAX_SWEEPS && off_diagonal(a) > 0; sweep++)
        for (int r = 0; r < 4; r++)
            for (int c = r + 1; c < 4; c++)
                jacobi_rotate(a, q, r, c);
}

void make_psd(double a[16])
{
    double l[16], q[16];
    memcpy(l, a, sizeof l);
    jacobi_eigen(l, q);
    /* Eigenvalues that are 0 but for rounding are not negative. */
    double largest = 0;
    bool negative = false;
    for (int i = 0; i < 4; i++)
        largest = fmax(largest, fabs(l[5 * i]));
    for (int i = 0; i < 4; i++)
        negative = negative || l[5 * i] < -1e-15 * largest;
    if (!negative)
        return;
    for (int r = 0; r < 4; r++)
        for (int c = r; c < 4; c++) {
            double sum = 0;
            for (int i = 0; i < 4; i++)
                sum += fmax(l[5 * i], 0) * q[4 * r + i] * q[4 * c + i];
            a[4 * r + c] = a[4 * c + r] = sum;
        }
}

Dual exact_energy(const IncrementalPotential *E, const double *u,
                  const double *x, int i, int j)
{
    const System *system = E->system;
    Dual P = {0}, inertia = {0};
    for (int s = 0; s < system->springs; s++)
        P = dual_add(P, exact_spring(system, x, s, i, j));
    for (int c = 0; c < 2 * system->nodes; c++) {
        long double half_m = 0.5L * system->m[c / 2];
        P = dual_add(P, dual_square(half_m * central_omega2(system),
                                    dual_coordinate(x[c], c, i, j)));
        if (!u)
            continue;
        long double away = (long double)u[c] - E->u_tilde[c];
        inertia = dual_add(inertia,
                           dual_square(half_m, dual_coordinate(away, c, i, j)));
    }
    P = dual_multiply(P, (Dual){.f = E->weight});
    return dual_add(P, inertia);
}

void exact_derivatives(const IncrementalPotential *E, const double *u,
                       const double *x, long double *g, long double *H)
{
    int size = 2 * E->system->nodes;
    for (int i = 0; i < size; i++) {
        g[i] = exact_energy(E, u, x, i, -1).d1;
        for (int j = 0; H && j < size; j++)
            H[size * i + j] = exact_energy(E, u, x, i, j).d12;
    }
}

/* Adds lambda q q^T of the direction q across the spring's four unknowns:
 * [q, -q] [q, -q]^T. */
static void add_mode(const System *system, int s, long double lambda,
                     const long double q[2], long double *H)
{
    int size = 2 * system->nodes;
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            int row = 2 * system->e[2 * s + r / 2] + r % 2;
            int column = 2 * system->e[2 * s + c / 2] + c % 2;
            long double sign = r / 2 == c / 2 ? 1 : -1;
            H[size * row + column] += sign * lambda * q[r % 2] * q[c % 2];
        }
}

void exact_hessian(const IncrementalPotential *E, const double *x, bool clamp,
                   long double *H)
{
    const System *system = E->system;
    int size = 2 * system->nodes;
    for (int i = 0; i < size * size; i++)
        H[i] = 0;
    for (int i = 0; i < size; i++)
        H[size * i + i] = system->m[i / 2] *
                          (1 + (long double)E->weight * central_omega2(system));
    for (int s = 0; s < system->springs; s++) {
        int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
        long double dx = (long double)x[i] - x[j];
        long double dy = (long double)x[i + 1] - x[j + 1];
        long double length = hypotl(dx, dy), l2 = system->l2[s];
        long double factor = 2 * (long double)E->weight * system->k[s] / l2;
        long double along = factor * (3 * length * length - l2);
        long double across = factor * (length * length - l2);
        long double q[2] = {1, 0}, r[2] = {0, 1};
        if (length > 0) {
            q[0] = r[1] = dx / length;
            q[1] = dy / length;
            r[0] = -q[1];
        }
        add_mode(system, s, clamp ? fmaxl(along, 0) : along, q, H);
        add_mode(system, s, clamp ? fmaxl(across, 0) : across, r, H);
    }
}

bool dense_solve(int n, long double *A, long double *b)
{
    for (int c = 0; c < n; c++) {
        int pivot = c;
        for (int r = c + 1; r < n; r++)
            if (fabsl(A[n * r + c]) > fabsl(A[n * pivot + c]))
                pivot = r;
        if (A[n * pivot + c] == 0)
            return false;
        for (int i = 0; i < n; i++) {
            long double swap = A[n * c + i];
            A[n * c + i] = A[n * pivot + i];
            A[n * pivot + i] = swap;
        }
        long double swap = b[c];
        b[c] = b[pivot];
        b[pivot] = swap;
        for (int r = c + 1; r < n; r++) {
            long double factor = A[n * r + c] / A[n * c + c];
            for (int i = c; i < n; i++)
                A[n * r + i] -= factor * A[n * c + i];
            b[r] -= factor * b[c];
        }
    }
    for (int r = n - 1; r >= 0; r--) {
        for (int i = r + 1; i < n; i++)
            b[r] -= A[n * r + i] * b[i];
        b[r] /= A[n * r + r];
    }
    return true;
}

void dense_from_sparse(const Sparse *A, double *dense)
{
    for (int i = 0; i < A->size * A->size; i++)
        dense[i] = 0;
    for (int c = 0; c < A->size; c++)
        for (int s = A->start[c]; s < A->start[c + 1]; s++) {
            dense[A->size * A->row[s] + c] = A->value[s];
            dense[A->size * c + A->row[s]] = A->value[s];
        }
}

void simulation_from_line(const char *line, NewtonObserver observer, void *user,
                          Simulation *simulation)
{
    char copy[512], message[256] = "", *argv[64] = {(char[]){"elasto"}};
    int argc = 1;
    Options options;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word = strtok(copy, " "); word; word = strtok(NULL, " "))
        argv[argc++] = word;
    if (options_parse(argc, argv, &options, message, sizeof message))
        print_error("%s\n", message);
    CHECK(message[0] == '\0');
    CHECK_STATUS(simulation_create(&options, observer, user, simulation),
                 STATUS_OK);
}

double energies_of(const Energies *energies, const char *name)
{
    for (int i = 0; i < energies->rows; i++)
        if (strcmp(energies->row[i].name, name) == 0)
            return energies->row[i].value;
    return 0;
}

double energy_now(const Simulation *simulation, int run, const char *name)
{
    const Energies energies = simulation_energies(simulation, run);
    return energies_of(&energies, name);
}

double strain_of(const Simulation *simulation, int s)
{
    const System *system = &simulation->system;
    const double *x = simulation->run[0].x;
    int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
    return hypot(x[i] - x[j], x[i + 1] - x[j + 1]) / sqrt(system->l2[s]) - 1;
}
