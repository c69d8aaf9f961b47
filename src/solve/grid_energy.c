/* grid_energy.c - E, its gradient and its change along a line, on the grid. */
#include <math.h>

#include "solve/grid_spring.h"

/* Begins a loop over bands.  A local copy of *grid can stay in registers. */
#define BANDS                                                                  \
    const Grid local = *grid;                                                  \
    const ptrdiff_t plane = local.rows.plane_length;                           \
    for (int band = 0; band < local.band_count; band++)

FAST double grid_gradient(const Grid *grid, double *g)
{
    double total = 0;
    BANDS
    {
        const double *const ax = local.target_offset, *const ay = ax + plane;
        double *const gx = g, *const gy = gx + plane;
        double sum[LANES] = {0};
        EACH_NODE_OF (local, band) {
            const ptrdiff_t q = at.first + e;
            Doubles mass = DOUBLES(local.m, q + at.mass_shift);
            Doubles fx = mass * DOUBLES(ax, q), fy = mass * DOUBLES(ay, q);
#define ADD(kind, to, numbers)                                                 \
    {                                                                          \
        GridSpring s = evaluate_grid_spring(&local, kind, q, to, numbers);     \
        Doubles f = s.c * s.s;                                                 \
        fx += f * s.dx;                                                        \
        fy += f * s.dy;                                                        \
        IN_ORDER(fx, fy);                                                      \
    }
            ALL_SPRINGS(ADD, at)
#undef ADD
            DOUBLES(gx, q) = fx;
            DOUBLES(gy, q) = fy;
            DOUBLES(sum, e) += DOUBLES(local.inverse_m, q + at.mass_shift) *
                               (fx * fx + fy * fy);
        }
        total += sum_lanes(sum);
    }
    return total;
}

/* Declares the difference u of p between the ends of a spring. */
#define P_DIFFERENCE(to)                                                       \
    Doubles ux = DOUBLES(px, q) - DOUBLES(px, q + (to));                       \
    Doubles uy = DOUBLES(py, q) - DOUBLES(py, q + (to))

FAST double grid_linear_residual(const Grid *grid, const double *g,
                                 const double *p)
{
    double total = 0;
    BANDS
    {
        const double *const px = p, *const py = px + plane;
        const double *const gx = g, *const gy = gx + plane;
        double sum[LANES] = {0};
        EACH_NODE_OF (local, band) {
            const ptrdiff_t q = at.first + e;
            Doubles hx = DOUBLES(px, q), hy = DOUBLES(py, q);
            Doubles mass = DOUBLES(local.m, q + at.mass_shift);
            Doubles fx = mass * hx, fy = mass * hy;
#define ADD(kind, to, numbers)                                                 \
    {                                                                          \
        GridSpring s = evaluate_grid_spring(&local, kind, q, to, numbers);     \
        P_DIFFERENCE(to);                                                      \
        add_hessian_product(s, ux, uy, &fx, &fy);                              \
        IN_ORDER(fx, fy);                                                      \
    }
            ALL_SPRINGS(ADD, at)
#undef ADD
            fx = -DOUBLES(gx, q) - fx;
            fy = -DOUBLES(gy, q) - fy;
            DOUBLES(sum, e) += DOUBLES(local.inverse_m, q + at.mass_shift) *
                               (fx * fx + fy * fy);
        }
        total += sum_lanes(sum);
    }
    return total;
}

FAST void grid_energy_quartic(const Grid *grid, const double *p,
                              double quartic[4])
{
    for (int s = 0; s < 4; s++)
        quartic[s] = 0;
    BANDS
    {
        const double *const ax = local.target_offset, *const ay = ax + plane;
        const double *const px = p, *const py = px + plane;
        double sum[4][LANES] = {{0}};
        EACH_NODE_OF (local, band) {
            const ptrdiff_t q = at.first + e;
            Doubles hx = DOUBLES(px, q), hy = DOUBLES(py, q);
            Doubles q0 = {0}, q1 = {0}, q2 = {0}, q3 = {0};
            Doubles mass = DOUBLES(local.m, q + at.mass_shift);
#define ADD(kind, to, numbers)                                                 \
    {                                                                          \
        GridSpring s = evaluate_grid_spring(&local, kind, q, to, numbers);     \
        P_DIFFERENCE(to);                                                      \
        spring_line_polynomial(s, ux, uy, &q0, &q1, &q2, &q3);                 \
        IN_ORDER(q0, q1);                                                      \
        IN_ORDER(q2, q3);                                                      \
    }
            OWN_SPRINGS(ADD, at)
#undef ADD
            DOUBLES(sum[0], e) +=
                q0 + mass * (DOUBLES(ax, q) * hx + DOUBLES(ay, q) * hy);
            DOUBLES(sum[1], e) += q1 + 0.5 * mass * (hx * hx + hy * hy);
            DOUBLES(sum[2], e) += q2;
            DOUBLES(sum[3], e) += 0.25 * q3;
        }
        for (int s = 0; s < 4; s++)
            quartic[s] += sum_lanes(sum[s]);
    }
}

/* ---- without springs ---- */

FAST double grid_make_p_conjugate(const Grid *grid, const double *g,
                                  const double *last_g, const double *last_p,
                                  double last_slope, double *p)
{
    double total = 0;
    BANDS
    {
        double sum[LANES] = {0};
        EACH_RUN_OF (local, band)
            EACH_OF (NEXT(at, LANES)) {
                const ptrdiff_t x = at.first + e, y = x + plane;
                sum[e] += p[x] * (g[x] - last_g[x]) + p[y] * (g[y] - last_g[y]);
            }
        total += sum_lanes(sum);
    }
    double beta = fmax(total / last_slope, 0);
    EACH_OF (2 * grid->rows.plane_length)
        p[e] += beta * last_p[e];
    return beta;
}

FAST double grid_correct_momentum(const Grid *grid)
{
    double mass = 0, moment[2] = {0, 0};
    BANDS
    {
        double sum[3][LANES] = {{0}};
        EACH_RUN_OF (local, band)
            EACH_OF (NEXT(at, LANES)) {
                const ptrdiff_t q = at.first + e;
                double m = local.m[q + at.mass_shift];
                sum[0][e] += m;
                sum[1][e] += m * local.target_offset[q];
                sum[2][e] += m * local.target_offset[q + plane];
            }
        mass += sum_lanes(sum[0]);
        moment[0] += sum_lanes(sum[1]);
        moment[1] += sum_lanes(sum[2]);
    }
    for (int c = 0; c < 2; c++) {
        const double mean = moment[c] / mass;
        BANDS
        {
            double *const away = local.target_offset + c * plane;
            double *const x = local.x + c * plane;
            const double *const x_tilde = local.x_tilde + c * plane;
            EACH_RUN_OF (local, band)
                EACH_OF (NEXT(at, LANES)) {
                    const ptrdiff_t q = at.first + e;
                    away[q] -= local.m[q + at.mass_shift] > 0 ? mean : 0;
                    x[q] = x_tilde[q] + away[q];
                }
        }
    }
    return -0.5 * (moment[0] * moment[0] + moment[1] * moment[1]) / mass;
}

FAST void grid_move_x(const Grid *grid, double a, const double *p)
{
    double *const away = grid->target_offset, *const x = grid->x;
    const double *const x_tilde = grid->x_tilde;
    EACH_OF (2 * grid->rows.plane_length) {
        away[e] += a * p[e];
        x[e] = x_tilde[e] + away[e];
    }
}

FAST void grid_update_float_x(const Grid *grid)
{
    const int n = grid->segments, plane = grid->rows.plane_length;
    for (int c = 0; c < 2; c++) {
        const double *const x = grid->x + c * plane;
        double middle = x[node_index(&grid->rows, n / 2, n / 2)];
        narrow_array_to_single(x, 1, middle, plane, grid->float_x + c * plane);
    }
}
