/* Factorisations of each kind against elimination in extended precision, and
 * what they say of matrices that have no factor.
 */
#include "test.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solve/cholesky.h"

enum { GRID = 5, SIZE = GRID * GRID, ENTRIES = 3 * SIZE };

/* The matrix of a grid: diagonal, left and lower neighbour. */
typedef struct Problem {
    Triplets triplets;
    Sparse A;
    int slot[ENTRIES];
    Cholesky *cholesky;
} Problem;

static void problem_create(CholeskyKind kind, bool ordered, Problem *problem)
{
    CHECK_STATUS(triplets_create(SIZE, ENTRIES, &problem->triplets), STATUS_OK);
    for (int i = 0; i < SIZE; i++) {
        triplets_add(&problem->triplets, i, i);
        if (i % GRID > 0)
            triplets_add(&problem->triplets, i, i - 1);
        if (i >= GRID)
            triplets_add(&problem->triplets, i, i - GRID);
    }
    CHECK_STATUS(sparse_create(&problem->triplets, &problem->A, problem->slot),
                 STATUS_OK);
    CHECK_STATUS(
        cholesky_create(&problem->A, kind, ordered, &problem->cholesky),
        STATUS_OK);
}

static void problem_free(Problem *problem)
{
    cholesky_free(problem->cholesky);
    sparse_free(&problem->A);
    triplets_free(&problem->triplets);
}

/* Random couplings; the diagonal is above the sum of a row by `margin`. */
static void problem_fill(Random *random, double margin, Problem *problem)
{
    const Triplets *triplets = &problem->triplets;
    double sum[SIZE] = {0};
    memset(problem->A.value, 0,
           ((size_t)problem->A.entries + 1) * sizeof(double));
    for (int t = 0; t < triplets->count; t++) {
        int r = triplets->row[t], c = triplets->column[t];
        if (r == c)
            continue;
        double v = random_uniform(random, -1, 1);
        problem->A.value[problem->slot[t]] = v;
        sum[r] += fabs(v);
        sum[c] += fabs(v);
    }
    for (int t = 0; t < triplets->count; t++)
        if (triplets->row[t] == triplets->column[t])
            problem->A.value[problem->slot[t]] = sum[triplets->row[t]] + margin;
}

/* Diagonal entry i. */
static double *diagonal(Problem *problem, int i)
{
    const Triplets *triplets = &problem->triplets;
    for (int t = 0; t < triplets->count; t++)
        if (triplets->row[t] == i && triplets->column[t] == i)
            return problem->A.value + problem->slot[t];
    return NULL;
}

/* |x - x_exact| over |x_exact|; the condition number is below 100, so 1e-13
 * leaves room for rounding and for nothing else. */
static void check_solution(Random *random, Problem *problem, bool in_place)
{
    double b[SIZE], x[SIZE], dense[SIZE * SIZE];
    long double A[SIZE * SIZE], exact[SIZE];
    for (int i = 0; i < SIZE; i++)
        exact[i] = b[i] = random_uniform(random, -1, 1);
    memcpy(x, b, sizeof b);
    dense_from_sparse(&problem->A, dense);
    for (int i = 0; i < SIZE * SIZE; i++)
        A[i] = dense[i];
    CHECK(dense_solve(SIZE, A, exact));
    CHECK_STATUS(cholesky_solve(problem->cholesky, in_place ? x : b, x),
                 STATUS_OK);
    for (int i = 0; i < SIZE; i++)
        CHECK_NEAR(x[i], exact[i], 1e-13);
}

/* The same handle for many fillings. */
static void check_kind(CholeskyKind kind, bool ordered)
{
    Random random = {30 + (uint64_t)kind};
    Problem problem;
    problem_create(kind, ordered, &problem);
    for (int trial = 0; trial < 30; trial++) {
        problem_fill(&random, 0.5, &problem);
        CHECK_STATUS(cholesky_factor(problem.cholesky), STATUS_OK);
        check_solution(&random, &problem, false);
        check_solution(&random, &problem, true);
    }
    CHECK(cholesky_factor_entries(problem.cholesky) >= problem.A.entries);
    problem_free(&problem);
}

TEST(definite_solves)
{
    check_kind(CHOLESKY_DEFINITE, false);
    check_kind(CHOLESKY_DEFINITE, true);
}

/* One diagonal entry in two made negative: the last one, and the first. */
TEST(indefinite_solves)
{
    check_kind(CHOLESKY_INDEFINITE, false);
    check_kind(CHOLESKY_INDEFINITE, true);
    Random random = {33};
    Problem problem;
    problem_create(CHOLESKY_INDEFINITE, true, &problem);
    for (int trial = 0; trial < 30; trial++) {
        problem_fill(&random, 0.5, &problem);
        for (int i = trial % 2; i < SIZE; i += 2)
            *diagonal(&problem, i) *= -1;
        CHECK_STATUS(cholesky_factor(problem.cholesky), STATUS_OK);
        check_solution(&random, &problem, false);
    }
    problem_free(&problem);
}

/* Every diagonal entry in turn made negative: one negative eigenvalue. */
TEST(indefinite_matrices_are_reported)
{
    Random random = {40};
    Problem problem;
    problem_create(CHOLESKY_DEFINITE, false, &problem);
    for (int i = 0; i < SIZE; i++) {
        problem_fill(&random, 0.5, &problem);
        *diagonal(&problem, i) *= -1;
        CHECK_STATUS(cholesky_factor(problem.cholesky),
                     STATUS_NOT_POSITIVE_DEFINITE);
        *diagonal(&problem, i) *= -1; /* it works again after a failure */
        CHECK_STATUS(cholesky_factor(problem.cholesky), STATUS_OK);
        check_solution(&random, &problem, false);
    }
    problem_free(&problem);
}

/* Zeros in row and column 7; the right-hand side is not 0 there. */
static void make_singular(Problem *problem)
{
    for (int t = 0; t < problem->triplets.count; t++)
        if (problem->triplets.row[t] == 7 || problem->triplets.column[t] == 7)
            problem->A.value[problem->slot[t]] = 0;
}

TEST(singular_matrices_are_reported)
{
    Random random = {50};
    Problem problem;
    problem_create(CHOLESKY_DEFINITE, true, &problem);
    problem_fill(&random, 1, &problem);
    make_singular(&problem);
    CHECK_STATUS(cholesky_factor(problem.cholesky),
                 STATUS_NOT_POSITIVE_DEFINITE);
    memset(problem.A.value, 0,
           ((size_t)problem.A.entries + 1) * sizeof(double));
    CHECK_STATUS(cholesky_factor(problem.cholesky),
                 STATUS_NOT_POSITIVE_DEFINITE);
    problem_fill(&random, 1, &problem);
    CHECK_STATUS(cholesky_factor(problem.cholesky), STATUS_OK);
    check_solution(&random, &problem, true);
    problem_free(&problem);
}

/* L D L^T steps over the zero pivot, and the solution tells. */
TEST(singular_systems_are_reported)
{
    Random random = {51};
    double b[SIZE], x[SIZE];
    Problem problem;
    problem_create(CHOLESKY_INDEFINITE, true, &problem);
    for (int i = 0; i < SIZE; i++)
        b[i] = 1;
    problem_fill(&random, 1, &problem);
    make_singular(&problem);
    CHECK_STATUS(cholesky_factor(problem.cholesky), STATUS_OK);
    CHECK_STATUS(cholesky_solve(problem.cholesky, b, x), STATUS_SINGULAR);
    problem_fill(&random, 1, &problem);
    CHECK_STATUS(cholesky_factor(problem.cholesky), STATUS_OK);
    check_solution(&random, &problem, true);
    problem_free(&problem);
}

/* Pivots that are 0 but for rounding, in a matrix that is not singular at
 * all: [[1e-17, 1], [1, 1]] in the corner.  Refinement must give the digits
 * back; 1e-11: it stops at a residual of 1e-15. */
TEST(small_pivots_are_refined)
{
    Random random = {52};
    double b[SIZE], x[SIZE], dense[SIZE * SIZE];
    long double A[SIZE * SIZE], exact[SIZE];
    Problem problem;
    problem_create(CHOLESKY_INDEFINITE, true, &problem);
    for (int trial = 0; trial < 20; trial++) {
        problem_fill(&random, 1, &problem);
        *diagonal(&problem, 0) = 1e-17;
        problem.A.value[problem.slot[2]] = 1; /* (1, 0) */
        CHECK_STATUS(cholesky_factor(problem.cholesky), STATUS_OK);
        for (int i = 0; i < SIZE; i++)
            exact[i] = b[i] = random_uniform(&random, -1, 1);
        dense_from_sparse(&problem.A, dense);
        for (int i = 0; i < SIZE * SIZE; i++)
            A[i] = dense[i];
        CHECK(dense_solve(SIZE, A, exact));
        CHECK_STATUS(cholesky_solve(problem.cholesky, b, x), STATUS_OK);
        for (int i = 0; i < SIZE; i++)
            CHECK_NEAR(x[i], exact[i], 1e-11);
    }
    problem_free(&problem);
}

/* In every place that there is, one at a time. */
TEST(numbers_that_are_not_finite_are_reported)
{
    const double bad[] = {NAN, INFINITY, -INFINITY};
    Random random = {60};
    for (int kind = 0; kind <= CHOLESKY_INDEFINITE; kind++) {
        Problem problem;
        problem_create((CholeskyKind)kind, true, &problem);
        for (int s = 0; s < problem.A.entries; s++) {
            problem_fill(&random, 1, &problem);
            problem.A.value[s] = bad[s % 3];
            CHECK_STATUS(cholesky_factor(problem.cholesky), STATUS_NOT_FINITE);
        }
        problem_fill(&random, 1, &problem);
        CHECK_STATUS(cholesky_factor(problem.cholesky), STATUS_OK);
        check_solution(&random, &problem, false);
        problem_free(&problem);
    }
}

/* b / 1e-300 is infinite for b = 1e300. */
TEST(overflowing_solutions_are_reported)
{
    for (int kind = 0; kind <= CHOLESKY_INDEFINITE; kind++) {
        Problem problem;
        double b[SIZE] = {0}, x[SIZE];
        problem_create((CholeskyKind)kind, false, &problem);
        memset(problem.A.value, 0,
           ((size_t)problem.A.entries + 1) * sizeof(double));
        for (int i = 0; i < SIZE; i++)
            *diagonal(&problem, i) = 1e-300;
        CHECK_STATUS(cholesky_factor(problem.cholesky), STATUS_OK);
        b[11] = 1e300;
        CHECK_STATUS(cholesky_solve(problem.cholesky, b, x), STATUS_NOT_FINITE);
        b[11] = NAN;
        CHECK_STATUS(cholesky_solve(problem.cholesky, b, x), STATUS_NOT_FINITE);
        problem_free(&problem);
    }
}

/* What is dropped lies behind the last entry and is never read. */
TEST(dropped_values_are_not_read)
{
    Random random = {70};
    Problem problem;
    problem_create(CHOLESKY_DEFINITE, true, &problem);
    problem_fill(&random, 1, &problem);
    problem.A.value[problem.A.entries] = NAN;
    CHECK_STATUS(cholesky_factor(problem.cholesky), STATUS_OK);
    check_solution(&random, &problem, false);
    problem_free(&problem);
    cholesky_free(NULL);
}

/* ---- CHOLMOD's calls of BLAS: every entry is one sum, in one order ------- */

void dgemm_(const char *, const char *, const int *, const int *, const int *,
            const double *, const double *, const int *, const double *,
            const int *, const double *, double *, const int *);
void dsyrk_(const char *, const char *, const int *, const int *,
            const double *, const double *, const int *, const double *,
            double *, const int *);
void dtrsm_(const char *, const char *, const char *, const char *, const int *,
            const int *, const double *, const double *, const int *, double *,
            const int *);
void dpotrf_(const char *, const int *, double *, const int *, int *);

enum { MOST = 21, LD = MOST + 2 };

static void fill(Random *random, double *A)
{
    for (int i = 0; i < LD * MOST; i++)
        A[i] = random_uniform(random, -1, 1);
}

/* sum_p A[i, p] B[j, p], p = 0 ... k - 1 */
static double product(const double *A, const double *B, int i, int j, int k)
{
    double sum = 0;
    for (int p = 0; p < k; p++)
        sum += A[p * LD + i] * B[p * LD + j];
    return sum;
}

/* Equal to the bit, whatever the width of the lanes; nothing else is written,
 * but by dsyrk right of the triangle. */
TEST(products_have_one_order_of_sums)
{
    Random random = {71};
    const int ld = LD;
    const double one = 1, zero = 0;
    double A[LD * MOST], B[LD * MOST], C[LD * MOST], S[LD * MOST];
    for (int m = 1; m <= MOST; m++)
        for (int n = 1; n <= 9; n++) {
            int k = (m * n) % MOST;
            fill(&random, A);
            fill(&random, B);
            for (int i = 0; i < LD * MOST; i++)
                C[i] = S[i] = 7;
            dgemm_("N", "C", &m, &n, &k, &one, A, &ld, B, &ld, &zero, C, &ld);
            dsyrk_("L", "N", &m, &k, &one, A, &ld, &zero, S, &ld);
            for (int j = 0; j < MOST; j++)
                for (int i = 0; i < LD; i++) {
                    double made = C[j * LD + i];
                    CHECK(made ==
                          (i < m && j < n ? product(A, B, i, j, k) : 7));
                    if (i >= j && i < m && j < m)
                        CHECK(S[j * LD + i] == product(A, A, i, j, k));
                    else if (i >= m || j >= m)
                        CHECK(S[j * LD + i] == 7);
                }
        }
}

/* L L^T = A, and (B L^-T) L^T = B, to some epsilon of the sums' sizes: pivots
 * are 2 at least, the other entries at most 1. */
TEST(factors_and_divisions_are_exact_to_rounding)
{
    Random random = {72};
    const int ld = LD;
    const double one = 1;
    double A[LD * MOST], L[LD * MOST], B[LD * MOST], X[LD * MOST];
    for (int n = 1; n <= MOST; n++) {
        int info = -1, m = 1 + (5 * n) % MOST;
        fill(&random, A);
        for (int i = 0; i < n; i++)
            A[i * LD + i] = 4 + n;
        memcpy(L, A, sizeof A);
        dpotrf_("L", &n, L, &ld, &info);
        CHECK(info == 0);
        fill(&random, B);
        memcpy(X, B, sizeof B);
        dtrsm_("R", "L", "C", "N", &m, &n, &one, L, &ld, X, &ld);
        for (int j = 0; j < n; j++) {
            for (int i = j; i < n; i++)
                CHECK_AT_MOST(fabs(product(L, L, i, j, j + 1) - A[j * LD + i]),
                              8 * DBL_EPSILON * (4 + n));
            for (int i = 0; i < m; i++)
                CHECK_AT_MOST(fabs(product(X, L, i, j, j + 1) - B[j * LD + i]),
                              8 * DBL_EPSILON * (4 + n));
        }
        int last = n - 1;
        A[last * LD + last] = -1;
        dpotrf_("L", &n, A, &ld, &info);
        CHECK(info == n);
    }
}

TESTS(NULL, NULL)
