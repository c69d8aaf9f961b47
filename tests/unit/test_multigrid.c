/* Multigrid: loops against the formulas spring by spring, the V-cycle's
 * symmetry, the certified end against a solution in extended precision, and
 * the same bits for every number of threads, whatever was before.
 */
#include "test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/square_mesh.h"
#include "solve/tiles.h"
#include "solve/v_cycle.h"

/* A square's step problem with everything that may differ from node to node
 * and from spring to spring. */
typedef struct Problem {
    SquareMesh mesh;
    double *m, *k, *l2, *x_n, *u, *u_tilde;
    unsigned char *pinned;
    double weight;
    unsigned version; /* of m, pinned, k and l2 */
} Problem;

static double *new_array(int count)
{
    double *array = calloc((size_t)count, sizeof *array);
    assert_non_null(array);
    return array;
}

/* The default square: stretch along x, equal masses and springs. */
static void problem_create(int segments, double stretch, Problem *problem)
{
    assert_int_equal(square_mesh_create(segments, segments, 1, &problem->mesh),
                     0);
    int n = problem->mesh.nodes, springs = problem->mesh.springs;
    problem->m = new_array(n);
    problem->k = new_array(springs);
    problem->l2 = new_array(springs);
    problem->x_n = new_array(2 * n);
    problem->u = new_array(2 * n);
    problem->u_tilde = new_array(2 * n);
    problem->pinned = NULL;
    problem->weight = 1.6e-5;
    const double *x = problem->mesh.x;
    for (int i = 0; i < n; i++) {
        problem->m[i] = 1000.0 / n;
        problem->x_n[2 * i] = stretch * x[2 * i];
        problem->x_n[2 * i + 1] = x[2 * i + 1];
    }
    for (int s = 0; s < springs; s++) {
        const int *e = problem->mesh.e + 2 * s;
        double dx = x[2 * e[0]] - x[2 * e[1]];
        double dy = x[2 * e[0] + 1] - x[2 * e[1] + 1];
        problem->l2[s] = (dx != 0 && dy != 0 ? 2.0 : 1.0) / segments / segments;
        problem->k[s] = 1e5;
    }
}

/* Moves, breaks, pins and weighs at random. */
static void problem_disturb(Random *random, bool pins, Problem *problem)
{
    int n = problem->mesh.nodes, side = problem->mesh.segments + 1;
    double cell = 1.0 / problem->mesh.segments;
    if (pins) {
        problem->pinned = calloc((size_t)n, 1);
        assert_non_null(problem->pinned);
        for (int i = 0; i < side; i++)
            problem->pinned[i * side + side - 1] = 1;
        for (int i = 0; i <= n / 20; i++)
            problem->pinned[random_below(random, n)] = 1;
    }
    for (int i = 0; i < n; i++) {
        problem->m[i] *= random_logarithmic(random, 0.3, 3);
        for (int c = 0; c < 2; c++) {
            bool held = pins && problem->pinned[i];
            double *u = problem->u + 2 * i + c;
            problem->x_n[2 * i + c] += random_uniform(random, -0.4, 0.4) * cell;
            *u = held ? 0 : random_uniform(random, -0.4, 0.4) * cell;
            problem->u_tilde[2 * i + c] =
                random_uniform(random, -0.1, 0.1) * cell;
        }
    }
    for (int s = 0; s < problem->mesh.springs; s++) {
        problem->k[s] *= random_logarithmic(random, 0.1, 10);
        problem->l2[s] *= random_logarithmic(random, 0.5, 2);
        if (random_below(random, 10) == 0)
            problem->k[s] = 0;
    }
}

static void problem_free(Problem *problem)
{
    square_mesh_free(&problem->mesh);
    free(problem->m);
    free(problem->k);
    free(problem->l2);
    free(problem->x_n);
    free(problem->u);
    free(problem->u_tilde);
    free(problem->pinned);
}

static bool is_pinned(const Problem *problem, int node)
{
    return problem->pinned && problem->pinned[node];
}

/* ---- the formulas once more, spring by spring, in extended precision ---- */

/* x_i - x_j of a spring for x = x_n + u. */
static void spring_vector(const Problem *problem, const double *u, int s,
                          long double d[2])
{
    const int *e = problem->mesh.e + 2 * s;
    for (int c = 0; c < 2; c++) {
        int i = 2 * e[0] + c, j = 2 * e[1] + c;
        d[c] = (long double)problem->x_n[i] + u[i] -
               ((long double)problem->x_n[j] + u[j]);
    }
}

static long double reference_energy(const Problem *problem, const double *u)
{
    long double E = 0;
    for (int i = 0; i < 2 * problem->mesh.nodes; i++) {
        long double away = (long double)u[i] - problem->u_tilde[i];
        E += problem->m[i / 2] * away * away / 2;
    }
    for (int s = 0; s < problem->mesh.springs; s++) {
        long double d[2], l2 = problem->l2[s];
        spring_vector(problem, u, s, d);
        long double strain = (d[0] * d[0] + d[1] * d[1]) / l2 - 1;
        E += problem->weight * l2 * problem->k[s] / 2 * strain * strain;
    }
    return E;
}

static void reference_gradient(const Problem *problem, const double *u,
                               long double *g)
{
    for (int i = 0; i < 2 * problem->mesh.nodes; i++)
        g[i] = problem->m[i / 2] * ((long double)u[i] - problem->u_tilde[i]);
    for (int s = 0; s < problem->mesh.springs; s++) {
        const int *e = problem->mesh.e + 2 * s;
        long double d[2];
        spring_vector(problem, u, s, d);
        long double strain = (d[0] * d[0] + d[1] * d[1]) / problem->l2[s] - 1;
        for (int c = 0; c < 2; c++) {
            long double f = 2 * problem->weight * problem->k[s] * strain * d[c];
            g[2 * e[0] + c] += f;
            g[2 * e[1] + c] -= f;
        }
    }
    for (int i = 0; i < 2 * problem->mesh.nodes; i++)
        g[i] = is_pinned(problem, i / 2) ? 0 : g[i];
}

/* y = H p; clamped: each spring's eigenvalues (2k/l2) (3 |d|^2 - l2) along d
 * and (2k/l2) (|d|^2 - l2) across it, where they are > 0. */
static void reference_product(const Problem *problem, const double *u,
                              bool clamped, const long double *p,
                              long double *y)
{
    for (int i = 0; i < 2 * problem->mesh.nodes; i++)
        y[i] = problem->m[i / 2] * p[i];
    for (int s = 0; s < problem->mesh.springs; s++) {
        const int *e = problem->mesh.e + 2 * s;
        long double d[2], l2 = problem->l2[s];
        spring_vector(problem, u, s, d);
        long double d2 = d[0] * d[0] + d[1] * d[1];
        long double c = 2 * problem->weight * problem->k[s] / l2;
        long double along = c * (3 * d2 - l2), across = c * (d2 - l2);
        if (clamped) {
            along = along > 0 ? along : 0;
            across = across > 0 ? across : 0;
        }
        long double q[2], dot;
        for (int i = 0; i < 2; i++)
            q[i] = p[2 * e[0] + i] - p[2 * e[1] + i];
        dot = (d[0] * q[0] + d[1] * q[1]) / d2;
        for (int i = 0; i < 2; i++) {
            long double f = across * (q[i] - dot * d[i]) + along * dot * d[i];
            y[2 * e[0] + i] += f;
            y[2 * e[1] + i] -= f;
        }
    }
    for (int i = 0; i < 2 * problem->mesh.nodes; i++)
        y[i] = is_pinned(problem, i / 2) ? 0 : y[i];
}

/* The residual of Algorithm 3 at u: p = -H^-1 g by conjugate gradients in
 * extended precision, until their remainder is nothing. */
static double reference_residual(const Problem *problem, const double *u,
                                 double h)
{
    int size = 2 * problem->mesh.nodes;
    long double *r = calloc((size_t)size * 4, sizeof *r);
    assert_non_null(r);
    long double *d = r + size, *y = d + size, *p = y + size, now = 0;
    reference_gradient(problem, u, r);
    for (int i = 0; i < size; i++) {
        d[i] = r[i] = -r[i];
        now += r[i] * r[i];
    }
    long double start = now;
    for (int k = 0; k < 20 * size && now > 1e-26L * start; k++) {
        reference_product(problem, u, true, d, y);
        long double bend = 0, next = 0;
        for (int i = 0; i < size; i++)
            bend += d[i] * y[i];
        for (int i = 0; i < size; i++) {
            p[i] += now / bend * d[i];
            r[i] -= now / bend * y[i];
            next += r[i] * r[i];
        }
        for (int i = 0; i < size; i++)
            d[i] = r[i] + next / now * d[i];
        now = next;
    }
    long double largest = 0;
    for (int i = 0; i < size; i += 2)
        largest = fmaxl(largest, fabsl(p[i]) + fabsl(p[i + 1]));
    CHECK_AT_MOST(now, 1e-26L * start);
    free(r);
    return (double)(largest / h);
}

/* ---- the loops ---- */

static const double H = 0.004, TOLERANCE = 1e-2;

static MultigridStep step_of(const Problem *problem)
{
    return (MultigridStep){.version = problem->version,
                           .x_n = problem->x_n,
                           .u = problem->u,
                           .u_tilde = problem->u_tilde,
                           .m = problem->m,
                           .pinned = problem->pinned,
                           .k = problem->k,
                           .l2 = problem->l2,
                           .weight = problem->weight,
                           .h = H,
                           .tolerance = TOLERANCE,
                           .is_free = !problem->pinned,
                           .minimum = true};
}

enum { VECTORS = 4 };

/* A grid with its parts and some vectors, at u. */
typedef struct Parts {
    const Problem *problem;
    Memory memory;
    Grid grid;
    VCycle cycle;
    Tiles tiles;
    double *vector[VECTORS]; /* [2 planes] */
} Parts;

static void lay_out_parts(Parts *parts)
{
    parts->memory.used = 0;
    grid_lay_out(parts->problem->mesh.segments, &parts->memory, &parts->grid);
    v_cycle_lay_out(&parts->grid, &parts->memory, &parts->cycle);
    tiles_lay_out(&parts->grid, &parts->memory, &parts->tiles);
    for (int i = 0; i < VECTORS; i++)
        parts->vector[i] =
            memory_piece(&parts->memory,
                         2 * (size_t)parts->grid.rows.plane * sizeof(double));
}

static void parts_create(const Problem *problem, int threads, Parts *parts)
{
    MultigridStep step = step_of(problem);
    *parts = (Parts){.problem = problem};
    lay_out_parts(parts);
    CHECK_STATUS(memory_create(&parts->memory), STATUS_OK);
    lay_out_parts(parts);
    parts->grid.crew = crew_create(threads);
    grid_read_system(&parts->grid, &step);
    grid_read_state(&parts->grid, &step);
    v_cycle_read_system(&parts->cycle);
}

static void parts_free(Parts *parts)
{
    crew_free(parts->grid.crew);
    free(parts->memory.base);
}

/* The place of component i of a vector of the system. */
static int component(const Parts *parts, int i)
{
    const Rows *rows = &parts->grid.rows;
    return i % 2 * rows->plane +
           place_of(rows, i / 2 / rows->nodes, i / 2 % rows->nodes);
}

/* A random vector, 0 for pins, on the grid and as it is. */
static void random_vector(Random *random, const Parts *parts, double *packed,
                          long double *plain)
{
    for (int i = 0; i < 2 * parts->problem->mesh.nodes; i++) {
        double number = 0.1 * random_uniform(random, -1, 1);
        number = is_pinned(parts->problem, i / 2) ? 0 : number;
        plain[i] = packed[component(parts, i)] = number;
    }
}

/* What the loops give where nodes move is at most a few roundings of the
 * largest number away from the formulas. */
static void check_vector(const Parts *parts, const double *packed,
                         const long double *expected)
{
    long double largest = 0, error = 0;
    for (int i = 0; i < 2 * parts->problem->mesh.nodes; i++)
        if (!is_pinned(parts->problem, i / 2)) {
            double got = packed[component(parts, i)];
            largest = fmaxl(largest, fabsl(expected[i]));
            error = fmaxl(error, fabsl(got - expected[i]));
            CHECK(got == got);
        }
    CHECK_AT_MOST(error, 1e-14L * largest);
}

/* |a|_(M^-1)^2 of what moves. */
static long double inverse_mass_square(const Problem *problem,
                                       const long double *a)
{
    long double sum = 0;
    for (int i = 0; i < 2 * problem->mesh.nodes; i++)
        sum += is_pinned(problem, i / 2) ? 0 : a[i] * a[i] / problem->m[i / 2];
    return sum;
}

/* grad E, -g - H p with the clamped H, and H p with H as it is. */
static void check_derivatives(Random *random, const Parts *parts)
{
    const Problem *problem = parts->problem;
    const Grid *grid = &parts->grid;
    int size = 2 * problem->mesh.nodes;
    long double *p = calloc((size_t)size * 3, sizeof *p), *y = p + size;
    assert_non_null(p);
    long double *g = y + size;
    double *const *v = parts->vector;
    reference_gradient(problem, problem->u, g);
    double moment[2], largest, sum = 0;
    double norm2 = grid_gradient(grid, v[0], moment);
    check_vector(parts, v[0], g);
    CHECK_NEAR(norm2, inverse_mass_square(problem, g), 1e-13 * norm2);
    for (int c = 0; c < 2; c++) {
        double exact = 0, size = 0;
        for (int i = c; i < 2 * problem->mesh.nodes; i += 2) {
            double away =
                problem->m[i / 2] * (problem->u[i] - problem->u_tilde[i]);
            exact += is_pinned(problem, i / 2) ? 0 : away;
            size += fabs(away);
        }
        CHECK_NEAR(moment[c], exact, 1e-14 * size);
    }
    random_vector(random, parts, v[1], p);
    reference_product(problem, problem->u, true, p, y);
    for (int i = 0; i < size; i++)
        y[i] = -g[i] - y[i];
    norm2 = grid_remainder(grid, v[0], v[1], v[2], &largest);
    check_vector(parts, v[2], y);
    CHECK_NEAR(norm2, inverse_mass_square(problem, y), 1e-13 * norm2);
    for (int i = 0; i < size; i += 2)
        sum = fmax(sum, (double)(fabsl(p[i]) + fabsl(p[i + 1])));
    CHECK_NEAR(largest, sum, 1e-15);
    sum = 0;
    reference_product(problem, problem->u, false, p, y);
    double bend = grid_product(grid, v[1], v[2]);
    check_vector(parts, v[2], y);
    for (int i = 0; i < size; i++)
        sum += (double)(p[i] * y[i]);
    CHECK_NEAR(bend, sum, 1e-13 * fabs(sum));
    CHECK_NEAR(grid_dot(grid, v[1], v[2]), bend, 1e-13 * fabs(sum));
    free(p);
}

/* E along a line: the polynomial against E itself; and going there. */
static void check_line(Random *random, const Parts *parts)
{
    const Problem *problem = parts->problem;
    const Grid *grid = &parts->grid;
    int size = 2 * problem->mesh.nodes;
    long double *p = calloc((size_t)size, sizeof *p);
    double *moved = new_array(size), moment[2], q[4], a = 0.7;
    assert_non_null(p);
    random_vector(random, parts, parts->vector[1], p);
    grid_gradient(grid, parts->vector[0], moment);
    grid_along(grid, parts->vector[0], parts->vector[1], q);
    for (int i = 0; i < size; i++)
        moved[i] = problem->u[i] + a * (double)p[i];
    long double change = reference_energy(problem, moved) -
                         reference_energy(problem, problem->u);
    CHECK_NEAR(a * (q[0] + a * (q[1] + a * (q[2] + a * q[3]))), change,
               1e-13L * fabsl(change));
    MultigridStep step = step_of(problem);
    double *u = new_array(size);
    grid_move(grid, a, parts->vector[1]);
    grid_displacement(grid, &step, u);
    for (int i = 0; i < size; i++)
        if (!is_pinned(problem, i / 2))
            CHECK_NEAR(u[i], moved[i], 4e-16);
        else
            CHECK(u[i] == 0);
    free(u);
    free(moved);
    free(p);
}

TEST(loops_agree_with_the_formulas)
{
    const int segments[] = {1, 2, 7, 8, 15, 17, 31, 40};
    for (int i = 0; i < 16; i++) {
        Random random = {(uint64_t)i};
        Problem problem;
        Parts parts;
        problem_create(segments[i / 2], 1.1, &problem);
        if (i % 4 < 3)
            problem_disturb(&random, i % 2 == 1, &problem);
        parts_create(&problem, 1 + i % 2, &parts);
        check_derivatives(&random, &parts);
        check_line(&random, &parts);
        parts_free(&parts);
        problem_free(&problem);
    }
}

/* ---- tiles ---- */

/* Two nodes are pulled out of a square at rest: tiles lower E by what they say,
 * and pins stay. */
TEST(tiles_lower_what_they_say)
{
    enum { SEGMENTS = 60, SIDE = SEGMENTS + 1, FIRST = 20 * SIDE + 31 };
    for (int pins = 0; pins < 2; pins++) {
        Problem problem;
        Parts parts;
        problem_create(SEGMENTS, 1, &problem);
        problem.u[2 * FIRST] = problem.u[2 * FIRST + 41] = 0.6 / SEGMENTS;
        if (pins)
            problem.pinned = calloc((size_t)problem.mesh.nodes, 1);
        if (pins)
            problem.pinned[FIRST] = 1;
        parts_create(&problem, 2, &parts);
        MultigridStep step = step_of(&problem);
        long double before = reference_energy(&problem, problem.u);
        double change = tiles_relax(&parts.tiles, -1e-9 * (double)before);
        CHECK(parts.tiles.sweeps > 3L * parts.tiles.high * parts.tiles.wide);
        grid_displacement(&parts.grid, &step, problem.u);
        long double after = reference_energy(&problem, problem.u);
        CHECK(after < (pins ? 0.9L : 0.3L) * before);
        CHECK_NEAR(change, (double)(after - before), 1e-13 * (double)before);
        CHECK((problem.u[2 * FIRST] == 0.6 / SEGMENTS) == pins);
        parts_free(&parts);
        problem_free(&problem);
    }
}

/* ---- the V-cycle ---- */

/* Masses and tensors of the next coarser level, from their definition. */
static void check_coarser(const Parts *parts)
{
    const Level *fine = parts->cycle.level, *coarse = fine + 1;
    const Rows *f = &fine->rows;
    /* Of each kind of spring, what it stands for: rows, columns, fourths. */
    const double from[KINDS][6][3] = {
        {{0, 0, 1},
         {1, 0, 1},
         {0, -1, .5},
         {1, -1, .5},
         {0, 1, .5},
         {1, 1, .5}},
        {{0, 0, 1},
         {0, 1, 1},
         {-1, 0, .5},
         {-1, 1, .5},
         {1, 0, .5},
         {1, 1, .5}},
        {{0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}},
        {{0, 0, 1}, {1, 0, 1}, {0, -1, 1}, {1, -1, 1}}};
    for (int node = 0; node < coarse->rows.nodes * coarse->rows.nodes; node++) {
        int I = node / coarse->rows.nodes, J = node % coarse->rows.nodes;
        int q = place_of(&coarse->rows, I, J);
        double mass = 0;
        for (int i = 2 * I - 1; i <= 2 * I + 1 && i < f->nodes; i++)
            for (int j = 2 * J - 1; j <= 2 * J + 1 && j < f->nodes; j++)
                if (i >= 0 && j >= 0)
                    mass += (double)fine->m[place_of(f, i, j)] *
                            (i == 2 * I ? 1 : 0.5) * (j == 2 * J ? 1 : 0.5);
        CHECK(coarse->m[q] == 0 || fabs(coarse->m[q] - mass) < 1e-5 * mass);
        for (int k = 0; k < KINDS * 3; k++) {
            double K = 0, size = 0;
            for (int t = 0; t < 6; t++) {
                int i = 2 * I + (int)from[k / 3][t][0];
                int j = 2 * J + (int)from[k / 3][t][1];
                if (i < 0 || j < 0 || i >= f->nodes || j >= f->nodes)
                    continue;
                double part = (double)fine->K[k / 3][k % 3][place_of(f, i, j)];
                K += 0.25 * from[k / 3][t][2] * part;
                size += fabs(part);
            }
            CHECK_NEAR(coarse->K[k / 3][k % 3][q], K, 1e-6 * size);
        }
    }
}

/* 15 cycles leave of the remainder no more than this share, and say so where it
 * is not yet rounding; of nothing they make nothing. */
static void check_solution(Parts *parts, double share)
{
    double *const *v = parts->vector;
    double moment[2], largest, left;
    double square = grid_gradient(&parts->grid, v[0], moment);
    VEnd end = {.cycles = 15};
    v_solve(&parts->cycle, -1, v[0], square, end, false, v[1]);
    left = grid_remainder(&parts->grid, v[0], v[1], v[2], &largest);
    CHECK_AT_MOST(sqrt(left / square), share);
    CHECK(parts->cycle.cycles == 15);
    end = (VEnd){.share = 0.1, .cycles = 15};
    v_solve(&parts->cycle, -1, v[0], square, end, false, v[1]);
    left = grid_remainder(&parts->grid, v[0], v[1], v[2], &largest);
    CHECK_AT_MOST(sqrt(left / square), 0.1 + 1e-5);
    v_solve(&parts->cycle, 1, v[2], left, end, true, v[1]);
    left = grid_remainder(&parts->grid, v[0], v[1], v[2], &largest);
    CHECK_AT_MOST(sqrt(left / square), 0.01 + 1e-5);
    grid_combine(&parts->grid, 0, v[0], 0, v[0]);
    CHECK(v_solve(&parts->cycle, 1, v[0], 0, end, false, v[1]) == 0);
    CHECK(grid_dot(&parts->grid, v[1], v[1]) == 0);
}

/* B is symmetric and positive definite, to the rounding of single precision. */
TEST(the_cycle_is_symmetric_and_positive)
{
    const int segments[] = {5, 12, 31, 40, 47, 64};
    for (int i = 0; i < 12; i++) {
        Random random = {7};
        Problem problem;
        Parts parts;
        problem_create(segments[i / 2], 1.2, &problem);
        problem_disturb(&random, i % 2 == 0, &problem);
        parts_create(&problem, 2, &parts);
        long double *plain =
            calloc((size_t)problem.mesh.nodes * 2, sizeof *plain);
        assert_non_null(plain);
        double *const *v = parts.vector;
        random_vector(&random, &parts, v[0], plain);
        random_vector(&random, &parts, v[1], plain);
        v_precondition(&parts.cycle, v[0], 1, v[2]);
        v_precondition(&parts.cycle, v[1], 1e-20, v[3]);
        double aBa = grid_dot(&parts.grid, v[0], v[2]);
        double bBb = grid_dot(&parts.grid, v[1], v[3]);
        CHECK(aBa > 0 && bBb > 0);
        CHECK_NEAR(grid_dot(&parts.grid, v[0], v[3]),
                   grid_dot(&parts.grid, v[1], v[2]), 1e-5 * sqrt(aBa * bBb));
        parts.cycle.cycles = 0;
        if (parts.cycle.levels > 1)
            check_coarser(&parts);
        /* Three times what they leave where springs are broken, nodes held. */
        check_solution(&parts, segments[i / 2] < 16 ? 4e-7 : 3e-3);
        free(plain);
        parts_free(&parts);
        problem_free(&problem);
    }
}

/* ---- whole steps ---- */

/* To the end; u is then the minimiser. */
static Status minimise(Multigrid *multigrid, Problem *problem)
{
    MultigridStep step = step_of(problem);
    memset(problem->u, 0, 2 * (size_t)problem->mesh.nodes * sizeof(double));
    Status status = multigrid_start(multigrid, &step);
    for (int i = 0; i < 300 && status == STATUS_RUNNING; i++)
        status = multigrid_iterate(multigrid);
    multigrid_displacement(multigrid, problem->u);
    return status;
}

/* The next step of backward Euler. */
static void advance(Problem *problem)
{
    for (int i = 0; i < 2 * problem->mesh.nodes; i++) {
        problem->x_n[i] += problem->u[i];
        problem->u_tilde[i] = problem->u[i];
    }
}

/* No step may be called converged that is not, and no update may raise E nor
 * lower it by something else than it says: recomputed in extended precision. */
static void check_steps(Problem *problem, int steps)
{
    Multigrid *multigrid;
    CHECK_STATUS(multigrid_create(problem->mesh.segments, 0, &multigrid),
                 STATUS_OK);
    size_t bytes = 2 * (size_t)problem->mesh.nodes * sizeof(double);
    for (int i = 0; i < steps; i++) {
        memset(problem->u, 0, bytes);
        MultigridStep step = step_of(problem);
        long double start = reference_energy(problem, problem->u), E = start;
        Status status = multigrid_start(multigrid, &step);
        while (status == STATUS_RUNNING) {
            status = multigrid_iterate(multigrid);
            multigrid_displacement(multigrid, problem->u);
            long double now = reference_energy(problem, problem->u);
            CHECK_AT_MOST(now, E);
            if (step.is_free) /* then its centre moves, too */
                CHECK_AT_MOST(now - E, multigrid_record(multigrid)->change +
                                           1e-15L * start);
            else
                CHECK_NEAR(now - E, multigrid_record(multigrid)->change,
                           1e-15L * start);
            E = now;
        }
        CHECK_STATUS(status, STATUS_OK);
        CHECK_AT_MOST(reference_residual(problem, problem->u, H),
                      TOLERANCE * (1 + 1e-9));
        advance(problem);
    }
    multigrid_free(multigrid);
    problem_free(problem);
}

TEST(steps_pass_the_test_of_algorithm_3)
{
    Problem problem;
    problem_create(16, 1.4, &problem);
    check_steps(&problem, 12);
    problem_create(21, 0.7, &problem);
    check_steps(&problem, 4);
    for (int i = 0; i < 4; i++) {
        Random random = {(uint64_t)i};
        problem_create(6 + 5 * i, 1.2, &problem);
        problem_disturb(&random, i % 2 == 1, &problem);
        check_steps(&problem, 3);
    }
}

/* Where the tolerance is the very residual that it finds, no remainder that
 * rounding leaves decides the test: then it is not passed. */
TEST(what_is_not_decided_is_not_converged)
{
    Multigrid *multigrid;
    CHECK_STATUS(multigrid_create(16, 1, &multigrid), STATUS_OK);
    for (int i = 0; i < 5; i++) {
        Problem problem;
        Status status = STATUS_OK;
        problem_create(16, 1.1 + 0.05 * i, &problem);
        MultigridStep step = step_of(&problem);
        step.tolerance = reference_residual(&problem, problem.u, H);
        for (int k = 0; k < 10; k++) {
            status = multigrid_start(multigrid, &step);
            if (multigrid_record(multigrid)->after == step.tolerance)
                break;
            step.tolerance = multigrid_record(multigrid)->after;
        }
        CHECK(multigrid_record(multigrid)->after == step.tolerance);
        CHECK_STATUS(status, STATUS_RUNNING);
        problem_free(&problem);
    }
    multigrid_free(multigrid);
}

/* A square in one point is a maximum of E, with no gradient at all; uniform
 * compression is a saddle.  Neither is an end. */
TEST(a_saddle_is_left)
{
    Problem problem;
    problem_create(10, 1, &problem);
    for (int i = 0; i < 2 * problem.mesh.nodes; i++)
        problem.x_n[i] = 0;
    Multigrid *multigrid;
    CHECK_STATUS(multigrid_create(10, 1, &multigrid), STATUS_OK);
    CHECK_STATUS(minimise(multigrid, &problem), STATUS_OK);
    CHECK(multigrid_counters(multigrid)->saddles > 0);
    double *zero = new_array(2 * problem.mesh.nodes);
    CHECK_AT_MOST(reference_energy(&problem, problem.u),
                  0.5 * reference_energy(&problem, zero));

    /* Without the look for negative curvature both would be. */
    MultigridStep step = step_of(&problem);
    step.minimum = false;
    CHECK_STATUS(multigrid_start(multigrid, &step), STATUS_OK);
    free(zero);
    multigrid_free(multigrid);
    problem_free(&problem);
}

/* Between two steps springs become stiffer: under a new version multigrid
 * solves the system that there is. */
TEST(what_has_changed_is_read_again)
{
    Problem problem;
    problem_create(8, 1.4, &problem);
    Multigrid *multigrid;
    CHECK_STATUS(multigrid_create(8, 1, &multigrid), STATUS_OK);
    CHECK_STATUS(minimise(multigrid, &problem), STATUS_OK);
    advance(&problem);
    for (int s = 0; s < problem.mesh.springs; s++)
        problem.k[s] *= s % 2 ? 3 : 5;
    problem.version++;
    CHECK_STATUS(minimise(multigrid, &problem), STATUS_OK);
    CHECK_AT_MOST(reference_residual(&problem, problem.u, H),
                  TOLERANCE * (1 + 1e-9));
    multigrid_free(multigrid);
    problem_free(&problem);
}

/* Near the maximum, on either side: a direction of negative curvature is gone
 * along in the sense in which E falls. */
TEST(a_saddle_is_left_downhill)
{
    Multigrid *multigrid;
    CHECK_STATUS(multigrid_create(10, 1, &multigrid), STATUS_OK);
    for (int sense = -1; sense <= 1; sense += 2) {
        Problem problem;
        problem_create(10, 1, &problem);
        for (int i = 0; i < 2 * problem.mesh.nodes; i++)
            problem.x_n[i] = 1e-9 * sense * problem.mesh.x[i];
        double *zero = new_array(2 * problem.mesh.nodes);
        CHECK_STATUS(minimise(multigrid, &problem), STATUS_OK);
        CHECK_AT_MOST(reference_energy(&problem, problem.u),
                      0.5 * reference_energy(&problem, zero));
        free(zero);
        problem_free(&problem);
    }
    multigrid_free(multigrid);
}

/* Steps with one thread and with two, and, from each of these starts, with a
 * new object that knows of no step before: the same bits. */
TEST(bits_depend_on_the_step_alone)
{
    for (int pins = 0; pins < 2; pins++) {
        Problem problem;
        Multigrid *multigrid[3];
        Random random = {5};
        problem_create(64, 1.4, &problem);
        if (pins)
            problem_disturb(&random, true, &problem);
        for (int i = 0; i < 2; i++)
            CHECK_STATUS(multigrid_create(64, 1 + i, &multigrid[i]), STATUS_OK);
        double *first = new_array(2 * problem.mesh.nodes);
        for (int step = 0; step < (pins ? 2 : 9); step++) {
            CHECK_STATUS(multigrid_create(64, 2, &multigrid[2]), STATUS_OK);
            for (int i = 0; i < 3; i++) {
                CHECK_STATUS(minimise(multigrid[i], &problem), STATUS_OK);
                if (i > 0)
                    CHECK_SAME_BITS(problem.u, first, 2 * problem.mesh.nodes);
                for (int k = 0; k < 2 * problem.mesh.nodes; k++)
                    first[k] = problem.u[k];
            }
            multigrid_free(multigrid[2]);
            advance(&problem);
        }
        CHECK(multigrid_counters(multigrid[0])->local > 0);
        for (int i = 0; i < 2; i++)
            multigrid_free(multigrid[i]);
        free(first);
        problem_free(&problem);
    }
}

/* Smooth steps take about as many directions and cycles at any size: here as
 * many as they took when this was written, and one more. */
TEST(smooth_steps_take_the_same_work_at_any_size)
{
    for (int segments = 16; segments <= 128; segments *= 2) {
        Problem problem;
        Multigrid *multigrid;
        problem_create(segments, 1.4, &problem);
        CHECK_STATUS(multigrid_create(segments, 0, &multigrid), STATUS_OK);
        const MultigridCounters *did = multigrid_counters(multigrid);
        for (int i = 0; i < 5; i++) {
            MultigridStep step = step_of(&problem);
            step.minimum = false;
            step.u = NULL;
            Status status = multigrid_start(multigrid, &step);
            while (status == STATUS_RUNNING)
                status = multigrid_iterate(multigrid);
            multigrid_displacement(multigrid, problem.u);
            advance(&problem);
        }
        CHECK_AT_MOST(did->iterations, 5 * 4);
        CHECK_AT_MOST(did->cycles, 5 * 10);
        CHECK(did->local == 0 && did->certificates >= 5);
        multigrid_free(multigrid);
        problem_free(&problem);
    }
}

TESTS(NULL, NULL)
