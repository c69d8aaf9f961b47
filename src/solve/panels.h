/* panels.h - products and solves with the dense panels of a Cholesky factor,
 * with the same bits on every processor.
 *
 * Columns of L with the same rows below them are one supernode, stored as a
 * panel (Davis et al.: A Survey of Direct Methods for Sparse Linear Systems,
 * 2016, 5 and 9).  CHOLMOD makes them by dgemm_, dsyrk_, dtrsm_ and dpotrf_.  A
 * library of BLAS chooses its kernels, and with them the order of its sums, by
 * the processor: three kinds of processors gave three factors.  The program
 * therefore has its own four functions, each for the one case that CHOLMOD
 * uses; the linker takes them before those of the library.  Every entry is one
 * sum over ascending columns, which has the same bits with lanes of any width.
 *
 * With one right-hand side CHOLMOD would call BLAS three times for each panel;
 * on the small panels of a square mesh these calls take longer than the
 * arithmetic.  In panels.c four columns go through a panel at a time: half the
 * time at 32 segments, four fifths at 64 and above. */
#pragma once

typedef struct FactorPanel {
    int columns, rows;
    const int *row; /* [rows] index of each row in L, diagonal block first */
    const double *value; /* [rows * columns] by columns; entries above the
                            diagonal have no meaning */
} FactorPanel;

/* Forward: solves for the panel's columns of L w = b, and subtracts their
 * products from the rows below.  Backward: solves for the panel's columns of
 * L^T w = b from known rows below.  w [rows] in/out. */
void panel_solve_forward(const FactorPanel *panel, double *w);
void panel_solve_backward(const FactorPanel *panel, double *w);
