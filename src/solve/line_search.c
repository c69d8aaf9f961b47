#include "solve/line_search.h"

Status line_search_backtrack(EnergyDifference difference, const void *function,
                             double *alpha, int *trials)
{
    for (*trials = 0; *trials <= LINE_SEARCH_MAX_HALVINGS; *alpha /= 2) {
        ++*trials;
        if (difference(function, *alpha) <= 0)
            return STATUS_OK;
    }
    *alpha = 0;
    return STATUS_LINE_SEARCH_LIMIT;
}
