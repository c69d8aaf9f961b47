/* Triplets, compressed columns and the slot map, against dense matrices; and
 * the assembly of the Hessian through them.
 */
#include "model/pull_energy.h"
#include "test.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "base/mathematics.h"
#include "model/mass_spring_energy.h"

enum { SIZE = 9, TRIPLETS = 60 };

/* Random places and values; row and column 4 stay empty.  The dense matrix
 * gets the mirror image of what is off the diagonal. */
static void random_triplets(Random *random, Triplets *triplets, double *value,
                            double *dense)
{
    CHECK_STATUS(triplets_create(SIZE, TRIPLETS, triplets), STATUS_OK);
    for (int i = 0; i < SIZE * SIZE; i++)
        dense[i] = 0;
    while (triplets->count < TRIPLETS) {
        int r = random_below(random, SIZE), c = random_below(random, SIZE);
        if (r == 4 || c == 4)
            continue;
        /* small whole numbers: sums are exact in any order */
        double v = random_below(random, 100) - 50;
        value[triplets->count] = v;
        triplets_add(triplets, r, c);
        dense[SIZE * r + c] += v;
        if (r != c)
            dense[SIZE * c + r] += v;
    }
}

static void check_structure(const Sparse *A)
{
    CHECK(A->start[0] == 0 && A->start[A->size] == A->entries);
    for (int c = 0; c < A->size; c++) {
        CHECK(A->start[c] <= A->start[c + 1]);
        for (int s = A->start[c]; s < A->start[c + 1]; s++) {
            CHECK(A->row[s] >= c);
            CHECK(s == A->start[c] || A->row[s] > A->row[s - 1]);
        }
    }
}

TEST(lower_triangle_is_the_dense_matrix)
{
    Random random = {1};
    for (int trial = 0; trial < 50; trial++) {
        Triplets triplets;
        Sparse A;
        int slot[TRIPLETS];
        double value[TRIPLETS], dense[SIZE * SIZE], got[SIZE * SIZE];
        random_triplets(&random, &triplets, value, dense);
        CHECK_STATUS(sparse_create(&triplets, &A, slot), STATUS_OK);
        CHECK(A.size == SIZE);
        check_structure(&A);
        CHECK(A.start[4] == A.start[5]);
        for (int t = 0; t < TRIPLETS; t++)
            A.value[slot[t]] += value[t];
        dense_from_sparse(&A, got);
        CHECK_SAME_BITS(got, dense, SIZE * SIZE);
        sparse_free(&A);
        triplets_free(&triplets);
    }
}

TEST(multiply_is_dense_multiply)
{
    Random random = {3};
    for (int round = 0; round < 2; round++) {
        Triplets triplets;
        Sparse A;
        int slot[TRIPLETS];
        double value[TRIPLETS], dense[SIZE * SIZE], x[SIZE], y[SIZE];
        random_triplets(&random, &triplets, value, dense);
        sparse_create(&triplets, &A, slot);
        for (int t = 0; t < TRIPLETS; t++)
            A.value[slot[t]] += value[t];
        for (int i = 0; i < SIZE; i++)
            x[i] = random_below(&random, 100) - 50;
        sparse_multiply(&A, x, y);
        for (int r = 0; r < SIZE; r++) {
            double sum = 0; /* whole numbers: exact */
            for (int c = 0; c < SIZE; c++)
                sum += dense[SIZE * r + c] * x[c];
            CHECK_NEAR(y[r], sum, 0);
        }
        sparse_free(&A);
        triplets_free(&triplets);
    }
}

TEST(duplicates_share_a_slot)
{
    Triplets triplets;
    Sparse A;
    int slot[5];
    CHECK_STATUS(triplets_create(3, 5, &triplets), STATUS_OK);
    triplets_add(&triplets, 2, 0);
    triplets_add(&triplets, 0, 2);
    triplets_add(&triplets, 1, 1);
    triplets_add(&triplets, 2, 0);
    triplets_add(&triplets, 0, 0);
    CHECK_STATUS(sparse_create(&triplets, &A, slot), STATUS_OK);
    CHECK(A.entries == 3);
    CHECK(slot[0] == slot[1] && slot[0] == slot[3]);
    CHECK(slot[4] == 0 && slot[0] == 1 && slot[2] == 2);
    sparse_free(&A);
    triplets_free(&triplets);
}

TEST(empty_matrix_is_possible)
{
    Triplets triplets;
    Sparse A;
    int slot[1];
    CHECK_STATUS(triplets_create(4, 1, &triplets), STATUS_OK);
    CHECK_STATUS(sparse_create(&triplets, &A, slot), STATUS_OK);
    CHECK(A.entries == 0 && A.start[4] == 0);
    sparse_free(&A);
    triplets_free(&triplets);
}

TEST(too_large_is_refused)
{
    Triplets triplets;
    CHECK_STATUS(triplets_create(4, INT_MAX, &triplets), STATUS_TOO_LARGE);
    triplets_free(&triplets);
    CHECK_STATUS(triplets_create(4, 1LL << 40, &triplets), STATUS_TOO_LARGE);
    triplets_free(&triplets);
    CHECK_STATUS(triplets_create(4, 0, &triplets), STATUS_TOO_LARGE);
    triplets_free(&triplets);
    CHECK_STATUS(triplets_create(0, 4, &triplets), STATUS_TOO_LARGE);
    triplets_free(&triplets);
    System system = {.nodes = 4, .springs = INT_MAX / SPRING_ENTRIES};
    system_add_term(&system, &mass_spring_energy, NULL);
    Sparse A;
    int *slot;
    CHECK_STATUS(incremental_potential_pattern(&system, &A, &slot),
                 STATUS_TOO_LARGE);
    sparse_free(&A);
    free(slot);
    triplets_free(NULL);
    sparse_free(NULL);
}

/* A Hessian of random springs, assembled through slots. */
typedef struct Assembly {
    System system;
    double x[MAX_SIZE];
    int *slot;
    Sparse A;
    Iterate at;
} Assembly;

static void assembly_create(Random *random, bool ordered, int pinned,
                            Assembly *assembly)
{
    System *system = &assembly->system;
    random_system(random, SPRINGS_MIXED, system, assembly->x);
    central_field_set(system, 2);
    size_t n = (size_t)system->nodes;
    if (ordered) { /* 1, 2, ..., 0 */
        system->order = calloc(n, sizeof *system->order);
        for (int i = 0; i < system->nodes; i++)
            system->order[i] = (i + 1) % system->nodes;
    }
    if (pinned >= 0) {
        system->pinned = calloc(n, 1);
        system->pinned[pinned] = 1;
    }
    assembly->at = (Iterate){.E = {.system = system, .weight = 0.5},
                             .u = assembly->x,
                             .x = assembly->x};
    CHECK_STATUS(
        incremental_potential_pattern(system, &assembly->A, &assembly->slot),
        STATUS_OK);
}

static void assembly_free(Assembly *assembly)
{
    free(assembly->slot);
    sparse_free(&assembly->A);
    system_free(&assembly->system);
}

/* Entry (row, column) of the dense Hessian, found through the order. */
static double assembled(const Assembly *assembly, const double *dense, int row,
                        int column)
{
    const int *order = assembly->system.order;
    int size = assembly->A.size;
    if (order) {
        row = 2 * order[row / 2] + row % 2;
        column = 2 * order[column / 2] + column % 2;
    }
    return dense[size * row + column];
}

/* 1e-14 of the largest entry: sums of at most forty terms. */
static void check_assembly(bool ordered, Filter filter)
{
    Random random = {5 + (uint64_t)filter};
    for (int trial = 0; trial < 20; trial++) {
        Assembly a;
        double dense[MAX_SIZE * MAX_SIZE];
        long double exact[MAX_SIZE * MAX_SIZE], largest = 0;
        assembly_create(&random, ordered, -1, &a);
        int size = a.A.size, short_springs = 0;
        for (int s = 0; s < a.system.springs; s++) {
            const double *xi = a.x + 2 * a.system.e[2 * s];
            const double *xj = a.x + 2 * a.system.e[2 * s + 1];
            short_springs +=
                pow(xi[0] - xj[0], 2) + pow(xi[1] - xj[1], 2) < a.system.l2[s];
        }
        int projected =
            incremental_potential_hessian(&a.at, filter, a.slot, &a.A);
        CHECK(projected == (filter == FILTER_CLAMP ? short_springs : 0));
        dense_from_sparse(&a.A, dense);
        exact_hessian(&a.at.E, a.x, filter == FILTER_CLAMP, exact);
        for (int i = 0; i < size * size; i++)
            largest = fmaxl(largest, fabsl(exact[i]));
        for (int i = 0; i < size * size; i++)
            CHECK_NEAR(assembled(&a, dense, i / size, i % size), exact[i],
                       1e-14L * largest);
        assembly_free(&a);
    }
}

TEST(assembly_is_the_formula)
{
    check_assembly(false, FILTER_NONE);
    check_assembly(false, FILTER_CLAMP);
    check_assembly(true, FILTER_NONE);
    check_assembly(true, FILTER_CLAMP);
}

/* slot NULL: entry t of the triplets; summed by hand at its row and column. */
TEST(plain_triplets_sum_to_the_same)
{
    Random random = {8};
    for (int trial = 0; trial < 10; trial++) {
        Assembly a;
        double by_hand[MAX_SIZE * MAX_SIZE] = {0};
        double dense[MAX_SIZE * MAX_SIZE];
        double value[SPRING_ENTRIES * MAX_SPRINGS] = {0};
        assembly_create(&random, trial % 2, -1, &a);
        int size = a.A.size;
        const System *system = &a.system;
        Triplets triplets;
        CHECK_STATUS(
            triplets_create(size, SPRING_ENTRIES * system->springs, &triplets),
            STATUS_OK);
        Place at = place_at(system, a.x, NULL, a.x);
        mass_spring_pattern(&at, &triplets);
        int plain[SPRING_ENTRIES * MAX_SPRINGS];
        for (int t = 0; t < SPRING_ENTRIES * system->springs; t++)
            plain[t] = t;
        mass_spring_energy.hessian(&at, FILTER_CLAMP, plain, NULL, value);
        for (int t = 0; t < SPRING_ENTRIES * system->springs; t++) {
            int r = triplets.row[t], c = triplets.column[t];
            by_hand[size * r + c] += value[t];
            if (r != c)
                by_hand[size * c + r] += value[t];
        }
        mass_spring_energy.hessian(&at, FILTER_CLAMP, a.slot + size, NULL,
                                   a.A.value);
        triplets_free(&triplets);
        dense_from_sparse(&a.A, dense);
        for (int i = 0; i < size * size; i++) /* another order of the sum */
            CHECK_NEAR(dense[i], by_hand[i], 1e-13 * (1 + fabs(by_hand[i])));
        assembly_free(&a);
    }
}

/* A pinned node keeps its mass and loses every term; the others lose only what
 * couples them to it. */
TEST(pinned_nodes_are_dropped)
{
    Random random = {9};
    for (int trial = 0; trial < 10; trial++) {
        Assembly a;
        double dense[MAX_SIZE * MAX_SIZE];
        long double exact[MAX_SIZE * MAX_SIZE];
        int pinned = random_below(&random, 3);
        assembly_create(&random, trial % 2, pinned, &a);
        int size = a.A.size;
        incremental_potential_hessian(&a.at, FILTER_NONE, a.slot, &a.A);
        dense_from_sparse(&a.A, dense);
        exact_hessian(&a.at.E, a.x, false, exact);
        for (int i = 0; i < size * size; i++) {
            int r = i / size, c = i % size;
            if (r / 2 == pinned || c / 2 == pinned)
                exact[i] = r == c ? a.system.m[pinned] : 0;
            CHECK_NEAR(assembled(&a, dense, r, c), exact[i],
                       1e-12L * (1 + fabsl(exact[i])));
        }
        assembly_free(&a);
    }
}

/* ---- base/mathematics.h -------------------------------------------------- */

/* Units in the last place between a double and the same in extended precision.
 */
static double ulps(double got, long double exact)
{
    double nearest = (double)exact;
    if (!isfinite(nearest))
        return got == nearest || (isnan(got) && isnan(nearest)) ? 0 : INFINITY;
    double unit = nextafter(fabs(nearest), INFINITY) - fabs(nearest);
    return (double)(fabsl(got - exact) / unit);
}

/* 1.5 units: what mathematics.h promises. */
TEST(logarithms_are_right_to_the_last_place)
{
    static const double edges[] = {
        0,       1,       -1,       0.70710678118654752, INFINITY,       NAN,
        DBL_MIN, DBL_MAX, 4.9e-324, 1 - DBL_EPSILON,     1 + DBL_EPSILON};
    Random random = {81};
    double worst = 0;
    for (int i = 0; i < 300000; i++) {
        double x = i % 3 == 0   ? random_logarithmic(&random, 1e-300, 1e300)
                   : i % 3 == 1 ? random_uniform(&random, 0.5, 2)
                                : 1 + random_uniform(&random, -1e-6, 1e-6);
        double z = i % 2 ? random_uniform(&random, -0.999, 3)
                         : random_logarithmic(&random, 1e-20, 1e20);
        z = i % 4 == 2 && z < 0.5 ? -z : z;
        worst = fmax(worst, ulps(math_log(x), logl(x)));
        worst = fmax(worst, ulps(math_log1p(z), log1pl(z)));
    }
    for (size_t i = 0; i < sizeof edges / sizeof *edges; i++) {
        worst = fmax(worst, ulps(math_log(edges[i]), logl(edges[i])));
        worst = fmax(worst, ulps(math_log1p(edges[i]), log1pl(edges[i])));
    }
    CHECK_AT_MOST(worst, 1.5);
}

TEST(lengths_are_right_to_the_last_place)
{
    static const double edges[] = {0,       1,       -3,       INFINITY, NAN,
                                   DBL_MIN, DBL_MAX, 4.9e-324, 1e-200,   1e200};
    const int count = sizeof edges / sizeof *edges;
    Random random = {82};
    double worst = 0;
    for (int i = 0; i < 100000; i++) {
        double x = random_logarithmic(&random, 1e-300, 1e300);
        double y = i % 2 ? x * random_uniform(&random, -2, 2)
                         : -random_logarithmic(&random, 1e-300, 1e300);
        worst = fmax(worst, ulps(math_hypot(x, y), hypotl(x, y)));
    }
    for (int i = 0; i < count * count; i++) {
        double x = edges[i / count], y = edges[i % count];
        worst = fmax(worst, ulps(math_hypot(x, y), hypotl(x, y)));
    }
    CHECK_AT_MOST(worst, 1.5);
}

TESTS(NULL, NULL)
