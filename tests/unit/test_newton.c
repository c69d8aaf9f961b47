/* test_newton.c - each way in which Newton's method can end, and its status,
 * checked by independent formulas. (`make stress` checks each update.) */
#include "test.h"
#include "stress.h"

#include <math.h>
#include <string.h>

#include "model/contact.h"
#include "solve/newton_parts.h"

/* Squares have up to 4 segments, most have 3 */
enum { MAX_UNKNOWNS = 2 * 25, UNKNOWNS_3_SEGMENTS = 2 * 16 };

/* The last record of a minimisation, and the iterate from which its p starts */
typedef struct LastRecord {
    const Simulation *simulation;
    NewtonRecord record;
    double u[MAX_UNKNOWNS];
} LastRecord;

static bool store_record(void *user, const NewtonRecord *record)
{
    LastRecord *last = user;
    const Newton *newton = last->simulation->run[0].newton;
    last->record = *record;
    memcpy(last->u, record->alpha != 0 ? newton->u_trial : newton->iterate.u,
           2 * (size_t)newton->system->nodes * sizeof *last->u);
    return true;
}

/* A residual that is called exact belongs to the exact direction at the iterate
 * before the update. An estimate errs by at most 1e-3 of itself; that of
 * multigrid by less than its distance from the tolerance. */
TEST(residuals_are_what_they_are_called)
{
    static const char *const lines[] = {
        "--segments 3 --tolerance 0.1",
        "--segments 3 --tolerance 1e-5",
        "--segments 3 --stretch 1.0001 --tolerance 1e-3",
        "--segments 3 --tolerance 1e-3 --stretch 0.6",
        "--segments 2 --tolerance 3 --stretch 2",
        "--segments 4 --solver multigrid --tolerance 1e-3",
        "--segments 4 --solver multigrid --stretch 1.001"};
    int seen[2][2] = {{0}};
    for (int line = 0; line < 7; line++) {
        LastRecord last;
        Simulation *simulation =
            simulate_observed(store_record, &last, "%s", lines[line]);
        TimeIntegrator *run = &simulation->run[0];
        const Newton *newton = run->newton;
        double tolerance = simulation->options.tolerance;
        last.simulation = simulation;
        for (int step = 0; step < 60; step++) {
            double x_n[MAX_UNKNOWNS];
            memcpy(x_n, run->x, 2 * (size_t)run->system->nodes * sizeof *x_n);
            make_steps(simulation, 1);
            IncrementalPotential E = newton->iterate.E;
            E.x_n = x_n;
            double residual = last.record.residual;
            double exact = exact_residual(&E, last.u, NULL, run->h, 0, 1, NULL);
            bool multigrid = newton->active_solver == SOLVER_MULTIGRID;
            seen[multigrid][last.record.residual_kind]++;
            if (last.record.residual_kind == RESIDUAL_EXACT)
                CHECK_NEAR(residual, exact, 1e-9 * exact + 1e-10);
            else if (multigrid && newton->meets_tolerance)
                CHECK_NEAR(residual, exact, tolerance - residual);
            else if (multigrid) /* the bound ends the step */
                CHECK_AT_MOST(exact_residual(&E, newton->iterate.u, NULL,
                                             run->h, 0, 1, NULL),
                              tolerance);
            else
                CHECK_NEAR(residual, exact, 1e-3 * exact);
        }
    }
    CHECK(seen[0][RESIDUAL_EXACT] > 20 && seen[0][RESIDUAL_ESTIMATE] > 20);
    CHECK(seen[1][RESIDUAL_EXACT] == 0 && seen[1][RESIDUAL_ESTIMATE] > 20);
}

/* ---- two nodes ----------------------------------------------------------- */

/* Two nodes joined by a spring of 1 m, which create_node_pair replaces */
static System pair;
static Newton newton;

static void create_node_pair(double m0, double m1, double k)
{
    newton_free(&newton);
    system_free(&pair);
    memset(&newton, 0, sizeof newton);
    CHECK_OK(system_create(2, 1, &pair));
    pair.e[1] = 1;
    pair.l2[0] = 1;
    pair.k[0] = k;
    pair.m[0] = m0;
    pair.m[1] = m1;
}

static void create_newton_for_pair(double h, double tolerance,
                                   Projection projection)
{
    const NewtonSettings settings = {.h = h,
                                     .tolerance = tolerance,
                                     .projection = projection,
                                     .max_iterations = 100};
    CHECK_OK(newton_create(&pair, &settings, &newton));
}

static Status minimise_pair(const double *x, double weight)
{
    newton_start(&newton, x, NULL, weight, newton.settings.tolerance);
    return newton_minimise(&newton);
}

/* With both nodes in one point and h = 1 the Hessian is [[m0 - 2, 2], [2, m1 -
 * 2]], which is indefinite where 1/m0 + 1/m1 > 1/2. The gradient is 0, so the
 * loop ends at once; without projection it counts an indefinite end. */
TEST(a_maximum_is_counted_without_projection)
{
    static const struct {
        double m0, m1;
        bool is_indefinite;
    } rows[] = {{0.1, 1e6, true}, {1e6, 0.1, true},  {2.2, 4.2, true},
                {3.9, 3.9, true}, {4.1, 4.1, false}, {2.1, 1e6, false}};
    const double x[4] = {0};
    for (int i = 0; i < 6; i++) {
        create_node_pair(rows[i].m0, rows[i].m1, 1);
        create_newton_for_pair(1, 1e-3, PROJECTION_NONE);
        CHECK_OK(minimise_pair(x, 1));
        CHECK(newton.counters.indefinite_convergences == rows[i].is_indefinite);
    }
}

/* A spring of stiffness k and rest length 1 joins a pinned node and a node of 1
 * kg at (1/2, 0); a force pulls sideways. With h = 1 the sideways entry of the
 * Hessian is 1 - 3/2 k. An entry near 0 makes p 1e38 m long: E falls only for
 * alpha below 2^-64. With projection the spring swings out. */
TEST(nearly_singular_steps_end_or_say_why_not)
{
    static const struct {
        double k, sideways_pull;
        Projection projection;
        Status end_status;
    } rows[] = {
        {(1 - 1e-8) / 1.5, 1e30, PROJECTION_NONE, STATUS_LINE_SEARCH_LIMIT},
        {2.0 / 3, 1, PROJECTION_NONE, STATUS_SINGULAR},
        {2.0 / 3, 1, PROJECTION_CLAMP, STATUS_OK}};
    const double x[4] = {0, 0, 0.5, 0};
    for (int i = 0; i < 3; i++) {
        Real g[4], H[16];
        const Iterate *at = &newton.iterate;
        create_node_pair(1, 1, rows[i].k);
        pair.is_pinned[0] = 1;
        create_newton_for_pair(1, 1e-6, rows[i].projection);
        newton.u_tilde[3] = rows[i].sideways_pull;
        CHECK_STATUS(minimise_pair(x, 1), rows[i].end_status);
        CHECK(at->u[0] == 0 && at->u[1] == 0);
        if (rows[i].end_status == STATUS_LINE_SEARCH_LIMIT)
            CHECK(newton.record.slope < 0 && newton.record.alpha == 0 &&
                  newton.record.trials == 65);
        for (int c = 0; rows[i].end_status && c < 4; c++)
            CHECK(at->u[c] == 0 && at->x[c] == x[c]);
        if (rows[i].end_status)
            continue;
        CHECK(at->u[3] > 0.5);
        exact_derivatives(&at->E, at->u, at->x, 1, 0, g, H);
        CHECK_NEAR(g[2], 0, 1e-5); /* tolerance times the largest eigenvalue */
        CHECK_NEAR(g[3], 0, 1e-5);
    }
}

/* ---- squares of next to no mass --------------------------------------- */

static bool store_max_shift(void *user, const NewtonRecord *record)
{
    double *largest = user;
    *largest = fmax(*largest, record->shift);
    return true;
}

/* Springs of 1e30 J/m^2 hide the masses in the rounding of H, which leaves the
 * last pivots of a free square near 0. A shift, small against h^2 k, replaces
 * the masses; conjugate gradients restore them and the mean velocity. */
TEST(tiny_masses_keep_their_velocity)
{
    double shift = 0;
    Simulation *simulation = simulate_observed(store_max_shift, &shift,
                                               "--segments 3 --stiffness 1e30");
    TimeIntegrator *run = &simulation->run[0];
    double start = system_potential(&simulation->system, run->x);
    for (int i = 0; i < UNKNOWNS_3_SEGMENTS; i++)
        run->v[i] = i % 2 ? 2 : 1;
    make_steps(simulation, 1);
    CHECK(shift > 0);
    CHECK_AT_MOST(shift, 1e-10 * 16e-6 * 1e30);
    double mean[2] = {0, 0};
    for (int i = 0; i < UNKNOWNS_3_SEGMENTS; i++)
        mean[i % 2] += run->v[i] / (UNKNOWNS_3_SEGMENTS / 2);
    CHECK_NEAR(mean[0], 1, 1e-12); /* rounding of 16 terms of up to 100 m/s */
    CHECK_NEAR(mean[1], 2, 1e-12);
    CHECK_AT_MOST(system_potential(&simulation->system, run->x), 1e-6 * start);
}

static bool pause_always(void *unused, const NewtonRecord *record)
{
    (void)unused, (void)record;
    return false;
}

/* Checks that no iterate raises E, and no step from rest the total energy. */
static bool check_energy_falls(void *unused, char *line)
{
    (void)unused;
    Simulation *simulation = simulate_observed(pause_always, NULL, "%s", line);
    TimeIntegrator *run = &simulation->run[0];
    Newton *newton = run->newton;
    const Iterate *at = &newton->iterate;
    for (int step = 0; step < 6; step++) {
        memset(run->v, 0, run->x_length * sizeof *run->v);
        memset(newton->u_tilde, 0, run->x_length * sizeof *run->v);
        newton_start(newton, run->x, NULL, run->h * run->h,
                     newton->settings.tolerance);
        double start = incremental_potential_value(&at->E, at->u, at->x);
        while (newton->status == STATUS_RUNNING) {
            newton_minimise(newton);
            CHECK_AT_MOST(incremental_potential_value(&at->E, at->u, at->x),
                          start * (1 + 1e-9));
        }
        double before = simulation_get_energies(simulation, 0).total;
        Status status = simulation_step(simulation);
        CHECK(!status || status_is_unconverged(status));
        CHECK_AT_MOST(simulation_get_energies(simulation, 0).total,
                      before * (1 + 1e-9));
    }
    return true;
}

TEST(energy_never_rises_without_masses)
{
    stress_read_rows("massless", check_energy_falls, NULL);
}

/* ---- backtracking ------------------------------------------------------ */

/* A made-up E along p: alphas up to max_alpha do not raise it */
typedef struct FakeEnergy {
    double max_alpha, change_below, change_above;
    int call_count;
} FakeEnergy;

static double fake_energy_difference(const void *function, double alpha)
{
    FakeEnergy *line = *(FakeEnergy *const *)function;
    line->call_count++;
    return alpha <= line->max_alpha ? line->change_below : line->change_above;
}

/* Backtracking takes the first of alpha, alpha/2, alpha/4, ... that does not
 * raise E; NaN is not lower; the search fails below 2^-64. */
TEST(backtracking_takes_the_first_that_is_not_higher)
{
    static const struct {
        double start_alpha;
        FakeEnergy energy;
        double alpha;
        int trials;
    } rows[] = {
        {1, {1, -1, 1, 0}, 1, 1},         {1, {1, 0, 1, 0}, 1, 1},
        {1, {0.5, 0, 1, 0}, 0.5, 2},      {1, {0.25, -1, NAN, 0}, 0.25, 3},
        {0.3, {0.1, -1, 1, 0}, 0.075, 3}, {1, {0x1p-64, -1, 1, 0}, 0x1p-64, 65},
        {1, {0x1p-65, -1, 1, 0}, 0, 65},  {1, {0, -1, NAN, 0}, 0, 65}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        FakeEnergy line = rows[i].energy, *pointer = &line;
        double alpha = rows[i].start_alpha;
        int trials;
        CHECK_STATUS(line_search_backtrack(fake_energy_difference, &pointer,
                                           &alpha, &trials),
                     rows[i].alpha > 0 ? STATUS_OK : STATUS_LINE_SEARCH_LIMIT);
        CHECK(alpha == rows[i].alpha);
        CHECK(trials == rows[i].trials && line.call_count == trials);
    }
}

/* ---- ends ------------------------------------------------------------- */

TEST(parts_share_one_limit)
{
    Simulation *simulation = simulate("squeeze --segments 8 --gravity 0");
    TimeIntegrator *run = &simulation->run[0];
    get_contact(run->system)->obstacle[1].motion = (ObstacleMotion){
        .phase_count = 1, .phase_end = {0.01}, .v = {{0, -50}}};
    run->newton->settings.max_iterations = 10;
    CHECK_STATUS(simulation_step(simulation), STATUS_ITERATION_LIMIT);
    CHECK_AT_MOST(run->newton->counters.updates, 19);
    CHECK(run->moved_fraction > 0 && run->moved_fraction < 1);
    CHECK(find_smallest_gap(run->system, run->x) > 0);
}

TESTS(NULL, NULL)
