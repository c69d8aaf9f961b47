#include "solve/cholesky.h"

#include <cholmod.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solve/one_thread.h"
#include "solve/supernodes.h"

struct Cholesky {
    cholmod_common common;
    cholmod_sparse A;  /* a view of the caller's matrix */
    cholmod_factor *L; /* symbolic at first, then numeric */
    cholmod_dense *x;  /* result and workspaces of cholmod_solve2 */
    cholmod_dense *y, *e;
    CholeskyKind kind;
    const Sparse *matrix; /* for the refinement of INDEFINITE */
    double *b, *r;        /* [n] right-hand side; residual or workspace */
};

/* Supernodes are merged if that adds few zeros; these limits were measured on
 * square meshes. */
static void set_parameters(cholmod_common *common, CholeskyKind kind,
                           bool ordered)
{
    common->print = 0;
    common->nmethods = 1;
    common->method[0].ordering = ordered ? CHOLMOD_NATURAL : CHOLMOD_AMD;
    common->postorder = !ordered;
    common->supernodal =
        kind == CHOLESKY_DEFINITE ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
    common->quick_return_if_not_posdef = 1;
    common->nrelax[0] = 8;
    common->nrelax[1] = 20;
    common->nrelax[2] = 40;
    common->zrelax[0] = 0.5;
    common->zrelax[1] = 0.1;
    common->zrelax[2] = 0.02;
}

/* CHOLMOD's name for what went wrong, as ours. */
static Status cholmod_failure(const cholmod_common *common)
{
    if (common->status == CHOLMOD_OUT_OF_MEMORY)
        return STATUS_OUT_OF_MEMORY;
    if (common->status == CHOLMOD_TOO_LARGE)
        return STATUS_TOO_LARGE;
    return common->status == CHOLMOD_OK ? STATUS_OK : STATUS_INVALID_INPUT;
}

/* The compressed columns of A as CHOLMOD wants to see them. */
static cholmod_sparse sparse_view(const Sparse *A)
{
    return (cholmod_sparse){
        .nrow = (size_t)A->size,
        .ncol = (size_t)A->size,
        .nzmax = (size_t)A->entries,
        .p = A->start,
        .i = A->row,
        .x = A->value,
        .stype = -1, /* the lower triangle */
        .itype = CHOLMOD_INT,
        .xtype = CHOLMOD_REAL,
        .dtype = CHOLMOD_DOUBLE,
        .sorted = 1,
        .packed = 1,
    };
}

Status cholesky_create(const Sparse *A, CholeskyKind kind, bool ordered,
                       Cholesky **out)
{
    *out = NULL;
    Cholesky *cholesky = calloc(1, sizeof *cholesky);
    if (!cholesky)
        return STATUS_OUT_OF_MEMORY;
    one_thread();
    cholmod_start(&cholesky->common);
    set_parameters(&cholesky->common, kind, ordered);
    cholesky->kind = kind;
    cholesky->A = sparse_view(A);
    cholesky->matrix = A;
    cholesky->L = cholmod_analyze(&cholesky->A, &cholesky->common);
    Status status = cholmod_failure(&cholesky->common);
    cholesky->b = malloc((size_t)A->size * sizeof *cholesky->b);
    cholesky->r = malloc((size_t)A->size * sizeof *cholesky->r);
    if (!status && (!cholesky->L || !cholesky->b || !cholesky->r))
        status = STATUS_OUT_OF_MEMORY;
    if (status) {
        cholesky_free(cholesky);
        return status;
    }
    *out = cholesky;
    return STATUS_OK;
}

void cholesky_free(Cholesky *cholesky)
{
    if (!cholesky)
        return;
    cholmod_free_dense(&cholesky->x, &cholesky->common);
    cholmod_free_dense(&cholesky->y, &cholesky->common);
    cholmod_free_dense(&cholesky->e, &cholesky->common);
    cholmod_free_factor(&cholesky->L, &cholesky->common);
    cholmod_finish(&cholesky->common);
    free(cholesky->b);
    free(cholesky->r);
    free(cholesky);
}

/* max |x_i| */
static double largest_of(const double *x, size_t n)
{
    double largest = 0;
    for (size_t i = 0; i < n; i++)
        largest = fmax(largest, fabs(x[i]));
    return largest;
}

Status cholesky_factor(Cholesky *cholesky)
{
    cholmod_common *common = &cholesky->common;
    if (!all_finite(cholesky->A.x, (size_t)cholesky->matrix->entries))
        return STATUS_NOT_FINITE;
    common->status = CHOLMOD_OK;
    if (cholesky->kind == CHOLESKY_INDEFINITE) /* pivots nearer to 0 go there */
        common->dbound = 1e-10 * largest_of(cholesky->matrix->value,
                                            (size_t)cholesky->matrix->entries);
    cholmod_factorize(&cholesky->A, cholesky->L, common);
    /* cholmod_factorize returns TRUE for indefinite matrices too. */
    if (common->status == CHOLMOD_NOT_POSDEF ||
        (common->status >= CHOLMOD_OK && cholesky->L->minor != cholesky->L->n))
        return STATUS_NOT_POSITIVE_DEFINITE;
    return common->status < CHOLMOD_OK ? cholmod_failure(common) : STATUS_OK;
}

/* x = P^T L^-T L^-1 P b, with P the order of the rows. */
static Status solve_by_supernodes(Cholesky *cholesky, const double *b,
                                  double *x)
{
    const cholmod_factor *L = cholesky->L;
    const Supernodes supernodes = {L->nsuper, L->super, L->pi,
                                   L->px,     L->s,     L->x};
    const int *order = L->Perm;
    for (size_t i = 0; i < L->n; i++)
        cholesky->b[i] = b[order[i]];
    supernodes_solve(&supernodes, cholesky->b, cholesky->r);
    for (size_t i = 0; i < L->n; i++)
        x[order[i]] = cholesky->b[i];
    return all_finite(x, L->n) ? STATUS_OK : STATUS_NOT_FINITE;
}

/* x = P^T L^-T D^-1 L^-1 P b */
static Status solve_by_columns(Cholesky *cholesky, const double *b, double *x)
{
    size_t n = cholesky->A.nrow;
    cholmod_dense right = {
        .nrow = n,
        .ncol = 1,
        .nzmax = n,
        .d = n,
        .xtype = CHOLMOD_REAL,
        .dtype = CHOLMOD_DOUBLE,
    };
    memcpy(&right.x, &b, sizeof b); /* only read, though the type says not */
    cholesky->common.status = CHOLMOD_OK;
    /* CHOLMOD 5.12 does not notice when it gets no memory for y. */
    if (!cholmod_ensure_dense(&cholesky->y, n, 1, n, CHOLMOD_REAL,
                              &cholesky->common))
        return cholmod_failure(&cholesky->common);
    if (!cholmod_solve2(CHOLMOD_A, cholesky->L, &right, NULL, &cholesky->x,
                        NULL, &cholesky->y, &cholesky->e, &cholesky->common))
        return cholmod_failure(&cholesky->common);
    memcpy(x, cholesky->x->x, n * sizeof *x);
    return all_finite(x, n) ? STATUS_OK : STATUS_NOT_FINITE;
}

/* r = b - A x; returns max |r_i|. */
static double residual_of(const Cholesky *cholesky, const double *x)
{
    size_t n = cholesky->A.nrow;
    sparse_multiply(cholesky->matrix, x, cholesky->r);
    for (size_t i = 0; i < n; i++)
        cholesky->r[i] = cholesky->b[i] - cholesky->r[i];
    return largest_of(cholesky->r, n);
}

/* Without pivoting an indefinite factor can be inaccurate, and pivots next to
 * zero were moved away from it.  Iterative refinement with the matrix itself,
 * x += (L D L^T)^-1 (b - A x), gives the accuracy back. */
static Status solve_refined(Cholesky *cholesky, double *x)
{
    enum { MAX_REFINEMENTS = 20 };
    size_t n = cholesky->A.nrow;
    double size = largest_of(cholesky->b, n);
    Status status = solve_by_columns(cholesky, cholesky->b, x);
    double residual = status ? 0 : residual_of(cholesky, x);
    for (int i = 0; i < MAX_REFINEMENTS && !status; i++) {
        if (residual <= 1e-15 * size)
            break;
        status = solve_by_columns(cholesky, cholesky->r, cholesky->r);
        for (size_t j = 0; j < n && !status; j++)
            x[j] += cholesky->r[j];
        double last = residual;
        residual = residual_of(cholesky, x);
        if (!(residual < 0.5 * last))
            break;
    }
    if (status)
        return status;
    return residual <= 1e-8 * size ? STATUS_OK : STATUS_SINGULAR;
}

Status cholesky_solve(Cholesky *cholesky, const double *b, double *x)
{
    if (cholesky->kind == CHOLESKY_DEFINITE)
        return solve_by_supernodes(cholesky, b, x);
    memcpy(cholesky->b, b, cholesky->A.nrow * sizeof *b);
    return solve_refined(cholesky, x);
}

double cholesky_factor_entries(const Cholesky *cholesky)
{
    return cholesky->common.lnz;
}

double cholesky_peak_bytes(const Cholesky *cholesky)
{
    return (double)cholesky->common.memory_usage;
}
