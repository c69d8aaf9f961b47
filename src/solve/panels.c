/* panels.c - products and solves with dense panels of a Cholesky factor. */
#include "solve/panels.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "solve/grid_loops.h"

/* Number of columns that a loop handles at once. */
enum { GROUP_COLUMNS = 4 };

/* Vectors of two and four doubles, an extension of C that gcc and clang share.
 * A vector may start at any element of an array of double. */
typedef double Double2
    __attribute__((vector_size(2 * sizeof(double)), aligned(sizeof(double))));
typedef double Double4
    __attribute__((vector_size(4 * sizeof(double)), aligned(sizeof(double))));

/* AVX marks a function for registers of four numbers; HAS_AVX tells whether the
 * processor has such registers. */
#if defined(__x86_64__) && !defined(AVX)
#define AVX       __attribute__((target("avx2")))
#define HAS_AVX() __builtin_cpu_supports("avx2")
#else
#define AVX
#define HAS_AVX() false
#endif

/* An unrolled loop of at most four passes. */
#define EACH(i, count) _Pragma("GCC unroll 4") for (int i = 0; i < (count); i++)

/* C [m, n] = A [m, k] B^T or, if is_subtracted, C -= A B^T, with B [n, k] and n
 * at most 4.  If L [n, n] is not NULL, C = C L^-T follows.  The matrices are
 * stored by columns, lda, ldb, ldc, ldl numbers apart. */
typedef struct DenseProduct {
    int m, n, k;
    const double *A, *B;
    double *C;
    int lda, ldb, ldc;
    bool is_subtracted;
    const double *L;
    int ldl;
} DenseProduct;

/* Defines a function `rows` that computes rows of C from row i on, as many as
 * `wide` vectors of type Lanes hold. */
#define ROWS(rows, Lanes, wide)                                                \
    INLINE void rows(const DenseProduct *at, int i, int n,                     \
                     const double *inverse)                                    \
    {                                                                          \
        const int lanes = sizeof(Lanes) / sizeof(double);                      \
        const double *a = at->A + i, *b = at->B;                               \
        Lanes s[GROUP_COLUMNS][wide] = {0};                                    \
        for (int p = 0; p < at->k; p++, a += at->lda, b += at->ldb)            \
            EACH (r, wide)                                                     \
                EACH (q, n)                                                    \
                    s[q][r] += *(const Lanes *)(a + r * lanes) * b[q];         \
        EACH (r, wide)                                                         \
            EACH (q, n) {                                                      \
                double *to = at->C + (size_t)q * at->ldc + i + r * lanes;      \
                Lanes *c = (Lanes *)to;                                        \
                s[q][r] = at->is_subtracted ? *c - s[q][r] : s[q][r];          \
                if (at->L) {                                                   \
                    EACH (p, GROUP_COLUMNS)                                    \
                        if (p < q)                                             \
                            s[q][r] -=                                         \
                                s[p][r] * at->L[(size_t)p * at->ldl + q];      \
                    s[q][r] *= inverse[q];                                     \
                }                                                              \
                *c = s[q][r];                                                  \
            }                                                                  \
    }
ROWS(one_row, double, 1)
ROWS(two_rows, Double2, 1)
ROWS(four_rows, Double2, 2)
ROWS(four_rows_avx, Double4, 1)
ROWS(eight_rows_avx, Double4, 2)

INLINE void multiply_columns(const DenseProduct *at, int n, bool avx)
{
    double inverse[GROUP_COLUMNS] = {0};
    int i = 0;
    for (int q = 0; at->L && q < n; q++)
        inverse[q] = 1 / at->L[(size_t)q * at->ldl + q];
    for (; avx && i + 8 <= at->m; i += 8)
        eight_rows_avx(at, i, n, inverse);
    for (; avx && i + 4 <= at->m; i += 4)
        four_rows_avx(at, i, n, inverse);
    for (; !avx && i + 4 <= at->m; i += 4)
        four_rows(at, i, n, inverse);
    for (; i + 2 <= at->m; i += 2)
        two_rows(at, i, n, inverse);
    for (; i < at->m; i++)
        one_row(at, i, n, inverse);
}

INLINE void multiply_in_groups(const DenseProduct *at, bool avx)
{
    switch (at->n) {
    case 1:
        multiply_columns(at, 1, avx);
        break;
    case 2:
        multiply_columns(at, 2, avx);
        break;
    case 3:
        multiply_columns(at, 3, avx);
        break;
    default:
        multiply_columns(at, GROUP_COLUMNS, avx);
    }
}

AVX static void multiply_avx(const DenseProduct *at)
{
    multiply_in_groups(at, true);
}

static void multiply_dense(const DenseProduct *at)
{
    if (HAS_AVX())
        multiply_avx(at);
    else
        multiply_in_groups(at, false);
}

static int smaller_of(int a, int b)
{
    return a < b ? a : b;
}

/* Whether a call is a case that CHOLMOD never uses.  The result then becomes
 * NaN, so that the factorisation fails. */
static bool reject_unsupported_case(bool known, double *result)
{
    if (!known)
        *result = NAN;
    return !known;
}

/* C = A B^T, the only case of this routine of BLAS that CHOLMOD needs here. */
void dgemm_(const char *transa, const char *transb, const int *m, const int *n,
            const int *k, const double *alpha, const double *A, const int *lda,
            const double *B, const int *ldb, const double *beta, double *C,
            const int *ldc)
{
    if (reject_unsupported_case(
            *transa == 'N' && *transb != 'N' && *alpha == 1 && *beta == 0, C))
        return;
    for (int j = 0; j < *n; j += GROUP_COLUMNS)
        multiply_dense(&(DenseProduct){*m, smaller_of(*n - j, GROUP_COLUMNS),
                                       *k, A, B + j, C + (size_t)j * *ldc, *lda,
                                       *ldb, *ldc, false, NULL, 0});
}

/* Computes the lower triangle of C = A A^T, and overwrites up to three entries
 * above the diagonal in each column. */
void dsyrk_(const char *uplo, const char *trans, const int *n, const int *k,
            const double *alpha, const double *A, const int *lda,
            const double *beta, double *C, const int *ldc)
{
    if (reject_unsupported_case(
            *uplo == 'L' && *trans == 'N' && *alpha == 1 && *beta == 0, C))
        return;
    for (int j = 0; j < *n; j += GROUP_COLUMNS)
        multiply_dense(&(DenseProduct){
            *n - j, smaller_of(*n - j, GROUP_COLUMNS), *k, A + j, A + j,
            C + (size_t)j * *ldc + j, *lda, *lda, *ldc, false, NULL, 0});
}

/* B = B L^-T */
void dtrsm_(const char *side, const char *uplo, const char *trans,
            const char *diag, const int *m, const int *n, const double *alpha,
            const double *L, const int *ldl, double *B, const int *ldb)
{
    if (reject_unsupported_case(*side == 'R' && *uplo == 'L' && *trans != 'N' &&
                                    *diag == 'N' && *alpha == 1,
                                B))
        return;
    for (int j = 0; j < *n; j += GROUP_COLUMNS) {
        const double *D = L + (size_t)j * *ldl + j;
        multiply_dense(&(DenseProduct){*m, smaller_of(*n - j, GROUP_COLUMNS), j,
                                       B, L + j, B + (size_t)j * *ldb, *ldb,
                                       *ldl, *ldb, true, D, *ldl});
    }
}

/* Factors D [n, n], n at most 4, as L L^T in place.  Returns the number, from
 * 1, of the first pivot that is not positive, or 0. */
static int factor_small_block(int n, double *D, int ldd)
{
    for (int q = 0; q < n; q++) {
        double *d = D + (size_t)q * ldd;
        for (int p = 0; p < q; p++)
            for (int i = q; i < n; i++)
                d[i] -= D[(size_t)p * ldd + i] * D[(size_t)p * ldd + q];
        if (!(d[q] > 0))
            return q + 1;
        d[q] = sqrt(d[q]);
        for (int i = q + 1; i < n; i++)
            d[i] /= d[q];
    }
    return 0;
}

/* Factors A = L L^T in place; info: number of the first pivot <= 0, or 0. */
void dpotrf_(const char *uplo, const int *n, double *A, const int *lda,
             int *info)
{
    *info = *uplo != 'L';
    if (*info)
        return;
    for (int j = 0; j < *n; j += GROUP_COLUMNS) {
        int wide = smaller_of(*n - j, GROUP_COLUMNS), below = *n - j - wide;
        double *D = A + (size_t)j * *lda + j;
        multiply_dense(&(DenseProduct){*n - j, wide, j, A + j, A + j, D, *lda,
                                       *lda, *lda, true, NULL, 0});
        int failed = factor_small_block(wide, D, *lda);
        if (failed) {
            *info = j + failed;
            return;
        }
        multiply_dense(&(DenseProduct){below, wide, 0, D, D, D + wide, *lda,
                                       *lda, *lda, true, D, *lda});
    }
}

/* ---- solving with one right-hand side: four columns at a time ---- */

static inline Double2 load_double2(const double *a)
{
    return *(const Double2 *)a;
}

static const double *panel_get_column(const FactorPanel *panel, int j)
{
    return panel->value + (size_t)j * (size_t)panel->rows;
}

/* Finds columns j to j + 3, and computes the inverses of their pivots. */
static inline void load_column_group(const FactorPanel *panel, int j,
                                     const double *a[GROUP_COLUMNS],
                                     double pivot[GROUP_COLUMNS])
{
    for (int q = 0; q < GROUP_COLUMNS; q++) {
        a[q] = panel_get_column(panel, j + q);
        pivot[q] = 1 / a[q][j + q];
    }
}

/* Solves L w = b for w[j] ... w[j + 3]; eliminates them from the rows below. */
static void solve_forward_group(const FactorPanel *panel, int j, double *w)
{
    const double *a[GROUP_COLUMNS];
    double v[GROUP_COLUMNS], pivot[GROUP_COLUMNS];
    load_column_group(panel, j, a, pivot);
    EACH (q, GROUP_COLUMNS) {
        v[q] = w[j + q];
        EACH (p, q)
            v[q] -= a[p][j + q] * v[p];
        w[j + q] = v[q] *= pivot[q];
    }
    int i = j + GROUP_COLUMNS;
    for (; i + 2 <= panel->rows; i += 2)
        *(Double2 *)(w + i) -=
            (load_double2(a[0] + i) * v[0] + load_double2(a[1] + i) * v[1]) +
            (load_double2(a[2] + i) * v[2] + load_double2(a[3] + i) * v[3]);
    for (; i < panel->rows; i++)
        w[i] -= (a[0][i] * v[0] + a[1][i] * v[1]) +
                (a[2][i] * v[2] + a[3][i] * v[3]);
}

/* Solves L^T w = b for w[j] ... w[j + 3]; the rows below are known. */
static void solve_backward_group(const FactorPanel *panel, int j, double *w)
{
    const double *a[GROUP_COLUMNS];
    double v[GROUP_COLUMNS], pivot[GROUP_COLUMNS];
    Double2 s[GROUP_COLUMNS] = {{0}};
    load_column_group(panel, j, a, pivot);
    int i = j + GROUP_COLUMNS;
    for (; i + 2 <= panel->rows; i += 2)
        EACH (q, GROUP_COLUMNS)
            s[q] += load_double2(a[q] + i) * load_double2(w + i);
    for (int q = 0; q < GROUP_COLUMNS; q++)
        v[q] = w[j + q] - (s[q][0] + s[q][1]);
    for (; i < panel->rows; i++)
        for (int q = 0; q < GROUP_COLUMNS; q++)
            v[q] -= a[q][i] * w[i];
#pragma GCC unroll 4
    for (int q = GROUP_COLUMNS - 1; q >= 0; q--) {
#pragma GCC unroll 4
        for (int p = GROUP_COLUMNS - 1; p > q; p--)
            v[q] -= a[q][j + p] * v[p];
        w[j + q] = v[q] *= pivot[q];
    }
}

void panel_solve_forward(const FactorPanel *panel, double *w)
{
    int j = 0;
    for (; j + GROUP_COLUMNS <= panel->columns; j += GROUP_COLUMNS)
        solve_forward_group(panel, j, w);
    for (; j < panel->columns; j++) {
        const double *a = panel_get_column(panel, j);
        w[j] /= a[j];
        for (int i = j + 1; i < panel->rows; i++)
            w[i] -= a[i] * w[j];
    }
}

void panel_solve_backward(const FactorPanel *panel, double *w)
{
    int j = panel->columns;
    while (j % GROUP_COLUMNS > 0) {
        const double *a = panel_get_column(panel, --j);
        for (int i = j + 1; i < panel->rows; i++)
            w[j] -= a[i] * w[i];
        w[j] /= a[j];
    }
    while (j > 0)
        solve_backward_group(panel, j -= GROUP_COLUMNS, w);
}

/* ---- what else CHOLMOD and OpenMP ask for ---- */

/* Complex matrices do not occur, but a static CHOLMOD needs these names. */
#define NOTHING(name)                                                          \
    void name(void);                                                           \
    void name(void)                                                            \
    {                                                                          \
    }
NOTHING(zgemm_)
NOTHING(zherk_)
NOTHING(ztrsm_)
NOTHING(zpotrf_)

/* Runs a loop of OpenMP in the calling thread.  A team of threads for each of
 * CHOLMOD's supernodes takes longer than most loops. */
void GOMP_parallel(void (*loop)(void *), void *data, unsigned threads,
                   unsigned flags);

void GOMP_parallel(void (*loop)(void *), void *data, unsigned threads,
                   unsigned flags)
{
    (void)threads;
    (void)flags;
    loop(data);
}
