#include "solve/grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* Bytes of a cache line, of the pages of memory, and how many lines one array
 * starts further than the one before. */
enum { LINE = 64, SMALL_PAGE = 4096, LARGE_PAGE = 2 << 20, STAGGER = 5 };

Rows rows_of(int nodes)
{
    int even = (nodes + 1) / 2;
    int half = (even + PADDED) / PADDED * PADDED; /* and a ghost */
    return (Rows){.nodes = nodes,
                  .count = {even, nodes / 2},
                  .half = half,
                  .pitch = 2 * half,
                  .plane = 2 * half * (nodes + 3)};
}

void *memory_piece(Memory *memory, size_t bytes)
{
    char *piece = memory->base ? memory->base + memory->used : NULL;
    bytes = (bytes + SMALL_PAGE - 1) / SMALL_PAGE * SMALL_PAGE;
    memory->used += bytes + STAGGER * LINE;
    return piece;
}

Status memory_create(Memory *memory)
{
    size_t page = memory->used < LARGE_PAGE ? SMALL_PAGE : LARGE_PAGE;
    size_t bytes = (memory->used + page) / page * page;
    memory->used = 0;
    memory->base = aligned_alloc(page, bytes);
    if (!memory->base)
        return STATUS_OUT_OF_MEMORY;
#ifdef MADV_HUGEPAGE
    if (page == LARGE_PAGE)
        madvise(memory->base, bytes, MADV_HUGEPAGE); /* may be refused */
#endif
    memset(memory->base, 0, bytes);
    return STATUS_OK;
}

void grid_lay_out(int segments, Memory *memory, Grid *grid)
{
    *grid = (Grid){.rows = rows_of(segments + 1),
                   .segments = segments,
                   .bands = segments / BAND + 1};
    size_t plane = (size_t)grid->rows.plane * sizeof(double);
    size_t shifts = ((size_t)segments + 2) * sizeof(int);
    double **vectors[] = {&grid->x, &grid->x_tilde, &grid->u_tilde,
                          &grid->away};
    for (int i = 0; i < 4; i++)
        *vectors[i] = memory_piece(memory, 2 * plane);
    for (int kind = 0; kind < KINDS; kind++) {
        grid->c[kind] = memory_piece(memory, plane);
        grid->l2[kind] = memory_piece(memory, plane);
    }
    grid->m = memory_piece(memory, plane);
    grid->per_m = memory_piece(memory, plane);
    grid->node_shift = memory_piece(memory, shifts);
    grid->spring_shift = memory_piece(memory, shifts);
    grid->sums = memory_piece(memory, (size_t)grid->bands * MAX_SUMS *
                                          sizeof *grid->sums);
}

/* Row i has written its numbers to the row `at`: where they are those of the
 * row before, the next one may write there.  Returns where that one writes. */
static int share_row(const Rows *rows, double *const *array, int arrays, int at)
{
    for (int a = 0; a < arrays; a++) {
        const double *row = array[a] + place_of(rows, at, 0);
        if (at == 0 ||
            memcmp(row, row - rows->pitch, (size_t)rows->pitch * sizeof *row))
            return at + 1;
    }
    return at;
}

double unit_of(double a)
{
    return a > 0 && isfinite(a) ? ldexp(1, -ilogb(a)) : 1;
}

static void read_nodes(Grid *grid, const System *system, const double *m)
{
    const Rows *rows = &grid->rows;
    double *const arrays[] = {grid->m, grid->per_m};
    grid->lightest = INFINITY;
    for (int k = 0; k < rows->nodes * rows->nodes; k++)
        if (!system->pinned[k])
            grid->lightest = fmin(grid->lightest, m[2 * k]);
    grid->mass = unit_of(grid->lightest);
    grid->lightest *= grid->mass;
    for (int i = 0, node = 0, at = 0; i < rows->nodes; i++) {
        for (int j = 0; j < rows->nodes; j++, node++) {
            bool held = system->pinned[node];
            int q = place_of(rows, at, j);
            grid->m[q] = grid->mass * m[2 * node];
            grid->per_m[q] = held ? 0 : 1 / grid->m[q];
        }
        int next = share_row(rows, arrays, 2, at);
        grid->node_shift[i] = (next - 1 - i) * rows->pitch;
        at = next;
    }
}

/* Of the springs of a kind, in the order of square_mesh.h: the one that starts
 * at node (i, j), or -1. */
static int spring_at(int n, int kind, int i, int j)
{
    int cell = 2 * n * (n + 1) + 2 * (i * n + j);
    if (i == n && kind != UP)
        return -1;
    switch (kind) {
    case RIGHT:
        return i * (n + 1) + j;
    case UP:
        return j < n ? n * (n + 1) + i * n + j : -1;
    case DIAGONAL:
        return j < n ? cell : -1;
    default:
        return j > 0 ? cell - 1 : -1;
    }
}

static void read_springs(Grid *grid, const double *k, const double *l2,
                         double weight)
{
    const Rows *rows = &grid->rows;
    int n = grid->segments;
    double unit, *arrays[2 * KINDS];
    for (int kind = 0; kind < KINDS; kind++) {
        arrays[kind] = grid->c[kind];
        arrays[KINDS + kind] = grid->l2[kind];
    }
    grid->length = unit_of(sqrt(l2[spring_at(n, DIAGONAL, 0, 0)]));
    unit = grid->length * grid->length;
    for (int i = 0, at = 0; i <= n; i++) {
        for (int j = 0; j <= n; j++)
            for (int kind = 0; kind < KINDS; kind++) {
                int s = spring_at(n, kind, i, j), q = place_of(rows, at, j);
                double c = s < 0 ? 0 : 2 * weight * k[s] / l2[s];
                grid->c[kind][q] = grid->mass / unit * c;
                grid->l2[kind][q] = s < 0 ? 0 : unit * l2[s];
            }
        int next = share_row(rows, arrays, 2 * KINDS, at);
        grid->spring_shift[i + 1] = (next - 1 - i) * rows->pitch;
        at = next;
    }
}

void grid_read_system(Grid *grid, const Iterate *at, const double *m)
{
    Place place = place_at(at->E.system, at->E.x_n, at->u, at->x);
    read_nodes(grid, at->E.system, m);
    read_springs(grid, place.k, place.l2, at->E.weight);
}

void grid_read_state(Grid *grid, const Iterate *at, const double *u_tilde)
{
    const Rows *rows = &grid->rows;
    const unsigned char *pinned = at->E.system->pinned;
    const double unit = grid->length;
    for (int i = 0, node = 0; i < rows->nodes; i++)
        for (int j = 0; j < rows->nodes; j++, node++) {
            int q = place_of(rows, i, j);
            bool held = pinned[node];
            for (int k = 2 * node; k < 2 * node + 2; k++, q += rows->plane) {
                double to = held ? at->u[k] : u_tilde[k];
                grid->x[q] = unit * at->x[k];
                grid->u_tilde[q] = unit * to;
                grid->x_tilde[q] = unit * (at->E.x_n[k] + to);
                grid->away[q] = unit * (at->u[k] - to);
            }
        }
}

void grid_write_state(const Grid *grid, Iterate *at)
{
    const Rows *rows = &grid->rows;
    const double metre = 1 / grid->length;
    for (int i = 0, node = 0; i < rows->nodes; i++)
        for (int j = 0; j < rows->nodes; j++, node++) {
            int q = place_of(rows, i, j);
            for (int k = 2 * node; k < 2 * node + 2; k++, q += rows->plane) {
                at->u[k] = metre * (grid->u_tilde[q] + grid->away[q]);
                at->x[k] = at->E.x_n[k] + at->u[k];
            }
        }
}
