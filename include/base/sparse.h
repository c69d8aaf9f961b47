/* sparse.h - symmetric sparse matrices: triplets to compressed columns with a
 * slot map (slide: coo_matrix).
 *
 * The pattern of the Hessian is that of the mesh and never changes.  So the
 * triplets are sorted once, and each remembers its slot: its place in the
 * compressed columns.  Afterwards assembly is values[slot[t]] += entry t.
 */
#ifndef ELASTO_SPARSE_H
#define ELASTO_SPARSE_H

#include <stddef.h>

#include "base/status.h"

typedef struct Triplets {
    int size;    /* rows = columns of the matrix */
    int count;   /* triplets so far */
    int *row;    /* [count, and room for more] row >= column */
    int *column; /* [the same] */
} Triplets;

typedef struct Sparse {
    int size;      /* rows = columns */
    int entries;   /* stored entries */
    int *start;    /* [size+1] column c is start[c] ... start[c+1]-1 */
    int *row;      /* [entries] ascending in each column */
    double *value; /* [entries+1] the last one takes what is dropped */
} Sparse;

/* Room for `capacity` triplets.  Returns OK, TOO_LARGE, OUT_OF_MEMORY. */
Status triplets_create(int size, long long capacity, Triplets *triplets);
void triplets_free(Triplets *triplets);

/* Appends entry (row, column); there must be room.  Only the lower triangle is
 * stored, and what belongs to the upper one is mirrored: CHOLMOD would add
 * mirrored entries. */
void triplets_add(Triplets *triplets, int row, int column);

/* Sums triplets with equal place.
 *   triplets  in
 *   A         out; free it with sparse_free, also after a failure
 *   slot      [count] out, place of each triplet in A->value
 * Time O(size + count): two counting sorts.  Returns OK, OUT_OF_MEMORY. */
Status sparse_create(const Triplets *triplets, Sparse *A, int *slot);
void sparse_free(Sparse *A);

/* y = A x with the whole symmetric matrix.  x [size] in, y [size] out. */
void sparse_multiply(const Sparse *A, const double *x, double *y);

/* Whether none of these numbers is NaN or infinite. */
bool all_finite(const double *value, size_t count);

#endif
