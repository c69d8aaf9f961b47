#include "solve/v_cycle_kernels.h"

#include "base/wide.h"

#define OF v

/* Registers of 16 bytes. */
#define TARGET
#define REAL  double
#define WIDTH 2
#include "solve/v_cycle_kernels.inc"
#undef REAL
#undef WIDTH
#define REAL  float
#define WIDTH 4
#include "solve/v_cycle_kernels.inc"
#undef REAL
#undef WIDTH
#undef TARGET

#if defined(__x86_64__)
/* Registers of 32 bytes. */
#define TARGET TARGET_4
#define REAL   double
#define WIDTH  4
#include "solve/v_cycle_kernels.inc"
#undef REAL
#undef WIDTH
#define REAL  float
#define WIDTH 8
#include "solve/v_cycle_kernels.inc"
#undef REAL
#undef WIDTH
#undef TARGET

/* Registers of 64 bytes. */
#define TARGET TARGET_8
#define REAL   double
#define WIDTH  8
#include "solve/v_cycle_kernels.inc"
#undef REAL
#undef WIDTH
#define REAL  float
#define WIDTH 16
#include "solve/v_cycle_kernels.inc"
#undef REAL
#undef WIDTH
#undef TARGET
#endif

#undef OF

const VKernels *v_cycle_kernels(int lanes, bool precise)
{
#if defined(__x86_64__)
    if (lanes == 8)
        return precise ? &kernels_v_double8 : &kernels_v_float16;
    if (lanes == 4)
        return precise ? &kernels_v_double4 : &kernels_v_float8;
#endif
    (void)lanes;
    return precise ? &kernels_v_double2 : &kernels_v_float4;
}
