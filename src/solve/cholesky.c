/* cholesky.c - sparse Cholesky factors by CHOLMOD, and solves with them. */
#include "solve/cholesky.h"

#include <cholmod.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solve/panels.h"

struct Cholesky {
    cholmod_common common;
    cholmod_factor *L; /* symbolic at first, then numeric */
    CholeskyKind kind;
    const Sparse *matrix; /* A, owned by the caller */
    double *b, *r; /* [n] copy of the right-hand side; residual or workspace */
};

/* Returns CHOLMOD's status as a Status. */
static Status translate_cholmod_status(const cholmod_common *common)
{
    if (common->status == CHOLMOD_OUT_OF_MEMORY)
        return STATUS_OUT_OF_MEMORY;
    if (common->status == CHOLMOD_TOO_LARGE)
        return STATUS_TOO_LARGE;
    return common->status == CHOLMOD_OK ? STATUS_OK : STATUS_INVALID_INPUT;
}

/* Returns A's compressed columns as a matrix of CHOLMOD, without a copy. */
static cholmod_sparse sparse_view(const Sparse *A)
{
    return (cholmod_sparse){
        .nrow = (size_t)A->size,
        .ncol = (size_t)A->size,
        .nzmax = (size_t)A->entries,
        .p = A->column_start,
        .i = A->row,
        .x = A->value,
        .stype = -1, /* A is the lower triangle */
        .itype = CHOLMOD_INT,
        .xtype = CHOLMOD_REAL,
        .dtype = CHOLMOD_DOUBLE,
        .sorted = 1,
        .packed = 1,
    };
}

Status cholesky_create(const Sparse *A, CholeskyKind kind, Cholesky **out)
{
    *out = NULL;
    Cholesky *cholesky = calloc(1, sizeof *cholesky);
    if (!cholesky)
        return STATUS_OUT_OF_MEMORY;
    cholmod_common *common = &cholesky->common;
    cholmod_start(common);
    common->print = 0;
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_NATURAL;
    common->postorder = false;
    common->supernodal =
        kind == CHOLESKY_DEFINITE ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
    common->quick_return_if_not_posdef = 1;
    /* Supernodes merge if few zeros are added: limits for square meshes. */
    common->nrelax[0] = 8;
    common->nrelax[1] = 20;
    common->nrelax[2] = 40;
    common->zrelax[0] = 0.5;
    common->zrelax[1] = 0.1;
    common->zrelax[2] = 0.02;
    cholesky->kind = kind;
    cholesky->matrix = A;
    cholmod_sparse view = sparse_view(A);
    cholesky->L = cholmod_analyze(&view, common);
    Status status = translate_cholmod_status(common);
    cholesky->b = malloc(2 * (size_t)A->size * sizeof *cholesky->b);
    if (!status && (!cholesky->L || !cholesky->b))
        status = STATUS_OUT_OF_MEMORY;
    if (status) {
        cholesky_free(cholesky);
        return status;
    }
    cholesky->r = cholesky->b + A->size;
    *out = cholesky;
    return STATUS_OK;
}

void cholesky_free(Cholesky *cholesky)
{
    if (!cholesky)
        return;
    cholmod_free_factor(&cholesky->L, &cholesky->common);
    cholmod_finish(&cholesky->common);
    free(cholesky->b);
    free(cholesky);
}

/* Returns max |x_i|. */
static double largest_magnitude(const double *x, size_t n)
{
    double largest = 0;
    for (size_t i = 0; i < n; i++)
        largest = fmax(largest, fabs(x[i]));
    return largest;
}

Status cholesky_factor(Cholesky *cholesky)
{
    cholmod_common *common = &cholesky->common;
    cholmod_sparse A = sparse_view(cholesky->matrix);
    if (!all_finite(A.x, A.nzmax))
        return STATUS_NOT_FINITE;
    common->status = CHOLMOD_OK;
    /* Pivots nearer to 0 than dbound become dbound, with their sign. */
    if (cholesky->kind == CHOLESKY_INDEFINITE)
        common->dbound = 1e-10 * largest_magnitude(A.x, A.nzmax);
    common->ndbounds_hit = 0;
    cholmod_factorize(&A, cholesky->L, common);
    /* cholmod_factorize returns TRUE for indefinite matrices too. */
    if (common->status == CHOLMOD_NOT_POSDEF ||
        (common->status >= CHOLMOD_OK && cholesky->L->minor != cholesky->L->n))
        return STATUS_NOT_POSITIVE_DEFINITE;
    return common->status < CHOLMOD_OK ? translate_cholmod_status(common)
                                       : STATUS_OK;
}

/* ---- definite: in panels ---- */

/* Overwrites y [n] with L^-T L^-1 y.  w [n] is workspace. */
static void solve_by_panels(const cholmod_factor *L, double *y, double *w)
{
    const int *column = L->super, *rows = L->pi, *values = L->px;
    for (size_t step = 0; step < 2 * L->nsuper; step++) {
        bool down = step < L->nsuper;
        size_t k = down ? step : 2 * L->nsuper - 1 - step;
        FactorPanel panel = {column[k + 1] - column[k], rows[k + 1] - rows[k],
                             (const int *)L->s + rows[k],
                             (const double *)L->x + values[k]};
        for (int i = 0; i < panel.rows; i++)
            w[i] = y[panel.row[i]];
        (down ? panel_solve_forward : panel_solve_backward)(&panel, w);
        for (int i = 0; i < (down ? panel.rows : panel.columns); i++)
            y[panel.row[i]] = w[i];
    }
}

/* ---- indefinite: the first entry of each column is that of D ---- */

/* Overwrites y [n] with L^-T D^-1 L^-1 y. */
static void solve_by_columns(const cholmod_factor *L, double *y)
{
    const int *start = L->p, *count = L->nz, *row = L->i;
    const double *value = L->x;
    for (size_t j = 0; j < L->n; j++)
        for (int k = start[j] + 1; k < start[j] + count[j]; k++)
            y[row[k]] -= value[k] * y[j];
    for (size_t j = L->n; j-- > 0;) {
        y[j] /= value[start[j]];
        for (int k = start[j] + 1; k < start[j] + count[j]; k++)
            y[j] -= value[k] * y[row[k]];
    }
}

/* An indefinite A is solved by iterative refinement with A itself,
 * x += (L D L^T)^-1 (b - A x), because its factor can be inaccurate: CHOLMOD
 * does not pivot, and replaces pivots near 0 (cholesky_factor). */
Status cholesky_solve(Cholesky *cholesky, const double *b, double *x)
{
    enum { MAX_REFINEMENTS = 21 };
    size_t n = cholesky->L->n;
    double *own = cholesky->b, *r = cholesky->r;
    if (cholesky->kind == CHOLESKY_DEFINITE) {
        memmove(x, b, n * sizeof *x);
        solve_by_panels(cholesky->L, x, r);
        return all_finite(x, n) ? STATUS_OK : STATUS_NOT_FINITE;
    }
    double size = largest_magnitude(b, n), residual = INFINITY, last;
    memcpy(own, b, n * sizeof *own); /* x may be b */
    memcpy(r, b, n * sizeof *r);
    memset(x, 0, n * sizeof *x);
    for (int i = 0; i < MAX_REFINEMENTS; i++) {
        solve_by_columns(cholesky->L, r);
        if (!all_finite(r, n))
            return STATUS_NOT_FINITE;
        for (size_t j = 0; j < n; j++)
            x[j] += r[j];
        sparse_multiply(cholesky->matrix, x, r);
        for (size_t j = 0; j < n; j++)
            r[j] = own[j] - r[j];
        last = residual;
        residual = largest_magnitude(r, n);
        if (residual <= 1e-15 * size || !(residual < 0.5 * last))
            break;
    }
    return residual <= 1e-8 * size ? STATUS_OK : STATUS_SINGULAR;
}

bool cholesky_is_exact(const Cholesky *cholesky)
{
    return cholesky->common.ndbounds_hit == 0;
}

int cholesky_negative_pivots(const Cholesky *cholesky)
{
    const cholmod_factor *L = cholesky->L;
    const int *start = L->p;
    const double *value = L->x;
    int count = 0;
    for (size_t j = 0; j < L->n; j++)
        count += value[start[j]] < 0;
    return count;
}
