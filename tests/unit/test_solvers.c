/* Multigrid against Algorithm 3, and what a step may skip: each by a
 * counter, or by formulas that share nothing with the solvers.
 */
#include "test.h"

#include <stdio.h>
#include <string.h>

#include "model/fracture.h"
#include "solve/newton_parts.h"

static const char *const implicit_names[] = {
    "backward-euler", "bdf2", "midpoint", "sdirk2", "avf", "avf4"};
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
    static const char *const lines[] = {
        "", "--segments 8 --stretch 1.1", "--segments 8 --stretch 0.9",
        "--stretch 3", "--stretch 0.5 --timestep 0.02"};
    for (int line = 0; line < 5; line++)
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
        CHECK(newton->working == SOLVER_MULTIGRID && !newton->refusal);
        CHECK(newton->counters.cycles > 0 && newton->counters.taken_back == 0);
        const Fracture *breaks = system_data(&it->system, &fracture);
        CHECK(i < 2 || breaks->broken > 0);
    }
}

/* At rest no matrix is ever made. */
TEST(rest_needs_no_factor)
{
    for (int i = 0; i < 2 * IMPLICIT; i++) {
        Simulation *rest =
            make_steps(simulate("--stretch 1 --integrator %s %s",
                                implicit_names[i / 2], i % 2 ? multigrid : ""),
                       5);
        NewtonCounters did = simulation_counters(rest);
        CHECK(did.factorisations == 0 && did.solves == 0 &&
              did.iterations == 0 && did.projected == 0);
        CHECK(rest->run[0].newton->search.cholesky == NULL);
        for (size_t c = 0; c < rest->run[0].size; c++)
            CHECK(rest->run[0].v[c] == 0);
    }
}

/* Nor where the test lets forces be left, though their bound does not tell. */
TEST(what_is_left_to_rest_needs_no_factor)
{
    Simulation *square = make_steps(simulate("--segments 8"), 300);
    const Newton *newton = square->run[0].newton;
    long before = newton->counters.factorisations;
    make_steps(square, 5);
    CHECK(newton->kind == RESIDUAL_ESTIMATE);
    CHECK(newton->counters.factorisations == before);
}

static bool count_factored(void *user, const NewtonRecord *record)
{
    *(long *)user += record->factorised;
    return true;
}

/* What counters say of ten steps: Algorithm 3 has a factor for each direction,
 * multigrid none at all; tiles are for steps that are not over after some
 * directions of the whole square, where it buckles; the default square of 16
 * segments comes to a saddle when it buckles, which Newton leaves if it is
 * asked to. */
TEST(counters_tell_what_was_done)
{
    static const struct {
        const char *line;
        bool factors, cycles, tiles, saddles;
    } rows[] = {{"--segments 8", true, false, false, false},
                {"--segments 8 --solver multigrid", false, true, false, false},
                {"--segments 40 --stretch 1.4", false, true, true, false},
                {"--segments 40 --stretch 1.01", false, true, false, false},
                {"--segments 16", true, false, false, false},
                {"--segments 16 --minimum", true, false, false, true}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        long factored = 0;
        Simulation *square = make_steps(
            simulate_watched(count_factored, &factored, "%s", rows[i].line),
            14);
        NewtonCounters did = simulation_counters(square);
        CHECK(did.iterations > 0);
        CHECK((factored > 0) == rows[i].factors);
        CHECK((did.solves > 0) == rows[i].factors);
        CHECK((did.cycles > 0) == rows[i].cycles);
        CHECK((did.local > 0) == rows[i].tiles);
        CHECK((did.saddles > 0) == rows[i].saddles);
    }
}

/* Asked for a minimum, multigrid's steps do not end on a saddle either: Newton
 * makes one iteration, which leaves it, and multigrid goes on.  At the end of
 * each the Hessian as it is has a Cholesky factor. */
TEST(multigrid_leaves_saddles)
{
    static const char *const lines[] = {"--segments 8 --stretch 1.5",
                                        "--segments 48"};
    for (int i = 0; i < 2; i++) {
        Simulation *square = simulate("%s --minimum %s", lines[i], multigrid);
        Newton *newton = square->run[0].newton;
        for (int step = 0; step < 20; step++) {
            make_steps(square, 1);
            CHECK_STATUS(direction_bends_up(newton, 1), STATUS_OK);
        }
        const NewtonCounters *did = &newton->counters;
        CHECK(did->saddles > 0 && did->taken_back == 0);
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
        {"--segments 32 --solver auto", SOLVER_NEWTON, NULL},
        {"--segments 33 --solver auto", SOLVER_MULTIGRID, NULL},
        {"--segments 33", SOLVER_MULTIGRID, NULL},
        {"--segments 33 --integrator bdf2", SOLVER_MULTIGRID, NULL},
        {"--segments 33 --integrator midpoint", SOLVER_MULTIGRID, NULL},
        {"--segments 33 --integrator sdirk2", SOLVER_MULTIGRID, NULL},
        {"--segments 33 --gravity 9.81 --pin top", SOLVER_MULTIGRID, NULL},
        {"--segments 33 --integrator avf", SOLVER_NEWTON, "averaged"},
        {"--segments 33 --filter abs", SOLVER_NEWTON, "projection"},
        {"--segments 33 --line-search none", SOLVER_NEWTON, "line search"},
        {"--segments 33 --stiffness 1e17", SOLVER_NEWTON, "outweigh"},
        {"--segments 8 --solver multigrid", SOLVER_MULTIGRID, NULL},
        {"--segments 8 --solver newton", SOLVER_NEWTON, NULL},
        {"--segments 33 --ground 0,1,0,-1", SOLVER_NEWTON, "energies"},
        {"--segments 33 --ball 0,-1,0.2", SOLVER_NEWTON, "energies"},
        {"drop --solver multigrid", SOLVER_NEWTON, "energies"},
        {"tear --solver multigrid", SOLVER_NEWTON, "energies"},
        {"bend --solver multigrid", SOLVER_NEWTON, "no square grid"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const Newton *newton =
            make_steps(simulate("--stretch 1.1 %s", rows[i].line), 1)
                ->run[0]
                .newton;
        CHECK(newton->working == rows[i].working);
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
    NewtonCounters did = simulation_counters(square);
    CHECK(did.taken_back == 3 && did.cycles > 0 && did.factorisations > 0);
}

TESTS(NULL, NULL)
