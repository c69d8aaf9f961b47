/* grid_kernels.h - the loops behind grid.h, once for each width of lanes.
 *
 * All have one shape: they do runs first ... end - 1 of a job's region, and
 * leave what they sum for each run.  So they can be shared among threads.
 */
#ifndef ELASTO_GRID_KERNELS_H
#define ELASTO_GRID_KERNELS_H

#include "solve/grid.h"

typedef struct GridJob {
    const Grid *grid;
    const GridRun *run;
    const double *in[3];
    double *out[2];
    double factor[2];
    bool clamped;
    double *sums; /* [runs * GRID_MAX_SUMS] */
} GridJob;

typedef void GridKernel(const GridJob *job, int first, int end);

/* in and out in the order of grid.h's arguments. */
struct GridKernels {
    int lanes;
    GridKernel *gradient, *product, *diagonal, *precondition, *direction;
    GridKernel *along, *in_plane, *move, *activity;
    GridKernel *dot, *inverse_mass_square, *largest, *combine;
};

/* Those for at most so many lanes that this processor has; 0: any number, but
 * at most what the environment variable ELASTO_LANES says. */
const GridKernels *grid_kernels(int lanes);

#endif
