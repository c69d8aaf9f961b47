/* The lagged solver against Algorithm 3, and what a step may skip: each by a
 * counter, or by formulas that share nothing with the solvers.
 */
#include "model/central_field.h"
#include "testing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "solve/plane_search.h"

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
    to->remembers = from->remembers;
}

/* From the same state both end in the same: within 20 times what the
 * tolerance allows a direction to be, h * 1e-10. */
static void check_same_minimum(const char *scene, const char *method)
{
    Simulation newton, lagged;
    create_run(scene, method, SOLVER_NEWTON, NULL, NULL, &newton);
    create_run(scene, method, SOLVER_LAGGED, NULL, NULL, &lagged);
    const TimeIntegrator *a = &newton.run[0];
    TimeIntegrator *b = &lagged.run[0];
    double bound = 20 * a->h * newton.options.tolerance;
    for (int step = 0; step < 10; step++) {
        copy_state(a, b);
        CHECK_STATUS(simulation_step(&newton), STATUS_OK);
        CHECK_STATUS(simulation_step(&lagged), STATUS_OK);
        for (int i = 0; i < 2 * a->system->nodes; i++)
            if (!(fabs(a->x[i] - b->x[i]) <= bound)) {
                print_error("%s, %s, step %d:\n", scene, method, step + 1);
                CHECK_NEAR(b->x[i], a->x[i], bound);
            }
    }
    CHECK(lagged.run[0].newton->counters.iterations > 0);
    simulation_free(&newton);
    simulation_free(&lagged);
}

static void lagged_finds_the_same_minimum(void **unused)
{
    (void)unused;
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

/* At the slides' tolerance, where most directions of an old factor pass too
 * early, and below it. */
static void converged_is_as_strict_as_algorithm_3(void **unused)
{
    (void)unused;
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
    check_verdicts("square", "midpoint", SOLVER_LAGGED);
    check_verdicts("square", "sdirk2", SOLVER_LAGGED);
}

/* From the slides' scene to large steps of stiff, squashed squares, where the
 * Hessian changes most while a factor is kept; steps may not converge there,
 * but if they say that they did, they did. */
static void converged_is_strict_wherever_it_is_said(void **unused)
{
    (void)unused;
    const double stretch[] = {-1, 0.05, 0.3, 0.5, 0.8, 1.2, 1.4, 2, 3};
    const double timestep[] = {0.004, 0.02, 0.1}, stiffness[] = {1e5, 1e8};
    const double tolerance[] = {1, 1e-1, 1e-2, 1e-3, 1e-5};
    int verdicts = 0;
    for (int i = 0; i < 9 * 3 * 2 * 5; i++) {
        char line[200];
        Simulation simulation;
        Judge judge = {.simulation = &simulation};
        snprintf(line, sizeof line,
                 "--segments 3 --stretch %g --timestep %g --stiffness %g "
                 "--tolerance %g",
                 stretch[i / 30], timestep[i / 10 % 3], stiffness[i / 5 % 2],
                 tolerance[i % 5]);
        create_run(line, "backward-euler", SOLVER_LAGGED, judge_end, &judge,
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
    CHECK(verdicts > 1000);
}

/* At rest a minimisation costs one gradient, and no matrix is ever made. */
static void rest_needs_no_factor(void **unused)
{
    (void)unused;
    for (int i = 0; i < IMPLICIT; i++)
        for (int s = 0; s < SOLVER_COUNT; s++) {
            Simulation simulation;
            create_run("--stretch 1", implicit_names[i], (Solver)s, NULL, NULL,
                       &simulation);
            for (int step = 0; step < 5; step++)
                CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
            NewtonCounters counters = simulation_counters(&simulation);
            CHECK(counters.minimisations >= 5);
            CHECK(counters.gradients == counters.minimisations);
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
static void stretched_springs_are_not_projected(void **unused)
{
    (void)unused;
    for (int s = 0; s < SOLVER_COUNT; s++)
        for (int longer = 0; longer < 2; longer++) {
            Simulation simulation;
            long seen = 0;
            create_run("--stretch 1 --timestep 1e-3", "backward-euler",
                       (Solver)s, count_projected, &seen, &simulation);
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

/* Algorithm 3 has a factor for each direction, the lagged solver one for many;
 * records say which. */
static bool count_reused(void *user, const NewtonRecord *record)
{
    long *reused = user;
    *reused += record->iteration >= 0 && !record->factorised;
    return true;
}

static void factors_are_reused(void **unused)
{
    (void)unused;
    for (int s = 0; s < SOLVER_COUNT; s++) {
        Simulation simulation;
        long reused = 0;
        create_run("--segments 8", "backward-euler", (Solver)s, count_reused,
                   &reused, &simulation);
        for (int step = 0; step < 10; step++)
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        NewtonCounters counters = simulation_counters(&simulation);
        CHECK(counters.iterations > 0 && counters.solves > 0);
        if (s == SOLVER_LAGGED) {
            CHECK(3 * counters.factorisations < counters.solves);
            CHECK(reused > counters.iterations / 2);
        } else {
            CHECK(counters.factorisations ==
                  counters.gradients - counters.skipped - counters.certified);
            CHECK(counters.certified > 0 && reused == 0);
        }
        simulation_free(&simulation);
    }
}

/* Only the lagged solver smooths, and only in steps that are not over after two
 * updates: at once where the square buckles, never where it is hardly moved. */
static void only_hard_steps_are_smoothed(void **unused)
{
    (void)unused;
    for (int s = 0; s < SOLVER_COUNT; s++)
        for (int hard = 0; hard < 2; hard++) {
            Simulation simulation;
            create_run(hard ? "--segments 16 --stretch 1.4"
                            : "--segments 16 --stretch 1.01",
                       "backward-euler", (Solver)s, NULL, NULL, &simulation);
            for (int step = 0; step < 5; step++)
                CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
            NewtonCounters counters = simulation_counters(&simulation);
            CHECK(counters.iterations > 0);
            CHECK((counters.smoothings > 0) == (hard && s == SOLVER_LAGGED));
            CHECK((simulation.run[0].newton->smoother.group != NULL) ==
                  (counters.smoothings > 0));
            simulation_free(&simulation);
        }
}

/* Explicit methods have no Newton object, so no matrix and no counters. */
static void explicit_methods_have_no_matrix(void **unused)
{
    (void)unused;
    const char *names[] = {"forward-euler", "symplectic-euler", "verlet"};
    for (int i = 0; i < 3; i++) {
        Simulation simulation;
        create_run("--timestep 1e-4", names[i], SOLVER_LAGGED, NULL, NULL,
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
static void averaged_force_does_the_work(void **unused)
{
    (void)unused;
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
        long double before = exact_energy(&E, NULL, x_n, -1, -1).f;
        long double after = exact_energy(&E, NULL, x, -1, -1).f, work = 0;
        E = (IncrementalPotential){&system, 1, x_n, u, true}; /* no inertia */
        incremental_potential_gradient(&E, u, x, g);
        for (int i = 0; i < 2 * system.nodes; i++)
            work += (long double)g[i] * u[i];
        CHECK_NEAR(work, after - before, 1e-12L * (after + before));
        system_free(&system);
    }
}

/* A random plane: convex if the springs are stretched, else perhaps not. */
static PlaneQuartic random_plane(Random *random, SpringState state)
{
    System system;
    double x[MAX_SIZE], u[MAX_SIZE], g[MAX_SIZE], p[MAX_SIZE], r[MAX_SIZE];
    random_system(random, state, &system, x);
    for (int i = 0; i < 2 * system.nodes; i++) {
        u[i] = 0;
        p[i] = random_uniform(random, -1, 1);
        r[i] = random_uniform(random, -1, 1);
    }
    IncrementalPotential E = {&system, 1, x, u, false};
    incremental_potential_gradient(&E, u, x, g);
    Iterate at = {E, u, x, g, p};
    PlaneQuartic plane = incremental_potential_in_plane(&at, r);
    system_free(&system);
    return plane;
}

/* The point that the search finds is below its start, and all around it, at a
 * distance of 1e-2 of its coordinates, nothing is lower by more than 5 %: it
 * has a limit of iterations. */
static void plane_search_ends_in_a_minimum(void **unused)
{
    (void)unused;
    Random random = {96};
    for (int trial = 0; trial < 400; trial++) {
        double at[2], pi = acos(-1);
        int trials;
        PlaneQuartic plane =
            random_plane(&random, (SpringState)(trial % SPRINGS_NEAR_ZERO));
        CHECK_STATUS(plane_minimise(&plane, at, &trials), STATUS_OK);
        double value = plane_value(&plane, at[0], at[1]);
        double radius = 1e-2 * (fabs(at[0]) + fabs(at[1]));
        CHECK(value < 0 && trials > 0);
        for (int i = 0; i < 24; i++)
            CHECK_AT_MOST(1.05 * value,
                          plane_value(&plane, at[0] + radius * cos(i * pi / 12),
                                      at[1] + radius * sin(i * pi / 12)));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lagged_finds_the_same_minimum),
        cmocka_unit_test(converged_is_as_strict_as_algorithm_3),
        cmocka_unit_test(converged_is_strict_wherever_it_is_said),
        cmocka_unit_test(rest_needs_no_factor),
        cmocka_unit_test(stretched_springs_are_not_projected),
        cmocka_unit_test(factors_are_reused),
        cmocka_unit_test(only_hard_steps_are_smoothed),
        cmocka_unit_test(explicit_methods_have_no_matrix),
        cmocka_unit_test(averaged_force_does_the_work),
        cmocka_unit_test(plane_search_ends_in_a_minimum),
    };
    return cmocka_run_group_tests_name("solvers", tests, NULL, NULL);
}
