/* tiles.c - minimisation of E tile by tile, where the square buckles. */
#include "solve/tiles.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "solve/grid_spring.h"

/* Number of rows of a tile, whose columns are LANES even and LANES odd ones. */
enum { TILE_ROWS = 4 };

/* Step lengths that are tried for a node besides 1. */
static const float OVER_RELAXED = 1.8f, SHORTER = 0.25f;

/* A node's block of the Hessian is not clamped if its determinant is larger
 * than this fraction of the squared trace. */
static const float DEFINITE = 0.0025f;

/* A round sweeps the tiles with at least SHARE of the largest activity.  A
 * sweep adds SPREAD of its change of E to the activity of the tiles around. */
static const double SHARE = 0.5, SPREAD = 0.1;

/* A direction of the whole square takes the time of DIRECTION_SWEEPS sweeps of
 * all tiles.  Rounds end when the decrease of E per sweep of a tile is below
 * WORTH times the mean: total decrease / (sweeps of tiles so far + sweeps in
 * the time of a direction). */
static const double DIRECTION_SWEEPS = 7, WORTH = 0.25;

/* Limit of the rounds, which rounding errors might continue for ever. */
enum { MAX_TILE_ROUNDS = 10000 };

void tiles_init(const Grid *grid, ArrayArena *memory, Tiles *tiles)
{
    int high = grid->segments / TILE_ROWS + 1;
    int wide = (grid->rows.column_count[0] + LANES - 1) / LANES;
    size_t count = (size_t)(high * wide + LANES - 1) / LANES * LANES;
    *tiles = (Tiles){.grid = grid, .rows = high, .columns = wide};
    tiles->activity = arena_take_piece(memory, count * sizeof *tiles->activity);
    tiles->last_change =
        arena_take_piece(memory, count * sizeof *tiles->last_change);
    tiles->active_tiles =
        arena_take_piece(memory, count * sizeof *tiles->active_tiles);
    size_t both = 2 * (size_t)grid->rows.plane_length * sizeof(float);
    tiles->u = arena_take_piece(memory, both);
    tiles->start_g = arena_take_piece(memory, both);
}

/* Tries three step lengths a, which change E by a q[0] + ... + a^4 q[3].
 * Returns the longest one that lowers E; 0: none.
 *   lower  out, the change of E */
INLINE float find_lowering_step(const float q[4], float *lower)
{
    const float far[3] = {SHORTER, 1, OVER_RELAXED};
    float go = 0;
    *lower = 0;
    for (int i = 0; i < 3; i++) {
        float a = far[i], E = a * (q[0] + a * (q[1] + a * (q[2] + a * q[3])));
        go = E < 0 ? a : go;
        *lower = E < 0 ? E : *lower;
    }
    return go;
}

/* Computes the sums over the springs of LANES nodes of a row.  A separate loop
 * is faster, since no iteration waits for another. */
INLINE void compute_spring_sums(const Tiles *tiles, NodeRange at,
                                bool has_tiny_moves, SpringSums of)
{
    const Grid *grid = tiles->grid;
    const ptrdiff_t plane = grid->rows.plane_length;
    const float *const ux = tiles->u, *const uy = ux + plane;
    EACH_FLOATS (NEXT(at, LANES)) {
        const ptrdiff_t q = at.first + e;
        Floats mass = FLOATS(grid->float_m, q);
        Floats sum[SUM_COUNT + 1] = {
            [GX] = FLOATS(tiles->start_g, q) + mass * FLOATS(ux, q),
            [GY] = FLOATS(tiles->start_g, q + plane) + mass * FLOATS(uy, q),
            [SUM_F] = mass};
#define ADD(kind, to, numbers)                                                 \
    {                                                                          \
        FloatSpring s = evaluate_float_spring(grid, kind, q, to, numbers);     \
        const Floats w[2] = {FLOATS(ux, q) - FLOATS(ux, q + (to)),             \
                             FLOATS(uy, q) - FLOATS(uy, q + (to))};            \
        add_spring_sums(s, has_tiny_moves ? w : NULL, sum);                    \
    }
        ALL_SPRINGS(ADD, at)
#undef ADD
        store_spring_sums(sum, e, of);
    }
}

/* Moves LANES nodes of a row that share no spring; adds E's changes to sum. */
INLINE void relax_nodes(const Tiles *tiles, NodeRange at, bool has_tiny_moves,
                        double *sum)
{
    const Grid *grid = tiles->grid;
    const ptrdiff_t plane = grid->rows.plane_length;
    float *const x = grid->float_x, *const y = x + plane;
    float *const ux = tiles->u, *const uy = ux + plane;
    SpringSums of;
    compute_spring_sums(tiles, at, has_tiny_moves, of);
    EACH_OF (NEXT(at, LANES)) {
        const ptrdiff_t q = at.first + e;
        float gx = of[GX][e], gy = of[GY][e], negative = of[SUM_NEGATIVE_F][e];
        float A = of[HXX][e], B = of[HXY][e], C = of[HYY][e], trace = A + C;
        bool good = (trace > 0) & (A * C - B * B > DEFINITE * trace * trace);
        float a = good ? A : A - negative, d = good ? C : C - negative;
        float det = a * d - B * B;
        bool moves = (det > 0) & (grid->float_m[q] > 0);
        float over = moves ? -1 / (det > 0 ? det : 1) : 0;
        float px = (d * gx - B * gy) * over, py = (a * gy - B * gx) * over;
        float along[4], lower;
        node_line_polynomial(of, e, px, py, along);
        float go = find_lowering_step(along, &lower);
        ux[q] += go * px;
        uy[q] += go * py;
        if (!has_tiny_moves) {
            x[q] += go * px;
            y[q] += go * py;
        }
        sum[e] += (double)lower;
    }
}

/* Moves each node of a tile once: even rows first, then odd rows, in each of
 * them the even columns first.  Returns the change of E. */
INLINE double relax_tile(const Tiles *tiles, int tile, bool has_tiny_moves)
{
    const Grid grid = *tiles->grid;
    int top = tile / tiles->columns * TILE_ROWS, column = tile % tiles->columns;
    double sum[LANES] = {0};
    for (int colour = 0; colour < 4; colour++)
        for (int i = top + colour / 2; i < top + TILE_ROWS; i += 2) {
            if (i >= grid.rows.nodes_per_side)
                break;
            NodeRange at = grid_get_node_range(&grid, i, colour % 2);
            at.first += column * LANES;
            if (at.first < at.end)
                relax_nodes(tiles, at, has_tiny_moves, sum);
        }
    return sum_lanes(sum);
}

/* Sweeps the tiles whose Tiles.activity, a change of E, is at most `activity`.
 * Tiles of one colour are not neighbours, so their order has no effect.
 *   visits  out, number of sweeps
 * Returns the change of E. */
FAST static double sweep_tiles(Tiles *tiles, double activity, int *visits)
{
    const int high = tiles->rows, wide = tiles->columns;
    double change = 0;
    *visits = 0;
    for (int colour = 0; colour < 4; colour++) {
        int count = 0;
        for (int i = colour / 2; i < high; i += 2)
            for (int j = colour % 2; j < wide; j += 2)
                if (tiles->activity[i * wide + j] <= activity)
                    tiles->active_tiles[count++] = i * wide + j;
        for (int t = 0; t < count; t++) {
            /* relax_tile is compiled for each value of the flag: faster. */
            int tile = tiles->active_tiles[t];
            tiles->last_change[tile] = tiles->has_tiny_moves
                                           ? relax_tile(tiles, tile, true)
                                           : relax_tile(tiles, tile, false);
        }
        for (int t = 0; t < count; t++) { /* neighbours become active */
            int tile = tiles->active_tiles[t], i = tile / wide, j = tile % wide;
            for (int a = i > 0 ? i - 1 : 0; a <= i + 1 && a < high; a++)
                for (int b = j > 0 ? j - 1 : 0; b <= j + 1 && b < wide; b++)
                    tiles->activity[a * wide + b] +=
                        SPREAD * tiles->last_change[tile];
            tiles->activity[tile] = tiles->last_change[tile];
            change += tiles->last_change[tile];
        }
        *visits += count;
    }
    tiles->sweeps += *visits;
    return change;
}

/* Starts a relaxation at the grid's x.
 *   g  [2 planes] out, grad E, only if has_tiny_moves */
INLINE void begin_relaxation(const Tiles *tiles, double *g)
{
    const Grid *grid = tiles->grid;
    const ptrdiff_t plane = grid->rows.plane_length;
    float *const start_g = tiles->start_g;
    grid_update_float_x(grid);
    memset(tiles->u, 0, 2 * (size_t)plane * sizeof(float));
    if (tiles->has_tiny_moves)
        grid_gradient(grid, g);
    narrow_array_to_single(tiles->has_tiny_moves ? g : grid->target_offset, 1,
                           0, 2 * plane, start_g);
    for (int c = 0; c < 2 && !tiles->has_tiny_moves; c++)
        EACH_OF (plane)
            start_g[c * plane + e] *= grid->float_m[e];
}

/* Returns the activity of the most active tile: the lowest number, since
 * activities are changes of E and <= 0. */
INLINE double find_lowest_activity(const Tiles *tiles)
{
    double low[LANES] = {0}, largest = 0;
    for (int t = 0; t < tiles->rows * tiles->columns; t += LANES)
        EACH_OF (LANES) { /* activity is 0 after the last tile */
            double activity = tiles->activity[t + e];
            low[e] = activity < low[e] ? activity : low[e];
        }
    for (int e = 0; e < LANES; e++)
        largest = low[e] < largest ? low[e] : largest;
    return largest;
}

FAST double tiles_relax(Tiles *tiles, double pace, double *p)
{
    int count = tiles->rows * tiles->columns, visits;
    double float_x_error = tiles->grid->segments * FLT_EPSILON;
    tiles->has_tiny_moves =
        pace > -tiles->grid->max_node_stiffness * float_x_error * float_x_error;
    begin_relaxation(tiles, p);
    for (int t = 0; t < count; t++)
        tiles->activity[t] = 0;
    const double first_change = sweep_tiles(tiles, 0, &visits);
    double change = first_change, sweeps = (1 + DIRECTION_SWEEPS) * count;
    for (int t = 0; t < count; t++)
        tiles->activity[t] = tiles->last_change[t];
    bool pays = change < 0;
    for (int round = 0; round < MAX_TILE_ROUNDS && pays; round++) {
        double least = SHARE * find_lowest_activity(tiles);
        double lowered = sweep_tiles(tiles, least, &visits);
        change += lowered;
        sweeps += visits;
        pays = lowered < fmin(pace, WORTH * change / sweeps) * visits;
    }
    EACH_OF (2 * tiles->grid->rows.plane_length)
        p[e] = (double)tiles->u[e];
    return first_change;
}
