/* scalar_newton.h - Newton's method in one variable (slides: Algorithm 1),
 * with Algorithm 2 if wanted: while |f'(x)| > tolerance: p = -f'(x)/f''(x),
 * x += alpha p.  Some scenes show nothing else.
 */
#ifndef ELASTO_SCALAR_NEWTON_H
#define ELASTO_SCALAR_NEWTON_H

#include "solve/newton.h"

/* f(x), f'(x), f''(x) */
typedef struct ScalarValues {
    double value, first, second;
} ScalarValues;

typedef struct ScalarFunction {
    ScalarValues (*at)(const void *data, double x);
    const void *data; /* what f depends on beside x, or NULL */
} ScalarFunction;

static inline ScalarValues scalar_at(const ScalarFunction *f, double x)
{
    return f->at(f->data, x);
}

typedef struct ScalarNewton {
    ScalarFunction f;
    double tolerance;  /* on |f'(x)| */
    LineSearch search; /* NONE: Algorithm 1 as it is */
    double x;          /* present iterate */
    double p;          /* direction there */
    double g;          /* f'(x) */
    int iterations;    /* done so far */
    Status status;     /* RUNNING, or how it ended */
} ScalarNewton;

/* Test and direction at newton->x; the fields above p are set by the caller.
 * Returns RUNNING, OK (a minimiser already), DIVERGED (it has no direction). */
Status scalar_newton_start(ScalarNewton *newton);

/* One iteration.  record out, also after a failure; its residual is |f'|,
 * its points are (x, f(x)).
 * Returns RUNNING, OK, LINE_SEARCH_LIMIT, NOT_DESCENT, or DIVERGED where the
 * next direction is beyond all numbers. */
Status scalar_newton_iterate(ScalarNewton *newton, NewtonRecord *record);

#endif
