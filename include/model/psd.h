/* psd.h - projection of the Hessian's blocks to positive semi-definite ones
 * (slide utils.py, make_PSD).
 *
 * The eigenvectors of each energy are known, so no energy needs the eigenvalue
 * routine of the slide.  Springs use spring_hessian (spring_law.h). */
#pragma once

#include <stdbool.h>

#include "base/mathematics.h"

/* How the negative eigenvalues of a block are treated. */
typedef enum Projection {
    PROJECTION_CLAMP,     /* negative eigenvalues become 0, as on the slides */
    PROJECTION_NONE,      /* negative eigenvalues stay */
    PROJECTION_ABS,       /* eigenvalues become their absolute values */
    PROJECTION_ON_DEMAND, /* as NONE; after a failed Cholesky factorisation
                             of the whole Hessian as CLAMP for some
                             iterations */
    PROJECTION_COUNT
} Projection;

/* Whether the negative eigenvalues of each block are replaced. */
static inline bool projects_blocks(Projection projection)
{
    return projection == PROJECTION_CLAMP || projection == PROJECTION_ABS;
}

/* Returns the eigenvalue that replaces `value` with CLAMP or ABS. */
static inline double project_eigenvalue(Projection projection, double value)
{
    return value >= 0 ? value : projection == PROJECTION_ABS ? -value : 0;
}

/* Projects a symmetric 2x2 matrix.  The eigenvalues are mean +- radius, and
 * (H - low I)/(high - low) projects on the eigenvector of `high`.  A matrix
 * without negative eigenvalues keeps its bits.
 *   H  [3] in/out: H_xx, H_xy, H_yy
 * Returns whether an eigenvalue was changed. */
static inline bool project_psd_2x2(Projection projection, double H[3])
{
    double mean = 0.5 * (H[0] + H[2]);
    double radius = math_hypot(0.5 * (H[0] - H[2]), H[1]);
    double low = mean - radius, high = mean + radius;
    if (low >= 0 || !projects_blocks(projection))
        return false;
    double new_low = project_eigenvalue(projection, low);
    double new_high = project_eigenvalue(projection, high);
    double factor = high > low ? (new_high - new_low) / (high - low) : 0;
    H[0] = new_low + factor * (H[0] - low);
    H[1] = factor * H[1];
    H[2] = new_low + factor * (H[2] - low);
    return true;
}
