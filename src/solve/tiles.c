/* tiles.c - minimisation of E tile by tile, where folds run through the
 * square.
 */
#include "solve/tiles.h"

#include "solve/grid_spring.h"

/* Number of rows of a tile, whose columns are LANES even and LANES odd ones. */
enum { TILE_ROWS = 4 };

/* Step lengths that are tried for a node besides 1. */
static const double OVER_RELAXED = 1.8, SHORTER = 0.25;

/* A node's block of the Hessian is not clamped if its determinant is larger
 * than this share of its trace's square. */
static const double DEFINITE = 0.0025;

/* A round sweeps the tiles with at least SHARE of the largest activity.  A
 * sweep adds SPREAD of its change of E to the activity of the tiles around.
 * Rounds end when no activity is STANDS_OUT times the mean. */
static const double SHARE = 0.4, SPREAD = 0.25, STANDS_OUT = 2;

/* Limit of the rounds, which rounding of E could keep from ending. */
enum { MAX_ROUNDS = 10000 };

void tiles_lay_out(const Grid *grid, Memory *memory, Tiles *tiles)
{
    int high = grid->segments / TILE_ROWS + 1;
    int wide = (grid->rows.count[0] + LANES - 1) / LANES;
    size_t count = (size_t)high * (size_t)wide;
    *tiles = (Tiles){.grid = grid, .rows = high, .columns = wide};
    tiles->activity =
        memory_take_piece(memory, count * sizeof *tiles->activity);
    tiles->change = memory_take_piece(memory, count * sizeof *tiles->change);
    tiles->chosen = memory_take_piece(memory, count * sizeof *tiles->chosen);
}

/* Returns the longest of three step lengths a that lower E, or 0; E changes by
 * a q[0] + ... + a^4 q[3].
 *   lower  out, the change of E */
INLINE double find_lowering_step(const double q[4], double *lower)
{
    const double far[3] = {SHORTER, 1, OVER_RELAXED};
    double go = 0;
    *lower = 0;
    for (int i = 0; i < 3; i++) {
        double a = far[i], E = a * (q[0] + a * (q[1] + a * (q[2] + a * q[3])));
        go = E < 0 ? a : go;
        *lower = E < 0 ? E : *lower;
    }
    return go;
}

/* Moves LANES nodes of a row that share no spring; adds E's changes to sum. */
INLINE void relax_nodes(const Grid *grid, NodeRun at, double *sum)
{
    const int plane = grid->rows.plane;
    const double *const tx = grid->x_tilde, *const ty = tx + plane;
    double *const x = grid->x, *const y = x + plane;
    double *const ax = grid->from_target, *const ay = ax + plane;
    NodeSums of;
    gather_springs(grid, at, of);
    EACH_OF (NEXT(at, LANES)) {
        const int q = at.first + e;
        double gx = of[GX][e], gy = of[GY][e], negative = of[NEGATIVE][e];
        double A = of[XX][e], B = of[XY][e], C = of[YY][e], trace = A + C;
        bool good = (trace > 0) & (A * C - B * B > DEFINITE * trace * trace);
        double a = good ? A : A - negative, d = good ? C : C - negative;
        double det = a * d - B * B;
        bool moves = (det > 0) & (grid->inverse_m[q + at.node] > 0);
        double over = moves ? -1 / (det > 0 ? det : 1) : 0;
        double px = (d * gx - B * gy) * over, py = (a * gy - B * gx) * over;
        double along[4], lower;
        node_line_polynomial(of, e, px, py, along);
        double go = find_lowering_step(along, &lower);
        double to_x = ax[q] + go * px, to_y = ay[q] + go * py;
        ax[q] = to_x;
        ay[q] = to_y;
        x[q] = tx[q] + to_x;
        y[q] = ty[q] + to_y;
        sum[e] += lower;
    }
}

/* Moves each node of a tile once: even rows first, then odd rows, in each of
 * them the even columns first.  Returns the change of E. */
INLINE double relax_tile(const Tiles *tiles, int tile)
{
    const Grid grid = *tiles->grid;
    int top = tile / tiles->columns * TILE_ROWS, column = tile % tiles->columns;
    double sum[LANES] = {0};
    for (int colour = 0; colour < 4; colour++)
        for (int i = top + colour / 2; i < top + TILE_ROWS; i += 2) {
            if (i >= grid.rows.nodes)
                break;
            NodeRun at = grid_nodes(&grid, i, colour % 2);
            at.first += column * LANES;
            if (at.first < at.end)
                relax_nodes(&grid, at, sum);
        }
    return sum_lanes(sum);
}

/* Sweeps the tiles whose change of E (Tiles.activity) is at most `activity`.
 * Tiles of one colour are not neighbours, so their order has no effect.
 *   visits  out, number of sweeps
 * Returns the change of E. */
FAST static double relax_active(Tiles *tiles, double activity, int *visits)
{
    const int high = tiles->rows, wide = tiles->columns;
    double change = 0;
    *visits = 0;
    for (int colour = 0; colour < 4; colour++) {
        int count = 0;
        for (int i = colour / 2; i < high; i += 2)
            for (int j = colour % 2; j < wide; j += 2)
                if (tiles->activity[i * wide + j] <= activity)
                    tiles->chosen[count++] = i * wide + j;
        for (int t = 0; t < count; t++)
            tiles->change[tiles->chosen[t]] =
                relax_tile(tiles, tiles->chosen[t]);
        for (int t = 0; t < count; t++) { /* neighbours become active */
            int tile = tiles->chosen[t], i = tile / wide, j = tile % wide;
            for (int a = i > 0 ? i - 1 : 0; a <= i + 1 && a < high; a++)
                for (int b = j > 0 ? j - 1 : 0; b <= j + 1 && b < wide; b++)
                    tiles->activity[a * wide + b] +=
                        SPREAD * tiles->change[tile];
            tiles->activity[tile] = tiles->change[tile];
            change += tiles->change[tile];
        }
        *visits += count;
    }
    tiles->sweeps += *visits;
    return change;
}

double tiles_relax(Tiles *tiles, double pace)
{
    int count = tiles->rows * tiles->columns, visits;
    for (int t = 0; t < count; t++)
        tiles->activity[t] = 0;
    double lowered = relax_active(tiles, 0, &visits), change = lowered;
    for (int t = 0; t < count; t++)
        tiles->activity[t] = tiles->change[t];
    for (int round = 0; round < MAX_ROUNDS; round++) {
        double sum = 0, most = 0;
        for (int t = 0; t < count; t++) {
            sum += tiles->activity[t];
            most = tiles->activity[t] < most ? tiles->activity[t] : most;
        }
        if (!(most < 0 && most <= STANDS_OUT * sum / count))
            break;
        lowered = relax_active(tiles, SHARE * most, &visits);
        change += lowered;
        if (!(lowered < pace * visits))
            break;
    }
    return change;
}
