#include "solve/v_cycle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solve/grid_kernels.h"
#include "solve/v_cycle_kernels.h"

/* The coarsest level has at most so many cells a side, and this many
 * smoothings, an odd number. */
enum { COARSEST = 8, COARSEST_SMOOTHINGS = 7 };

/* Up to so many segments the cycle is in double precision. */
enum { PRECISE_SEGMENTS = 32 };

/* What kernels may read beyond the last plane. */
enum { V_SLACK = 128, V_ALIGNMENT = 64 };

/* Nanoseconds that a row takes for each of its nodes, about. */
static const double V_LIGHT = 0.4, V_HEAVY = 1.5;

struct VCycle {
    const Grid *grid;
    const VKernels *kernels;
    VLevel level[V_MAX_LEVELS]; /* the finest first */
    int levels;
    double length, mass; /* units, powers of two: 1/m, 1/kg */
};

/* Zeros for some planes of a level, or NULL. */
static void *v_planes(const VCycle *cycle, const VLevel *level, int planes)
{
    size_t count = (size_t)planes * (size_t)level->layout.plane + V_SLACK;
    size_t size = (count * cycle->kernels->real + V_ALIGNMENT - 1) /
                  V_ALIGNMENT * V_ALIGNMENT;
    void *array = aligned_alloc(V_ALIGNMENT, size);
    if (array)
        memset(array, 0, size);
    return array;
}

static bool create_v_level(const VCycle *cycle, int nodes, VLevel *level)
{
    level->layout = grid_layout(nodes);
    struct {
        void **array;
        int planes;
    } arrays[] = {{&level->m, 1}, {&level->free, 1}, {&level->D, 3},
                  {&level->b, 2}, {&level->x, 2},    {&level->r, 2}};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        if (!(*arrays[i].array = v_planes(cycle, level, arrays[i].planes)))
            return false;
    for (int kind = 0; kind < SPRING_KINDS; kind++)
        for (int t = 0; t < V_TENSOR; t++)
            if (!(level->K[kind][t] = v_planes(cycle, level, 1)))
                return false;
    return true;
}

VCycle *v_cycle_create(const Grid *grid)
{
    VCycle *cycle = calloc(1, sizeof *cycle);
    if (!cycle)
        return NULL;
    int n = grid->segments;
    cycle->grid = grid;
    cycle->kernels =
        v_cycle_kernels(grid->kernels->lanes, n <= PRECISE_SEGMENTS);
    for (bool more = true; more; n = (n + 1) / 2) {
        more = n > COARSEST;
        if (!create_v_level(cycle, n + 1, &cycle->level[cycle->levels++])) {
            v_cycle_free(cycle);
            return NULL;
        }
    }
    return cycle;
}

void v_cycle_free(VCycle *cycle)
{
    if (!cycle)
        return;
    for (int l = 0; l < cycle->levels; l++) {
        VLevel *level = &cycle->level[l];
        for (int kind = 0; kind < SPRING_KINDS; kind++)
            for (int t = 0; t < V_TENSOR; t++)
                free(level->K[kind][t]);
        void *arrays[] = {level->m, level->free, level->D,
                          level->b, level->x,    level->r};
        for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
            free(arrays[i]);
    }
    free(cycle);
}

typedef struct VCall {
    VKernel *kernel;
    const VJob *job;
} VCall;

static void call_v_kernel(const void *call, int first, int end)
{
    const VCall *c = call;
    c->kernel(c->job, first, end);
}

/* All rows of the level that the kernel writes to.
 *   cost  nanoseconds a node */
static void run_rows(const VCycle *cycle, VKernel *kernel, VJob job,
                     const VLevel *writes, double cost)
{
    job.grid = cycle->grid;
    job.length = cycle->length;
    job.mass = cycle->mass;
    VCall call = {kernel, &job};
    int rows = writes->layout.nodes;
    crew_run(cycle->grid->crew, call_v_kernel, &call, rows,
             cost * rows * (double)rows);
}

/* A power of two near 1/a. */
static double unit_of(double a)
{
    return ldexp(1, -ilogb(a));
}

void v_cycle_set_nodes(VCycle *cycle)
{
    const VKernels *kernels = cycle->kernels;
    cycle->mass = unit_of(cycle->grid->lightest);
    VLevel *level = cycle->level;
    run_rows(cycle, kernels->set_nodes, (VJob){.level = level}, level, V_LIGHT);
    for (; level + 1 < cycle->level + cycle->levels; level++)
        run_rows(cycle, kernels->coarsen_nodes,
                 (VJob){.level = level, .coarse = level + 1}, level + 1,
                 V_HEAVY);
}

void v_cycle_set_up(VCycle *cycle)
{
    const VKernels *kernels = cycle->kernels;
    VLevel *level = cycle->level;
    cycle->length = unit_of(sqrt(cycle->grid->rest[SPRING_DIAGONAL]));
    run_rows(cycle, kernels->tensors, (VJob){.level = level}, level,
             4 * V_HEAVY);
    for (int l = 0; l < cycle->levels; l++, level++) {
        VJob job = {.level = level, .coarse = level + 1};
        run_rows(cycle, kernels->invert, job, level, V_HEAVY);
        if (l + 1 < cycle->levels)
            run_rows(cycle, kernels->coarsen_tensors, job, level + 1,
                     4 * V_HEAVY);
    }
}

/* Smoothings from x to r and back, so many; returns where the result is. */
static void *v_smooth(const VCycle *cycle, const VLevel *level, int times)
{
    void *from = level->x, *to = level->r;
    for (int i = 0; i < times; i++) {
        run_rows(cycle, cycle->kernels->smooth,
                 (VJob){.level = level, .in = from, .out = to}, level, V_HEAVY);
        void *swap = from;
        from = to;
        to = swap;
    }
    return from;
}

/* From level->b; returns where the result is. */
static void *v_descend(const VCycle *cycle, int l)
{
    const VKernels *kernels = cycle->kernels;
    const VLevel *level = &cycle->level[l], *coarse = level + 1;
    VJob job = {.level = level, .coarse = coarse};
    run_rows(cycle, kernels->begin, job, level, V_LIGHT);
    if (l == cycle->levels - 1)
        return v_smooth(cycle, level, COARSEST_SMOOTHINGS - 1);
    job.in = level->x;
    job.out = level->r;
    run_rows(cycle, kernels->residual, job, level, V_HEAVY);
    job.in = level->r;
    run_rows(cycle, kernels->restrict_, job, coarse, V_HEAVY);
    job.in = v_descend(cycle, l + 1);
    run_rows(cycle, kernels->prolong, job, level, V_LIGHT);
    return v_smooth(cycle, level, 1);
}

void v_cycle_apply(VCycle *cycle, const double *r, double size, double *z)
{
    const VLevel *level = cycle->level;
    double unit = size > 0 && isfinite(size) ? unit_of(size) : 1;
    run_rows(cycle, cycle->kernels->take,
             (VJob){.level = level, .in = r, .factor = unit}, level, V_LIGHT);
    const void *x = v_descend(cycle, 0);
    run_rows(
        cycle, cycle->kernels->give,
        (VJob){.level = level, .in = x, .out = z, .factor = cycle->mass / unit},
        level, V_LIGHT);
}
