/* Triangular solves by panels against substitution in extended precision.
 */
#include "test.h"

#include <math.h>
#include <string.h>

#include "solve/cholesky_parts.h"

enum { ROWS = 48, MAX_WIDTH = 11 };

/* A random lower triangle in panels; L is the same, dense. */
typedef struct Factor {
    int column[ROWS + 1], rows[ROWS + 1], values[ROWS + 1];
    int row[ROWS * ROWS];
    double value[ROWS * ROWS];
    long double L[ROWS][ROWS];
    Supernodes view;
} Factor;

/* The columns first ... end - 1, and below them some of the rows.  Entries
 * above the diagonal must never be used: they are NaN. */
static void add_panel(Random *random, int first, int end, Factor *factor)
{
    size_t k = factor->view.count++;
    int *row = factor->row + factor->rows[k], rows = 0;
    double *value = factor->value + factor->values[k];
    for (int i = first; i < ROWS; i++)
        if (i < end || random_below(random, 3) == 0)
            row[rows++] = i;
    for (int j = first; j < end; j++, value += rows)
        for (int t = 0; t < rows; t++) {
            value[t] = row[t] < j    ? NAN
                       : row[t] == j ? random_logarithmic(random, 0.5, 2)
                                     : random_uniform(random, -0.2, 0.2);
            if (row[t] >= j)
                factor->L[row[t]][j] = value[t];
        }
    factor->column[k + 1] = end;
    factor->rows[k + 1] = factor->rows[k] + rows;
    factor->values[k + 1] = factor->values[k] + rows * (end - first);
}

static void factor_create(Random *random, Factor *factor)
{
    memset(factor, 0, sizeof *factor);
    for (int first = 0; first < ROWS;) {
        int end = first + 1 + random_below(random, MAX_WIDTH);
        end = end < ROWS ? end : ROWS;
        add_panel(random, first, end, factor);
        first = end;
    }
    factor->view =
        (Supernodes){factor->view.count, factor->column, factor->rows,
                     factor->values,     factor->row,    factor->value};
}

/* x = L^-T L^-1 x */
static void substitute(const Factor *factor, long double *x)
{
    for (int i = 0; i < ROWS; i++) {
        for (int j = 0; j < i; j++)
            x[i] -= factor->L[i][j] * x[j];
        x[i] /= factor->L[i][i];
    }
    for (int i = ROWS - 1; i >= 0; i--) {
        for (int j = i + 1; j < ROWS; j++)
            x[i] -= factor->L[j][i] * x[j];
        x[i] /= factor->L[i][i];
    }
}

/* Rounding grows with the products of the entries, which stay near 1: the
 * worst of 500 factors is off by 7e-16 of the largest unknown. */
TEST(panels_solve)
{
    Random random = {80};
    static Factor factor;
    for (int trial = 0; trial < 500; trial++) {
        double x[ROWS], w[ROWS];
        long double exact[ROWS], largest = 0;
        factor_create(&random, &factor);
        for (int i = 0; i < ROWS; i++)
            exact[i] = x[i] = random_uniform(&random, -1, 1);
        substitute(&factor, exact);
        supernodes_solve(&factor.view, x, w);
        for (int i = 0; i < ROWS; i++)
            largest = fmaxl(largest, fabsl(exact[i]));
        for (int i = 0; i < ROWS; i++)
            CHECK_NEAR(x[i], exact[i], 2e-15L * largest);
    }
}

/* Unit vectors go through with their zeros: what no entry of L connects stays
 * 0 to the last bit. */
TEST(zeros_stay_zero)
{
    double x[ROWS] = {0}, w[ROWS];
    Factor factor = {.view.count = 0};
    for (int i = 0; i < ROWS; i++) {
        factor.column[i] = factor.rows[i] = factor.values[i] = i;
        factor.row[i] = i;
        factor.value[i] = 2;
    }
    factor.column[ROWS] = factor.rows[ROWS] = factor.values[ROWS] = ROWS;
    factor.view = (Supernodes){ROWS,          factor.column, factor.rows,
                               factor.values, factor.row,    factor.value};
    x[7] = 12;
    supernodes_solve(&factor.view, x, w);
    for (int i = 0; i < ROWS; i++)
        CHECK(x[i] == (i == 7 ? 3 : 0));
}

TESTS(NULL, NULL)
