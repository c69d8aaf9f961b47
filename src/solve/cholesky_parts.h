/* cholesky_parts.h - what the factor and its solves are made of beside CHOLMOD,
 * each in a file of its own.
 */
#ifndef ELASTO_CHOLESKY_PARTS_H
#define ELASTO_CHOLESKY_PARTS_H

#include <stddef.h>

/* ---- blas.c: the four calls of BLAS and LAPACK that CHOLMOD's supernodal
 * factorisation makes, with the same bits on every processor; and its loops on
 * one thread.
 *
 * A library of BLAS chooses its kernels, and with them the order of its sums,
 * by the processor: three kinds of processors gave three factors.  So the
 * program brings dgemm_, dsyrk_, dtrsm_ and dpotrf_ itself, each for the one
 * case that CHOLMOD has; CHOLMOD finds them before those of its library.  Every
 * entry is one sum over ascending columns: lanes of any width give its bits.
 */

/* Chooses the widest registers that the processor has.  Called before the first
 * factorisation; a program that calls it is linked with these calls. */
void blas_start(void);

/* ---- supernodes.c: triangular solves with a supernodal Cholesky factor.
 *
 * Columns of L with the same rows below them are one supernode, stored as a
 * dense panel (Davis et al.: A Survey of Direct Methods for Sparse Linear
 * Systems, 2016, 5 and 9).  With one right-hand side CHOLMOD calls BLAS three
 * times for each panel; on the small panels of a square mesh these calls take
 * longer than the arithmetic.  Here four columns go through a panel at a time:
 * half the time at 32 segments, four fifths at 64 and above.
 */

/* A view of L; panel k has the columns column[k] ... column[k + 1] - 1 and the
 * rows row[rows[k]] ... row[rows[k + 1] - 1], its columns first; its entries
 * begin at value[values[k]], column by column, and those above the diagonal
 * are not used. */
typedef struct Supernodes {
    size_t count;
    const int *column; /* [count + 1] */
    const int *rows;   /* [count + 1] */
    const int *values; /* [count + 1] */
    const int *row;
    const double *value;
} Supernodes;

/* x = L^-T L^-1 x.
 *   x  [size] in/out
 *   w  [size] workspace */
void supernodes_solve(const Supernodes *L, double *x, double *w);

#endif
