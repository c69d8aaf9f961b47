/* Steps in time: what implicit Euler promises, and all first-order methods
 * against formulas of their own.
 */
#include "test.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "step/time_integrator.h"

/* Squares of up to 4 segments. */
enum { SIZE = 2 * 25 };

/* sum m |v - w|^2 / 2, w NULL: 0 */
static long double kinetic(const System *system, const double *v,
                           const double *w)
{
    long double sum = 0;
    for (int i = 0; i < 2 * system->nodes; i++) {
        long double difference = (long double)v[i] - (w ? w[i] : 0);
        sum += 0.5L * system->m[i / 2] * difference * difference;
    }
    return sum;
}

static long double potential(const System *system, const double *x)
{
    IncrementalPotential E = {.system = system, .weight = 1};
    return exact_energy(&E, NULL, x);
}

/* |v| of a metre per second in random directions. */
static void disturb(Random *random, TimeIntegrator *run, double speed)
{
    for (int i = 0; i < 2 * run->system->nodes; i++) {
        run->x[i] += random_uniform(random, -0.05, 0.05);
        run->v[i] = speed * random_uniform(random, -1, 1);
    }
}

/* M|v1 - v0|^2/2 + P(x1) <= M|v0|^2/2 + P(x0), from any start: the minimiser's
 * E is not above E(x0).  1e-13 of it: the rounding of the state. */
TEST(backward_euler_gains_nothing)
{
    const char *lines[] = {"--stretch 1.4", "--stretch 0.5 --timestep 0.02",
                           "--stretch 2 --timestep 1",
                           "--stiffness 1e8 --timestep 1e-4",
                           "--stretch -0.3 --timestep 0.05"};
    Random random = {80};
    for (int line = 0; line < 5; line++) {
        Simulation *simulation = simulate("%s", lines[line]);
        TimeIntegrator *run = &simulation->run[0];
        disturb(&random, run, 3);
        for (int step = 0; step < 15; step++) {
            double x0[SIZE], v0[SIZE];
            memcpy(x0, run->x, sizeof x0);
            memcpy(v0, run->v, sizeof v0);
            make_steps(simulation, 1);
            long double before =
                kinetic(run->system, v0, NULL) + potential(run->system, x0);
            long double after = kinetic(run->system, run->v, v0) +
                                potential(run->system, run->x);
            CHECK_AT_MOST(after, before * (1 + 1e-13L));
        }
    }
}

/* Springs pull in pairs: each Newton direction keeps the momentum, whether
 * converged or not.  1e-12 of sum m|v|: rounding of the solves. */
TEST(momentum_is_kept)
{
    const char *lines[] = {"--timestep 0.004", "--stretch 0.4 --timestep 0.05",
                           "--integrator symplectic-euler --timestep 0.001",
                           "--integrator forward-euler --timestep 0.001"};
    Random random = {81};
    for (int line = 0; line < 4; line++) {
        Simulation *simulation = simulate("%s", lines[line]);
        TimeIntegrator *run = &simulation->run[0];
        disturb(&random, run, 3);
        double start[2] = {0, 0}, scale = 0;
        for (int i = 0; i < 2 * run->system->nodes; i++) {
            start[i % 2] += run->system->m[i / 2] * run->v[i];
            scale += run->system->m[i / 2] * fabs(run->v[i]);
        }
        for (int step = 0; step < 20; step++) {
            make_steps(simulation, 1);
            double now[2] = {0, 0};
            for (int i = 0; i < 2 * run->system->nodes; i++)
                now[i % 2] += run->system->m[i / 2] * run->v[i];
            CHECK_NEAR(now[0], start[0], 1e-12 * scale);
            CHECK_NEAR(now[1], start[1], 1e-12 * scale);
        }
    }
}

/* At rest, moved at 0.5 m/s: the velocity stays, although a step of h v =
 * 5e-10 m is lost in the last digits of x.  1e-12 needs the displacement. */
TEST(free_flight_keeps_its_velocity)
{
    Simulation *simulation =
        simulate("--stretch 1 --timestep 1e-9 --tolerance 1e-14");
    TimeIntegrator *run = &simulation->run[0];
    for (int i = 0; i < 2 * run->system->nodes; i++)
        run->v[i] = i % 2 ? -0.25 : 0.5;
    make_steps(simulation, 10);
    for (int i = 0; i < 2 * run->system->nodes; i++)
        CHECK_NEAR(run->v[i], i % 2 ? -0.25 : 0.5, 1e-12);
    CHECK_NEAR(run->clock, 1e-8, 1e-22);
}

/* Two masses, one spring, made by hand. */
typedef struct Pair {
    System system;
    TimeIntegrator run;
} Pair;

static void pair_create(const char *method, double h, Pair *pair)
{
    const double x[] = {0, 0, 1.5, 0}, v[] = {0, 0, 0, 0};
    NewtonSettings settings = {
        .h = h, .tolerance = 1e-13, .max_iterations = 200};
    CHECK_STATUS(system_create(2, 1, &pair->system), STATUS_OK);
    pair->system.e[1] = 1;
    pair->system.m[0] = 2;
    pair->system.m[1] = 3;
    pair->system.l2[0] = 1;
    pair->system.k[0] = 40;
    CHECK_STATUS(time_integrator_create(integrator_method(method),
                                        &pair->system, &settings, x, v,
                                        &pair->run),
                 STATUS_OK);
}

static void pair_free(Pair *pair)
{
    time_integrator_free(&pair->run);
    system_free(&pair->system);
}

/* Along the x axis only the length d counts: with the reduced mass m and the
 * slope P'(d) = 2 k (d^2/l2 - 1) d, a step solves
 * m (d - d_n - h w_n) + h^2 P'(d) = 0, w = (d - d_n)/h; here by bisection.
 * 1e-11: the tolerance of Newton, over 40 steps. */
TEST(two_masses_follow_their_recurrence)
{
    Pair pair;
    long double h = 0.03L, m = 2.0L * 3 / 5, d = 1.5L, w = 0;
    pair_create("backward-euler", 0.03, &pair);
    for (int step = 0; step < 40; step++) {
        long double low = 0.2L, high = 3, target = d + h * w;
        for (int i = 0; i < 70; i++) {
            long double middle = (low + high) / 2;
            long double slope = m * (middle - target) +
                                h * h * 2 * 40 * (middle * middle - 1) * middle;
            *(slope > 0 ? &high : &low) = middle;
        }
        w = (low - d) / h;
        d = low;
        CHECK_STATUS(time_integrator_step(&pair.run), STATUS_OK);
        CHECK_NEAR(pair.run.x[2] - pair.run.x[0], d, 1e-11);
        CHECK_NEAR(pair.run.v[2] - pair.run.v[0], w, 1e-11);
        CHECK(pair.run.x[1] == 0 && pair.run.x[3] == 0);
    }
    pair_free(&pair);
}

/* One step after another against extended precision.  1e-12: a spring's
 * share, h k/m l, is some ten m/s, and some of them cancel. */
static void check_explicit(const char *line, bool symplectic)
{
    Simulation *simulation = simulate("%s", line);
    TimeIntegrator *run = &simulation->run[0];
    int size = 2 * run->system->nodes;
    long double g[SIZE], h = run->h;
    IncrementalPotential E = {.system = run->system, .weight = 1};
    CHECK(run->newton == NULL && !run->method->implicit);
    for (int step = 0; step < 20; step++) {
        double x[SIZE], v[SIZE];
        memcpy(x, run->x, sizeof x);
        memcpy(v, run->v, sizeof v);
        exact_derivatives(&E, NULL, x, g, NULL);
        make_steps(simulation, 1);
        for (int i = 0; i < size; i++) {
            long double new_v = v[i] - h * g[i] / run->system->m[i / 2];
            CHECK_NEAR(run->v[i], new_v, 1e-12 * (1 + fabsl(new_v)));
            CHECK_NEAR(run->x[i], x[i] + h * (symplectic ? new_v : v[i]),
                       1e-15 * (1 + fabs(x[i]) + fabsl(h * new_v)));
        }
    }
    NewtonCounters counters = simulation_counters(simulation);
    CHECK(counters.gradients == 0 && counters.factorisations == 0);
}

TEST(forward_euler_is_its_formula)
{
    check_explicit("--integrator forward-euler --timestep 5e-4", false);
}

TEST(symplectic_euler_is_its_formula)
{
    check_explicit("--integrator symplectic-euler --timestep 5e-4", true);
}

/* h far above the limit: it overflows at last, and says so, and the state of
 * the last good step stays. */
static void check_overflow(const char *line)
{
    Simulation *simulation = simulate("%s", line);
    TimeIntegrator *run = &simulation->run[0];
    for (int step = 0; step < 100; step++) {
        double x[SIZE], v[SIZE];
        memcpy(x, run->x, sizeof x);
        memcpy(v, run->v, sizeof v);
        Status status = simulation_step(simulation);
        if (status) {
            CHECK_STATUS(status, STATUS_NOT_FINITE);
            CHECK_SAME_BITS(run->x, x, SIZE);
            CHECK_SAME_BITS(run->v, v, SIZE);
            CHECK(run->steps == step && simulation->steps == step && step > 0);
            return;
        }
        for (int i = 0; i < SIZE; i++)
            CHECK(isfinite(run->x[i]) && isfinite(run->v[i]));
    }
    fail_msg("%s: no overflow in 100 steps", line);
}

TEST(overflow_changes_nothing)
{
    check_overflow("--integrator forward-euler --timestep 1");
    check_overflow("--integrator symplectic-euler --timestep 1");
}

TEST(bad_starts_are_refused)
{
    Pair pair;
    TimeIntegrator run;
    pair_create("backward-euler", 0.1, &pair);
    const double bad[] = {NAN, INFINITY, 0, -1};
    for (int i = 0; i < 8; i++) {
        double x[] = {0, 0, 1, 0}, v[] = {0, 0, 0, 0};
        NewtonSettings settings = {.h = 1, .tolerance = 1};
        if (i < 4)
            settings.h = bad[i];
        else if (i == 4)
            settings.tolerance = 0;
        else if (i == 5)
            settings.tolerance = NAN;
        else
            *(i == 6 ? &v[3] : &x[3]) = i == 6 ? NAN : INFINITY;
        CHECK_STATUS(time_integrator_create(pair.run.method, &pair.system,
                                            &settings, x, v, &run),
                     STATUS_INVALID_INPUT);
        time_integrator_free(&run);
    }
    time_integrator_free(NULL);
    pair_free(&pair);
}

/* The table has every method under its name, and what needs no minimisation
 * makes no Newton object. */
TEST(the_table_is_complete)
{
    CHECK(integrator_method("backward-euler") == &integrator_methods[0]);
    CHECK(integrator_method("euler") == NULL);
    CHECK(integrator_method("") == NULL);
    for (const IntegratorMethod *row = integrator_methods; row->name; row++) {
        Pair pair;
        CHECK(integrator_method(row->name) == row && row->label && row->land);
        CHECK(row->order >= 1);
        pair_create(row->name, 1e-3, &pair);
        CHECK((pair.run.newton != NULL) == row->implicit);
        pair_free(&pair);
    }
}

/* Acceleration of the length d of the pair. */
static long double length_acceleration(long double d)
{
    return -80 * (d * d - 1) * d / (2.0L * 3 / 5);
}

/* The length of the pair at t = 0.256 s: classical Runge-Kutta steps in
 * extended precision, so small that their error is below 1e-15. */
static long double exact_length(void)
{
    enum { STEPS = 16384 };
    long double d = 1.5L, w = 0, h = 0.256L / STEPS;
    for (int i = 0; i < STEPS; i++) {
        long double a1 = length_acceleration(d), w1 = w;
        long double a2 = length_acceleration(d + h / 2 * w1);
        long double w2 = w + h / 2 * a1;
        long double a3 = length_acceleration(d + h / 2 * w2);
        long double w3 = w + h / 2 * a2;
        long double a4 = length_acceleration(d + h * w3), w4 = w + h * a3;
        d += h / 6 * (w1 + 2 * w2 + 2 * w3 + w4);
        w += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return d;
}

/* Error of the length of the pair at t = 0.256 s. */
static double length_error(const char *method, int steps)
{
    double d = (double)exact_length();
    Pair pair;
    pair_create(method, 0.256 / steps, &pair);
    for (int i = 0; i < steps; i++)
        CHECK(!time_integrator_step(&pair.run) ||
              status_is_unconverged(pair.run.status));
    double error = fabs(pair.run.x[2] - pair.run.x[0] - d);
    pair_free(&pair);
    return error;
}

/* After a step that ran off, Verlet asks for the acceleration again: what it
 * remembered was that of a place where it never came to be. */
TEST(a_failed_step_is_not_remembered)
{
    Pair failed, fresh;
    pair_create("verlet", 1e-3, &failed);
    pair_create("verlet", 1e-3, &fresh);
    CHECK_STATUS(time_integrator_step(&failed.run), STATUS_OK);
    CHECK_STATUS(time_integrator_step(&fresh.run), STATUS_OK);
    double v = failed.run.v[0];
    failed.run.v[0] = 1e300;
    CHECK_STATUS(time_integrator_step(&failed.run), STATUS_NOT_FINITE);
    failed.run.v[0] = v;
    CHECK_STATUS(time_integrator_step(&failed.run), STATUS_OK);
    CHECK_STATUS(time_integrator_step(&fresh.run), STATUS_OK);
    CHECK(failed.run.x[0] == fresh.run.x[0] &&
          failed.run.v[0] == fresh.run.v[0]);
    pair_free(&failed);
    pair_free(&fresh);
}

/* Halving h divides the error by 2^order; a quarter of an order is what is
 * left of the next one at these steps. */
TEST(orders_are_as_in_the_table)
{
    for (const IntegratorMethod *row = integrator_methods; row->name; row++) {
        int steps = row->order == 1 ? 1024 : row->order == 2 ? 256 : 64;
        double slope = log2(length_error(row->name, steps) /
                            length_error(row->name, 2 * steps));
        if (!(fabs(slope - row->order) <= 0.25))
            print_error("%s:\n", row->name);
        CHECK_NEAR(slope, row->order, 0.25);
    }
}

TESTS(NULL, NULL)
