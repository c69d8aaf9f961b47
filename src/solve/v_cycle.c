#include "solve/v_cycle.h"

#include <math.h>
#include <stdlib.h>

#include "solve/grid_kernels.h"
#include "solve/v_cycle_kernels.h"

/* The coarsest of two levels or more has at most so many cells a side, and
 * this many smoothings, an odd number. */
enum { COARSEST = 8, COARSEST_SMOOTHINGS = 7 };

/* Shares of a block Jacobi step.  No eigenvalue of D A is above 2, since
 * d.K d <= 2 (a.K a + b.K b) for d = a - b; the coarser level takes care of
 * those below 1/2, about.  The finest level smooths once before it goes to the
 * coarser one, and once after.  The others, which cost little, smooth twice, so
 * that their result is nearly the exact one; their shares are 1 over the roots
 * of Chebyshev's polynomial of degree 2 for eigenvalues 1/2 ... 2. */
static const double OMEGA_FINEST = 0.7, OMEGA[2] = {0.5617, 1.389};

/* Up to so many segments the cycle is in double precision. */
enum { PRECISE_SEGMENTS = 32 };

/* What kernels may read beyond the last plane. */
enum { V_SLACK = 128 };

/* Nanoseconds that a row takes for each of its nodes, about. */
static const double V_LIGHT = 0.4, V_HEAVY = 1.5;

/* Where a level is larger than the cache that is near, loops that follow each
 * other go through it in panels, whose tensors have so many bytes; at least so
 * many rows, an even number. */
enum { PANEL_BYTES = 1 << 18, LEAST_ROWS = 8 };

/* Loops that follow each other at most. */
enum { V_MAX_STAGES = 3 };

struct VCycle {
    const Grid *grid;
    const VKernels *kernels;
    VLevel level[V_MAX_LEVELS]; /* the finest first */
    int levels;
    double length, mass; /* units, powers of two: 1/m, 1/kg */
    double unit;         /* of r */
    double now, bend;    /* its r.z and z.H z */
    double beta, alpha;  /* d = z + beta d, p += alpha d */
    bool first;          /* no step yet: p is 0, and d nothing */
    double *sums;        /* [rows * V_SUMS] */
};

/* Every array of a level, with how many planes it has, in one piece. */
static bool create_v_level(const VCycle *cycle, int nodes, VLevel *level)
{
    level->layout = grid_layout(nodes);
    int finest = level == cycle->level ? 2 : 0;
    for (int i = 0; i < 2; i++)
        level->omega[i] = finest ? OMEGA_FINEST : OMEGA[i];
    struct {
        void **array;
        int planes;
    } arrays[9 + SPRING_KINDS * V_TENSOR] = {
        {&level->m, 1},      {&level->D, 3},      {&level->b, 2},
        {&level->x, 2},      {&level->r, 2},      {&level->p, finest},
        {&level->d, finest}, {&level->y, finest}, {&level->w, finest}};
    int count = 9, planes = 0;
    for (int kind = 0; kind < SPRING_KINDS; kind++)
        for (int t = 0; t < V_TENSOR; t++, count++) {
            arrays[count].array = &level->K[kind][t];
            arrays[count].planes = 1;
        }
    for (int i = 0; i < count; i++)
        planes += arrays[i].planes;
    size_t real = cycle->kernels->real;
    size_t plane = (size_t)level->layout.plane * real;
    char *next =
        grid_memory((size_t)planes * plane + V_SLACK * real, &level->memory);
    for (int i = 0; i < count && next; i++) {
        *arrays[i].array = next;
        next += (size_t)arrays[i].planes * plane;
    }
    size_t lines =
        (size_t)(nodes / 2 + 1) * V_LINES * (size_t)level->layout.pitch;
    level->line = calloc(lines + V_SLACK, real);
    return next && level->line;
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
    cycle->sums = malloc((size_t)(n + 1) * V_SUMS * sizeof *cycle->sums);
    if (!cycle->sums) {
        v_cycle_free(cycle);
        return NULL;
    }
    for (bool more = true; more; n = (n + 1) / 2) {
        more = n > COARSEST || cycle->levels == 0;
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
        free(cycle->level[l].memory);
        free(cycle->level[l].line);
    }
    free(cycle->sums);
    free(cycle);
}

typedef struct VCall {
    VKernel *kernel;
    const VJob *job;
    int first;
} VCall;

static void call_v_kernel(const void *call, int first, int end)
{
    const VCall *c = call;
    c->kernel(c->job, c->first + first, c->first + end);
}

/* Rows first ... end - 1 of the level that the kernel writes to.
 *   cost  nanoseconds a node */
static void run_panel(const VCycle *cycle, VKernel *kernel, VJob job,
                      const VLevel *writes, int first, int end, double cost)
{
    if (first >= end)
        return;
    job.grid = cycle->grid;
    job.length = cycle->length;
    job.mass = cycle->mass;
    job.sums = cycle->sums;
    VCall call = {kernel, &job, first};
    crew_run(cycle->grid->crew, call_v_kernel, &call, end - first,
             cost * (end - first) * writes->layout.nodes);
}

/* All its rows. */
static void run_rows(const VCycle *cycle, VKernel *kernel, VJob job,
                     const VLevel *writes, double cost)
{
    run_panel(cycle, kernel, job, writes, 0, writes->layout.nodes, cost);
}

/* How far a panel reaches that begins at this row: what one loop leaves there
 * is still near when the next one reads it.  An even row, or past the last. */
static int panel_end(const VCycle *cycle, const VLevel *level, int first)
{
    size_t row = (size_t)level->layout.pitch * cycle->kernels->real;
    int rows = 2 * (int)(PANEL_BYTES / (2 * SPRING_KINDS * V_TENSOR * row));
    int end = first + (rows > LEAST_ROWS ? rows : LEAST_ROWS);
    return end < level->layout.nodes ? end : level->layout.nodes;
}

/* A loop over all rows of a level, one of several that follow each other. */
typedef struct VStage {
    VKernel *kernel;
    VJob job;
    double cost;
} VStage;

/* Does them panel by panel; each may read a row beyond its own of what the one
 * before it writes. */
static void run_stages(const VCycle *cycle, const VLevel *level,
                       const VStage *stage, int stages)
{
    int nodes = level->layout.nodes, done[V_MAX_STAGES] = {0};
    for (int end; done[0] < nodes;) {
        end = panel_end(cycle, level, done[0]);
        for (int s = 0; s < stages; s++) {
            int ready = end < nodes ? end - s : nodes;
            run_panel(cycle, stage[s].kernel, stage[s].job, level, done[s],
                      ready, stage[s].cost);
            done[s] = ready;
        }
    }
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
    cycle->length = unit_of(sqrt(cycle->grid->rest[SPRING_DIAGONAL]));
    for (int l = 0; l < cycle->levels; l++) {
        const VLevel *level = &cycle->level[l], *coarse = level + 1;
        VJob job = {.level = level, .coarse = coarse};
        int nodes = level->layout.nodes;
        for (int first = 0, end; first < nodes; first = end) {
            end = panel_end(cycle, level, first);
            if (l == 0)
                run_panel(cycle, kernels->tensors, job, level, first, end,
                          4 * V_HEAVY);
            run_panel(cycle, kernels->invert, job, level, first, end, V_HEAVY);
            if (l + 1 < cycle->levels)
                run_panel(
                    cycle, kernels->coarsen_tensors, job, coarse, first / 2,
                    end < nodes ? end / 2 : coarse->layout.nodes, 4 * V_HEAVY);
        }
    }
}

/* out is in after its smoothing number i. */
static VStage smoothing(const VCycle *cycle, const VLevel *level, int i,
                        void *in, void *out)
{
    VJob job = {
        .level = level, .in = in, .out = out, .factor = level->omega[i]};
    return (VStage){cycle->kernels->smooth, job, V_HEAVY};
}

/* The coarsest level: from x to r and back, until x is smooth. */
static void smooth_coarsest(const VCycle *cycle, const VLevel *level)
{
    VStage to_r = smoothing(cycle, level, 1, level->x, level->r);
    VStage to_x = smoothing(cycle, level, 0, level->r, level->x);
    for (int i = 1; i < COARSEST_SMOOTHINGS; i += 2) {
        run_stages(cycle, level, &to_r, 1);
        run_stages(cycle, level, &to_x, 1);
    }
}

/* What the last kernel has summed up in the rows of the finest level. */
static double sum_rows(const VCycle *cycle, int which)
{
    double sum = 0;
    for (int i = 0; i < cycle->level->layout.nodes; i++)
        sum += cycle->sums[i * V_SUMS + which];
    return sum;
}

/* From level->b and the first smoothing, level->x; returns where the result is.
 *   multiplied  of the finest level: level->w is A times it */
static void *v_descend(const VCycle *cycle, int l, bool multiplied)
{
    const VKernels *kernels = cycle->kernels;
    const VLevel *level = &cycle->level[l], *coarse = level + 1;
    if (l == cycle->levels - 1) {
        smooth_coarsest(cycle, level);
        return level->x;
    }
    bool once = l == 0;
    void *x = once ? level->x : level->r, *next = once ? level->r : level->x;
    VStage second = smoothing(cycle, level, 1, next, x);
    if (!once)
        run_stages(cycle, level, &second, 1);
    VJob descend = {.level = level, .coarse = coarse, .in = x};
    run_rows(cycle, kernels->descend, descend, coarse, 5 * V_HEAVY);
    VJob prolong = {.level = level, .coarse = coarse, .out = x};
    prolong.in = v_descend(cycle, l + 1, false);
    VJob multiply = {.level = level, .in = level->r, .out = level->w};
    VStage stage[] = {{kernels->prolong, prolong, V_LIGHT},
                      smoothing(cycle, level, 1, x, next),
                      {kernels->multiply, multiply, V_HEAVY}};
    if (!once)
        stage[2] = smoothing(cycle, level, 0, next, x);
    run_stages(cycle, level, stage, once && !multiplied ? 2 : 3);
    return level->r;
}

/* Takes s r as b of the finest level, and smooths once. */
static void take(VCycle *cycle, double s, const double *r, double size)
{
    const VLevel *level = cycle->level;
    cycle->unit = size > 0 && isfinite(size) ? unit_of(size) : 1;
    VJob job = {.level = level, .in = r, .factor = s * cycle->unit};
    VStage stage[] = {{cycle->kernels->take, job, V_LIGHT},
                      {cycle->kernels->begin, job, V_LIGHT}};
    run_stages(cycle, level, stage, 2);
}

/* Gives what has the units of B r. */
static void give(const VCycle *cycle, const void *x, double *out)
{
    const VLevel *level = cycle->level;
    VJob job = {.level = level,
                .in = x,
                .out = out,
                .factor = cycle->mass / cycle->unit};
    run_rows(cycle, cycle->kernels->give, job, level, V_LIGHT);
}

void v_cycle_apply(VCycle *cycle, const double *r, double size, double *z)
{
    take(cycle, 1, r, size);
    give(cycle, v_descend(cycle, 0, false), z);
}

/* z = B b, w = H z, and their products. */
static void precondition(VCycle *cycle)
{
    v_descend(cycle, 0, true);
    cycle->now = sum_rows(cycle, V_DOT);
    cycle->bend = sum_rows(cycle, V_BEND);
}

void v_solve_begin(VCycle *cycle, double s, const double *r, double size)
{
    take(cycle, s, r, size);
    cycle->first = true;
    precondition(cycle);
}

/* What was new is the last one. */
static void swap(void **now, void **last)
{
    void *was = *last;
    *last = *now;
    *now = was;
}

bool v_solve_step(VCycle *cycle, VRemainder *remainder)
{
    VLevel *level = cycle->level;
    double bend = cycle->bend; /* d.H d */
    if (!cycle->first)
        bend -= cycle->beta * cycle->now / cycle->alpha;
    cycle->alpha = cycle->now / bend;
    if (!(bend > 0) || !isfinite(cycle->alpha))
        return false;
    VJob job = {.level = level,
                .factor = cycle->alpha,
                .beta = cycle->beta,
                .first = cycle->first};
    run_rows(cycle, cycle->kernels->update, job, level, V_LIGHT);
    swap(&level->r, &level->d);
    swap(&level->w, &level->y);
    cycle->first = false;
    double largest = 0, units = cycle->mass / cycle->unit;
    for (int i = 0; i < level->layout.nodes; i++)
        largest = fmax(largest, cycle->sums[i * V_SUMS + V_LARGEST]);
    remainder->largest = units * largest;
    remainder->square =
        sum_rows(cycle, V_SQUARE) * cycle->mass / (cycle->unit * cycle->unit);
    return true;
}

void v_solve_next(VCycle *cycle)
{
    double last = cycle->now;
    precondition(cycle);
    cycle->beta = cycle->now / last;
}

void v_solve_end(const VCycle *cycle, double *p)
{
    if (cycle->first)
        grid_clear(cycle->grid, p);
    else
        give(cycle, cycle->level->p, p);
}
