/* v_cycle_kernels.h - the loops of a V-cycle over the rows of a level, for
 * each precision and width of lanes. */
#ifndef ELASTO_V_CYCLE_KERNELS_H
#define ELASTO_V_CYCLE_KERNELS_H

#include <stddef.h>

#include "solve/grid.h"

enum { V_MAX_LEVELS = 12, V_TENSOR = 3 };

/* Lines of a row of the coarse level that a kernel works with. */
enum { V_LINES = 6 };

/* A level; all arrays have planes of numbers of the cycle's precision. */
typedef struct VLevel {
    GridLayout layout;
    void *memory;                    /* all of these */
    void *K[SPRING_KINDS][V_TENSOR]; /* [plane] xx, xy, yy of springs */
    void *m;                         /* [plane] masses; 0: pinned or outside */
    void *D;                         /* [3 planes] inverse diagonal blocks */
    void *b, *x, *r;                 /* [2 planes] */
    void *p, *d, *y, *w; /* [2 planes] of conjugate gradients on the finest
                            level: r is z = B b, w = A z, y = A d */
    void *line;          /* [rows of the coarser level * V_LINES * pitch] */
    double omega[2];     /* share of a block Jacobi step, by smoothing */
} VLevel;

/* What kernels sum up in each row, or find the largest of. */
enum { V_SUMS = 4 };
enum { V_DOT, V_BEND, V_SQUARE, V_LARGEST };

/* Partial sums of a row. */
enum { V_PARTIAL = 16 };

typedef struct VJob {
    const Grid *grid;
    const VLevel *level, *coarse; /* the next coarser one */
    double length, mass;          /* units, powers of two: 1/m, 1/kg */
    const void *in;               /* [2 planes] */
    void *out;                    /* [2 planes] */
    double factor;
    double beta;
    bool first;   /* of conjugate gradients: d, y and p hold nothing */
    double *sums; /* [rows * V_SUMS] */
} VJob;

/* Each does rows first ... end - 1: of the level, or of the coarse one where it
 * writes to that. */
typedef void VKernel(const VJob *job, int first, int end);

typedef struct VKernels {
    size_t real;                        /* bytes of a number */
    VKernel *set_nodes, *coarsen_nodes; /* m */
    VKernel *tensors, *coarsen_tensors; /* K */
    VKernel *invert;                    /* D */
    VKernel *take;     /* b = factor in, doubles of the grid's layout */
    VKernel *begin;    /* x = omega[0] D b */
    VKernel *descend;  /* coarse->b = P^T (b - A in), and there begin */
    VKernel *prolong;  /* out += P in, in on the coarse level */
    VKernel *smooth;   /* out = in + factor D (b - A in), DOT b.out */
    VKernel *give;     /* out = factor in, doubles */
    VKernel *multiply; /* out = A in, BEND in.out */
    VKernel *update;   /* r += beta d, w += beta y, p += factor r,
                          b -= factor w, and begin; SQUARE |b|_(m^-1)^2,
                          LARGEST of p */
} VKernels;

/* Those for a grid's lanes.  precise: double precision. */
const VKernels *v_cycle_kernels(int lanes, bool precise);

#endif
