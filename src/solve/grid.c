/* grid.c - the square's masses, springs and positions as arrays by rows. */
#include "solve/grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "model/spring_law.h"

/* Bytes of a cache line and of memory pages; GAP_CACHE_LINES is the number of
 * cache lines left free between two arrays. */
enum {
    CACHE_LINE_BYTES = 64,
    PAGE_BYTES = 4096,
    LARGE_PAGE_BYTES = 2 << 20,
    GAP_CACHE_LINES = 5
};

RowLayout make_row_layout(int nodes)
{
    int even = (nodes + 1) / 2;
    int half = (even + LANES) / LANES * LANES; /* with room for a ghost node */
    return (RowLayout){.nodes_per_side = nodes,
                       .column_count = {even, nodes / 2},
                       .odd_offset = half,
                       .pitch = 2 * half,
                       .plane_length = 2 * half * (nodes + 3)};
}

void *arena_take_piece(ArrayArena *memory, size_t bytes)
{
    char *piece = memory->base ? memory->base + memory->used_bytes : NULL;
    bytes = (bytes + PAGE_BYTES - 1) / PAGE_BYTES * PAGE_BYTES;
    memory->used_bytes += bytes + GAP_CACHE_LINES * CACHE_LINE_BYTES;
    return piece;
}

Status arena_allocate(ArrayArena *memory)
{
    size_t page =
        memory->used_bytes < LARGE_PAGE_BYTES ? PAGE_BYTES : LARGE_PAGE_BYTES;
    size_t bytes = (memory->used_bytes + page) / page * page;
    memory->used_bytes = 0;
    memory->base = aligned_alloc(page, bytes);
    if (!memory->base)
        return STATUS_OUT_OF_MEMORY;
#ifdef MADV_HUGEPAGE
    if (page == LARGE_PAGE_BYTES)
        madvise(memory->base, bytes,
                MADV_HUGEPAGE); /* a failure costs only time */
#endif
    memset(memory->base, 0, bytes);
    return STATUS_OK;
}

void grid_init(int segments, ArrayArena *memory, Grid *grid)
{
    *grid = (Grid){.rows = make_row_layout(segments + 1),
                   .segments = segments,
                   .band_count = segments / BAND_ROWS + 1};
    size_t plane = (size_t)grid->rows.plane_length * sizeof(double);
    size_t shifts = ((size_t)segments + 2) * sizeof(int);
    double **vectors[] = {&grid->x, &grid->x_tilde, &grid->u_tilde,
                          &grid->target_offset};
    for (int i = 0; i < 4; i++)
        *vectors[i] = arena_take_piece(memory, 2 * plane);
    for (int kind = 0; kind < SPRING_KINDS; kind++) {
        grid->c[kind] = arena_take_piece(memory, plane);
        grid->l2[kind] = arena_take_piece(memory, plane);
        grid->float_c[kind] = arena_take_piece(memory, plane / 2);
        grid->float_l2[kind] = arena_take_piece(memory, plane / 2);
    }
    grid->float_m = arena_take_piece(memory, plane / 2);
    grid->float_x = arena_take_piece(memory, plane);
    grid->m = arena_take_piece(memory, plane);
    grid->inverse_m = arena_take_piece(memory, plane);
    grid->mass_shift = arena_take_piece(memory, shifts);
    grid->spring_shift = arena_take_piece(memory, shifts);
}

/* Removes rows that equal the row before them.
 *   shift  [nodes_per_side] out, index shift from each row to its stored row */
static void remove_duplicate_rows(const RowLayout *rows, double *const *array,
                                  int arrays, int *shift)
{
    size_t bytes = (size_t)rows->pitch * sizeof **array;
    for (int i = 0, at = 0; i < rows->nodes_per_side; i++) {
        bool same = i > 0;
        int from = node_index(rows, i, 0), to = node_index(rows, at, 0);
        for (int a = 0; a < arrays && same; a++)
            same = !memcmp(array[a] + from, array[a] + to - rows->pitch, bytes);
        for (int a = 0; a < arrays && !same; a++)
            memmove(array[a] + to, array[a] + from, bytes);
        at += !same;
        shift[i] = (at - 1 - i) * rows->pitch;
    }
}

double power_of_two_scale(double a)
{
    return a > 0 && isfinite(a) ? ldexp(1, -ilogb(a)) : 1;
}

void grid_copy_from_system(Grid *grid, const Iterate *at, const double *m)
{
    const System *system = at->E.system;
    const EvalPoint point = make_eval_point(system, at->E.x_n, at->u, at->x);
    const RowLayout *rows = &grid->rows;
    double *const masses[] = {grid->m, grid->inverse_m};
    double unit, *springs[2 * SPRING_KINDS];
    grid->min_mass = INFINITY;
    grid->max_node_stiffness = 0;
    for (int k = 0; k < rows->nodes_per_side * rows->nodes_per_side; k++)
        if (!system->is_pinned[k])
            grid->min_mass = fmin(grid->min_mass, m[2 * k]);
    grid->mass_scale = power_of_two_scale(grid->min_mass);
    grid->min_mass *= grid->mass_scale;
    for (int i = 0, node = 0; i < rows->nodes_per_side; i++)
        for (int j = 0; j < rows->nodes_per_side; j++, node++) {
            int q = node_index(rows, i, j);
            grid->m[q] = grid->mass_scale * m[2 * node];
            grid->inverse_m[q] = system->is_pinned[node] ? 0 : 1 / grid->m[q];
            grid->float_m[q] = system->is_pinned[node] ? 0 : (float)grid->m[q];
        }
    remove_duplicate_rows(rows, masses, 2, grid->mass_shift);
    for (int kind = 0; kind < SPRING_KINDS; kind++) {
        springs[kind] = grid->c[kind];
        springs[SPRING_KINDS + kind] = grid->l2[kind];
    }
    grid->length_scale =
        power_of_two_scale(sqrt(point.l2[system->springs - 1]));
    unit = grid->length_scale * grid->length_scale;
    grid->energy_scale = grid->mass_scale * unit;
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * s;
        int a = e[0] < e[1] ? e[0] : e[1], b = e[0] < e[1] ? e[1] : e[0];
        int i = a / rows->nodes_per_side,
            q = node_index(rows, i, a % rows->nodes_per_side);
        int kind = i == b / rows->nodes_per_side   ? UP
                   : b - a == rows->nodes_per_side ? RIGHT
                   : b - a > rows->nodes_per_side  ? DIAGONAL
                                                   : ANTIDIAGONAL;
        double c =
            spring_hessian_factor(point.l2[s], at->E.weight * point.k[s]);
        grid->c[kind][q] = grid->mass_scale / unit * c;
        grid->l2[kind][q] = unit * point.l2[s];
    }
    remove_duplicate_rows(rows, springs, 2 * SPRING_KINDS,
                          grid->spring_shift + 1);
    for (int kind = 0; kind < SPRING_KINDS; kind++)
        for (int q = 0; q < rows->plane_length; q++) {
            double c = grid->c[kind][q], l2 = grid->l2[kind][q];
            grid->max_node_stiffness =
                fmax(grid->max_node_stiffness, 8 * c * l2);
            grid->float_c[kind][q] = (float)c;
            grid->float_l2[kind][q] = (float)l2;
        }
}

void grid_copy_from_state(Grid *grid, const Iterate *at, const double *u_tilde)
{
    const RowLayout *rows = &grid->rows;
    const unsigned char *pinned = at->E.system->is_pinned;
    const double unit = grid->length_scale;
    for (int i = 0, node = 0; i < rows->nodes_per_side; i++)
        for (int j = 0; j < rows->nodes_per_side; j++, node++) {
            int q = node_index(rows, i, j);
            bool held = pinned[node];
            for (int k = 2 * node; k < 2 * node + 2;
                 k++, q += rows->plane_length) {
                double to = held ? at->u[k] : u_tilde[k];
                grid->x[q] = unit * at->x[k];
                grid->u_tilde[q] = unit * to;
                grid->x_tilde[q] = unit * (at->E.x_n[k] + to);
                grid->target_offset[q] = unit * (at->u[k] - to);
            }
        }
}

void grid_copy_to_iterate(const Grid *grid, Iterate *at)
{
    const RowLayout *rows = &grid->rows;
    const double metre = 1 / grid->length_scale;
    for (int i = 0, node = 0; i < rows->nodes_per_side; i++)
        for (int j = 0; j < rows->nodes_per_side; j++, node++) {
            int q = node_index(rows, i, j);
            for (int k = 2 * node; k < 2 * node + 2;
                 k++, q += rows->plane_length) {
                at->u[k] = metre * (grid->u_tilde[q] + grid->target_offset[q]);
                at->x[k] = at->E.x_n[k] + at->u[k];
            }
        }
}
