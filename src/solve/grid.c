#include "solve/grid.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "solve/grid_kernels.h"

/* Bytes of the pages of memory. */
enum { SMALL_PAGE = 4096, LARGE_PAGE = 2 << 20 };

/* What kernels may read beyond the last row of ghosts, rounded up so that
 * arrays are whole cache lines. */
enum { GRID_SLACK = 64, GRID_ALIGNMENT = 64 };

GridLayout grid_layout(int nodes)
{
    int padded = (nodes + GRID_LEAD - 1) / GRID_LEAD * GRID_LEAD;
    int pitch = GRID_LEAD + padded;
    return (GridLayout){.nodes = nodes,
                        .pitch = pitch,
                        .blocks = (nodes + GRID_BLOCK - 1) / GRID_BLOCK,
                        .plane = pitch * (nodes + 2) + GRID_SLACK,
                        .offset = {pitch, 1, pitch + 1, pitch - 1}};
}

/* Whole cache lines of zeros. */
static void *create_lines(size_t bytes)
{
    bytes = (bytes + GRID_ALIGNMENT - 1) / GRID_ALIGNMENT * GRID_ALIGNMENT;
    void *lines = aligned_alloc(GRID_ALIGNMENT, bytes);
    return lines ? memset(lines, 0, bytes) : NULL;
}

void *grid_memory(size_t bytes, void **memory)
{
    if (bytes < LARGE_PAGE)
        return *memory = create_lines(bytes);
    char *start = *memory = calloc(1, bytes + GRID_ALIGNMENT);
    if (!start)
        return NULL;
#ifdef MADV_HUGEPAGE
    size_t past = (uintptr_t)start % SMALL_PAGE;
    madvise(start - past, bytes + past, MADV_HUGEPAGE); /* may be refused */
#endif
    return start + GRID_ALIGNMENT - (uintptr_t)start % GRID_ALIGNMENT;
}

/* Numbers in so many planes, and what may be read beyond. */
static size_t planes_bytes(const Grid *grid, int planes)
{
    return ((size_t)planes * (size_t)grid->layout.plane +
            2 * (size_t)GRID_SLACK) *
           sizeof(double);
}

double *grid_planes(const Grid *grid, int planes)
{
    return create_lines(planes_bytes(grid, planes));
}

double *grid_piece(const Grid *grid, int planes, void **memory)
{
    return grid_memory(planes_bytes(grid, planes), memory);
}

/* Every array of the grid, with how many planes it has, in one piece. */
static Status create_grid_arrays(Grid *grid)
{
    struct {
        double **array;
        int planes;
    } arrays[6 + 2 * SPRING_KINDS] = {{&grid->x, 2}, {&grid->x_n, 2},
                                      {&grid->u, 2}, {&grid->u_tilde, 2},
                                      {&grid->m, 1}, {&grid->per_mass, 1}};
    int count = 6, planes = 0;
    for (int kind = 0; kind < SPRING_KINDS; kind++) {
        double **springs[] = {&grid->c[kind], &grid->l2[kind]};
        for (int i = 0; i < 2; i++, count++) {
            arrays[count].array = springs[i];
            arrays[count].planes = 1;
        }
    }
    for (int i = 0; i < count; i++)
        planes += arrays[i].planes;
    double *next = grid_piece(grid, planes, &grid->memory);
    for (int i = 0; i < count && next; i++) {
        *arrays[i].array = next;
        next += arrays[i].planes * grid->layout.plane;
    }
    size_t runs = (size_t)grid->layout.nodes * (size_t)grid->layout.blocks;
    size_t rows = (size_t)grid->layout.nodes + 2; /* with ghosts */
    grid->sums = malloc(runs * GRID_MAX_SUMS * sizeof *grid->sums);
    grid->node_shift = calloc(rows, 2 * sizeof *grid->node_shift);
    grid->spring_shift = grid->node_shift ? grid->node_shift + rows : NULL;
    return next && grid->sums && grid->node_shift ? STATUS_OK
                                                  : STATUS_OUT_OF_MEMORY;
}

Status grid_create(int segments, int lanes, Grid *grid)
{
    *grid = (Grid){.segments = segments,
                   .layout = grid_layout(segments + 1),
                   .kernels = grid_kernels(lanes)};
    const GridLayout *layout = &grid->layout;
    Status status = create_grid_arrays(grid);
    if (!status)
        status = grid_region_create(grid, &grid->all);
    if (status)
        return status;
    GridRegion *all = &grid->all;
    for (all->runs = 0; all->runs < layout->nodes; all->runs++)
        all->run[all->runs] = (GridRun){all->runs, 0, layout->blocks};
    all->blocks = layout->nodes * layout->blocks;
    return STATUS_OK;
}

void grid_free(Grid *grid)
{
    if (!grid)
        return;
    free(grid->memory);
    free(grid->all.run);
    free(grid->sums);
    free(grid->node_shift);
    *grid = (Grid){0};
}

Status grid_region_create(const Grid *grid, GridRegion *region)
{
    *region = (GridRegion){0};
    size_t runs = (size_t)grid->layout.nodes * (size_t)grid->layout.blocks;
    region->run = malloc(runs * sizeof *region->run);
    return region->run ? STATUS_OK : STATUS_OUT_OF_MEMORY;
}

/* Row i has written its numbers to the row `at`: where they are those of the
 * row before, the next one may write there.  Returns where that one writes. */
static int share_row(const Grid *grid, double *const *array, int arrays, int i,
                     int at, int *shift)
{
    const GridLayout *layout = &grid->layout;
    bool alike = at > 0;
    for (int a = 0; a < arrays; a++) {
        const double *row = array[a] + grid_at(layout, at, 0);
        alike = alike && !memcmp(row, row - layout->pitch,
                                 (size_t)layout->nodes * sizeof *row);
    }
    shift[i + 1] = (at - alike - i) * layout->pitch;
    return at + !alike;
}

void grid_set_nodes(Grid *grid, const double *m, const unsigned char *pinned)
{
    const GridLayout *layout = &grid->layout;
    double *const arrays[] = {grid->m, grid->per_mass};
    grid->lightest = INFINITY;
    grid->pinned = false;
    for (int i = 0, at = 0; i < layout->nodes; i++) {
        for (int j = 0; j < layout->nodes; j++) {
            int node = i * layout->nodes + j, q = grid_at(layout, at, j);
            bool held = pinned && pinned[node];
            grid->m[q] = m[node];
            grid->per_mass[q] = held ? 0 : 1 / m[node];
            grid->pinned = grid->pinned || held;
            if (!held && m[node] < grid->lightest)
                grid->lightest = m[node];
        }
        at = share_row(grid, arrays, 2, i, at, grid->node_shift);
    }
}

/* Of the springs of a kind, in the order of square_mesh.h: the one that starts
 * at node (i, j), or -1. */
static int spring_at(int n, int kind, int i, int j)
{
    int cell = 2 * n * (n + 1) + 2 * (i * n + j);
    if (i == n && kind != SPRING_UP)
        return -1;
    switch (kind) {
    case SPRING_RIGHT:
        return i * (n + 1) + j;
    case SPRING_UP:
        return j < n ? n * (n + 1) + i * n + j : -1;
    case SPRING_DIAGONAL:
        return j < n ? cell : -1;
    default:
        return j > 0 ? cell - 1 : -1;
    }
}

/* The springs that start at (i, j); their numbers go to the row `at`. */
static void set_springs_of(Grid *grid, const double *k, const double *l2,
                           double weight, int i, int j, int at)
{
    int q = grid_at(&grid->layout, at, j);
    for (int kind = 0; kind < SPRING_KINDS; kind++) {
        int s = spring_at(grid->segments, kind, i, j);
        grid->c[kind][q] = s < 0 ? 0 : 2 * weight * k[s] / l2[s];
        if (!grid->uniform)
            grid->l2[kind][q] = s < 0 ? 0 : l2[s];
    }
}

/* Whether all springs of a kind are equally long. */
static bool is_uniform(const Grid *grid, const double *l2)
{
    int n = grid->segments;
    for (int kind = 0; kind < SPRING_KINDS; kind++)
        for (int i = 0; i <= n; i++)
            for (int j = 0; j <= n; j++) {
                int s = spring_at(n, kind, i, j);
                if (s >= 0 && l2[s] != grid->rest[kind])
                    return false;
            }
    return true;
}

void grid_set_springs(Grid *grid, const double *k, const double *l2,
                      double weight)
{
    int n = grid->segments;
    double *arrays[2 * SPRING_KINDS];
    for (int kind = 0; kind < SPRING_KINDS; kind++) {
        int first = spring_at(n, kind, 0, kind == SPRING_ANTIDIAGONAL);
        grid->rest[kind] = l2[first];
        arrays[kind] = grid->c[kind];
        arrays[SPRING_KINDS + kind] = grid->l2[kind];
    }
    grid->uniform = is_uniform(grid, l2);
    int count = grid->uniform ? SPRING_KINDS : 2 * SPRING_KINDS;
    for (int i = 0, at = 0; i <= n; i++) {
        for (int j = 0; j <= n; j++)
            set_springs_of(grid, k, l2, weight, i, j, at);
        at = share_row(grid, arrays, count, i, at, grid->spring_shift);
    }
}

void grid_pack(const Grid *grid, const double *from, double *to)
{
    const GridLayout *layout = &grid->layout;
    for (int i = 0; i < layout->nodes; i++) {
        double *x = to + grid_at(layout, i, 0), *y = x + layout->plane;
        for (int j = 0; j < layout->nodes; j++) {
            x[j] = *from++;
            y[j] = *from++;
        }
    }
}

void grid_unpack(const Grid *grid, const double *from, double *to)
{
    const GridLayout *layout = &grid->layout;
    for (int i = 0; i < layout->nodes; i++) {
        const double *x = from + grid_at(layout, i, 0), *y = x + layout->plane;
        for (int j = 0; j < layout->nodes; j++) {
            *to++ = x[j];
            *to++ = y[j];
        }
    }
}

/* ---- kernels ---- */

typedef struct GridCall {
    GridKernel *kernel;
    const GridJob *job;
} GridCall;

static void call_grid_kernel(const void *call, int first, int end)
{
    const GridCall *c = call;
    c->kernel(c->job, first, end);
}

/* Nanoseconds a block of nodes takes, about: it decides only who works. */
enum { GRID_LIGHT = 4, GRID_HEAVY = 20 };

/* Runs a kernel over a region and adds up what it has summed, run by run.
 *   sum  [sums] out */
static void run_kernel(GridKernel *kernel, GridJob job, const Grid *grid,
                       const GridRegion *region, int cost, int sums,
                       double *sum)
{
    if (!region)
        region = &grid->all;
    job.grid = grid;
    job.run = region->run;
    job.sums = grid->sums;
    GridCall call = {kernel, &job};
    crew_run(grid->crew, call_grid_kernel, &call, region->runs,
             (double)cost * region->blocks);
    for (int s = 0; s < sums; s++)
        sum[s] = 0;
    for (int r = 0; r < region->runs; r++)
        for (int s = 0; s < sums; s++)
            sum[s] += job.sums[r * GRID_MAX_SUMS + s];
}

double grid_gradient(const Grid *grid, const GridRegion *region, double *g)
{
    double sum;
    run_kernel(grid->kernels->gradient, (GridJob){.out = {g}}, grid, region,
               GRID_HEAVY, 1, &sum);
    return sum;
}

double grid_product(const Grid *grid, bool clamped, const double *q, double *y)
{
    double sum;
    GridJob job = {.in = {q}, .out = {y}, .clamped = clamped};
    run_kernel(grid->kernels->product, job, grid, NULL, 2 * GRID_HEAVY, 1,
               &sum);
    return sum;
}

void grid_diagonal(const Grid *grid, const GridRegion *region, double *D)
{
    run_kernel(grid->kernels->diagonal, (GridJob){.out = {D}}, grid, region,
               2 * GRID_HEAVY, 0, NULL);
}

double grid_precondition(const Grid *grid, const GridRegion *region,
                         const double *D, const double *old_g, double *g,
                         double *z, double *old)
{
    double sum[2];
    GridJob job = {.in = {D, old_g}, .out = {g, z}};
    run_kernel(grid->kernels->precondition, job, grid, region, GRID_HEAVY, 2,
               sum);
    *old = sum[1];
    return sum[0];
}

double grid_direction(const Grid *grid, const GridRegion *region,
                      const double *z, double beta, const double *g, double *p,
                      double *inertia)
{
    double sum[2];
    GridJob job = {.in = {z, g}, .out = {p}, .factor = {beta}};
    run_kernel(grid->kernels->direction, job, grid, region, GRID_LIGHT, 2, sum);
    *inertia = sum[1];
    return sum[0];
}

void grid_along(const Grid *grid, const GridRegion *region, const double *p,
                double slope, double inertia, double q[4])
{
    double sum[3];
    run_kernel(grid->kernels->along, (GridJob){.in = {p}}, grid, region,
               GRID_HEAVY, 3, sum);
    q[0] = slope;
    q[1] = 0.25 * sum[0] + 0.5 * inertia;
    q[2] = 0.5 * sum[1];
    q[3] = 0.25 * sum[2];
}

void grid_in_plane(const Grid *grid, const double *g, const double *p,
                   const double *r, double c[14])
{
    run_kernel(grid->kernels->in_plane, (GridJob){.in = {g, p, r}}, grid, NULL,
               2 * GRID_HEAVY, 14, c);
}

void grid_move(const Grid *grid, const GridRegion *region, double a,
               const double *p, double b, double *r)
{
    run_kernel(grid->kernels->move,
               (GridJob){.in = {p}, .out = {r}, .factor = {a, b}}, grid, region,
               GRID_LIGHT, 0, NULL);
}

void grid_activity(const Grid *grid, const GridRegion *region, const double *D,
                   const double *g, double *activity)
{
    run_kernel(grid->kernels->activity,
               (GridJob){.in = {D, g}, .out = {activity}}, grid, region,
               GRID_LIGHT, 0, NULL);
}

void grid_clear(const Grid *grid, double *a)
{
    memset(a, 0, 2 * (size_t)grid->layout.plane * sizeof *a);
}

void grid_region_clear(const Grid *grid, const GridRegion *region, double *a)
{
    for (int r = 0; r < region->runs; r++)
        for (int c = 0; c < 2; c++)
            memset(a + c * grid->layout.plane +
                       grid_start(&grid->layout, region->run[r]),
                   0, GRID_BLOCK * (size_t)region->run[r].blocks * sizeof *a);
}

double grid_dot(const Grid *grid, const double *a, const double *b)
{
    double sum;
    run_kernel(grid->kernels->dot, (GridJob){.in = {a, b}}, grid, NULL,
               GRID_LIGHT, 1, &sum);
    return sum;
}

double grid_inverse_mass_square(const Grid *grid, const double *a)
{
    double sum;
    run_kernel(grid->kernels->inverse_mass_square, (GridJob){.in = {a}}, grid,
               NULL, GRID_LIGHT, 1, &sum);
    return sum;
}

double grid_largest(const Grid *grid, const double *a)
{
    double largest = 0;
    run_kernel(grid->kernels->largest, (GridJob){.in = {a}}, grid, NULL,
               GRID_LIGHT, 0, NULL);
    for (int r = 0; r < grid->all.runs; r++)
        largest = fmax(largest, grid->sums[r * GRID_MAX_SUMS]);
    return largest;
}

void grid_combine(const Grid *grid, const GridRegion *region, double alpha,
                  const double *x, double beta, double *y)
{
    run_kernel(grid->kernels->combine,
               (GridJob){.in = {x}, .out = {y}, .factor = {alpha, beta}}, grid,
               region, GRID_LIGHT, 0, NULL);
}
