/* line_search.h - step length along a search direction (slide: Algorithm 2,
 * backtracking line search).
 *
 * The slides halve alpha while E(x + alpha p) > E(x).  The program computes the
 * difference itself (make_line_energy), so that rounding of large energies does
 * not hide a small decrease. */
#pragma once

#include "base/status.h"

typedef enum LineSearch {
    LINE_SEARCH_BACKTRACK, /* Algorithm 2: halves alpha while E rises */
    LINE_SEARCH_NONE,      /* alpha = 1, or as much as the terms allow */
    LINE_SEARCH_COUNT
} LineSearch;

/* E(x + alpha p) - E(x); NaN counts as "not lower". */
typedef double (*EnergyFunction)(const void *function, double alpha);

/* Halvings of alpha after which no step is assumed to lower E. */
enum { LINE_SEARCH_MAX_HALVINGS = 64 };

/* Algorithm 2: while E(x + alpha p) > E(x), alpha = alpha/2.
 *   alpha   in: the first trial, 1 or as much as terms allow; out: the first
 *           trial, or 1/2, 1/4, ... of it; 0 after a failure
 *   trials  out, number of energies compared
 * Returns OK, LINE_SEARCH_LIMIT. */
Status line_search_backtrack(EnergyFunction difference, const void *function,
                             double *alpha, int *trials);
