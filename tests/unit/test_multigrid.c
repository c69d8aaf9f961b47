/* Multigrid: what each update does to E and the certified end, against sums and
 * a solution in extended precision; the work that it takes, and the same bits
 * whatever was before.  Both solvers: the same minimum, and what a step may
 * skip, by a counter.
 */
#include "test.h"
#include "stress.h"

#include <stdio.h>
#include <string.h>

#include "model/fracture.h"
#include "model/pull_energy.h"
#include "solve/multigrid.h"
#include "solve/newton_parts.h"

/* A square's step problem: the system of a command line, and where it is. */
enum { LARGEST = 2 * 129 * 129 };

static Newton *newton; /* of the present test's */
static Iterate *at;
static System *body;
static double *x_n;
static int size; /* 2n */

static const double H = 0.004;

static Simulation *begin_problem(int segments, double stretch)
{
    Simulation *square = simulate(
        "--segments %d --stretch %g --solver multigrid", segments, stretch);
    newton = square->run[0].newton;
    at = &newton->at;
    body = &square->system;
    x_n = square->run[0].x;
    size = 2 * body->nodes;
    at->E = (IncrementalPotential){.system = body,
                                   .weight = H * H,
                                   .x_n = x_n,
                                   .u_tilde = newton->u_tilde};
    CHECK(size <= LARGEST);
    return square;
}

/* Moves, breaks, pins and weighs at random. */
static void disturb(Random *random, bool pins)
{
    int side = body->segments + 1;
    double cell = 1.0 / body->segments;
    if (pins) {
        for (int i = 0; i < side; i++)
            body->pinned[i * side + side - 1] = 1;
        for (int i = 0; i <= body->nodes / 20; i++)
            body->pinned[random_below(random, body->nodes)] = 1;
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

/* A hand that pulls the node in the middle, as stiffly as `times` its mass. */
static void pull(double times)
{
    int node = body->nodes / 2;
    Pull hand = {.node = node,
                 .mouse = {0.1, 0.4},
                 .strength = times * body->m[node] / (H * H),
                 .cell = 1.0 / body->segments,
                 .side = 1};
    CHECK_OK(pull_configure(body, &hand_energy, &hand));
}

/* ---- whole steps ------------------------------------------------------- */

/* No update may raise E nor lower it by something else than it says.  The end
 * is judged in extended precision. */
typedef struct Fall {
    Real start, now;
    int judged;
    int by_bound; /* steps ended by a bound of the next residual */
} Fall;

static bool see_fall(void *user, const NewtonRecord *record)
{
    static const double zero[LARGEST];
    Fall *E = user;
    if (record->iteration == 0)
        E->start = E->now = wide_energy(&(Moment){.E = at->E}, zero);
    Real now = wide_energy(&(Moment){.E = at->E}, at->u);
    CHECK_AT_MOST(now, E->now);
    CHECK_NEAR(now - E->now, record->change, 2e-14L * E->start);
    E->now = now;
    if (record->status == STATUS_OK) {
        const double *judged = newton->passes ? newton->u_trial : at->u;
        CHECK(large_judge(&newton->at.E, judged, newton->settings.h,
                          newton->tolerance) == LARGE_PASSED);
        E->judged++;
        E->by_bound += !newton->passes;
    }
    return true;
}

/* As they are, at random, and with a hand that pulls. */
TEST(steps_fall_and_pass_the_test_of_algorithm_3)
{
    static const struct {
        int segments;
        double stretch;
        bool disturbed, pins;
        double hand;
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
        Fall fall = {0};
        Simulation *square = begin_problem(rows[i].segments, rows[i].stretch);
        if (rows[i].disturbed)
            disturb(&random, rows[i].pins);
        if (rows[i].hand > 0)
            pull(rows[i].hand);
        if (i == 14) /* a short step, which a bound ends */
            square->run[0].h = newton->settings.h = 1e-4;
        newton->settings.observer = see_fall;
        newton->settings.user = &fall;
        for (int step = 0; step < (i == 0 ? 12 : 4); step++) {
            make_steps(square, 1);
            CHECK(newton->active_solver == SOLVER_MULTIGRID);
        }
        CHECK(fall.judged > 1 && newton->counters.handed_over == 0);
        CHECK(i < 14 || fall.by_bound > 0);
    }
}

static Status minimise(double tolerance)
{
    newton_start(newton, x_n, NULL, H * H, tolerance);
    return newton_minimise(newton);
}

/* The first direction does not pass with a tolerance just below its residual,
 * which a factor knows: multigrid's p may seem shorter, but its error counts.
 */
TEST(what_is_not_decided_is_not_converged)
{
    static const double parts[] = {0.9, 0.99, 0.999, 0.999999};
    for (int i = 0; i < 5; i++) {
        begin_problem(16, 1.1 + 0.05 * i);
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

/* Steps, and from each of these starts one with a new object that knows of no
 * step before: the same bits.  In the midst springs become stiffer. */
TEST(bits_depend_on_the_step_alone)
{
    static double first[LARGEST];
    for (int pins = 0; pins < 2; pins++) {
        Multigrid *multigrid[2];
        Random random = {5};
        begin_problem(64, 1.4);
        if (pins)
            disturb(&random, true);
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

/* Smooth steps take about as many directions and cycles at any size; where
 * nodes are held, springs broken and masses are not alike, more: here at most
 * as many cycles as they took when this was written. */
TEST(steps_take_no_more_work)
{
    static const struct {
        int segments, smooth, rough;
    } rows[] = {{16, 25, 65}, {32, 31, 147}, {64, 33, 250}, {128, 38, 472}};
    for (int i = 0; i < 8; i++) {
        Random random = {7};
        bool rough = i % 2;
        Simulation *square = begin_problem(rows[i / 2].segments, 1.4);
        if (rough)
            disturb(&random, true);
        make_steps(square, 5);
        CHECK_AT_MOST(newton->counters.cycles,
                      rough ? rows[i / 2].rough : rows[i / 2].smooth);
        CHECK(rough || newton->counters.iterations <= 5 * 5);
        CHECK(rough || newton->counters.tile_sweeps == 0);
    }
}

static const char *const implicit_names[] = {"backward-euler", "bdf2",
                                             "midpoint", "sdirk2"};
enum { IMPLICIT = sizeof implicit_names / sizeof *implicit_names };

/* Positions, velocities and what the method remembers. */
static void copy_state(const TimeIntegrator *from, TimeIntegrator *to)
{
    memcpy(to->x, from->x, from->size * sizeof *to->x);
    memcpy(to->v, from->v, from->size * sizeof *to->v);
    if (from->memory)
        memcpy(to->memory, from->memory,
               from->size * (size_t)from->method->memory * sizeof *to->x);
    to->memory_h = from->memory_h;
}

/* From the same state both end in the same, step by step: within so many times
 * what the tolerance allows a direction to be.  Returns the other. */
static Simulation *check_same_minimum(const char *scene, const char *other,
                                      int steps, double times)
{
    Simulation *newton = simulate("%s --solver newton", scene);
    Simulation *it = simulate("%s %s", scene, other);
    const TimeIntegrator *a = &newton->run[0];
    TimeIntegrator *b = &it->run[0];
    double bound = times * a->h * newton->options.tolerance;
    for (int step = 0; step < steps; step++) {
        copy_state(a, b);
        make_steps(newton, 1);
        make_steps(it, 1);
        for (size_t i = 0; i < a->size; i++)
            CHECK_NEAR(b->x[i], a->x[i], bound);
    }
    CHECK(b->newton->counters.iterations > 0);
    return it;
}

static const char multigrid[] = "--solver multigrid";

TEST(multigrid_finds_the_same_minimum)
{
    static const char *const lines[] = {"--segments 8 --stretch 1.1",
                                        "--stretch 3",
                                        "--stretch 0.5 --timestep 0.02"};
    for (int line = 0; line < 3; line++)
        for (int i = 0; i < IMPLICIT; i++) {
            char scene[250];
            snprintf(scene, sizeof scene,
                     "%s --tolerance 1e-10 --integrator %s", lines[line],
                     implicit_names[i]);
            check_same_minimum(scene, multigrid, 10, 20);
        }
}

/* Damped springs, gravity and pins, springs that break.  Where springs break,
 * rounding hides what iterations change of E from a tolerance of 1e-7 on. */
TEST(multigrid_serves_all_that_springs_do)
{
    static const char *const lines[] = {
        "square --segments 40 --damping 0.005 --tolerance 1e-7",
        "hang --segments 40 --damping 0.05 --tolerance 1e-7",
        ("square --segments 36 --damping 0.001 --tear 0.5 --stretch 1.26 "
         "--tolerance 5e-7"),
        "square --segments 36 --tear 0.5 --stretch 1.26 --tolerance 5e-7"};
    for (int i = 0; i < 4; i++) {
        Simulation *it = check_same_minimum(lines[i], multigrid, 8, 100);
        const Newton *newton = it->run[0].newton;
        CHECK(newton->active_solver == SOLVER_MULTIGRID && !newton->refusal);
        CHECK(newton->counters.cycles > 0 && newton->counters.handed_over == 0);
        CHECK(i < 2 || energy_now(it, 0, "fracture") > 0);
    }
}

/* A square at rest takes one iteration a step, and stays where it is. */
TEST(rest_takes_one_iteration)
{
    for (int i = 0; i < 2 * IMPLICIT; i++) {
        Simulation *rest =
            make_steps(simulate("--stretch 1 --integrator %s %s",
                                implicit_names[i / 2], i % 2 ? multigrid : ""),
                       5);
        NewtonCounters did = simulation_sum_counters(rest);
        CHECK(did.iterations <= 5 * rest->run[0].method->stages);
        for (size_t c = 0; c < rest->run[0].size; c++)
            CHECK(fabs(rest->run[0].v[c]) < 1e-15);
    }
}

static bool count_factored(void *user, const NewtonRecord *record)
{
    *(long *)user += record->factorised;
    return true;
}

/* What counters say of ten steps: Algorithm 3 has a factor for each direction,
 * multigrid none at all; tiles are for steps that are not over after some
 * directions of the whole square, where it buckles. */
TEST(counters_count_what_was_done)
{
    static const struct {
        const char *line;
        bool factors, cycles, tiles;
    } rows[] = {{"--segments 8", true, false, false},
                {"--segments 8 --solver multigrid", false, true, false},
                {"--segments 40 --stretch 1.4", false, true, true},
                {"--segments 40 --stretch 1.01", false, true, false},
                {"--segments 8 --stretch 2", true, false, false}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        long factored = 0;
        Simulation *square = make_steps(
            simulate_watched(count_factored, &factored, "%s", rows[i].line),
            14);
        NewtonCounters did = simulation_sum_counters(square);
        CHECK(did.iterations > 0);
        CHECK((factored > 0) == rows[i].factors);
        CHECK((did.solves > 0) == rows[i].factors);
        CHECK((did.cycles > 0) == rows[i].cycles);
        CHECK((did.tile_sweeps > 0) == rows[i].tiles);
    }
}

/* Who works, and why it is not multigrid. */
TEST(what_does_not_fit_is_left_to_newton)
{
    static const struct {
        const char *line;
        Solver working;
        const char *refusal; /* a word of it */
    } rows[] = {
        {"--segments 8 --solver auto", SOLVER_NEWTON, NULL},
        {"--segments 9 --solver auto", SOLVER_MULTIGRID, NULL},
        {"--segments 33 --solver auto", SOLVER_MULTIGRID, NULL},
        {"--segments 33 --integrator bdf2", SOLVER_MULTIGRID, NULL},
        {"--segments 33 --integrator sdirk2", SOLVER_MULTIGRID, NULL},
        {"--segments 33 --gravity 9.81 --pin top", SOLVER_MULTIGRID, NULL},
        {"--segments 33 --projection abs", SOLVER_NEWTON, "projection"},
        {"--segments 33 --line-search none", SOLVER_NEWTON, "line search"},
        {"--segments 33 --stiffness 1e17", SOLVER_NEWTON, "outweigh"},
        {"--segments 8 --solver multigrid", SOLVER_MULTIGRID, NULL},
        {"--segments 33 --ground 0,1,0,-1", SOLVER_NEWTON, "energies"},
        {"tear --solver multigrid", SOLVER_NEWTON, "energies"},
        {"bend --solver multigrid", SOLVER_NEWTON, "no square grid"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const Newton *newton =
            make_steps(simulate("--stretch 1.1 %s", rows[i].line), 1)
                ->run[0]
                .newton;
        CHECK(newton->active_solver == rows[i].working);
        CHECK(!newton->refusal == !rows[i].refusal);
        CHECK(!rows[i].refusal || strstr(newton->refusal, rows[i].refusal));
    }
}

/* Below rounding multigrid cannot go on; Newton judges the end. */
TEST(newton_takes_back_what_multigrid_cannot_end)
{
    Simulation *square =
        simulate("--segments 8 --stretch 1.2 --tolerance 1e-15 %s", multigrid);
    for (int step = 0; step < 3; step++)
        CHECK(status_is_unconverged(simulation_step(square)));
    NewtonCounters did = simulation_sum_counters(square);
    CHECK(did.handed_over == 3 && did.cycles > 0 && did.factorisations > 0);
}

TESTS(NULL, NULL)
