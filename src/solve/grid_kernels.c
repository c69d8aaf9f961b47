#include "solve/grid_kernels.h"

#include <stdlib.h>

#include "base/wide.h"

#define OF grid

#define REAL double

#define WIDTH 2
#define TARGET
#include "solve/grid_kernels.inc"
#undef WIDTH
#undef TARGET

#if defined(__x86_64__)
#define WIDTH  4
#define TARGET TARGET_4
#include "solve/grid_kernels.inc"
#undef WIDTH
#undef TARGET

#define WIDTH  8
#define TARGET TARGET_8
#include "solve/grid_kernels.inc"
#undef WIDTH
#undef TARGET
#endif

#undef REAL

#undef OF

const GridKernels *grid_kernels(int lanes)
{
    const char *limit = getenv("ELASTO_LANES");
    int most = wide_doubles();
    if (lanes == 0)
        lanes = limit ? atoi(limit) : most;
    if (lanes > most)
        lanes = most;
#if defined(__x86_64__)
    if (lanes >= 8)
        return &kernels_grid_double8;
    if (lanes >= 4)
        return &kernels_grid_double4;
#endif
    return &kernels_grid_double2;
}
