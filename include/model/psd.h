/* psd.h - projection of a Hessian's blocks to positive semi-definite ones
 * (slide utils.py, make_PSD).  Each energy has few negative eigenvalues whose
 * vectors are known, so none needs the slide's eigenvalue routine: springs have
 * spring_hessian in spring_law.h.
 */
#ifndef ELASTO_PSD_H
#define ELASTO_PSD_H

#include <math.h>
#include <stdbool.h>

#include "base/mathematics.h"

/* What is done with the negative eigenvalues of a block. */
typedef enum Filter {
    FILTER_CLAMP,     /* replace them by 0: the slides' projection */
    FILTER_NONE,      /* keep them */
    FILTER_ABS,       /* replace them by their absolute values */
    FILTER_ON_DEMAND, /* keep them while the whole Hessian has a Cholesky
                         factor, else clamp; for one block: as NONE */
    FILTER_COUNT
} Filter;

/* Whether it changes a negative eigenvalue of a block at all. */
static inline bool filter_projects(Filter filter)
{
    return filter == FILTER_CLAMP || filter == FILTER_ABS;
}

/* What becomes of one eigenvalue where it does. */
static inline double projected_eigenvalue(Filter filter, double value)
{
    return value >= 0 ? value : filter == FILTER_ABS ? -value : 0;
}

/* Does so with any symmetric 2x2 matrix; one without negative eigenvalues stays
 * as it is, to the last bit.  They are mean +- radius; (H - low I)/(high - low)
 * is the projector on the eigenvector of the higher one.
 *   H  [3] in/out: H_xx, H_xy, H_yy
 * Returns whether one was changed. */
static inline bool filter_2x2(Filter filter, double H[3])
{
    double mean = 0.5 * (H[0] + H[2]);
    double radius = math_hypot(0.5 * (H[0] - H[2]), H[1]);
    double low = mean - radius, high = mean + radius;
    if (low >= 0 || !filter_projects(filter))
        return false;
    double new_low = projected_eigenvalue(filter, low);
    double new_high = projected_eigenvalue(filter, high);
    double factor = high > low ? (new_high - new_low) / (high - low) : 0;
    H[0] = new_low + factor * (H[0] - low);
    H[1] = factor * H[1];
    H[2] = new_low + factor * (H[2] - low);
    return true;
}

#endif
