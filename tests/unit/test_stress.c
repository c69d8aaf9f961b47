/* A short run of what `make stress` does for minutes, and proofs that its
 * judge sees a broken promise.
 */
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
              (tally.judged > count && tally.blurred * 10 < tally.judged));
    }
}

/* Scenes in which something was wrong once. */
#define STIFF                                                                  \
    "square --segments 2 --density 1e-3 --timestep 0.1 --tolerance 1e-6 "      \
    "--material neo-hookean --poisson 0.3 --stretch 0.5 --turn 30 --young "
#define TURNS                                                                  \
    "square --segments 3 --material neo-hookean --poisson 0.2 --turn 210 "     \
    "--stretch 2.2 --tolerance 1e-5 --young "
#define EDGE                                                                   \
    "square --segments 3 --stiffness 2.41e6 --density 8.93e-5 --timestep "     \
    "13.1 --yield 7e-4 --hardening 1.5e-4 --stretch "
static const struct {
    int steps;
    const char *line;
    Verdict worst; /* worst verdict that is allowed */
} once_wrong[] = {
    /* a light body of stiff triangles: rounding of forces that cancel must
     * not turn it */
    {3, STIFF "1e10", VERDICT_CONVERGED},
    {3, STIFF "1e12", VERDICT_CONVERGED},
    {3, STIFF "1e13", VERDICT_CONVERGED},
    {3, STIFF "1e12 --gravity 9.81 --pin left", VERDICT_CONVERGED},
    {3, STIFF "3e11 --stretch 1.7 --turn 200 --velocity 5,-3",
     VERDICT_CONVERGED},
    /* what turns it must not be lost in H p, either; and it is turned to the
     * angle of its target, not left where tiny straight directions pass */
    {2,
     "square --segments 3 --material neo-hookean --young 1.74e12 "
     "--poisson 0.187 --density 5.85e-6 --timestep 0.442 --stretch 2.6 "
     "--turn 210 --tolerance 1.01e-5",
     VERDICT_CONVERGED},
    {10,
     "square --segments 3 --material neo-hookean --young 9.65e12 "
     "--poisson 0.292 --density 1.32e-5 --timestep 0.707 --stretch 2.53 "
     "--turn 254 --tolerance 1.9e-4",
     VERDICT_CONVERGED},
    {10,
     "square --segments 1 --material neo-hookean --young 1.42e12 "
     "--poisson 0.0263 --density 6.31e-6 --timestep 0.419 --stretch 0.74 "
     "--turn 191 --tolerance 5.72e-6",
     VERDICT_CONVERGED},
    {3, TURNS "2.4e8 --density 2.07e-6 --timestep 0.314 --stretch 2.58",
     VERDICT_CONVERGED},
    {3, TURNS "5.55e12 --density 2e-6 --timestep 5e-3 --velocity -3,5",
     VERDICT_CONVERGED},
    {3, TURNS "1e12 --density 1e-5 --timestep 0.3 --pin 0 --gravity 9.81",
     VERDICT_CONVERGED},
    {2,
     "square --segments 1 --stiffness 1610 --density 7.49e-9 --timestep "
     "5.06e5 --stretch 0.0198 --tolerance 9.11e-6 --projection abs "
     "--solver newton shaken 7.01e5",
     VERDICT_REPORTED},
    {1,
     "square --segments 1 --stiffness 404 --density 81.4 --side 0.0666 "
     "--timestep 0.0415 --stretch 0.0595 --solver multigrid --velocity "
     "-2.64,0.486 shaken 2.75e5",
     VERDICT_CONVERGED},
    /* step 9 begins at rest, after an end that was looked at for a saddle:
     * the test there is of the projected Hessian again */
    {10,
     "square --segments 4 --side 0.9 --timestep 0.787 --material "
     "neo-hookean --young 5.39e+04 --poisson 0.337 --body "
     "0,0,349,-1.05,-4.92,0.822,1.14 --body "
     "1.6,-0.26,293,-8.4,-0.252 --body 0.267,1.6,41.8,6.37,-0.279 "
     "--self-friction 1.21 --pin top-corners --tolerance 1.37e-05 "
     "--projection clamp",
     VERDICT_CONVERGED},
    /* in step 3 a contact has opened since the Hessian was factored, whose
     * factor proposes far too small a correction of the last direction */
    {3,
     "square --segments 2 --side 0.9 --stiffness 7.33e+07 --timestep 0.945 "
     "--self-contact on --cells on --body 0,0,93.1,0.319,-5.03,0.935,0.825 "
     "--body 1.6,0.183,116,-0.193,0.179 --body -1.6,0.442,351,1.86,2.26 "
     "--body 0.11,3.2,224,0,-16.8,1.12,0.998 --ground -0.0727,1,0,-2.4 "
     "--friction 0.464 --self-friction 0.753 --gravity 9.81 --tear 0.0404 "
     "--tolerance 2.41e-06",
     VERDICT_CONVERGED},
    /* the beam folds at its notch, whose faces touch in the first step */
    {1,
     "bend --segments 16 --stiffness 1.52e+04 --timestep 0.787 "
     "--tolerance 3.96e-06 --friction 0.61 --cells off --yield 0.0124 "
     "--hardening 1.71 --barrier 0.00139,2.69e+05",
     VERDICT_CONVERGED},
    /* the second step begins where springs have just flowed and V'' jumps:
     * either side is right */
    {3, EDGE "0.6336", VERDICT_CONVERGED},
    {3, EDGE "0.6686", VERDICT_CONVERGED},
    {3, EDGE "0.6904", VERDICT_CONVERGED},
    {3, EDGE "0.7034", VERDICT_CONVERGED},
    /* in step 6 all move alike, so that what springs add to H p is far
     * smaller than the entries of H, and their rounding, times p */
    {6,
     "tear --segments 2 --stiffness 9.25e6 --timestep 0.772 "
     "--tolerance 1.8e-4 --yield 0.0415 --hardening 0.101",
     VERDICT_CONVERGED},
    /* a soft barrier is used up to where rounding decides on which side of
     * an edge a point is, of an update and of the centre's last move */
    {1,
     "square --segments 4 --material neo-hookean --young 1e9 --timestep "
     "0.02 --body 0,0,0,20,0 --body 1.45,0.1,5,-20,0 --tolerance 1e-6 "
     "--barrier 1e-6,1",
     VERDICT_REPORTED},
};

TEST(faults_of_the_past_stay_away)
{
    for (size_t i = 0; i < sizeof once_wrong / sizeof *once_wrong; i++) {
        Tally tally = {0};
        char reason[512] = "";
        if (stress_run(once_wrong[i].line, once_wrong[i].steps, &tally,
                       reason) > once_wrong[i].worst)
            fail_msg("%s: %s", once_wrong[i].line, reason);
        CHECK(once_wrong[i].worst || tally.judged >= once_wrong[i].steps);
    }
}

/* Steps that break one promise each, and else are those of the slides. */
static void go_back_a_little(TimeIntegrator *run)
{
    integrator_methods[0].finish(run);
    for (size_t i = 0; i < run->size; i++)
        run->newton->at.u[i] *= 0.9;
}

static void fall_through(TimeIntegrator *run)
{
    integrator_methods[0].finish(run);
    run->new_x[1] = -0.7;
}

static void shift(TimeIntegrator *run)
{
    integrator_methods[0].finish(run);
    for (size_t i = 0; i < run->size; i++)
        run->new_v[i] += 1e-5;
}

static void turn(TimeIntegrator *run)
{
    integrator_methods[0].finish(run);
    for (size_t i = 0; i < run->size; i++)
        run->new_v[i] += (i % 2 ? 1e-3 : -1e-3) * run->new_x[i ^ 1];
}

/* A tolerance that grows behind the judge's back. */
static double tolerance;

static void be_content(TimeIntegrator *run)
{
    tolerance = run->newton->settings.tolerance;
    run->newton->settings.tolerance = 1;
    integrator_methods[0].set_target(run);
}

static void be_strict_again(TimeIntegrator *run)
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
        {"--segments 2", NULL, go_back_a_little, "E rises"},
        {"--segments 2 --integrator midpoint", NULL, go_back_a_little,
         "E rises"},
        {"--segments 2", be_content, be_strict_again, "the residual is"},
        {"--segments 12", be_content, be_strict_again, "the residual is"},
        {"--segments 2 --ground 0,1,0,-0.6", NULL, fall_through, "gap is -0.1"},
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
        for (int record = 1, stops = 1; integrator_methods[i].implicit && stops;
             record++) {
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
    CHECK(large_judge(&newton->at.E, newton->at.u, newton->settings.h,
                      newton->tolerance) == LARGE_FAILED);
    CHECK_OK(newton_minimise(newton));
    CHECK(large_judge(&newton->at.E, newton->at.u, newton->settings.h,
                      newton->tolerance) == LARGE_PASSED);
}

TESTS(NULL, NULL)
