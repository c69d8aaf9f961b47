/* Multigrid against Algorithm 3, and what a step may skip: each by a
 * counter, or by formulas that share nothing with the solvers.
 */
#include "model/pull_energy.h"
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const implicit_names[] = {
    "backward-euler", "bdf2", "midpoint", "sdirk2", "avf", "avf4"};
enum { IMPLICIT = sizeof implicit_names / sizeof *implicit_names };

/* The same scene with another solver. */
static void create_run(const char *scene, const char *method, Solver solver,
                       NewtonObserver observer, void *user,
                       Simulation *simulation)
{
    char line[250];
    snprintf(line, sizeof line, "%s --integrator %s --solver %s", scene, method,
             solver_name(solver));
    simulation_from_line(line, observer, user, simulation);
}

/* Positions, velocities and what the method remembers. */
static void copy_state(const TimeIntegrator *from, TimeIntegrator *to)
{
    size_t bytes = 2 * (size_t)from->system->nodes * sizeof(double);
    memcpy(to->x, from->x, bytes);
    memcpy(to->v, from->v, bytes);
    if (from->memory)
        memcpy(to->memory, from->memory, bytes * (size_t)from->method->memory);
    to->memory_h = from->memory_h;
}

/* From the same state both end in the same: within 20 times what the
 * tolerance allows a direction to be, h * 1e-10. */
static void check_same_minimum(const char *scene, const char *method)
{
    Simulation newton, multigrid;
    create_run(scene, method, SOLVER_NEWTON, NULL, NULL, &newton);
    create_run(scene, method, SOLVER_MULTIGRID, NULL, NULL, &multigrid);
    const TimeIntegrator *a = &newton.run[0];
    TimeIntegrator *b = &multigrid.run[0];
    double bound = 20 * a->h * newton.options.tolerance;
    for (int step = 0; step < 10; step++) {
        copy_state(a, b);
        CHECK_STATUS(simulation_step(&newton), STATUS_OK);
        CHECK_STATUS(simulation_step(&multigrid), STATUS_OK);
        for (int i = 0; i < 2 * a->system->nodes; i++)
            if (!(fabs(a->x[i] - b->x[i]) <= bound)) {
                print_error("%s, %s, step %d:\n", scene, method, step + 1);
                CHECK_NEAR(b->x[i], a->x[i], bound);
            }
    }
    CHECK(multigrid.run[0].newton->counters.iterations > 0);
    simulation_free(&newton);
    simulation_free(&multigrid);
}

TEST(multigrid_finds_the_same_minimum)
{
    const char *scenes_of_this[] = {
        "--tolerance 1e-10", "--segments 8 --stretch 1.1 --tolerance 1e-10",
        "--segments 8 --stretch 0.9 --tolerance 1e-10",
        "--stretch 3 --tolerance 1e-10",
        "--stretch 0.5 --timestep 0.02 --tolerance 1e-10"};
    for (int scene = 0; scene < 5; scene++)
        for (int i = 0; i < IMPLICIT; i++)
            check_same_minimum(scenes_of_this[scene], implicit_names[i]);
}

/* Judges what a solver calls converged. */
typedef struct Judge {
    const Simulation *simulation;
    int verdicts;
    double worst; /* residual over tolerance */
} Judge;

/* The test of Algorithm 3 at the iterate with a fresh factor of the clamped
 * Hessian: dense, in extended precision. */
static bool judge_end(void *user, const NewtonRecord *record)
{
    Judge *judge = user;
    const Newton *newton = judge->simulation->run[0].newton;
    enum { SMALL = 2 * 25 };
    static long double H[SMALL * SMALL], p[SMALL];
    if (record->status != STATUS_OK)
        return true;
    long double largest = 0;
    int size = 2 * newton->system->nodes;
    CHECK(size <= SMALL);
    exact_derivatives(&newton->at.E, newton->at.u, newton->at.x, p, NULL);
    exact_hessian(&newton->at.E, newton->at.x, true, H);
    CHECK(dense_solve(size, H, p));
    for (int i = 0; i < size; i += 2)
        largest = fmaxl(largest, fabsl(p[i]) + fabsl(p[i + 1]));
    double residual = (double)largest / newton->settings.h;
    judge->worst = fmax(judge->worst, residual / newton->settings.tolerance);
    judge->verdicts++;
    return true;
}

/* exact_derivatives does not know averaged energies. */
static void check_verdicts(const char *scene, const char *method, Solver solver)
{
    Simulation simulation;
    Judge judge = {.simulation = &simulation};
    create_run(scene, method, solver, judge_end, &judge, &simulation);
    for (int step = 0; step < 12; step++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    if (!(judge.worst <= 1 + 1e-6))
        print_error("%s, %s, %s:\n", scene, method, solver_name(solver));
    CHECK(judge.verdicts > 0);
    CHECK_AT_MOST(judge.worst, 1 + 1e-6);
    simulation_free(&simulation);
}

/* At the slides' tolerance and below it. */
TEST(converged_is_as_strict_as_algorithm_3)
{
    const char *scenes_of_this[] = {
        "square",
        "--tolerance 1e-4",
        "--stretch 0.5 --timestep 0.02",
        "--segments 3 --stretch 2 --tolerance 1e-6",
        "--segments 3 --stiffness 1e8 --stretch 2.5 --timestep 0.1",
        "--segments 3 --stretch 0.05 --timestep 0.1 --tolerance 1e-3"};
    for (int scene = 0; scene < 6; scene++)
        for (int s = 0; s < SOLVER_COUNT; s++) {
            check_verdicts(scenes_of_this[scene], "backward-euler", (Solver)s);
            check_verdicts(scenes_of_this[scene], "bdf2", (Solver)s);
        }
    check_verdicts("square", "midpoint", SOLVER_MULTIGRID);
    check_verdicts("square", "sdirk2", SOLVER_MULTIGRID);
}

/* From the slides' scene to large steps of stiff, squashed squares; steps may
 * not converge there, but if they say that they did, they did. */
TEST(converged_is_strict_wherever_it_is_said)
{
    const double stretch[] = {-1, 0.05, 0.3, 0.5, 0.8, 1.2, 1.4, 2, 3};
    const double timestep[] = {0.004, 0.02, 0.1}, stiffness[] = {1e5, 1e8};
    const double tolerance[] = {1, 1e-1, 1e-2, 1e-3, 1e-5};
    const int stride = tests_are_long() ? 1 : 2;
    int verdicts = 0;
    for (int i = 0; i < 9 * 3 * 2 * 5; i += stride) {
        char line[200];
        Simulation simulation;
        Judge judge = {.simulation = &simulation};
        snprintf(line, sizeof line,
                 "--segments 3 --stretch %g --timestep %g --stiffness %g "
                 "--tolerance %g",
                 stretch[i / 30], timestep[i / 10 % 3], stiffness[i / 5 % 2],
                 tolerance[i % 5]);
        create_run(line, "backward-euler", SOLVER_MULTIGRID, judge_end, &judge,
                   &simulation);
        for (int step = 0; step < 12; step++) {
            Status status = simulation_step(&simulation);
            CHECK(!status || status_is_unconverged(status));
        }
        if (!(judge.worst <= 1 + 1e-6))
            print_error("%s:\n", line);
        CHECK_AT_MOST(judge.worst, 1 + 1e-6);
        verdicts += judge.verdicts;
        simulation_free(&simulation);
    }
    CHECK(verdicts > 500);
}

/* At rest a minimisation costs one gradient (multigrid: one more, Newton's look
 * at a gradient that vanishes), and no matrix is ever made. */
TEST(rest_needs_no_factor)
{
    for (int i = 0; i < IMPLICIT; i++)
        for (int s = 0; s < SOLVER_COUNT; s++) {
            Simulation simulation;
            create_run("--stretch 1", implicit_names[i], (Solver)s, NULL, NULL,
                       &simulation);
            for (int step = 0; step < 5; step++)
                CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
            NewtonCounters counters = simulation_counters(&simulation);
            CHECK(counters.minimisations >= 5);
            CHECK(counters.gradients == (1 + (s == SOLVER_MULTIGRID && i < 4)) *
                                            counters.minimisations);
            CHECK(counters.skipped == counters.minimisations);
            CHECK(counters.factorisations == 0 && counters.solves == 0 &&
                  counters.iterations == 0 && counters.projected == 0);
            CHECK(simulation.run[0].newton->search.cholesky == NULL);
            simulation_free(&simulation);
        }
}

static bool count_projected(void *user, const NewtonRecord *record)
{
    long *projected = user;
    *projected += record->projected;
    return true;
}

/* Springs longer than at rest are left as they are; shorter ones are not. */
TEST(stretched_springs_are_not_projected)
{
    for (int longer = 0; longer < 2; longer++) {
        Simulation simulation;
        long seen = 0;
        create_run("--stretch 1 --timestep 1e-3", "backward-euler",
                   SOLVER_NEWTON, count_projected, &seen, &simulation);
        TimeIntegrator *run = &simulation.run[0];
        for (int i = 0; i < 2 * run->system->nodes; i++)
            run->x[i] *= longer ? 1.3 : 0.7;
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        NewtonCounters counters = simulation_counters(&simulation);
        CHECK(counters.iterations > 0 && counters.factorisations > 0);
        CHECK(longer ? counters.projected == 0 && seen == 0
                     : counters.projected >= run->system->springs);
        simulation_free(&simulation);
    }
}

/* Algorithm 3 has a factor for each direction, multigrid none at all; records
 * say so. */
static bool count_factored(void *user, const NewtonRecord *record)
{
    long *factored = user;
    *factored += record->factorised;
    return true;
}

TEST(only_newton_has_factors)
{
    for (int s = 0; s < SOLVER_COUNT; s++) {
        Simulation simulation;
        long factored = 0;
        create_run("--segments 8", "backward-euler", (Solver)s, count_factored,
                   &factored, &simulation);
        for (int step = 0; step < 10; step++)
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        NewtonCounters counters = simulation_counters(&simulation);
        CHECK(counters.iterations > 0);
        CHECK((counters.cycles > 0) == (s == SOLVER_MULTIGRID));
        CHECK((counters.solves > 0) == (s == SOLVER_NEWTON));
        CHECK((factored > 0) == (s == SOLVER_NEWTON));
        if (s == SOLVER_NEWTON) {
            CHECK(counters.factorisations ==
                  counters.gradients - counters.skipped);
        }
        simulation_free(&simulation);
    }
}

/* Tiles are for steps that are not over after some directions of the whole
 * square: where it buckles, never where it is hardly moved. */
TEST(only_hard_steps_get_tiles)
{
    for (int hard = 0; hard < 2; hard++) {
        Simulation simulation;
        create_run(hard ? "--segments 40 --stretch 1.4"
                        : "--segments 40 --stretch 1.01",
                   "backward-euler", SOLVER_MULTIGRID, NULL, NULL, &simulation);
        for (int step = 0; step < 10; step++)
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        NewtonCounters counters = simulation_counters(&simulation);
        CHECK(counters.iterations > 0);
        CHECK((counters.local > 0) == hard);
        simulation_free(&simulation);
    }
}

/* Asked for a minimum, Newton does not end where the Hessian bends down: the
 * default square of 16 segments comes to such a place when it buckles. */
TEST(newton_leaves_a_saddle_when_asked)
{
    for (int minimum = 0; minimum < 2; minimum++) {
        Simulation simulation;
        create_run(minimum ? "--segments 16 --minimum" : "--segments 16",
                   "backward-euler", SOLVER_NEWTON, NULL, NULL, &simulation);
        for (int step = 0; step < 14; step++)
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        CHECK((simulation_counters(&simulation).saddles > 0) == minimum);
        simulation_free(&simulation);
    }
}

/* What Newton counts of multigrid is what multigrid has done, and its limit of
 * iterations holds for it. */
TEST(multigrid_is_counted)
{
    Simulation simulation;
    create_run("--segments 8 --stretch 1.5 --minimum", "backward-euler",
               SOLVER_MULTIGRID, NULL, NULL, &simulation);
    for (int step = 0; step < 20; step++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    Newton *newton = simulation.run[0].newton;
    const MultigridCounters *did = multigrid_counters(newton->multigrid);
    CHECK(newton->counters.taken_back == 0 && did->saddles > 0);
    CHECK(newton->counters.saddles == did->saddles);
    CHECK(newton->counters.iterations == did->iterations);
    CHECK(newton->counters.cycles == did->cycles);
    newton->settings.max_iterations = 1;
    long before = did->iterations;
    CHECK_STATUS(simulation_step(&simulation), STATUS_ITERATION_LIMIT);
    CHECK(did->iterations == before + 1);
    CHECK(newton->counters.iterations == did->iterations);
    simulation_free(&simulation);
}

/* Who works, and why it is not multigrid. */
TEST(what_does_not_fit_is_left_to_newton)
{
    const struct {
        const char *line;
        Solver working;
        const char *refusal; /* a word of it */
    } cases[] = {
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
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Simulation simulation;
        char line[120];
        snprintf(line, sizeof line, "--stretch 1.1 %s", cases[i].line);
        simulation_from_line(line, NULL, NULL, &simulation);
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        const Newton *newton = simulation.run[0].newton;
        if (newton->working != cases[i].working ||
            !newton->refusal != !cases[i].refusal)
            print_error("%s: %s\n", line, solver_name(newton->working));
        CHECK(newton->working == cases[i].working);
        CHECK(!newton->refusal == !cases[i].refusal);
        if (cases[i].refusal)
            CHECK(strstr(newton->refusal, cases[i].refusal) != NULL);
        simulation_free(&simulation);
    }
}

/* Below rounding multigrid cannot go on; Newton judges the end. */
TEST(newton_takes_back_what_multigrid_cannot_end)
{
    Simulation simulation;
    create_run("--segments 8 --stretch 1.2 --tolerance 1e-15", "backward-euler",
               SOLVER_MULTIGRID, NULL, NULL, &simulation);
    for (int step = 0; step < 3; step++)
        CHECK(status_is_unconverged(simulation_step(&simulation)));
    NewtonCounters counters = simulation_counters(&simulation);
    CHECK(counters.taken_back == 3 && counters.cycles > 0 &&
          counters.factorisations > 0);
    simulation_free(&simulation);
}

/* Explicit methods have no Newton object, so no matrix and no counters. */
TEST(explicit_methods_have_no_matrix)
{
    const char *names[] = {"forward-euler", "symplectic-euler", "verlet"};
    for (int i = 0; i < 3; i++) {
        Simulation simulation;
        create_run("--timestep 1e-4", names[i], SOLVER_MULTIGRID, NULL, NULL,
                   &simulation);
        CHECK(simulation.run[0].newton == NULL);
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        CHECK(simulation.run[0].newton == NULL);
        NewtonCounters counters = simulation_counters(&simulation);
        CHECK(counters.gradients == 0 && counters.factorisations == 0);
        simulation_free(&simulation);
    }
}

/* What makes AVF conserve energy: grad Phi(u) . u = P(x_n + u) - P(x_n).
 * 1e-12 of both energies: rounding of x_n + u. */
TEST(averaged_force_does_the_work)
{
    Random random = {95};
    for (int trial = 0; trial < 50; trial++) {
        System system;
        double x_n[MAX_SIZE], u[MAX_SIZE], x[MAX_SIZE], g[MAX_SIZE];
        random_system(&random, (SpringState)(trial % SPRINGS_NEAR_ZERO),
                      &system, x_n);
        central_field_set(&system, random_uniform(&random, 0, 3));
        for (int i = 0; i < 2 * system.nodes; i++) {
            u[i] = random_uniform(&random, -1, 1);
            x[i] = x_n[i] + u[i];
        }
        IncrementalPotential E = {.system = &system, .weight = 1};
        long double before = exact_energy(&E, NULL, x_n);
        long double after = exact_energy(&E, NULL, x), work = 0;
        E = (IncrementalPotential){&system, 1, x_n, u, true}; /* no inertia */
        incremental_potential_gradient(&E, u, x, g);
        for (int i = 0; i < 2 * system.nodes; i++)
            work += (long double)g[i] * u[i];
        CHECK_NEAR(work, after - before, 1e-12L * (after + before));
        system_free(&system);
    }
}

TESTS(NULL, NULL)
