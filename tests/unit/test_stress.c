/* A short run of what `make stress` does for minutes, and proofs that its
 * judge sees a broken promise.
 */
#include "test.h"
#include "model/pull_energy.h"
#include "stress.h"
#include "stress_large.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

TEST(named_cases_keep_the_promise)
{
    for (const StressCase *row = stress_cases; row->name; row++) {
        char reason[512] = "";
        Tally tally = {0};
        if (row->slow || (row->same && !tests_are_long()))
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
    static const char *const kinds[] = {"s", "cccctbww", "f"};
    for (int i = 0; i < 3; i++) {
        Tally tally = {0};
        char reason[512] = "";
        const long count = tests_are_long() ? 1000 : 120;
        bool good =
            stress_scenes(kinds[i], 1, count, i == 1 ? 10 : 2, &tally, reason);
        if (!good)
            print_error("build/stress --line '%s': %s\n", stress_present,
                        reason);
        CHECK(good);
        CHECK(tally.steps[VERDICT_CONVERGED] >
              2 * tally.steps[VERDICT_REPORTED]);
        CHECK(i > 0 ||
              (tally.judged > 2 * count && tally.blurred * 10 < tally.judged));
    }
}

/* The wide formulas against those of the other suites. */
TEST(two_exact_formulas_agree)
{
    Random random = {3};
    for (int round = 0; round < 20; round++) {
        System system;
        double x[MAX_SIZE], u[MAX_SIZE], target[MAX_SIZE], at[MAX_SIZE];
        random_system(&random, SPRINGS_MIXED, &system, x);
        int n = 2 * system.nodes, negative;
        for (int i = 0; i < n; i++) {
            u[i] = random_uniform(&random, -0.1, 0.1);
            target[i] = random_uniform(&random, -0.1, 0.1);
            at[i] = x[i] + u[i];
            x[i] = at[i] - u[i]; /* so that x + u is at, nearly */
        }
        IncrementalPotential E = {&system, 0.3, x, target, false};
        Wide g[MAX_SIZE], H[MAX_SIZE * MAX_SIZE], h[MAX_SIZE];
        long double g2[MAX_SIZE], H2[MAX_SIZE * MAX_SIZE];
        wide_derivatives(&E, u, FILTER_CLAMP, g, H);
        exact_derivatives(&E, u, at, g2, NULL);
        exact_hessian(&E, at, true, H2);
        for (int i = 0; i < n; i++) {
            CHECK_NEAR((long double)g[i], g2[i], 1e-9L);
            h[i] = g[i];
            for (int j = 0; j < n; j++)
                CHECK_NEAR((long double)H[n * i + j], H2[n * i + j],
                           1e-7L * (1 + fabsl(H2[n * i + j])));
        }
        CHECK(wide_factor(n, H, &negative) && negative == 0);
        wide_solve(n, H, h);
        wide_derivatives(&E, u, FILTER_CLAMP, g, H);
        for (int i = 0; i < n; i++) {
            Wide sum = -g[i];
            for (int j = 0; j < n; j++)
                sum += H[n * i + j] * h[j];
            CHECK_NEAR((long double)sum, 0, 1e-15L);
        }
        system_free(&system);
    }
}

/* H q spring by spring is H q by the dense Hessian, with every term, filter
 * and pin there is. */
TEST(products_are_those_of_the_matrix)
{
    Random random = {6};
    for (int round = 0; round < 24; round++) {
        System system;
        double x[MAX_SIZE], u[MAX_SIZE], q[MAX_SIZE], y[MAX_SIZE];
        random_system(&random, SPRINGS_MIXED, &system, x);
        int n = 2 * system.nodes;
        Filter filter = (Filter)(round % 3); /* clamp, none, abs */
        CHECK_STATUS(system_create_pins(&system), STATUS_OK);
        system.pinned[1] = 1;
        central_field_set(&system, round / 3 % 2 ? 2.5 : 0);
        for (int i = 0; i < n; i++) {
            u[i] = random_uniform(&random, -0.1, 0.1);
            q[i] = i / 2 == 1 ? 0 : random_uniform(&random, -1, 1);
        }
        IncrementalPotential E = {&system, 0.3, x, u, round / 6 % 2 == 1};
        Wide g[MAX_SIZE], H[MAX_SIZE * MAX_SIZE];
        double moved[MAX_SIZE];
        for (int i = 0; i < n; i++)
            moved[i] = x[i] + u[i];
        wide_derivatives(&E, u, filter, g, H);
        Iterate at = {.E = E, .u = u, .x = moved};
        incremental_potential_product(&at, filter, q, y);
        for (int i = 0; i < n; i++) {
            long double sum = 0, size = 0;
            for (int j = 0; j < n; j++) {
                sum += (long double)H[n * i + j] * q[j];
                size += fabsl((long double)H[n * i + j] * q[j]);
            }
            CHECK_NEAR(y[i], i / 2 == 1 ? 0 : sum, 1e-12L * (1 + size));
        }
        system_free(&system);
    }
}

/* A direction that bends down leads downhill, and nothing is left over of the
 * one that was found before. */
TEST(bends_are_found_afresh)
{
    Simulation *simulation = simulate("--segments 3 --stretch 0.3");
    Newton *newton = simulation->run[0].newton;
    double p[2][2 * 16], slope = 0;
    CHECK_STATUS(newton_start(newton, simulation->run[0].x, NULL, 0.01),
                 STATUS_RUNNING);
    for (int i = 0; i < 2; i++) {
        bool found;
        CHECK_STATUS(
            search_direction_bends_down(&newton->search, &newton->at, &found),
            STATUS_OK);
        CHECK(found);
        memcpy(p[i], newton->at.p, sizeof p[i]);
    }
    CHECK_SAME_BITS(p[1], p[0], 2 * 16);
    for (int i = 0; i < 2 * 16; i++)
        slope += newton->at.g[i] * p[0][i];
    CHECK(slope < 0);
}

/* The largest shift of all records. */
static bool keep_shift(void *user, const NewtonRecord *record)
{
    double *largest = user;
    *largest = fmax(*largest, record->shift);
    return true;
}

TEST(shifts_are_small)
{
    double shift = 0, scale = 16e-6 * 1e30; /* h^2 k */
    Simulation *simulation =
        simulate_watched(keep_shift, &shift, "--segments 3 --stiffness 1e30");
    make_steps(simulation, 1);
    CHECK(shift > 0);
    CHECK_AT_MOST(shift, 1e-10 * scale);
}

/* A square that only flies and turns: forces that the masses alone resist,
 * while the shift is some 1e12 masses.  1e-8: of p, 1e-3, what is left when
 * rounding of products with the springs' 1e30 ends the solves. */
TEST(shifted_solves_find_the_masses)
{
    enum { N = 2 * 9 }; /* nodes at multiples of 1/2: no strain at all */
    Simulation *simulation =
        simulate("--segments 2 --stretch 1 --stiffness 1e30");
    TimeIntegrator *run = &simulation->run[0];
    Newton *newton = run->newton;
    for (int i = 0; i < N; i += 2) {
        newton->u_tilde[i] = 1e-3 * (3 - run->x[i + 1]);
        newton->u_tilde[i + 1] = 1e-3 * (run->x[i] - 2);
    }
    CHECK_STATUS(newton_start(newton, run->x, NULL, 16e-6), STATUS_RUNNING);
    CHECK(newton->search.shift > 1e6 * simulation->system.m[0]);
    Wide g[N], H[N * N];
    int negative;
    wide_derivatives(&newton->at.E, newton->at.u, FILTER_CLAMP, g, H);
    CHECK(wide_factor(N, H, &negative) && negative == 0);
    wide_solve(N, H, g);
    for (int i = 0; i < N; i++)
        CHECK_NEAR(newton->at.p[i], -(long double)g[i], 1e-8);
}

/* Averaged: its gradient is the slope of its energy. */
TEST(averaged_formulas_agree)
{
    Random random = {4};
    System system;
    double x[MAX_SIZE], u[MAX_SIZE] = {0}, target[MAX_SIZE] = {0};
    random_system(&random, SPRINGS_MIXED, &system, x);
    IncrementalPotential E = {&system, 0.3, x, target, true};
    Wide g[MAX_SIZE];
    for (int i = 0; i < 2 * system.nodes; i++)
        u[i] = random_uniform(&random, -0.5, 0.5);
    wide_derivatives(&E, u, FILTER_CLAMP, g, NULL);
    for (int i = 0; i < 2 * system.nodes; i++) {
        double step = 0x1p-20, middle = u[i];
        u[i] = middle + step;
        long double above = wide_energy(&E, u);
        u[i] = middle - step;
        long double below = wide_energy(&E, u);
        u[i] = middle;
        CHECK_NEAR((above - below) / (2 * step), (long double)g[i],
                   1e-6L * (1 + fabsl((long double)g[i])));
    }
    system_free(&system);
}

/* Steps that break one promise each, and else are those of the slides. */
static void add_momentum(TimeIntegrator *run)
{
    integrator_methods[0].land(run);
    run->new_v[0] += 1e-9;
}

static bool spoil(Term *term, System *system, const double *x, const double *v,
                  double h)
{
    (void)term;
    (void)system;
    (void)v;
    (void)h;
    ((double *)x)[3] = NAN;
    return false;
}

/* What a step leads to is looked at, what a term's end does is not. */
static void make_nan(TimeIntegrator *run)
{
    static const TermKind spoiler = {.end = spoil};
    CHECK(!system_add_term(run->system, &spoiler, NULL));
    integrator_methods[0].land(run);
}

static void fail_for_nothing(TimeIntegrator *run)
{
    run->new_x[0] = NAN;
}

static void move_and_fail(TimeIntegrator *run)
{
    run->x[0] += 1;
    run->new_x[0] = NAN;
}

/* As a step that fails with this status leaves it. */
static void stay(TimeIntegrator *run, int status)
{
    memcpy(run->new_x, run->x, 2 * run->size * sizeof *run->x);
    run->status = (Status)status;
}

static void run_out_of_memory(TimeIntegrator *run)
{
    stay(run, STATUS_OUT_OF_MEMORY);
}

static void return_nonsense(TimeIntegrator *run)
{
    stay(run, 77);
}

static void stay_and_lie(TimeIntegrator *run)
{
    integrator_methods[0].land(run);
    for (int i = 0; i < 2 * run->system->nodes; i++)
        run->newton->at.u[i] *= 0.9;
}

static void gain_energy(TimeIntegrator *run)
{
    integrator_methods[0].land(run);
    for (int i = 0; i < 2 * run->system->nodes; i++)
        run->new_v[i] *= 3;
}

static void skip_an_iteration(TimeIntegrator *run)
{
    NewtonRecord record = {.iteration = 5};
    run->newton->settings.observer(run->newton->settings.user, &record);
    integrator_methods[0].aim(run);
}

/* A tolerance that grows behind the judge's back. */
static double tolerance;

static void be_content(TimeIntegrator *run)
{
    tolerance = run->newton->settings.tolerance;
    run->newton->settings.tolerance = 1;
    integrator_methods[0].aim(run);
}

static void be_strict_again(TimeIntegrator *run)
{
    run->newton->settings.tolerance = tolerance;
    integrator_methods[0].land(run);
}

typedef void Part(TimeIntegrator *);

/* What the judge says about a step of these parts; NULL: those of the slides.
 */
static void check_blamed(Part *aim, Part *land, const char *why)
{
    Watch watch;
    Simulation *simulation = simulate("--segments 2 --tolerance 1e-6");
    TimeIntegrator *run = &simulation->run[0];
    IntegratorMethod method = *run->method;
    CHECK(watch_create(run, &watch));
    CHECK(watch_step(&watch) == VERDICT_CONVERGED);
    method.aim = aim ? aim : method.aim;
    method.land = land ? land : method.land;
    run->method = &method;
    bool seen = watch_step(&watch) == VERDICT_WRONG &&
                strstr(watch.reason, why) != NULL;
    if (!seen)
        print_error("'%s' was not noticed; reason: %s\n", why, watch.reason);
    CHECK(seen);
    watch_free(&watch);
}

TEST(broken_promises_are_noticed)
{
    check_blamed(NULL, add_momentum, "momentum");
    check_blamed(NULL, make_nan, "not finite");
    check_blamed(NULL, move_and_fail, "moved");
    check_blamed(NULL, fail_for_nothing, "nothing is near overflow");
    check_blamed(NULL, run_out_of_memory, "fails with out_of_memory");
    check_blamed(NULL, return_nonsense, "has no name");
    check_blamed(NULL, stay_and_lie, "E rises");
    check_blamed(NULL, gain_energy, "kinetic and elastic");
    check_blamed(skip_an_iteration, NULL, "record 5");
}

TEST(false_convergence_is_noticed)
{
    check_blamed(be_content, be_strict_again, "the residual is");
}

/* Caps are looked at through the records of a real minimisation. */
TEST(too_many_iterations_are_noticed)
{
    Watch watch;
    Simulation *simulation = simulate("--segments 3");
    TimeIntegrator *run = &simulation->run[0];
    CHECK(watch_create(run, &watch));
    run->newton->settings.max_iterations = 0; /* one is made all the same */
    CHECK(watch_step(&watch) == VERDICT_WRONG);
    CHECK(strstr(watch.reason, "more than allowed") != NULL);
    watch_free(&watch);
}

static bool is_stiff(const char *line)
{
    const char *k = strstr(line, "--stiffness ");
    return k && strtod(k + 12, NULL) > 1e3;
}

TEST(failures_shrink)
{
    int shrunk = 0;
    for (long i = 0; i < 50; i++) {
        char line[STRESS_LINE];
        stress_line("s", 5, i, line);
        if (!is_stiff(line))
            continue;
        stress_shrink(line, is_stiff);
        CHECK(strncmp(line, "square --stiffness ", 19) == 0);
        CHECK(strlen(line) == 19 + 5); /* one digit */
        shrunk++;
    }
    CHECK(shrunk > 5);
}

/* The picture in the README is drawn from a table; cells of it, computed
 * again, are what it says. */
TEST(envelope_is_up_to_date)
{
    static Envelope envelope;
    Random random = {11};
    Tally tally = {0};
    CHECK(envelope_read("tests/data/envelope.csv", &envelope));
    for (int i = 0; i < 200; i++) {
        Solver solver = (Solver)random_below(&random, SOLVER_COUNT);
        int s = random_below(&random, ENVELOPE_STRETCH);
        int k = random_below(&random, ENVELOPE_K);
        int h = random_below(&random, ENVELOPE_H);
        char reason[600] = "", expected = envelope.verdict[solver][s][k][h];
        char got = envelope_cell(solver, s, k, h, &tally, reason);
        if (got != expected || got == 'w')
            print_error("solver %d, stretch %g, k %g, h %g: %c, in the "
                        "picture %c; make envelope draws it anew; %s\n",
                        solver, envelope_stretch(s), envelope_k(k),
                        envelope_h(h), got, expected, reason);
        CHECK(got == expected && got != 'w');
    }
    for (int solver = 0; solver < SOLVER_COUNT; solver++)
        CHECK(envelope_share(&envelope, (Solver)solver) >= 0.98);
    CHECK(memchr(&envelope, 'w', sizeof envelope) == NULL);
}

/* Large squares by multigrid, judged without a matrix; and the judge sees an
 * iterate that is not the end. */
TEST(large_squares_pass_what_they_say)
{
    const char *const lines[] = {
        "--segments 33 --stretch 1.4", "--segments 40 --minimum",
        "--segments 20 --stretch 0.5 --timestep 0.02",
        "--segments 24 --pin top-corners --gravity 9.81 --integrator sdirk2"};
    for (int i = 0; i < 4; i++) {
        Tally tally = {0};
        char reason[512] = "";
        if (!large_steps(lines[i], i == 0 ? 10 : 4, &tally, reason))
            print_error("%s\n", reason);
        CHECK(tally.wrong == 0 && tally.judged > 0 && tally.blurred == 0);
    }
    Simulation *simulation = simulate("--segments 12 --solver multigrid");
    Newton *newton = simulation->run[0].newton;
    CHECK_STATUS(newton_start(newton, simulation->run[0].x, NULL, 1.6e-5),
                 STATUS_RUNNING);
    CHECK(large_judge(newton) == LARGE_FAILED);
    while (newton_iterate(newton) == STATUS_RUNNING)
        continue;
    CHECK(large_judge(newton) == LARGE_PASSED);
}

TESTS(NULL, NULL)
