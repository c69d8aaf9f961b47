/* one_thread.h - CHOLMOD and its BLAS on one thread.
 *
 * Blocks of a square's factor are too small to share among threads: OpenMP
 * inside CHOLMOD costs more than it gives.  And with one thread of BLAS the
 * sums have one order, so the same bits, however many threads a machine has.
 */
#ifndef ELASTO_ONE_THREAD_H
#define ELASTO_ONE_THREAD_H

/* Tells OpenMP and OpenBLAS, where the program has them. */
void one_thread(void);

#endif
