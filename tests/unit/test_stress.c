/* A short run of what `make stress` does for minutes, and proofs that its
 * judge sees a broken promise. */
#include "test.h"
#include "stress.h"

#include <string.h>

TEST(named_cases_keep_the_promise)
{
    for (const StressCase *row = stress_cases; row->name; row++) {
        char reason[512] = "";
        Tally tally = {0};
        if (row->slow)
            continue;
        bool good = row->run(&tally, reason);
        if (!good)
            print_error("%s: %s\n", row->name, reason);
        CHECK(good);
        CHECK(tally.wrong == 0);
    }
}

/* Of each kind some; and they are scenes that can be solved, not excuses. */
TEST(random_scenes_keep_the_promise)
{
    static const char *const kinds[] = {"s", "cccctbww", "f", "mn", "k"};
    for (int i = 0; i < 5; i++) {
        Tally tally = {0};
        char reason[512] = "";
        const long count = tests_many(1000, 32) / (i == 3 ? 3 : 1);
        bool good =
            stress_scenes(kinds[i], 1, count, i % 2 ? 10 : 2, &tally, reason);
        if (!good)
            print_error("build/stress --line '%s': %s\n", stress_present,
                        reason);
        CHECK(good);
        CHECK(tally.steps[VERDICT_CONVERGED] >
              2 * tally.steps[VERDICT_REPORTED]);
        CHECK(i > 0 ||
              (tally.judged > count && tally.undecided * 10 < tally.judged));
    }
}

/* Steps that break one promise each, and else are those of the slides. */
static void reduce_step(TimeIntegrator *run)
{
    integrator_methods[0].finish(run);
    for (size_t i = 0; i < run->x_length; i++)
        run->newton->iterate.u[i] *= 0.9;
}

static void cross_ground(TimeIntegrator *run)
{
    integrator_methods[0].finish(run);
    run->new_x[1] = -0.7;
}

static void shift(TimeIntegrator *run)
{
    integrator_methods[0].finish(run);
    for (size_t i = 0; i < run->x_length; i++)
        run->new_v[i] += 1e-5;
}

static void turn(TimeIntegrator *run)
{
    integrator_methods[0].finish(run);
    for (size_t i = 0; i < run->x_length; i++)
        run->new_v[i] += (i % 2 ? 1e-3 : -1e-3) * run->new_x[i ^ 1];
}

/* A tolerance that grows behind the judge's back. */
static double tolerance;

static void loosen(TimeIntegrator *run)
{
    tolerance = run->newton->settings.tolerance;
    run->newton->settings.tolerance = 1;
    integrator_methods[0].set_target(run);
}

static void tighten(TimeIntegrator *run)
{
    run->newton->settings.tolerance = tolerance;
    integrator_methods[0].finish(run);
}

TEST(broken_promises_are_noticed)
{
    static const struct {
        const char *line;
        void (*set_target)(TimeIntegrator *), (*finish)(TimeIntegrator *);
        const char *why;
    } rows[] = {
        {"--segments 2", NULL, reduce_step, "E rises"},
        {"--segments 2 --integrator midpoint", NULL, reduce_step, "E rises"},
        {"--segments 2", loosen, tighten, "the residual is"},
        {"--segments 12", loosen, tighten, "the residual is"},
        {"--segments 2 --ground 0,1,0,-0.6", NULL, cross_ground, "gap is -0.1"},
        {"--segments 2", NULL, shift, "momentum"},
        {"--segments 2 --material neo-hookean", NULL, turn, "angular"},
    };
    for (int i = 0; i < 7; i++) {
        Watch watch;
        Tally tally = {0};
        TimeIntegrator *run =
            &simulate("%s --tolerance 1e-6", rows[i].line)->run[0];
        IntegratorMethod method = *run->method;
        CHECK(watch_create(run, &tally, &watch));
        CHECK(watch_step(&watch) == VERDICT_CONVERGED);
        method.set_target =
            rows[i].set_target ? rows[i].set_target : method.set_target;
        method.finish = rows[i].finish;
        run->method = &method;
        CHECK(watch_step(&watch) == VERDICT_WRONG);
        CHECK(strstr(watch.reason, rows[i].why) != NULL);
        watch_free(&watch);
    }
}

/* Stops at the given record; 0: never. */
static bool stop_at_record(void *user, const NewtonRecord *record)
{
    (void)record;
    return --*(int *)user != 0;
}

/* A step that is left in a pause, at whatever record, moved nothing, and is
 * made again to the same bits. */
TEST(interruptions_leave_no_trace)
{
    for (int i = 0; integrator_methods[i].name; i++)
        for (int record = 1, stops = 1;
             integrator_methods[i].is_implicit && stops; record++) {
            int left = 0, never = 0;
            const char *line = "--integrator %s --tolerance 1e-8";
            Simulation *one = simulate_watched(stop_at_record, &left, line,
                                               integrator_methods[i].name);
            Simulation *other = simulate_watched(stop_at_record, &never, line,
                                                 integrator_methods[i].name);
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

/* The judge of large squares (test_multigrid has their steps) sees an iterate
 * that is not the end. */
TEST(an_unfinished_search_is_noticed)
{
    Simulation *simulation = simulate("--segments 12 --solver multigrid");
    Newton *newton = simulation->run[0].newton;
    newton_start(newton, simulation->run[0].x, NULL, 1.6e-5, 0.01);
    CHECK(large_judge(&newton->iterate.E, newton->iterate.u, newton->settings.h,
                      newton->tolerance) == LARGE_FAILED);
    CHECK_OK(newton_minimise(newton));
    CHECK(large_judge(&newton->iterate.E, newton->iterate.u, newton->settings.h,
                      newton->tolerance) == LARGE_PASSED);
}

TESTS(NULL, NULL)
