#include "solve/cholesky_parts.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* Four numbers side by side, an extension of C that gcc and clang share; they
 * may begin at any number of an array. */
enum { LANES = 4, GROUP = 4 };
typedef double Lanes __attribute__((vector_size(LANES * sizeof(double)),
                                    aligned(sizeof(double))));

/* C [m, n] = A [m, k] B^T or, where it subtracts, C -= A B^T, with B [n, k]
 * and n at most 4.  All are stored by columns, lda, ldb, ldc numbers apart. */
typedef struct Product {
    int m, n, k;
    const double *A, *B;
    double *C;
    int lda, ldb, ldc;
    bool subtracts;
} Product;

/* Rows i ... i + 4 wide - 1 of C's n columns; wide is 1 or 2. */
static inline __attribute__((always_inline)) void block(const Product *at,
                                                        int i, int wide, int n)
{
    const double *a = at->A + i, *b = at->B;
    Lanes s[GROUP][2] = {{{0}}};
    for (int p = 0; p < at->k; p++, a += at->lda, b += at->ldb)
#pragma GCC unroll 4
        for (int r = 0; r < wide; r++)
#pragma GCC unroll 4
            for (int q = 0; q < n; q++)
                s[q][r] += *(const Lanes *)(a + r * LANES) * b[q];
#pragma GCC unroll 4
    for (int r = 0; r < wide; r++)
#pragma GCC unroll 4
        for (int q = 0; q < n; q++) {
            Lanes *c = (Lanes *)(at->C + (size_t)q * at->ldc + i + r * LANES);
            *c = at->subtracts ? *c - s[q][r] : s[q][r];
        }
}

/* Row i of C's n columns. */
static inline __attribute__((always_inline)) void row(const Product *at, int i,
                                                      int n)
{
    const double *a = at->A + i, *b = at->B;
    double s[GROUP] = {0};
    for (int p = 0; p < at->k; p++, a += at->lda, b += at->ldb)
#pragma GCC unroll 4
        for (int q = 0; q < n; q++)
            s[q] += *a * b[q];
#pragma GCC unroll 4
    for (int q = 0; q < n; q++) {
        double *c = at->C + (size_t)q * at->ldc + i;
        *c = at->subtracts ? *c - s[q] : s[q];
    }
}

static inline __attribute__((always_inline)) void columns(const Product *at,
                                                          int wide, int n)
{
    int i = 0;
    for (; wide == 2 && i + 2 * LANES <= at->m; i += 2 * LANES)
        block(at, i, 2, n);
    for (; i + LANES <= at->m; i += LANES)
        block(at, i, 1, n);
    for (; i < at->m; i++)
        row(at, i, n);
}

static inline __attribute__((always_inline)) void multiply_by(const Product *at,
                                                              int wide)
{
    switch (at->n) {
    case 1:
        columns(at, wide, 1);
        break;
    case 2:
        columns(at, wide, 2);
        break;
    case 3:
        columns(at, wide, 3);
        break;
    default:
        columns(at, wide, GROUP);
    }
}

/* What a function needs to have four numbers in one register, and whether this
 * processor does. */
#if defined(__x86_64__)
#define FOUR_WIDE __attribute__((target("avx2")))
static bool is_four_wide(void)
{
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx2");
}
#else
#define FOUR_WIDE
static bool is_four_wide(void)
{
    return false;
}
#endif

/* Two registers a column where they hold four numbers, else one pair of two. */
FOUR_WIDE static void multiply_wide(const Product *at)
{
    multiply_by(at, 2);
}

static void multiply_narrow(const Product *at)
{
    multiply_by(at, 1);
}

static void (*multiply)(const Product *at) = multiply_narrow;

void blas_start(void)
{
    if (is_four_wide())
        multiply = multiply_wide;
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* B [m, n] = B L^-T, with L [n, n] and n at most 4. */
static void divide(int m, int n, const double *L, int ldl, double *B, int ldb)
{
    for (int q = 0; q < n; q++) {
        double *b = B + (size_t)q * ldb, inverse = 1 / L[(size_t)q * ldl + q];
        for (int p = 0; p < q; p++) {
            const double *a = B + (size_t)p * ldb;
            double l = L[(size_t)p * ldl + q];
            for (int i = 0; i < m; i++)
                b[i] -= a[i] * l;
        }
        for (int i = 0; i < m; i++)
            b[i] *= inverse;
    }
}

/* Another case than CHOLMOD's has no answer: it ends as a pivot that is NaN. */
static bool unknown(bool known, double *result)
{
    if (!known)
        *result = NAN;
    return !known;
}

/* C = A B^T */
void dgemm_(const char *transa, const char *transb, const int *m, const int *n,
            const int *k, const double *alpha, const double *A, const int *lda,
            const double *B, const int *ldb, const double *beta, double *C,
            const int *ldc)
{
    if (unknown(*transa == 'N' && *transb != 'N' && *alpha == 1 && *beta == 0,
                C))
        return;
    for (int j = 0; j < *n; j += GROUP)
        multiply(&(Product){*m, least(*n - j, GROUP), *k, A, B + j,
                            C + (size_t)j * *ldc, *lda, *ldb, *ldc, false});
}

/* The lower triangle of C = A A^T; what stands right of it in a group of
 * columns is written, too. */
void dsyrk_(const char *uplo, const char *trans, const int *n, const int *k,
            const double *alpha, const double *A, const int *lda,
            const double *beta, double *C, const int *ldc)
{
    if (unknown(*uplo == 'L' && *trans == 'N' && *alpha == 1 && *beta == 0, C))
        return;
    for (int j = 0; j < *n; j += GROUP)
        multiply(&(Product){*n - j, least(*n - j, GROUP), *k, A + j, A + j,
                            C + (size_t)j * *ldc + j, *lda, *lda, *ldc, false});
}

/* B = B L^-T */
void dtrsm_(const char *side, const char *uplo, const char *trans,
            const char *diag, const int *m, const int *n, const double *alpha,
            const double *L, const int *ldl, double *B, const int *ldb)
{
    if (unknown(*side == 'R' && *uplo == 'L' && *trans != 'N' && *diag == 'N' &&
                    *alpha == 1,
                B))
        return;
    for (int j = 0; j < *n; j += GROUP) {
        int wide = least(*n - j, GROUP);
        double *b = B + (size_t)j * *ldb;
        multiply(&(Product){*m, wide, j, B, L + j, b, *ldb, *ldl, *ldb, true});
        divide(*m, wide, L + (size_t)j * *ldl + j, *ldl, b, *ldb);
    }
}

/* L L^T of D [n, n], n at most 4.  Returns the first pivot that is not above
 * 0, counted from 1; 0: all are. */
static int factor(int n, double *D, int ldd)
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

/* The lower triangle of A = L L^T; info: as factor returns it. */
void dpotrf_(const char *uplo, const int *n, double *A, const int *lda,
             int *info)
{
    *info = *uplo != 'L';
    if (*info)
        return;
    for (int j = 0; j < *n; j += GROUP) {
        int wide = least(*n - j, GROUP), below = *n - j - wide;
        double *D = A + (size_t)j * *lda + j;
        multiply(&(Product){*n - j, wide, j, A + j, A + j, D, *lda, *lda, *lda,
                            true});
        int failed = factor(wide, D, *lda);
        if (failed) {
            *info = j + failed;
            return;
        }
        divide(below, wide, D, *lda, D + wide, *lda);
    }
}

/* CHOLMOD's complex matrices, which there are none of: an archive of it asks
 * for these, too. */
#define NOTHING(name)                                                          \
    void name(void);                                                           \
    void name(void)                                                            \
    {                                                                          \
    }
NOTHING(zgemm_)
NOTHING(zherk_)
NOTHING(ztrsm_)
NOTHING(zpotrf_)

/* OpenMP would wake a team of threads for each of CHOLMOD's supernodes, which
 * takes longer than most of them do: its loops run where they are called. */
void GOMP_parallel(void (*loop)(void *), void *data, unsigned threads,
                   unsigned flags);

void GOMP_parallel(void (*loop)(void *), void *data, unsigned threads,
                   unsigned flags)
{
    (void)threads;
    (void)flags;
    loop(data);
}
