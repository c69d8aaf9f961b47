/* sparse.h - symmetric sparse matrices: triplets to compressed columns with a
 * slot map (slide: coo_matrix).
 *
 * The pattern of the Hessian follows from the mesh and stays the same from step
 * to step.  The triplets are therefore sorted once.  The slot of a triplet is
 * its place in the compressed columns, and assembly is
 *   value[slot[t]] += entry t. */
#pragma once

#include <stddef.h>

#include "base/status.h"

typedef struct Triplets {
    int matrix_size; /* number of rows and of columns of the matrix */
    long long count; /* number of triplets */
    int *row; /* [count] row of each triplet, >= column; NULL while counting */
    int *column; /* [count] column of each triplet */
} Triplets;

typedef struct Sparse {
    int size;          /* number of rows and of columns */
    int entries;       /* number of stored entries */
    int *column_start; /* [size+1] index of each column's first entry */
    int *row;      /* [entries] row of each entry, ascending in each column */
    double *value; /* [entries+1] values, then a bin for unused triplets */
    int *slot;     /* [triplets] index in value[] of each triplet's entry */
} Sparse;

/* Allocates memory for the counted triplets, which the caller then adds again.
 * Returns OK, TOO_LARGE or OUT_OF_MEMORY. */
Status triplets_allocate(Triplets *triplets);
void triplets_free(Triplets *triplets);

/* Counts the entry (row, column) and, after triplets_allocate, stores it.  The
 * lower triangle is stored: an entry above the diagonal as (column, row). */
void triplets_add(Triplets *triplets, int row, int column);

/* Builds A, in which triplets with the same row and column share one entry.
 *   triplets  in
 *   A         out; free it with sparse_free, also after a failure
 * Takes the time O(size + count).  Returns OK or OUT_OF_MEMORY. */
Status sparse_create(const Triplets *triplets, Sparse *A);
void sparse_free(Sparse *A);

/* y = A x with both triangles of A.  x [size] in, y [size] out. */
void sparse_multiply(const Sparse *A, const double *x, double *y);

/* Returns whether all numbers are finite.  value [count] in. */
bool all_finite(const double *value, size_t count);
