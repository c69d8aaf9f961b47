#include "solve/multigrid.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "solve/grid_kernels.h"
#include "solve/plane_search.h"
#include "solve/tips.h"
#include "solve/v_cycle.h"

/* Newton's directions: the remainder falls to this share of its norm, in at
 * most so many V-cycles; between windows one cycle is enough. */
static const double CG_ENOUGH = 0.3;

enum { MAX_CYCLES = 30, CYCLES_BETWEEN_WINDOWS = 1 };

/* After so many directions windows may be worth it, and they are once the
 * gradient's bound falls by less than this factor. */
enum { GLOBAL_STEPS = 2 };
static const double STALLS = 0.3;

/* The test is worth conjugate gradients when the gradient's bound is at most
 * so many tolerances for each segment, and has halved since they last said no.
 * Where windows are minimised, the bound falls slowly and these take long. */
static const double WORTH_A_TEST = 8, WORTH_BETWEEN_WINDOWS = 4;
enum { MAX_TEST_CYCLES = 100 };

/* Single precision can make the remainder smaller by this factor; then it is
 * computed again in double precision. */
static const double REFINED = 1e-4;

/* Iterations that look for negative curvature; without any, the remainder of
 * random numbers falls to this share of its norm. */
enum { CURVATURE_CYCLES = 20 };
static const double NO_CURVATURE = 1e-3;

/* Saddles that one step leaves. */
enum { MAX_SADDLES = 30 };

struct Multigrid {
    Grid grid;
    Crew *crew;
    VCycle *cycle;
    Tips tips;
    MultigridCounters counters;
    MultigridRecord record;
    MultigridStep step; /* arrays are not looked at after the start */
    double *g, *p;      /* [2 planes] grad E and direction at x */
    double *r; /* [2 planes] the last update, but for what windows move */
    double *rest, *z, *d, *y; /* [2 planes] of conjugate gradients */
    void *memory;             /* of these vectors */
    double norm2;             /* |g|_(M^-1)^2 */
    double bound;             /* m/s, of the residual */
    double last_bound;        /* m/s, an iteration before */
    double test_below;        /* m/s, half the bound when it said no */
    double residual;          /* m/s */
    bool known;               /* the grid has the system's numbers */
    bool directed;            /* p is a direction at x */
    bool set_up;              /* the V-cycle has its tensors at x */
    bool windows;             /* are minimised in each iteration */
    bool updated;             /* r is not 0 */
    int iterations, saddles;  /* of this step */
};

static Status create_parts(Multigrid *mg)
{
    Status status = tips_create(&mg->grid, &mg->tips);
    if (status)
        return status;
    mg->cycle = v_cycle_create(&mg->grid);
    double **vectors[] = {&mg->g, &mg->p, &mg->r, &mg->rest,
                          &mg->z, &mg->d, &mg->y};
    int count = sizeof vectors / sizeof *vectors;
    double *next = grid_piece(&mg->grid, 2 * count, &mg->memory);
    for (int i = 0; i < count && next; i++, next += 2 * mg->grid.layout.plane)
        *vectors[i] = next;
    return mg->cycle && next ? STATUS_OK : STATUS_OUT_OF_MEMORY;
}

Status multigrid_create(int segments, int lanes, int threads,
                        Multigrid **multigrid)
{
    *multigrid = NULL;
    if (segments < 1)
        return STATUS_INVALID_INPUT;
    Multigrid *mg = calloc(1, sizeof *mg);
    if (!mg)
        return STATUS_OUT_OF_MEMORY;
    Status status = grid_create(segments, lanes, &mg->grid);
    if (!status)
        status = create_parts(mg);
    if (status) {
        multigrid_free(mg);
        return status;
    }
    mg->crew = mg->grid.crew = crew_create(threads);
    *multigrid = mg;
    return STATUS_OK;
}

void multigrid_free(Multigrid *mg)
{
    if (!mg)
        return;
    crew_free(mg->crew);
    v_cycle_free(mg->cycle);
    tips_free(&mg->tips);
    grid_free(&mg->grid);
    free(mg->memory);
    free(mg);
}

/* ---- conjugate gradients ---- */

/* m/s, the largest residual of a direction with this norm |p|_M. */
static double largest_residual(const Multigrid *mg, double norm)
{
    return sqrt(2 / mg->grid.lightest) / mg->step.h * norm;
}

static void set_up_cycle(Multigrid *mg)
{
    if (mg->set_up)
        return;
    v_cycle_set_up(mg->cycle);
    mg->counters.set_ups++;
    mg->set_up = true;
}

/* How large rest is where |rest|_(M^-1)^2 is this. */
static double size_of(const Multigrid *mg, double square)
{
    return sqrt(square * mg->grid.lightest);
}

/* p = -H^-1 g, about, and its residual.
 *   most  V-cycles */
static void find_direction(Multigrid *mg, int most)
{
    VRemainder remainder = {0, 0};
    set_up_cycle(mg);
    v_solve_begin(mg->cycle, -1, mg->g, size_of(mg, mg->norm2));
    for (int i = 1;; i++) {
        mg->counters.cycles++;
        if (!v_solve_step(mg->cycle, &remainder) || i == most ||
            remainder.square <= CG_ENOUGH * CG_ENOUGH * mg->norm2)
            break;
        v_solve_next(mg->cycle);
    }
    v_solve_end(mg->cycle, mg->p);
    mg->residual = remainder.largest / mg->step.h;
}

/* Whether a direction with this residual and remainder decides the test. */
static bool test_is_decided(const Multigrid *mg, double residual, double square)
{
    return fabs(residual - mg->step.tolerance) >=
           largest_residual(mg, sqrt(square));
}

/* rest = -g - H p; returns |rest|_(M^-1)^2. */
static double true_remainder(Multigrid *mg)
{
    grid_product(&mg->grid, true, mg->p, mg->rest);
    grid_combine(&mg->grid, NULL, -1, mg->g, -1, mg->rest);
    return grid_inverse_mass_square(&mg->grid, mg->rest);
}

/* p += about H^-1 rest, until that seems to decide the test; and mg->residual
 * of p.
 *   square  |rest|_(M^-1)^2
 *   first   p is taken for 0, rest for -g
 *   left    V-cycles, in/out */
static bool refine_direction(Multigrid *mg, double square, bool first,
                             int *left)
{
    const Grid *grid = &mg->grid;
    VRemainder remainder;
    double enough = REFINED * REFINED * square;
    v_solve_begin(mg->cycle, first ? -1 : 1, first ? mg->g : mg->rest,
                  size_of(mg, square));
    for (bool more = true; more;) {
        mg->counters.cycles++;
        --*left;
        if (!v_solve_step(mg->cycle, &remainder))
            return false;
        double residual = first ? remainder.largest / mg->step.h : mg->residual;
        more = *left > 0 && remainder.square > enough &&
               !test_is_decided(mg, residual, remainder.square);
        if (more)
            v_solve_next(mg->cycle);
    }
    v_solve_end(mg->cycle, first ? mg->p : mg->z);
    if (!first)
        grid_combine(grid, NULL, 1, mg->z, 1, mg->p);
    mg->residual = grid_largest(grid, mg->p) / mg->step.h;
    return true;
}

/* p = -H^-1 g, until its residual is known to pass or to fail, by a remainder
 * in double precision.  Returns whether it got there. */
static bool decide_test(Multigrid *mg)
{
    double square = mg->norm2, last;
    int left = MAX_TEST_CYCLES;
    set_up_cycle(mg);
    do {
        last = square;
        if (!refine_direction(mg, square, left == MAX_TEST_CYCLES, &left))
            return false;
        square = true_remainder(mg);
        if (test_is_decided(mg, mg->residual, square))
            return true;
    } while (left > 0 && square < 0.25 * last);
    return false;
}

/* z = B rest; returns rest.z. */
static double apply_cycle(Multigrid *mg)
{
    double square = grid_inverse_mass_square(&mg->grid, mg->rest);
    v_cycle_apply(mg->cycle, mg->rest, size_of(mg, square), mg->z);
    mg->counters.cycles++;
    return grid_dot(&mg->grid, mg->rest, mg->z);
}

/* Conjugate gradients on the Hessian as it is, from random numbers in `rest`:
 * whether they have met a d with d.H d < 0. */
static bool find_curvature(Multigrid *mg)
{
    const Grid *grid = &mg->grid;
    set_up_cycle(mg);
    double now = apply_cycle(mg), start = now;
    grid_combine(grid, NULL, 1, mg->z, 0, mg->d);
    for (int i = 1; i <= CURVATURE_CYCLES; i++) {
        double bend = grid_product(grid, false, mg->d, mg->y);
        if (bend < 0)
            return true;
        if (!(bend > 0) || !isfinite(now) || i == CURVATURE_CYCLES)
            return false;
        grid_combine(grid, NULL, -now / bend, mg->y, 1, mg->rest);
        double last = now;
        now = apply_cycle(mg);
        if (now <= NO_CURVATURE * NO_CURVATURE * start)
            return false;
        grid_combine(grid, NULL, 1, mg->z, now / last, mg->d);
    }
    return false;
}

/* ---- the test ---- */

/* Springs cannot move the centre of mass: at the minimum sum m u is
 * sum m u_tilde.  What is missing is moved, all nodes alike; that lowers E,
 * changes no spring, and g by m times it. */
static void centre_mass(Multigrid *mg)
{
    const Grid *grid = &mg->grid;
    const GridLayout *layout = &grid->layout;
    for (int c = 0; c < 2; c++) {
        const double *u = grid->u + c * layout->plane;
        const double *u_tilde = grid->u_tilde + c * layout->plane;
        double mass = 0, missing = 0;
        for (int i = 0; i < layout->nodes; i++) {
            int q = grid_at(layout, i, 0);
            const double *m = grid->m + grid_shift(grid->node_shift, i);
            for (int past = q + layout->nodes; q < past; q++) {
                mass += m[q];
                missing += m[q] * (u_tilde[q] - u[q]);
            }
        }
        for (int i = 0; i < layout->nodes; i++) {
            int q = grid_at(layout, i, 0);
            for (int past = q + layout->nodes; q < past; q++)
                mg->z[c * layout->plane + q] = missing / mass;
        }
    }
    grid_move(grid, NULL, 1, mg->z, 0, NULL);
}

/* Random numbers of -1 ... 1 for every node, the same ones always. */
static void random_remainder(Multigrid *mg)
{
    const GridLayout *layout = &mg->grid.layout;
    uint64_t state = 1;
    for (int c = 0; c < 2; c++)
        for (int i = 0; i < layout->nodes; i++)
            for (int j = 0; j < layout->nodes; j++) {
                int q = grid_at(layout, i, j);
                state = state * 6364136223846793005u + 1442695040888963407u;
                double number = (double)(int64_t)state / 9223372036854775808.0;
                int shift = grid_shift(mg->grid.node_shift, i);
                bool moves = mg->grid.per_mass[q + shift] > 0;
                mg->rest[c * layout->plane + q] = moves ? number : 0;
            }
}

/* At the start of a step, and of what follows a saddle. */
static void begin_iterations(Multigrid *mg)
{
    mg->windows = false;
    mg->iterations = 0;
    mg->test_below = INFINITY;
}

/* Goes along a direction in which E bends down, if there is one.  Returns
 * whether it has. */
static bool leaves_saddle(Multigrid *mg)
{
    const Grid *grid = &mg->grid;
    if (!mg->step.minimum || mg->saddles == MAX_SADDLES)
        return false;
    random_remainder(mg);
    if (!find_curvature(mg))
        return false;
    double inertia, slope = grid_dot(grid, mg->g, mg->d);
    double sign = slope > 0 ? -1 : 1;
    grid_combine(grid, NULL, -sign, mg->d, 0, mg->z);
    slope = grid_direction(grid, NULL, mg->z, 0, mg->g, mg->d, &inertia);
    Quartic along;
    grid_along(grid, NULL, mg->d, slope, inertia, along.q);
    double alpha = quartic_first_minimum(&along);
    if (!(alpha > 0) || !(quartic_value(&along, alpha) < 0))
        return false;
    grid_move(grid, NULL, alpha, mg->d, 0, NULL);
    grid_combine(grid, NULL, alpha, mg->d, 0, mg->r);
    mg->record.change += quartic_value(&along, alpha);
    mg->updated = true;
    begin_iterations(mg);
    mg->saddles++;
    mg->counters.saddles++;
    return true;
}

/* The bound at x, where g is known.  norm2  |g|_(M^-1)^2 */
static void bound_residual(Multigrid *mg, double norm2)
{
    mg->norm2 = norm2;
    mg->bound = mg->residual = largest_residual(mg, sqrt(mg->norm2));
    mg->directed = mg->set_up = false;
}

/* g and the bound at x. */
static void evaluate(Multigrid *mg)
{
    double norm2 = grid_gradient(&mg->grid, NULL, mg->g);
    mg->counters.gradients++;
    bound_residual(mg, norm2);
}

/* The test of Algorithm 3 at x.  Returns OK, RUNNING, NOT_FINITE. */
static Status multigrid_test(Multigrid *mg)
{
    if (!isfinite(mg->norm2))
        return STATUS_NOT_FINITE;
    double worth = mg->windows ? WORTH_BETWEEN_WINDOWS : WORTH_A_TEST;
    worth *= mg->step.tolerance * mg->grid.segments;
    if (mg->bound > fmin(worth, mg->test_below))
        return STATUS_RUNNING;
    if (mg->bound > mg->step.tolerance) {
        if (mg->step.is_free) {
            centre_mass(mg);
            evaluate(mg);
        }
        bool decided = decide_test(mg);
        mg->counters.certificates++;
        mg->test_below = mg->bound / 2;
        mg->directed = decided;
        if (!decided || !(mg->residual <= mg->step.tolerance))
            return STATUS_RUNNING;
    }
    if (!leaves_saddle(mg))
        return STATUS_OK;
    evaluate(mg);
    return STATUS_RUNNING;
}

/* ---- the iteration ---- */

Status multigrid_start(Multigrid *mg, const MultigridStep *step)
{
    Grid *grid = &mg->grid;
    mg->known = mg->known && step->weight == mg->step.weight;
    mg->step = *step;
    mg->record = (MultigridRecord){0};
    mg->last_bound = INFINITY;
    mg->updated = false;
    mg->saddles = 0;
    begin_iterations(mg);
    mg->tips.weighed = false;
    crew_begin(mg->crew);
    if (!mg->known) {
        grid_set_nodes(grid, step->m, step->pinned);
        grid_set_springs(grid, step->k, step->l2, step->weight);
        v_cycle_set_nodes(mg->cycle);
    }
    mg->known = true;
    grid_pack(grid, step->x_n, grid->x_n);
    grid_pack(grid, step->u_tilde, grid->u_tilde);
    if (step->u)
        grid_pack(grid, step->u, grid->u);
    else
        grid_clear(grid, grid->u);
    grid_clear(grid, mg->r);
    grid_move(grid, NULL, 0, mg->r, 0, NULL);
    evaluate(mg);
    return multigrid_test(mg);
}

void multigrid_forget(Multigrid *mg)
{
    if (mg)
        mg->known = false;
}

/* The lowest point in the plane of p and the last update, or along p. */
static Status search_step(Multigrid *mg, double at[2])
{
    MultigridRecord *record = &mg->record;
    PlaneQuartic plane;
    grid_in_plane(&mg->grid, mg->g, mg->p, mg->r, plane.c);
    record->slope = plane.c[0];
    record->trials = 0;
    if (!isfinite(record->slope))
        return STATUS_NOT_FINITE;
    if (!(record->slope < 0))
        return STATUS_NOT_DESCENT;
    if (!mg->updated || plane_minimise(&plane, at, &record->trials)) {
        Quartic line = {{plane.c[0], plane.c[2], plane.c[5], plane.c[9]}};
        at[0] = quartic_first_minimum(&line);
        at[1] = 0;
        record->trials++;
    }
    record->alpha = at[0];
    record->change = plane_value(&plane, at[0], at[1]);
    if (!(record->change < 0))
        return STATUS_LINE_SEARCH_LIMIT;
    return STATUS_OK;
}

/* Windows are worth it once directions of the whole square no longer are. */
static void decide_windows(Multigrid *mg)
{
    if (mg->iterations >= GLOBAL_STEPS && mg->bound > STALLS * mg->last_bound)
        mg->windows = true;
    mg->last_bound = mg->bound;
}

Status multigrid_leave(Multigrid *mg)
{
    mg->step.minimum = true;
    return multigrid_test(mg);
}

Status multigrid_iterate(Multigrid *mg)
{
    const Grid *grid = &mg->grid;
    decide_windows(mg);
    if (!mg->directed)
        find_direction(mg, mg->windows ? CYCLES_BETWEEN_WINDOWS : MAX_CYCLES);
    mg->record.residual = mg->residual;
    double at[2];
    Status status = search_step(mg, at);
    if (status)
        return status;
    grid_move(grid, NULL, at[0], mg->p, at[1], mg->r);
    mg->updated = true;
    mg->iterations++;
    mg->counters.iterations++;
    if (!mg->windows) {
        evaluate(mg);
        return multigrid_test(mg);
    }
    long phases = mg->tips.phases, local = mg->tips.iterations;
    mg->record.change += tips_minimise(&mg->tips, mg->record.change, mg->g);
    mg->counters.windows += mg->tips.phases - phases;
    mg->counters.local += mg->tips.iterations - local;
    mg->counters.gradients++;
    bound_residual(mg, grid_inverse_mass_square(grid, mg->g));
    return multigrid_test(mg);
}

/* ---- what others may know ---- */

void multigrid_displacement(const Multigrid *mg, double *u)
{
    grid_unpack(&mg->grid, mg->grid.u, u);
}

double multigrid_residual(const Multigrid *mg)
{
    return mg->residual;
}

const MultigridRecord *multigrid_record(const Multigrid *mg)
{
    return &mg->record;
}

const MultigridCounters *multigrid_counters(const Multigrid *mg)
{
    return &mg->counters;
}

int multigrid_lanes(const Multigrid *mg)
{
    return mg->grid.kernels->lanes;
}

int multigrid_threads(const Multigrid *mg)
{
    return crew_threads(mg->crew);
}
