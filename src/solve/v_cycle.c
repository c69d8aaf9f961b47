/* v_cycle.c - directions by a multigrid V-cycle, alone or as the preconditioner
 * of conjugate gradients. */
#include "solve/v_cycle.h"

#include <math.h>
#include <string.h>

#include "solve/grid_spring.h"

/* Largest number of nodes along a side of the coarsest level. */
enum { COARSEST_SIDE_NODES = 3 };

void v_cycle_init(const Grid *grid, ArrayArena *memory, VCycle *cycle)
{
    Level *level = cycle->level;
    *cycle = (VCycle){.grid = grid};
    for (int nodes = grid->rows.nodes_per_side, more = 1; more; level++) {
        more = nodes > COARSEST_SIDE_NODES;
        level->rows = make_row_layout(nodes);
        nodes = nodes / 2 + 1;
        size_t bytes = (size_t)level->rows.plane_length * sizeof(float);
        for (int i = 0; i < 3 * SPRING_KINDS; i++)
            level->K[i / 3][i % 3] = arena_take_piece(memory, bytes);
        for (int i = 0; i < 3; i++)
            level->D[i] = arena_take_piece(memory, bytes);
        level->m = level == cycle->level ? grid->float_m
                                         : arena_take_piece(memory, bytes);
        float **vectors[] = {&level->x, &level->b, &level->w};
        for (int i = 0; i < 3; i++)
            *vectors[i] = arena_take_piece(memory, 2 * bytes);
    }
    size_t bytes = 2 * (size_t)grid->rows.plane_length * sizeof(float);
    float **vectors[] = {&cycle->p, &cycle->d, &cycle->Ad};
    for (int i = 0; i < 3; i++)
        *vectors[i] = arena_take_piece(memory, bytes);
}

/* ---- loops in stages ----
 *
 * Loops that follow each other go through a level's rows together, each a row
 * behind the one before, whose neighbouring rows it needs: what one leaves is
 * still near when the next one reads it. */

INLINE bool row_exists(int rows, int i)
{
    return i >= 0 && i < rows;
}

/* Number of a level's rows.  If a coarser level exists, a row outside of the
 * grid makes an even number odd: the last row is then a coarse row. */
INLINE int count_rows_to_coarsen(const Level *level)
{
    int nodes = level->rows.nodes_per_side;
    return level->coarse ? nodes | 1 : nodes;
}

/* ---- tensors ---- */

/* Computes the tensors of the springs that start in row i. */
INLINE void compute_spring_tensors(const VCycle *cycle, int i, bool is_clamped)
{
    const Grid grid = *cycle->grid;
    const Level level = cycle->level[0];
    for (int odd = 0; odd < 2; odd++)
        for (NodeRange at = grid_get_node_range(&grid, i, odd);
             at.first < at.end; at.first += LANES) {
#define ADD(kind, to, numbers)                                                 \
    EACH_FLOATS (NEXT(at, LANES)) {                                            \
        const ptrdiff_t q = at.first + e;                                      \
        FloatSpring s = evaluate_float_spring(&grid, kind, q, to, numbers);    \
        Floats H[3];                                                           \
        float_spring_hessian(s, is_clamped, H);                                \
        FLOATS(level.K[kind][0], q) = H[0];                                    \
        FLOATS(level.K[kind][1], q) = H[1];                                    \
        FLOATS(level.K[kind][2], q) = H[2];                                    \
    }
            OWN_SPRINGS(ADD, at)
#undef ADD
        }
}

INLINE void invert_diagonal_row(const Level *of, int i)
{
    const Level level = *of;
    for (int odd = 0; odd < 2; odd++)
        for (NodeRange at = get_node_range(&level.rows, i, odd);
             at.first < at.end; at.first += LANES)
            EACH_OF (NEXT(at, LANES)) {
                const ptrdiff_t q = at.first + e;
                float mass = level.m[q], xx = mass, xy = 0, yy = mass;
#define ADD(kind, to, numbers)                                                 \
    xx += level.K[kind][0][q + (numbers)];                                     \
    xy += level.K[kind][1][q + (numbers)];                                     \
    yy += level.K[kind][2][q + (numbers)];
                ALL_SPRINGS(ADD, at)
#undef ADD
                float det = xx * yy - xy * xy;
                bool moves = (det > 0) & (mass > 0);
                float over = moves ? 1 / (moves ? det : 1) : 0;
                level.D[0][q] = yy * over;
                level.D[1][q] = -xy * over;
                level.D[2][q] = xx * over;
            }
}

/* Stores LANES columns of coarse row I, from column `first` on, even
 * columns apart from odd ones. */
INLINE void split_even_odd(const RowLayout *rows, int I, int first,
                           const float *line, float *to)
{
    float *even = to + node_index(rows, I, first),
          *odd = even + rows->odd_offset;
    EACH_OF (AT_MOST(LANES / 2, (rows->nodes_per_side - first + 1) / 2)) {
        even[e] = line[2 * e];
        odd[e] = line[2 * e + 1];
    }
}

/* FINER selects a plane of the finer level.  For the coarse node in row I and
 * column J = first + e, EVEN(di) is the plane's number in row 2 I + di and
 * column 2 J, and ODD(di, dj) is in this row and column 2 (J + dj) + 1. */
#define FINER(from)                                                            \
    const float *const a = (from) + node_index(&fine, 2 * I, 0) + first
#define EVEN(di)    a[(di)*fine.pitch + e]
#define ODD(di, dj) a[(di)*fine.pitch + fine.odd_offset + e + (dj)]

/* A coarse tensor is the mean of the four finer ones it stands for. */
INLINE void coarsen_row(const Level *level, const Level *coarse, int I)
{
    const RowLayout fine = level->rows, rows = coarse->rows;
    for (int first = 0; first < rows.nodes_per_side; first += LANES)
        for (int t = 0; t < 3; t++) {
            float line[LANES];
#define MEAN(kind, sum)                                                        \
    {                                                                          \
        FINER(level->K[kind][t]);                                              \
        EACH_OF (LANES)                                                        \
            line[e] = 0.25f * (sum);                                           \
        split_even_odd(&rows, I, first, line, coarse->K[kind][t]);             \
    }
            MEAN(RIGHT, EVEN(0) + EVEN(1) +
                            0.5f * ((ODD(0, -1) + ODD(1, -1)) +
                                    (ODD(0, 0) + ODD(1, 0))))
            MEAN(UP,
                 EVEN(0) + ODD(0, 0) +
                     0.5f * ((EVEN(-1) + ODD(-1, 0)) + (EVEN(1) + ODD(1, 0))))
            MEAN(DIAGONAL, (EVEN(0) + ODD(0, 0)) + (EVEN(1) + ODD(1, 0)))
            MEAN(ANTIDIAGONAL, (EVEN(0) + EVEN(1)) + (ODD(0, -1) + ODD(1, -1)))
#undef MEAN
        }
}

/* Restricts a plane of the finer level to coarse row I: to = P^T from. */
INLINE void restrict_row(const RowLayout *finer, const RowLayout *coarse, int I,
                         const float *from, float *to)
{
    const RowLayout fine = *finer;
    for (int first = 0; first < coarse->nodes_per_side; first += LANES) {
        float line[LANES];
        FINER(from);
        EACH_OF (LANES)
            line[e] =
                EVEN(0) +
                0.5f * ((EVEN(-1) + EVEN(1)) + (ODD(0, -1) + ODD(0, 0))) +
                0.25f * ((ODD(-1, -1) + ODD(-1, 0)) + (ODD(1, -1) + ODD(1, 0)));
        split_even_odd(coarse, I, first, line, to);
    }
}

/* Computes the matrices of rows i and i + 1, and tensors of coarse row i/2. */
INLINE void compute_row_matrices(const VCycle *cycle, const Level *level, int i)
{
    for (int row = i; row < i + 2; row++)
        if (row_exists(level->rows.nodes_per_side, row)) {
            if (level == cycle->level && cycle->is_clamped)
                compute_spring_tensors(cycle, row, true);
            else if (level == cycle->level)
                compute_spring_tensors(cycle, row, false);
            invert_diagonal_row(level, row);
        }
    if (level->coarse && row_exists(count_rows_to_coarsen(level), i))
        coarsen_row(level, level->coarse, i / 2);
}

void v_cycle_copy_system(VCycle *cycle)
{
    const Grid *grid = cycle->grid;
    double m = grid->min_mass;
    Level *l = cycle->level;
    for (; l->rows.nodes_per_side > COARSEST_SIDE_NODES &&
           grid->max_node_stiffness > m;
         l++, m *= 4) {
        const Level *coarse = l->coarse = l + 1;
        int last = l->rows.nodes_per_side - 1;
        for (int I = 0; I < coarse->rows.nodes_per_side; I++) {
            restrict_row(&l->rows, &coarse->rows, I, l->m, coarse->m);
            for (int J = 0; J < coarse->rows.nodes_per_side; J++) {
                int i = 2 * I < last ? 2 * I : last;
                int j = 2 * J < last ? 2 * J : last;
                if (l->m[node_index(&l->rows, i, j)] == 0)
                    coarse->m[node_index(&coarse->rows, I, J)] = 0;
            }
        }
    }
    l->coarse = NULL;
}

/* ---- the V-cycle: A x = b ---- */

/* What a pass over one colour of a row computes. */
typedef enum SweepKind {
    SWEEP_FIRST, /* the first pass, from x = 0: x = D (b + sum of K x'), D the
                    inverse diagonal, x' at neighbours of earlier colours */
    SWEEP_RESIDUAL, /* w = b - A x after SWEEP_FIRST.  All terms cancel but the
                       sum of K x' over springs to later colours */
    SWEEP_SMOOTH,   /* Gauss-Seidel: x += D (b - A x), node by node */
    SWEEP_PRODUCT   /* w = A x; adds x.b to xb and x.w to xw */
} SweepKind;

/* Makes a pass over one colour of row i, if the level has this row.  The colour
 * is 2 in odd rows, plus 1 in odd columns.  Neighbours of earlier colours are
 * beside a node in an odd column, and above and below a node in an odd row. */
INLINE void sweep_row(const Level *of, int i, int colour, SweepKind result,
                      float *xb, float *xw)
{
    const Level level = *of;
    const ptrdiff_t plane = level.rows.plane_length;
    const bool from_0 = result == SWEEP_FIRST || result == SWEEP_RESIDUAL;
    const bool along = !from_0 || (colour % 2 != 0) == (result == SWEEP_FIRST);
    const bool across = !from_0 || (colour / 2 != 0) == (result == SWEEP_FIRST);
    float *const x = level.x, *const y = x + plane;
    float *const wx = level.w, *const wy = wx + plane;
    const float *const bx = level.b, *const by = bx + plane;
    if (!row_exists(level.rows.nodes_per_side, i))
        return;
    for (NodeRange at = get_node_range(&level.rows, i, colour % 2);
         at.first < at.end; at.first += LANES)
        EACH_FLOATS (NEXT(at, LANES)) {
            const ptrdiff_t q = at.first + e;
            /* (ax, ay) becomes b - A x if from_0, else A x. */
            Floats hx = {0}, hy = {0}, ax = {0}, ay = {0};
            if (result == SWEEP_FIRST) {
                ax = FLOATS(bx, q);
                ay = FLOATS(by, q);
            } else if (!from_0) {
                hx = FLOATS(x, q);
                hy = FLOATS(y, q);
                ax = FLOATS(level.m, q) * hx;
                ay = FLOATS(level.m, q) * hy;
            }
#define ADD(kind, to, numbers)                                                 \
    {                                                                          \
        Floats dx = FLOATS(x, q + (to)), dy = FLOATS(y, q + (to));             \
        dx = from_0 ? dx : hx - dx;                                            \
        dy = from_0 ? dy : hy - dy;                                            \
        Floats xy = FLOATS(level.K[kind][1], q + (numbers));                   \
        ax += FLOATS(level.K[kind][0], q + (numbers)) * dx + xy * dy;          \
        ay += xy * dx + FLOATS(level.K[kind][2], q + (numbers)) * dy;          \
        IN_ORDER(ax, ay);                                                      \
    }
            if (along) {
                ROW_SPRINGS(ADD, at)
            }
            if (across) {
                CROSS_SPRINGS(ADD, at)
            }
#undef ADD
            Floats rx = from_0 ? ax : FLOATS(bx, q) - ax;
            Floats ry = from_0 ? ay : FLOATS(by, q) - ay;
            if (result == SWEEP_FIRST || result == SWEEP_SMOOTH) {
                Floats xx = FLOATS(level.D[0], q), xy = FLOATS(level.D[1], q);
                Floats yy = FLOATS(level.D[2], q);
                FLOATS(x, q) = hx + (xx * rx + xy * ry);
                FLOATS(y, q) = hy + (xy * rx + yy * ry);
            } else if (result == SWEEP_RESIDUAL) {
                FLOATS(wx, q) = WHERE(FLOATS(level.D[0], q) != 0, rx);
                FLOATS(wy, q) = WHERE(FLOATS(level.D[0], q) != 0, ry);
            } else {
                FLOATS(xb, e) += hx * FLOATS(bx, q) + hy * FLOATS(by, q);
                FLOATS(xw, e) += hx * ax + hy * ay;
                FLOATS(wx, q) = ax;
                FLOATS(wy, q) = ay;
            }
        }
}

/* Interpolates the coarse plane `from` to row i and adds the result to the
 * plane `to`; held nodes stay 0. */
INLINE void prolong_row(const Level *level, const RowLayout *coarse, int i,
                        const float *from, float *to)
{
    const RowLayout fine = level->rows;
    const float *const a = from + node_index(coarse, i / 2, 0);
    const float *const z = from + node_index(coarse, (i + 1) / 2, 0);
    const int odd_offset = coarse->odd_offset, at = node_index(&fine, i, 0);
    float *const even = to + at, *const odd = even + fine.odd_offset;
    const float *const D = level->D[0] + at, *const odd_D = D + fine.odd_offset;
    for (int first = 0; 2 * first < fine.column_count[0]; first += LANES / 2)
        EACH_OF (AT_MOST(LANES / 2, fine.odd_offset / 2 - first)) {
            const int J = first + e;
            float here = 0.5f * (a[J] + z[J]);
            float after = 0.5f * (a[odd_offset + J] + z[odd_offset + J]);
            float next = 0.5f * (a[J + 1] + z[J + 1]);
            even[2 * J] += D[2 * J] != 0 ? here : 0;
            even[2 * J + 1] += D[2 * J + 1] != 0 ? after : 0;
            odd[2 * J] += odd_D[2 * J] != 0 ? 0.5f * (here + after) : 0;
            odd[2 * J + 1] += odd_D[2 * J + 1] != 0 ? 0.5f * (after + next) : 0;
        }
}

/* Makes one forward Gauss-Seidel pass from x = 0, and restricts the residual to
 * b of the coarser level.  Computes the matrices before, if needed.  Even rows
 * come before odd rows, and in each row even columns before odd columns. */
FAST static void descend_level(const VCycle *cycle, const Level *l)
{
    const int rows = count_rows_to_coarsen(l);
    for (int i = 0; i < rows + 4; i += 2) {
        if (!cycle->has_matrices)
            compute_row_matrices(cycle, l, i);
        sweep_row(l, i, 0, SWEEP_FIRST, NULL, NULL);
        sweep_row(l, i, 1, SWEEP_FIRST, NULL, NULL);
        sweep_row(l, i - 1, 2, SWEEP_FIRST, NULL, NULL);
        sweep_row(l, i - 1, 3, SWEEP_FIRST, NULL, NULL);
        sweep_row(l, i - 1, 2, SWEEP_RESIDUAL, NULL, NULL);
        sweep_row(l, i - 1, 3, SWEEP_RESIDUAL, NULL, NULL);
        sweep_row(l, i - 2, 0, SWEEP_RESIDUAL, NULL, NULL);
        sweep_row(l, i - 2, 1, SWEEP_RESIDUAL, NULL, NULL);
        for (int c = 0; c < 2 && l->coarse && row_exists(rows, i - 4); c++)
            restrict_row(&l->rows, &l->coarse->rows, i / 2 - 2,
                         l->w + c * l->rows.plane_length,
                         l->coarse->b + c * l->coarse->rows.plane_length);
    }
}

/* Adds the interpolated x of the coarser level, then makes a second pass: in
 * the order opposite to the first one, or in the order 1, 0, 2, 3. */
FAST static void ascend_level(const Level *l, bool is_opposite)
{
    const int nodes = l->rows.nodes_per_side;
    for (int i = 0; i < nodes + 2; i += 2) {
        for (int row = i; l->coarse && row < i + 2 && row < nodes; row++)
            for (int c = 0; c < 2; c++)
                prolong_row(l, &l->coarse->rows, row,
                            l->coarse->x + c * l->coarse->rows.plane_length,
                            l->x + c * l->rows.plane_length);
        if (is_opposite) {
            sweep_row(l, i - 1, 3, SWEEP_SMOOTH, NULL, NULL);
            sweep_row(l, i - 1, 2, SWEEP_SMOOTH, NULL, NULL);
            sweep_row(l, i - 2, 1, SWEEP_SMOOTH, NULL, NULL);
            sweep_row(l, i - 2, 0, SWEEP_SMOOTH, NULL, NULL);
        } else {
            sweep_row(l, i, 1, SWEEP_SMOOTH, NULL, NULL);
            sweep_row(l, i, 0, SWEEP_SMOOTH, NULL, NULL);
            sweep_row(l, i - 1, 2, SWEEP_SMOOTH, NULL, NULL);
            sweep_row(l, i - 1, 3, SWEEP_SMOOTH, NULL, NULL);
        }
    }
}

/* Approximates x = A^-1 b on this level and all coarser ones. */
static void run_v_cycle(const VCycle *cycle, const Level *level)
{
    descend_level(cycle, level);
    if (level->coarse)
        run_v_cycle(cycle, level->coarse);
    ascend_level(level, cycle->is_clamped);
}

/* Computes w = A x on one level.
 *   sums  [2] out, x.b and x.w */
FAST static void multiply_by_level_matrix(const Level *level, double *sums)
{
    sums[0] = sums[1] = 0;
    for (int i = 0; i < level->rows.nodes_per_side; i++) {
        float xb[LANES] = {0}, xw[LANES] = {0};
        double row[2] = {0, 0};
        sweep_row(level, i, 0, SWEEP_PRODUCT, xb, xw);
        sweep_row(level, i, 1, SWEEP_PRODUCT, xb, xw);
        for (int e = 0; e < LANES; e++) {
            row[0] += (double)xb[e];
            row[1] += (double)xw[e];
        }
        sums[0] += row[0];
        sums[1] += row[1];
    }
}

/* ---- conjugate gradients ---- */

/* Makes a step of conjugate gradients.  A V-cycle on the residual b has found
 * x, and w = A x.  The step is d = x + beta d, A d = w + beta A d, p += alpha
 * d, b -= alpha A d.  Returns |b|_(M^-1)^2. */
FAST static double advance_conjugate_gradients(const VCycle *of, float alpha,
                                               float beta)
{
    const VCycle cycle = *of;
    const Grid grid = *cycle.grid;
    const Level level = cycle.level[0];
    const ptrdiff_t plane = grid.rows.plane_length;
    double total = 0;
    float square[LANES];
    for (int band = 0; band < grid.band_count; band++) {
        double sum[LANES] = {0};
        EACH_RUN_OF (grid, band) {
            EACH_OF (NEXT(at, LANES)) {
                float of_b = 0;
                for (ptrdiff_t c = 0, q = at.first + e; c < 2;
                     c++, q += plane) {
                    float d = level.x[q] + beta * cycle.d[q];
                    float Ad = level.w[q] + beta * cycle.Ad[q];
                    float p = cycle.p[q] + alpha * d;
                    float b = level.b[q] - alpha * Ad;
                    cycle.d[q] = d;
                    cycle.Ad[q] = Ad;
                    cycle.p[q] = p;
                    level.b[q] = b;
                    of_b += b * b;
                }
                square[e] = of_b;
            }
            EACH_OF (NEXT(at, LANES))
                sum[e] += grid.inverse_m[at.first + at.mass_shift + e] *
                          (double)square[e];
        }
        total += sum_lanes(sum);
    }
    return total;
}

bool p_meets_tolerance(const Grid *grid, double largest, double square,
                       double longest)
{
    return largest + sqrt(2 / grid->min_mass * square) <= longest;
}

/* Limit of the V-cycles for one direction. */
enum { MAX_V_CYCLES = 60 };

/* Conjugate gradients end when p passes the stopping test even if the bound of
 * its error is multiplied by MARGIN, or when the linear residual, relative to
 * the gradient in the norm of M^-1, is at most LOOSE or LEAST.  LOOSE is for a
 * p that is not small (SMALL_P): a further iteration of Newton costs no more
 * than an exact p, and leaves a smaller error.  LEAST is near the limit of
 * single precision. */
static const double MARGIN = 1.3, LOOSE = 0.5, LEAST = 1e-4;

/* If p is small, but its bound from g (multigrid.h) is more than FAR times the
 * limit of the test, the Hessian is clamped: conjugate gradients then let p
 * pass the test sooner than further iterations do.  Springs that are stiff in
 * comparison with the masses make the bound so large. */
static const double FAR = 1e4;

/* Returns the largest |x_x| + |x_y| of a node. */
FAST static double find_largest_node_norm(const float *x, int plane)
{
    const float *const y = x + plane;
    float most[LANES] = {0};
    double largest = 0;
    for (int q = 0; q < plane; q += LANES)
        EACH_OF (LANES) {
            float size = fabsf(x[q + e]) + fabsf(y[q + e]);
            most[e] = size > most[e] ? size : most[e];
        }
    for (int e = 0; e < LANES; e++)
        largest = fmax(largest, most[e]);
    return largest;
}

FAST bool v_cycle_solve(VCycle *cycle, const double *g, double square,
                        double longest, double *p, double *largest)
{
    const Grid *grid = cycle->grid;
    const int plane = grid->rows.plane_length, numbers = 2 * plane;
    const double unit = power_of_two_scale(sqrt(square * grid->min_mass));
    const float *found = cycle->level->x;
    double last = 0, alpha = 1;
    bool passes = false;
    if (!cycle->has_matrices)
        grid_update_float_x(grid);
    narrow_array_to_single(g, -unit, 0, numbers, cycle->level->b);
    for (int i = 0; i < MAX_V_CYCLES && !passes; i++) {
        double sums[2];
        run_v_cycle(cycle, cycle->level);
        cycle->has_matrices = true;
        cycle->cycles++;
        if (i == 0) {
            *largest = find_largest_node_norm(found, plane) / unit;
            if (!cycle->is_clamped) {
                double bound = sqrt(2 / grid->min_mass * square);
                if (*largest > SMALL_P * longest || bound <= FAR * longest)
                    break;
                cycle->is_clamped = true;
                cycle->has_matrices = false;
                return v_cycle_solve(cycle, g, square, longest, p, largest);
            }
            found = cycle->p;
            for (int k = 0; k < 3; k++)
                memset((float *[]){cycle->p, cycle->d, cycle->Ad}[k], 0,
                       (size_t)numbers * sizeof(float));
        }
        multiply_by_level_matrix(cycle->level, sums);
        double xb = sums[0], beta = i > 0 ? xb / last : 0;
        double bend = sums[1] - beta * xb / alpha; /* d.A d */
        if (!(bend > 0 && xb > 0) || !isfinite(xb / bend))
            break;
        last = xb;
        alpha = xb / bend;
        double rest =
            advance_conjugate_gradients(cycle, (float)alpha, (float)beta);
        double share = sqrt(rest / square) / unit;
        *largest = find_largest_node_norm(found, plane) / unit;
        passes = p_meets_tolerance(
            grid, *largest, MARGIN * MARGIN * share * share * square, longest);
        if (share <= (*largest > SMALL_P * longest ? LOOSE : LEAST))
            break;
    }
    const double inverse_unit = 1 / unit;
    EACH_OF (numbers)
        p[e] = inverse_unit * found[e];
    return passes;
}
