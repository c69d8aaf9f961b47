/* sparse.c - symmetric sparse matrices, built from triplets. */
#include "base/sparse.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

Status triplets_allocate(Triplets *triplets)
{
    size_t bytes = (size_t)triplets->count * sizeof(int);
    if (triplets->count >= INT_MAX)
        return STATUS_TOO_LARGE;
    triplets->row = malloc(bytes);
    triplets->column = malloc(bytes);
    triplets->count = 0;
    if (!triplets->row || !triplets->column)
        return STATUS_OUT_OF_MEMORY;
    return STATUS_OK;
}

void triplets_free(Triplets *triplets)
{
    free(triplets->row);
    free(triplets->column);
    *triplets = (Triplets){0};
}

void triplets_add(Triplets *triplets, int row, int column)
{
    long long t = triplets->count++;
    if (!triplets->row)
        return;
    triplets->row[t] = row > column ? row : column;
    triplets->column[t] = row > column ? column : row;
}

/* out = the entries of `in` (NULL: 0, 1, 2, ...) stably sorted by key.
 *   key    [count] in, 0 ... size-1
 *   start  [size+1] workspace */
static void counting_sort(int count, int size, const int *key, const int *in,
                          int *start, int *out)
{
    memset(start, 0, ((size_t)size + 1) * sizeof *start);
    for (int t = 0; t < count; t++)
        start[key[t] + 1]++;
    for (int i = 0; i < size; i++)
        start[i + 1] += start[i];
    for (int t = 0; t < count; t++) {
        int entry = in ? in[t] : t;
        out[start[key[entry]]++] = entry;
    }
}

Status sparse_create(const Triplets *triplets, Sparse *A)
{
    const int *row = triplets->row, *column = triplets->column;
    int count = (int)triplets->count, size = triplets->matrix_size;
    size_t bytes = ((size_t)count + 1) * sizeof(int);
    size_t starts = ((size_t)size + 1) * sizeof *A->column_start;
    *A = (Sparse){.size = size,
                  .column_start = malloc(starts),
                  .row = malloc(bytes),
                  .slot = malloc(bytes)};
    int *by_row = malloc(bytes), *sorted = malloc(bytes);
    if (A->column_start && A->row && A->slot && by_row && sorted) {
        counting_sort(count, size, row, NULL, A->column_start, by_row);
        counting_sort(count, size, column, by_row, A->column_start, sorted);
        memset(A->column_start, 0, starts);
        for (int i = 0; i < count; i++) { /* equal (row, column) share a slot */
            int t = sorted[i], last = i > 0 ? sorted[i - 1] : -1;
            if (last < 0 || row[t] != row[last] || column[t] != column[last]) {
                A->row[A->entries++] = row[t];
                A->column_start[column[t] + 1]++;
            }
            A->slot[t] = A->entries - 1;
        }
        for (int c = 0; c < size; c++)
            A->column_start[c + 1] += A->column_start[c];
        A->value = calloc((size_t)A->entries + 1, sizeof *A->value);
    }
    free(by_row);
    free(sorted);
    return A->value ? STATUS_OK : STATUS_OUT_OF_MEMORY;
}

void sparse_free(Sparse *A)
{
    free(A->column_start);
    free(A->row);
    free(A->value);
    free(A->slot);
    *A = (Sparse){0};
}

/* Each stored entry off the diagonal counts twice: at (r, c) and (c, r). */
void sparse_multiply(const Sparse *A, const double *x, double *y)
{
    for (int i = 0; i < A->size; i++)
        y[i] = 0;
    for (int c = 0; c < A->size; c++)
        for (int s = A->column_start[c]; s < A->column_start[c + 1]; s++) {
            int r = A->row[s];
            y[r] += A->value[s] * x[c];
            if (r != c)
                y[c] += A->value[s] * x[r];
        }
}

/* 0 * value is NaN if value is not finite.  Four sums are faster than one. */
bool all_finite(const double *value, size_t count)
{
    double sum[4] = {0, 0, 0, 0};
    size_t i = 0;
    for (; i + 4 <= count; i += 4)
        for (int j = 0; j < 4; j++)
            sum[j] += 0 * value[i + j];
    for (; i < count; i++)
        sum[0] += 0 * value[i];
    return sum[0] + sum[1] + sum[2] + sum[3] == 0;
}
