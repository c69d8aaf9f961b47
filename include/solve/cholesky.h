/* cholesky.h - sparse Cholesky factorisation (slide: spsolve), by CHOLMOD.
 *
 * The pattern is analysed once; each change of the values needs a new factor.
 * Solves allocate nothing.  CHOLMOD's types stay inside cholesky.c. */
#pragma once

#include "base/sparse.h"

typedef struct Cholesky Cholesky;

typedef enum CholeskyKind {
    CHOLESKY_DEFINITE,   /* L L^T in dense panels, with BLAS */
    CHOLESKY_INDEFINITE, /* L D L^T without pivoting: allows D < 0 */
} CholeskyKind;

/* Analyses the pattern of A, whose rows are in elimination order.
 *   A    in; must live as long as the handle, which reads its values
 *   out  the handle; free it with cholesky_free; NULL after a failure
 * Returns OK, OUT_OF_MEMORY, TOO_LARGE. */
Status cholesky_create(const Sparse *A, CholeskyKind kind, Cholesky **out);
void cholesky_free(Cholesky *cholesky);

/* Factors A with its present values.
 * Returns OK, NOT_POSITIVE_DEFINITE (a pivot not > 0; never for INDEFINITE),
 * NOT_FINITE (NaN or infinity in A), OUT_OF_MEMORY. */
Status cholesky_factor(Cholesky *cholesky);

/* Solves A x = b with the last factor.  b [size] in, x [size] out; x may be b.
 * INDEFINITE refines the solution with A, which must still hold the values that
 * were factored.  Returns OK, NOT_FINITE (the result overflows), SINGULAR (only
 * INDEFINITE: no solution within 1e-8 of b). */
Status cholesky_solve(Cholesky *cholesky, const double *b, double *x);

/* Whether the last factor is that of A itself, without a replaced pivot. */
bool cholesky_is_exact(const Cholesky *cholesky);

/* Returns the number of negative pivots of the last factor, of kind INDEFINITE,
 * which is the number of negative eigenvalues of A. */
int cholesky_negative_pivots(const Cholesky *cholesky);
