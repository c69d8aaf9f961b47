/* blas.h - the four calls of BLAS and LAPACK that CHOLMOD's supernodal
 * factorisation makes, with the same bits on every processor; and its loops on
 * one thread.
 *
 * A library of BLAS chooses its kernels, and with them the order of its sums,
 * by the processor: three kinds of processors gave three factors.  So the
 * program brings dgemm_, dsyrk_, dtrsm_ and dpotrf_ itself, each for the one
 * case that CHOLMOD has; CHOLMOD finds them before those of its library.  Every
 * entry is one sum over ascending columns: lanes of any width give its bits.
 */
#ifndef ELASTO_BLAS_H
#define ELASTO_BLAS_H

/* Chooses the widest registers that the processor has.  Called before the first
 * factorisation; a program that calls it is linked with these calls. */
void blas_start(void);

#endif
