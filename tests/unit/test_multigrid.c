/* test_multigrid.c - multigrid: changes of E and final residuals in extended
 * precision, its work, and bits that do not depend on earlier steps. (`make
 * stress` tests that both solvers find the same minimum.) */
#include "test.h"
#include "stress.h"

#include <string.h>

#include "model/pull_energy.h"
#include "solve/multigrid.h"
#include "solve/newton_parts.h"

enum { MAX_UNKNOWNS = 2 * 129 * 129 }; /* unknowns of the largest square here */

static Newton *newton; /* minimiser of the running test */
static Iterate *at;    /* iterate of newton */
static System *body;
static double *x_n; /* positions at the start of the step, m */
static int size;    /* 2n */

static const double H = 0.004;

static Simulation *begin_square(int segments, double stretch)
{
    Simulation *square = simulate(
        "--segments %d --stretch %g --solver multigrid", segments, stretch);
    newton = square->run[0].newton;
    at = &newton->iterate;
    body = &square->system;
    x_n = square->run[0].x;
    size = 2 * body->nodes;
    at->E = (IncrementalPotential){.system = body,
                                   .weight = H * H,
                                   .x_n = x_n,
                                   .u_tilde = newton->u_tilde};
    CHECK(size <= MAX_UNKNOWNS);
    return square;
}

static void randomise_square(Random *random, bool pins)
{
    int side = body->segments + 1;
    double cell = 1.0 / body->segments;
    if (pins) {
        for (int i = 0; i < side; i++)
            body->is_pinned[i * side + side - 1] = 1;
        for (int i = 0; i <= body->nodes / 20; i++)
            body->is_pinned[random_below(random, body->nodes)] = 1;
    }
    for (int i = 0; i < size; i++) {
        if (i % 2 == 0)
            body->m[i / 2] *= random_logarithmic(random, 0.3, 3);
        x_n[i] += random_uniform(random, -0.4, 0.4) * cell;
        newton->u_tilde[i] = random_uniform(random, -0.1, 0.1) * cell;
    }
    for (int s = 0; s < body->springs; s++) {
        body->k[s] *= random_logarithmic(random, 0.1, 10);
        body->l2[s] *= random_logarithmic(random, 0.5, 2);
        if (random_below(random, 10) == 0)
            body->k[s] = 0;
    }
    system_mark_changed(body, true);
}

/* Adds a hand of the stiffness `times` mass/h^2 at the middle node. */
static void pull_middle_node(double times)
{
    int node = body->nodes / 2;
    NodePull hand = {.node = node,
                     .mouse_xy = {0.1, 0.4},
                     .mouse_k = times * body->m[node] / (H * H),
                     .cell_size = 1.0 / body->segments,
                     .body_side = 1};
    CHECK_OK(pull_configure(body, &hand_energy, &hand));
}

/* ---- whole steps ------------------------------------------------------- */

/* E at the start and now; counts of residuals tested in extended precision */
typedef struct EnergyHistory {
    Real start_energy, last_energy;
    int tested_residual_count; /* number of tested residuals */
    int bound_end_count;       /* steps ended by a bound of the next residual */
} EnergyHistory;

static bool check_E_decrease(void *user, const NewtonRecord *record)
{
    static const double zero[MAX_UNKNOWNS];
    EnergyHistory *E = user;
    if (record->iteration == 0)
        E->start_energy = E->last_energy =
            exact_energy(&(StepPotential){.E = at->E}, zero);
    Real now = exact_energy(&(StepPotential){.E = at->E}, at->u);
    CHECK_AT_MOST(now, E->last_energy);
    CHECK_NEAR(now - E->last_energy, record->energy_change,
               2e-14L * E->start_energy);
    E->last_energy = now;
    if (record->status == STATUS_OK) {
        const double *judged =
            newton->meets_tolerance ? newton->u_trial : at->u;
        CHECK(test_cg_residual(&newton->iterate.E, judged, newton->settings.h,
                               newton->tolerance) == TEST_PASSED);
        E->tested_residual_count++;
        E->bound_end_count += !newton->meets_tolerance;
    }
    return true;
}

/* Updates of plain, random and pulled squares lower E by the recorded changes;
 * the last residual of each step passes the stopping test of Algorithm 3. */
TEST(steps_fall_and_pass_the_test_of_algorithm_3)
{
    static const struct {
        int segments;
        double stretch;
        bool is_random, has_pins;
        double hand_stiffness;
    } rows[] = {{16, 1.4, false, false, 0}, {21, 0.7, false, false, 0},
                {6, 1.2, true, false, 0},   {11, 1.2, true, true, 0},
                {16, 1.2, true, false, 10}, {21, 1.2, true, true, 0},
                {40, 1.1, false, false, 3}, {33, 1.4, false, false, 3000},
                {1, 1.2, true, false, 0},   {2, 1.2, true, false, 0},
                {7, 1.2, true, true, 0},    {8, 1.2, true, false, 0},
                {15, 1.2, true, true, 0},   {31, 1.2, true, false, 0},
                {16, 1.1, false, false, 0}};
    for (int i = 0; i < 15; i++) {
        Random random = {(uint64_t)i};
        EnergyHistory history = {0};
        Simulation *square = begin_square(rows[i].segments, rows[i].stretch);
        if (rows[i].is_random)
            randomise_square(&random, rows[i].has_pins);
        if (rows[i].hand_stiffness > 0)
            pull_middle_node(rows[i].hand_stiffness);
        if (i == 14) /* short steps end by the bound of the next p */
            square->run[0].h = newton->settings.h = 1e-4;
        newton->settings.observer = check_E_decrease;
        newton->settings.user_data = &history;
        for (int step = 0; step < (i == 0 ? 12 : 4); step++) {
            make_steps(square, 1);
            CHECK(newton->active_solver == SOLVER_MULTIGRID);
        }
        CHECK(history.tested_residual_count > 1 &&
              newton->counters.newton_takeovers == 0);
        CHECK(i < 14 || history.bound_end_count > 0);
    }
}

static Status minimise(double tolerance)
{
    newton_start(newton, x_n, NULL, H * H, tolerance);
    return newton_minimise(newton);
}

/* The tolerance is just below the exact residual of the first direction.
 * Multigrid's residual may be lower, but its upper bound is not. */
TEST(undecided_directions_have_not_converged)
{
    static const double parts[] = {0.9, 0.99, 0.999, 0.999999};
    for (int i = 0; i < 5; i++) {
        begin_square(16, 1.1 + 0.05 * i);
        newton->settings.max_iterations = 1;
        newton->settings.solver = SOLVER_NEWTON;
        CHECK_STATUS(minimise(1e-30), STATUS_ITERATION_LIMIT);
        double residual = newton->record.residual;
        newton->settings.solver = SOLVER_MULTIGRID;
        for (int k = 0; k < 4; k++) {
            CHECK_STATUS(minimise(parts[k] * residual), STATUS_ITERATION_LIMIT);
            CHECK_NEAR(newton->record.residual, residual, 0.1 * residual);
        }
    }
}

/* A new and a used multigrid give the same bits, also with stiffer springs. */
TEST(bits_depend_on_the_step_alone)
{
    static double first[MAX_UNKNOWNS];
    for (int pins = 0; pins < 2; pins++) {
        Multigrid *multigrid[2];
        Random random = {5};
        begin_square(64, 1.4);
        if (pins)
            randomise_square(&random, true);
        CHECK_OK(multigrid_create(64, &multigrid[0]));
        for (int n = 0; n < (pins ? 2 : 9); n++) {
            bool stiffer = n > 0 && n % 2 == 0;
            for (int s = 0; stiffer && s < body->springs; s++)
                body->k[s] *= s % 2 ? 1.1 : 1.2;
            if (stiffer)
                system_mark_changed(body, false);
            CHECK_OK(multigrid_create(64, &multigrid[1]));
            for (int i = 0; i < 2; i++) {
                newton->multigrid = multigrid[i];
                CHECK_OK(minimise(newton->settings.tolerance));
                if (i > 0)
                    CHECK_SAME_BITS(at->u, first, size);
                memcpy(first, at->u, (size_t)size * sizeof *first);
            }
            multigrid_free(multigrid[1]);
            for (int i = 0; i < size; i++) {
                x_n[i] += at->u[i];
                newton->u_tilde[i] = at->u[i];
            }
        }
        CHECK(newton->counters.tile_sweeps > 0);
        multigrid_free(multigrid[0]);
        newton->multigrid = NULL;
    }
}

/* Multigrid takes no more cycles than the table allows. Smooth steps take one
 * cycle for each update; pins, broken springs and random masses take more. Long
 * steps of a stiff spinning square take few sweeps of tiles. */
TEST(steps_take_no_more_work_than_counted)
{
    static const struct {
        int segments, max_regular_cycles, max_random_cycles;
    } rows[] = {{16, 25, 45}, {32, 30, 85}, {64, 32, 119}, {128, 36, 217}};
    for (int i = 0; i < 8; i++) {
        Random random = {7};
        bool rough = i % 2;
        Simulation *square = begin_square(rows[i / 2].segments, 1.4);
        if (rough)
            randomise_square(&random, true);
        make_steps(square, 5);
        CHECK_AT_MOST(newton->counters.v_cycles,
                      rough ? rows[i / 2].max_random_cycles
                            : rows[i / 2].max_regular_cycles);
        CHECK(rough || newton->counters.updates == newton->counters.v_cycles);
        CHECK(rough || newton->counters.tile_sweeps == 0);
    }
    Simulation *stiff = simulate("--segments 16 --stretch 1 --stiffness 1e9 "
                                 "--timestep 0.00625 --tolerance 0.00625");
    for (size_t i = 0; i < stiff->run->x_length; i++)
        stiff->run->v[i] = (i % 2 ? 10 : -10) * stiff->run->x[i ^ 1];
    make_steps(stiff, 16);
    CHECK_AT_MOST(stiff->run->newton->counters.tile_sweeps, 7000);
}

TESTS(NULL, NULL)
