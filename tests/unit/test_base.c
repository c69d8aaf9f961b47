/* test_base.c - factorisations of sparse matrices, statuses for singular ones,
 * the BLAS calls, and functions that are right to the last digit */
#include "test.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/mathematics.h"

/* ---- factorisations ---------------------------------------------------- */

enum { SIDE = 7, UNKNOWNS = SIDE * SIDE, ENTRIES = 3 * UNKNOWNS };

/* A sparse matrix of a grid: diagonal, left and lower neighbours */
typedef struct GridMatrix {
    Triplets triplets;
    Sparse A;
    Cholesky *cholesky;
} GridMatrix;

static void grid_matrix_create(CholeskyKind kind, GridMatrix *matrix)
{
    matrix->triplets = (Triplets){.matrix_size = UNKNOWNS, .count = ENTRIES};
    CHECK_OK(triplets_allocate(&matrix->triplets));
    for (int i = 0; i < UNKNOWNS; i++) {
        triplets_add(&matrix->triplets, i, i);
        if (i % SIDE > 0)
            triplets_add(&matrix->triplets, i, i - 1);
        if (i >= SIDE)
            triplets_add(&matrix->triplets, i, i - SIDE);
    }
    CHECK_OK(sparse_create(&matrix->triplets, &matrix->A));
    CHECK_OK(cholesky_create(&matrix->A, kind, &matrix->cholesky));
}

static void grid_matrix_free(GridMatrix *matrix)
{
    cholesky_free(matrix->cholesky);
    sparse_free(&matrix->A);
    triplets_free(&matrix->triplets);
}

static double *find_entry_value(GridMatrix *matrix, int row, int column)
{
    for (int s = matrix->A.column_start[column];; s++)
        if (matrix->A.row[s] == row)
            return matrix->A.value + s;
}

/* Fills the matrix at random; the diagonal exceeds the sum of a row by 1/2. */
static void fill_grid_matrix(Random *random, GridMatrix *matrix)
{
    Sparse *A = &matrix->A;
    double sum[UNKNOWNS] = {0};
    for (int c = 0; c < UNKNOWNS; c++)
        for (int s = A->column_start[c]; s < A->column_start[c + 1]; s++) {
            A->value[s] = random_uniform(random, -1, 1);
            sum[c] += fabs(A->value[s]);
            sum[A->row[s]] += fabs(A->value[s]);
        }
    for (int i = 0; i < UNKNOWNS; i++)
        *find_entry_value(matrix, i, i) = sum[i] + 0.5;
}

/* Checks that x solves A x = b, in an array of its own and in place of b. */
static void check_solution(Random *random, GridMatrix *matrix, double tolerance)
{
    double b[UNKNOWNS], x[2][UNKNOWNS], A[UNKNOWNS * UNKNOWNS];
    for (int i = 0; i < UNKNOWNS; i++)
        b[i] = x[1][i] = random_uniform(random, -1, 1);
    fill_dense_matrix(&matrix->A, A);
    for (int k = 0; k < 2; k++) {
        CHECK_OK(cholesky_solve(matrix->cholesky, k ? x[k] : b, x[k]));
        for (int i = 0; i < UNKNOWNS; i++) {
            Real sum = 0;
            for (int j = 0; j < UNKNOWNS; j++)
                sum += (Real)A[UNKNOWNS * i + j] * x[k][j];
            CHECK_NEAR(sum, b[i], tolerance);
        }
    }
}

typedef enum MatrixDamage {
    NO_DAMAGE,
    NEGATE_ONE,  /* one entry of the diagonal changes its sign */
    NEGATE_HALF, /* half of the diagonal changes its sign */
    EMPTY_ROW,   /* row and column 7; b is not 0 there */
    EMPTY_MATRIX,
    SMALL_PIVOT, /* [[1e-17, 1], [1, 1]] in the corner of a regular matrix */
    NOT_FINITE,
    ALL_TINY /* diagonal 1e-310, whose inverse is infinite */
} MatrixDamage;

static void damage_matrix(GridMatrix *matrix, MatrixDamage how, int trial)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    Sparse *A = &matrix->A;
    for (int c = 0; c < UNKNOWNS; c++)
        for (int s = A->column_start[c]; s < A->column_start[c + 1]; s++) {
            double *value = A->value + s;
            int r = A->row[s];
            if (r == c && ((how == NEGATE_ONE && c == trial) ||
                           (how == NEGATE_HALF && c % 2 == trial % 2)))
                *value = -*value;
            if (how == EMPTY_MATRIX || (how == EMPTY_ROW && (r == 7 || c == 7)))
                *value = 0;
            if (how == SMALL_PIVOT && c == 0 && r < 2)
                *value = r == 0 ? 1e-17 : 1;
            if (how == NOT_FINITE && s == trial % A->entries)
                *value = bad[trial % 3];
            if (how == ALL_TINY)
                *value = r == c ? 1e-310 : 0;
        }
}

/* Each kind of factorisation solves a matrix or returns the status of its
 * defect; then it solves the next one. Entries of A x are near 10, so 1e-14 is
 * rounding; refinement ends at 1e-15. L D L^T skips a zero pivot, which the
 * solution reports. The entry after a matrix must not be read. */
TEST(matrices_are_solved_or_refused)
{
    static const struct {
        MatrixDamage damage;
        CholeskyKind kind;
        Status factor_status, solve_status;
        double tolerance;
    } rows[] = {
        {NO_DAMAGE, CHOLESKY_DEFINITE, STATUS_OK, STATUS_OK, 1e-14},
        {NO_DAMAGE, CHOLESKY_INDEFINITE, STATUS_OK, STATUS_OK, 1e-14},
        {NEGATE_HALF, CHOLESKY_INDEFINITE, STATUS_OK, STATUS_OK, 1e-14},
        {SMALL_PIVOT, CHOLESKY_INDEFINITE, STATUS_OK, STATUS_OK, 1e-14},
        {NEGATE_ONE, CHOLESKY_DEFINITE, STATUS_NOT_POSITIVE_DEFINITE, 0, 0},
        {EMPTY_ROW, CHOLESKY_DEFINITE, STATUS_NOT_POSITIVE_DEFINITE, 0, 0},
        {EMPTY_MATRIX, CHOLESKY_DEFINITE, STATUS_NOT_POSITIVE_DEFINITE, 0, 0},
        {EMPTY_ROW, CHOLESKY_INDEFINITE, STATUS_OK, STATUS_SINGULAR, 0},
        {NOT_FINITE, CHOLESKY_DEFINITE, STATUS_NOT_FINITE, 0, 0},
        {NOT_FINITE, CHOLESKY_INDEFINITE, STATUS_NOT_FINITE, 0, 0},
        {ALL_TINY, CHOLESKY_DEFINITE, STATUS_OK, STATUS_NOT_FINITE, 0},
        {ALL_TINY, CHOLESKY_INDEFINITE, STATUS_OK, STATUS_NOT_FINITE, 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Random random = {30 + (uint64_t)i};
        GridMatrix matrix;
        grid_matrix_create(rows[i].kind, &matrix);
        matrix.A.value[matrix.A.entries] = NAN;
        for (int trial = 0; trial < UNKNOWNS; trial++) {
            double x[UNKNOWNS];
            for (int k = 0; k < UNKNOWNS; k++)
                x[k] = 1;
            fill_grid_matrix(&random, &matrix);
            damage_matrix(&matrix, rows[i].damage, trial);
            CHECK_STATUS(cholesky_factor(matrix.cholesky),
                         rows[i].factor_status);
            if (rows[i].factor_status == STATUS_OK)
                CHECK_STATUS(cholesky_solve(matrix.cholesky, x, x),
                             rows[i].solve_status);
            if (rows[i].tolerance > 0)
                check_solution(&random, &matrix, rows[i].tolerance);
            fill_grid_matrix(&random, &matrix);
            CHECK_OK(cholesky_factor(matrix.cholesky));
            check_solution(&random, &matrix, 1e-14);
        }
        grid_matrix_free(&matrix);
    }
}

/* ---- CHOLMOD's calls of BLAS: every entry is one sum, in one order ----- */

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

enum { MAX_ORDER = 21, LD = MAX_ORDER + 2 }; /* LD: leading dimension */
static const int ld = LD;
static const double one = 1, zero = 0;

static void fill_random_matrix(Random *random, double *A)
{
    for (int i = 0; i < LD * MAX_ORDER; i++)
        A[i] = random_uniform(random, -1, 1);
}

/* Returns sum_p A[i, p] B[j, p], p = 0 ... k - 1. */
static double dot_rows(const double *A, const double *B, int i, int j, int k)
{
    double sum = 0;
    for (int p = 0; p < k; p++)
        sum += A[p * LD + i] * B[p * LD + j];
    return sum;
}

/* Products have the same bits whatever the width of the registers. Entries
 * outside of the result stay; dsyrk may also fill its upper triangle. */
TEST(products_have_one_order_of_sums)
{
    Random random = {71};
    double A[LD * MAX_ORDER], B[LD * MAX_ORDER], C[LD * MAX_ORDER],
        S[LD * MAX_ORDER];
    for (int m = 1; m <= MAX_ORDER; m++)
        for (int n = 1; n <= 9; n++) {
            int k = (m * n) % MAX_ORDER;
            fill_random_matrix(&random, A);
            fill_random_matrix(&random, B);
            for (int i = 0; i < LD * MAX_ORDER; i++)
                C[i] = S[i] = 7;
            dgemm_("N", "C", &m, &n, &k, &one, A, &ld, B, &ld, &zero, C, &ld);
            dsyrk_("L", "N", &m, &k, &one, A, &ld, &zero, S, &ld);
            for (int j = 0; j < MAX_ORDER; j++)
                for (int i = 0; i < LD; i++) {
                    double *c = C + j * LD + i, *s = S + j * LD + i;
                    CHECK(*c == (i < m && j < n ? dot_rows(A, B, i, j, k) : 7));
                    if (i >= m || j >= m)
                        CHECK(*s == 7);
                    else if (i >= j)
                        CHECK(*s == dot_rows(A, A, i, j, k));
                }
        }
}

/* L L^T = A, and X L^T = B for X = B L^-T, with the rounding errors of sums:
 * pivots are at least 2, other entries at most 1. */
TEST(factors_and_divisions_are_exact_to_rounding)
{
    Random random = {72};
    double A[LD * MAX_ORDER], L[LD * MAX_ORDER], B[LD * MAX_ORDER],
        X[LD * MAX_ORDER];
    for (int n = 1; n <= MAX_ORDER; n++) {
        int info = -1, m = 1 + (5 * n) % MAX_ORDER;
        fill_random_matrix(&random, A);
        for (int i = 0; i < n; i++)
            A[i * LD + i] = 4 + n;
        memcpy(L, A, sizeof A);
        dpotrf_("L", &n, L, &ld, &info);
        CHECK(info == 0);
        fill_random_matrix(&random, B);
        memcpy(X, B, sizeof B);
        dtrsm_("R", "L", "C", "N", &m, &n, &one, L, &ld, X, &ld);
        for (int j = 0; j < n; j++) {
            for (int i = j; i < n; i++)
                CHECK_NEAR(dot_rows(L, L, i, j, j + 1), A[j * LD + i],
                           8 * DBL_EPSILON * (4 + n));
            for (int i = 0; i < m; i++)
                CHECK_NEAR(dot_rows(X, L, i, j, j + 1), B[j * LD + i],
                           8 * DBL_EPSILON * (4 + n));
        }
        A[(n - 1) * LD + n - 1] = -1;
        dpotrf_("L", &n, A, &ld, &info);
        CHECK(info == n);
    }
}

/* Returns the error of a double in units of its last place. */
static double find_ulp_error(double got, long double exact)
{
    double nearest = (double)exact;
    if (!isfinite(nearest))
        return got == nearest || (isnan(got) && isnan(nearest)) ? 0 : INFINITY;
    double unit = nextafter(fabs(nearest), INFINITY) - fabs(nearest);
    return (double)(fabsl(got - exact) / unit);
}

/* Checks the error bound of mathematics.h, 1.5 units in the last place. */
static void check_math_accuracy(double x, double z)
{
    CHECK_AT_MOST(find_ulp_error(math_log(x), logl(x)), 1.5);
    CHECK_AT_MOST(find_ulp_error(math_log1p(z), log1pl(z)), 1.5);
    CHECK_AT_MOST(find_ulp_error(math_hypot(x, z), hypotl(x, z)), 1.5);
}

TEST(functions_are_right_to_the_last_place)
{
    static const double edges[] = {
        0,       1,       -1,       0.70710678118654752, INFINITY,        NAN,
        DBL_MIN, DBL_MAX, 4.9e-324, 1 - DBL_EPSILON,     1 + DBL_EPSILON, -3,
        1e-200,  1e200};
    const int count = sizeof edges / sizeof *edges;
    Random random = {81};
    for (int i = 0; i < count * count; i++)
        check_math_accuracy(edges[i / count], edges[i % count]);
    for (int i = 0; i < 300000; i++) {
        double x = i % 3 == 0   ? random_logarithmic(&random, 1e-300, 1e300)
                   : i % 3 == 1 ? random_uniform(&random, 0.5, 2)
                                : 1 + random_uniform(&random, -1e-6, 1e-6);
        double z = i % 2 ? random_uniform(&random, -0.999, 3)
                         : random_logarithmic(&random, 1e-20, 1e20);
        check_math_accuracy(x, i % 4 == 2 && z < 0.5 ? -z : z);
        if (i % 5 == 0)
            check_math_accuracy(x, x * random_uniform(&random, -2, 2));
    }
}

TESTS(NULL, NULL)
