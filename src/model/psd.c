#include "model/psd.h"

#include <math.h>

/* The eigenvalues are mean +- radius.  (H - low I)/(high - low) is the
 * projector on the eigenvector of the higher one. */
bool filter_2x2(Filter filter, double H[3])
{
    double mean = 0.5 * (H[0] + H[2]);
    double radius = hypot(0.5 * (H[0] - H[2]), H[1]);
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
