/* test_stress.c - a short `make stress`, and tests that it finds wrong steps */
#include "test.h"
#include "stress.h"

#include <string.h>

TEST(named_cases_keep_the_promise)
{
    for (const StressCase *row = stress_cases; row->name; row++) {
        char reason[512] = "";
        VerdictTally tally = {0};
        if (row->is_slow)
            continue;
        bool good = row->run_case(&tally, reason);
        if (!good)
            print_error("%s: %s\n", row->name, reason);
        CHECK(good);
        CHECK(tally.wrong_cases == 0);
    }
}

/* Steps of random scenes keep the promise of stress.h, and most converge. */
TEST(random_scenes_keep_the_promise)
{
    static const char *const kinds[] = {"s", "cccctbww", "f", "mn", "k"};
    for (int i = 0; i < 5; i++) {
        VerdictTally tally = {0};
        char reason[512] = "";
        const long count = choose_case_count(1000, 32) / (i == 3 ? 3 : 1);
        bool good = stress_run_scenes(kinds[i], 1, count, i % 2 ? 10 : 2,
                                      &tally, reason);
        if (!good)
            print_error("build/stress --line '%s': %s\n", stress_line, reason);
        CHECK(good);
        CHECK(tally.steps_by_verdict[VERDICT_CONVERGED] >
              2 * tally.steps_by_verdict[VERDICT_REPORTED]);
        CHECK(i > 0 || (tally.judged_residuals > count &&
                        tally.undecided_tests * 10 < tally.judged_residuals));
    }
}

/* Steps of an integrator that break one promise each */
static void shorten_motion(TimeIntegrator *run)
{
    integrator_methods[0].set_x_v(run);
    for (size_t i = 0; i < run->x_length; i++)
        run->newton->iterate.u[i] *= 0.9;
}

static void put_node_below_ground(TimeIntegrator *run)
{
    integrator_methods[0].set_x_v(run);
    run->new_x[1] = -0.7;
}

static void add_momentum(TimeIntegrator *run)
{
    integrator_methods[0].set_x_v(run);
    for (size_t i = 0; i < run->x_length; i++)
        run->new_v[i] += 1e-5;
}

static void add_angular_momentum(TimeIntegrator *run)
{
    integrator_methods[0].set_x_v(run);
    for (size_t i = 0; i < run->x_length; i++)
        run->new_v[i] += (i % 2 ? 1e-3 : -1e-3) * run->new_x[i ^ 1];
}

/* m/s, the true tolerance while a step has a larger one */
static double tolerance;

static void loosen_tolerance(TimeIntegrator *run)
{
    tolerance = run->newton->settings.tolerance;
    run->newton->settings.tolerance = 1;
    integrator_methods[0].set_target(run);
}

static void restore_tolerance(TimeIntegrator *run)
{
    run->newton->settings.tolerance = tolerance;
    integrator_methods[0].set_x_v(run);
}

TEST(broken_promises_are_noticed)
{
    static const struct {
        const char *line;
        void (*set_target)(TimeIntegrator *), (*set_x_v)(TimeIntegrator *);
        const char *reason;
    } rows[] = {
        {"--segments 2", NULL, shorten_motion, "E rises"},
        {"--segments 2 --integrator midpoint", NULL, shorten_motion, "E rises"},
        {"--segments 2", loosen_tolerance, restore_tolerance,
         "the residual is"},
        {"--segments 12", loosen_tolerance, restore_tolerance,
         "the residual is"},
        {"--segments 2 --ground 0,1,0,-0.6", NULL, put_node_below_ground,
         "gap is -0.1"},
        {"--segments 2", NULL, add_momentum, "momentum"},
        {"--segments 2 --material neo-hookean", NULL, add_angular_momentum,
         "angular"},
    };
    for (int i = 0; i < 7; i++) {
        RunWatch watch;
        VerdictTally tally = {0};
        TimeIntegrator *run =
            &simulate("%s --tolerance 1e-6", rows[i].line)->run[0];
        IntegratorMethod method = *run->method;
        CHECK(watch_create(run, &tally, &watch));
        CHECK(make_judged_step(&watch) == VERDICT_CONVERGED);
        method.set_target =
            rows[i].set_target ? rows[i].set_target : method.set_target;
        method.set_x_v = rows[i].set_x_v;
        run->method = &method;
        CHECK(make_judged_step(&watch) == VERDICT_WRONG);
        CHECK(strstr(watch.reason, rows[i].reason) != NULL);
        watch_free(&watch);
    }
}

/* Stops Newton's method at the record that counts *user down to 0; 0: never. */
static bool stop_at_iteration(void *user, const NewtonRecord *record)
{
    (void)record;
    return --*(int *)user != 0;
}

/* An interrupted step moves no node, and is made later with the same bits. */
TEST(interruptions_leave_no_trace)
{
    for (int i = 0; integrator_methods[i].name; i++)
        for (int record = 1, stops = 1;
             integrator_methods[i].stages > 0 && stops; record++) {
            int left = 0, never = 0;
            const char *line = "--integrator %s --tolerance 1e-8";
            Simulation *one = simulate_observed(stop_at_iteration, &left, line,
                                                integrator_methods[i].name);
            Simulation *other = simulate_observed(
                stop_at_iteration, &never, line, integrator_methods[i].name);
            make_steps(one, 2);
            make_steps(other, 2);
            left = record;
            simulation_begin_step(one);
            stops = simulation_advance(one) == STATUS_RUNNING;
            CHECK(stops || record >= 4);
            if (!stops)
                continue;
            CHECK_SAME_BITS(one->run[0].x, other->run[0].x, 50);
            CHECK_SAME_BITS(one->run[0].v, other->run[0].v, 50);
            left = never = 0;
            make_steps(one, 2);
            make_steps(other, 2);
            CHECK_SAME_BITS(one->run[0].x, other->run[0].x, 50);
            CHECK_SAME_BITS(one->run[0].v, other->run[0].v, 50);
        }
}

/* test_cg_residual rejects the first iterate and accepts the last one. */
TEST(an_unfinished_search_is_noticed)
{
    Simulation *simulation = simulate("--segments 12 --solver multigrid");
    Newton *newton = simulation->run[0].newton;
    newton_start(newton, simulation->run[0].x, NULL, 1.6e-5, 0.01);
    CHECK(test_cg_residual(&newton->iterate.E, newton->iterate.u,
                           newton->settings.h,
                           newton->tolerance) == TEST_FAILED);
    CHECK_OK(newton_minimise(newton));
    CHECK(test_cg_residual(&newton->iterate.E, newton->iterate.u,
                           newton->settings.h,
                           newton->tolerance) == TEST_PASSED);
}

TESTS(NULL, NULL)
