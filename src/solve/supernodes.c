#include "solve/cholesky_parts.h"

/* Two numbers in one register, an extension of C that gcc and clang share:
 * arithmetic works lane by lane, with the bits that each would have alone.  It
 * may begin at any number of an array. */
enum { LANES = 2 };
typedef double Lanes __attribute__((vector_size(LANES * sizeof(double)),
                                    aligned(sizeof(double))));

static inline Lanes lanes(const double *a)
{
    return *(const Lanes *)a;
}

/* Columns that are eliminated together. */
enum { GROUP = 4 };

typedef struct Panel {
    int columns, rows;
    const int *row;      /* [rows] */
    const double *value; /* [rows * columns] */
} Panel;

static Panel panel_of(const Supernodes *L, size_t k)
{
    return (Panel){L->column[k + 1] - L->column[k], L->rows[k + 1] - L->rows[k],
                   L->row + L->rows[k], L->value + L->values[k]};
}

static const double *panel_column(const Panel *panel, int j)
{
    return panel->value + (size_t)j * (size_t)panel->rows;
}

/* Solves for w[j] and takes its share from the rows below. */
static void forward_one(const Panel *panel, int j, double *w)
{
    const double *a = panel_column(panel, j);
    w[j] /= a[j];
    for (int i = j + 1; i < panel->rows; i++)
        w[i] -= a[i] * w[j];
}

/* The same for w[j] ... w[j + 3].  The pivots' inverses do not wait for one
 * another. */
static void forward_group(const Panel *panel, int j, double *w)
{
    const double *a = panel_column(panel, j), *b = a + panel->rows;
    const double *c = b + panel->rows, *d = c + panel->rows;
    double pivot[GROUP] = {1 / a[j], 1 / b[j + 1], 1 / c[j + 2], 1 / d[j + 3]};
    double v0 = w[j] * pivot[0];
    double v1 = (w[j + 1] - a[j + 1] * v0) * pivot[1];
    double v2 = (w[j + 2] - a[j + 2] * v0 - b[j + 2] * v1) * pivot[2];
    double v3 = w[j + 3] - a[j + 3] * v0 - b[j + 3] * v1 - c[j + 3] * v2;
    v3 *= pivot[3];
    w[j] = v0;
    w[j + 1] = v1;
    w[j + 2] = v2;
    w[j + 3] = v3;
    int i = j + GROUP;
    for (; i + LANES <= panel->rows; i += LANES)
        *(Lanes *)(w + i) -= (lanes(a + i) * v0 + lanes(b + i) * v1) +
                             (lanes(c + i) * v2 + lanes(d + i) * v3);
    for (; i < panel->rows; i++)
        w[i] -= (a[i] * v0 + b[i] * v1) + (c[i] * v2 + d[i] * v3);
}

/* Solves for w[j], the rows below being known. */
static void backward_one(const Panel *panel, int j, double *w)
{
    const double *a = panel_column(panel, j);
    double sum = w[j];
    for (int i = j + 1; i < panel->rows; i++)
        sum -= a[i] * w[i];
    w[j] = sum / a[j];
}

static void backward_group(const Panel *panel, int j, double *w)
{
    const double *a = panel_column(panel, j), *b = a + panel->rows;
    const double *c = b + panel->rows, *d = c + panel->rows;
    double pivot[GROUP] = {1 / a[j], 1 / b[j + 1], 1 / c[j + 2], 1 / d[j + 3]};
    Lanes s0 = {0}, s1 = {0}, s2 = {0}, s3 = {0};
    int i = j + GROUP;
    for (; i + LANES <= panel->rows; i += LANES) {
        Lanes below = lanes(w + i);
        s0 += lanes(a + i) * below;
        s1 += lanes(b + i) * below;
        s2 += lanes(c + i) * below;
        s3 += lanes(d + i) * below;
    }
    double v0 = w[j] - (s0[0] + s0[1]), v1 = w[j + 1] - (s1[0] + s1[1]);
    double v2 = w[j + 2] - (s2[0] + s2[1]), v3 = w[j + 3] - (s3[0] + s3[1]);
    for (; i < panel->rows; i++) {
        v0 -= a[i] * w[i];
        v1 -= b[i] * w[i];
        v2 -= c[i] * w[i];
        v3 -= d[i] * w[i];
    }
    w[j + 3] = v3 *= pivot[3];
    w[j + 2] = v2 = (v2 - c[j + 3] * v3) * pivot[2];
    w[j + 1] = v1 = (v1 - b[j + 3] * v3 - b[j + 2] * v2) * pivot[1];
    w[j] = (v0 - a[j + 3] * v3 - a[j + 2] * v2 - a[j + 1] * v1) * pivot[0];
}

static void forward(const Panel *panel, double *w)
{
    int j = 0;
    for (; j + GROUP <= panel->columns; j += GROUP)
        forward_group(panel, j, w);
    for (; j < panel->columns; j++)
        forward_one(panel, j, w);
}

static void backward(const Panel *panel, double *w)
{
    int j = panel->columns;
    while (j % GROUP > 0)
        backward_one(panel, --j, w);
    while (j > 0)
        backward_group(panel, j -= GROUP, w);
}

void supernodes_solve(const Supernodes *L, double *x, double *w)
{
    for (size_t k = 0; k < L->count; k++) {
        Panel panel = panel_of(L, k);
        for (int i = 0; i < panel.rows; i++)
            w[i] = x[panel.row[i]];
        forward(&panel, w);
        for (int i = 0; i < panel.rows; i++)
            x[panel.row[i]] = w[i];
    }
    for (size_t k = L->count; k > 0; k--) {
        Panel panel = panel_of(L, k - 1);
        for (int i = 0; i < panel.rows; i++)
            w[i] = x[panel.row[i]];
        backward(&panel, w);
        for (int i = 0; i < panel.columns; i++)
            x[panel.row[i]] = w[i];
    }
}
