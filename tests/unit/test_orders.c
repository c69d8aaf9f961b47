/* Accuracy of all methods in time: their orders, and what they conserve.
 *
 * The exact motion comes from classical Runge-Kutta steps in extended
 * precision with forces written here, so small that nothing is left of their
 * error.
 */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bench/reference.h"

/* Squares of up to 4 segments. */
enum { SIZE = 2 * 25 };

/* Positions and velocities in extended precision. */
typedef struct Exact {
    long double x[SIZE], v[SIZE];
} Exact;

static Exact exact_start(const TimeIntegrator *run)
{
    Exact state;
    for (int i = 0; i < 2 * run->system->nodes; i++) {
        state.x[i] = run->x[i];
        state.v[i] = run->v[i];
    }
    return state;
}

/* x' = v, v' = -M^-1 grad P: node i of a spring is pulled by 2 k s d towards
 * node j. */
static Exact exact_rate(const System *system, const Exact *state)
{
    Exact rate = {{0}, {0}};
    for (int i = 0; i < 2 * system->nodes; i++)
        rate.x[i] = state->v[i];
    for (int spring = 0; spring < system->springs; spring++) {
        int i = system->e[2 * spring], j = system->e[2 * spring + 1];
        long double dx = state->x[2 * j] - state->x[2 * i];
        long double dy = state->x[2 * j + 1] - state->x[2 * i + 1];
        long double s = (dx * dx + dy * dy) / system->l2[spring] - 1;
        long double pull = 2 * (long double)system->k[spring] * s;
        rate.v[2 * i] += pull * dx / system->m[i];
        rate.v[2 * i + 1] += pull * dy / system->m[i];
        rate.v[2 * j] -= pull * dx / system->m[j];
        rate.v[2 * j + 1] -= pull * dy / system->m[j];
    }
    return rate;
}

/* state + h rate */
static Exact exact_move(const System *system, const Exact *state, long double h,
                        const Exact *rate)
{
    Exact moved = {{0}, {0}};
    for (int i = 0; i < 2 * system->nodes; i++) {
        moved.x[i] = state->x[i] + h * rate->x[i];
        moved.v[i] = state->v[i] + h * rate->v[i];
    }
    return moved;
}

static void exact_solve(const System *system, long double time, int steps,
                        Exact *state)
{
    long double h = time / steps;
    for (int step = 0; step < steps; step++) {
        Exact a = exact_rate(system, state);
        Exact at = exact_move(system, state, h / 2, &a);
        Exact b = exact_rate(system, &at);
        at = exact_move(system, state, h / 2, &b);
        Exact c = exact_rate(system, &at);
        at = exact_move(system, state, h, &c);
        Exact d = exact_rate(system, &at);
        *state = exact_move(system, state, h / 6, &a);
        *state = exact_move(system, state, h / 3, &b);
        *state = exact_move(system, state, h / 3, &c);
        *state = exact_move(system, state, h / 6, &d);
    }
}

/* Nine nodes for 0.064 s, in which they move by a tenth; not alike along x and
 * y, and with velocities of some m/s. */
static const double order_time = 0.064;

static void order_create(const char *method, const char *solver, int steps,
                         Simulation *simulation)
{
    char line[200];
    Random random = {90};
    snprintf(line, sizeof line,
             "--segments 2 --stretch 1.1 --tolerance 1e-13 --timestep %.17g "
             "--integrator %s --solver %s",
             order_time / steps, method, solver);
    simulation_from_line(line, NULL, NULL, simulation);
    TimeIntegrator *run = &simulation->run[0];
    for (int i = 0; i < 2 * run->system->nodes; i++)
        run->v[i] += random_uniform(&random, -1, 1);
}

/* The exact end; 4096 steps of order 4 leave less than 1e-13. */
static Exact order_end(void)
{
    Simulation simulation;
    order_create("verlet", "newton", 1, &simulation);
    Exact end = exact_start(&simulation.run[0]);
    exact_solve(simulation.run[0].system, order_time, 4096, &end);
    simulation_free(&simulation);
    return end;
}

/* Root mean squares of both errors. */
static void order_errors(const char *method, const char *solver, int steps,
                         const Exact *end, double *x_error, double *v_error)
{
    Simulation simulation;
    long double x = 0, v = 0;
    order_create(method, solver, steps, &simulation);
    const TimeIntegrator *run = &simulation.run[0];
    for (int step = 0; step < steps; step++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    int size = 2 * run->system->nodes;
    for (int i = 0; i < size; i++) {
        x += powl(run->x[i] - end->x[i], 2);
        v += powl(run->v[i] - end->v[i], 2);
    }
    *x_error = (double)sqrtl(x / size);
    *v_error = (double)sqrtl(v / size);
    simulation_free(&simulation);
}

/* Three halvings, from steps so small that the next term of the error changes
 * the slope by less than 0.05. */
static void check_order(const IntegratorMethod *row, int order,
                        const char *solver, const Exact *end)
{
    int steps = order == 1 ? 2048 : order == 2 ? 256 : 32;
    double x, v, half_x, half_v;
    CHECK(row->order == order);
    order_errors(row->name, solver, steps, end, &x, &v);
    for (int halving = 0; halving < 3; halving++) {
        steps *= 2;
        order_errors(row->name, solver, steps, end, &half_x, &half_v);
        double x_order = log2(x / half_x), v_order = log2(v / half_v);
        if (!(fabs(x_order - order) <= 0.05 && fabs(v_order - order) <= 0.05))
            print_error("%s, %s, %d steps: errors %g m, %g m/s\n", row->name,
                        solver, steps, half_x, half_v);
        CHECK_NEAR(x_order, order, 0.05);
        CHECK_NEAR(v_order, order, 0.05);
        x = half_x;
        v = half_v;
    }
}

TEST(orders_are_what_they_should_be)
{
    const struct {
        const char *name;
        int order;
    } methods[] = {{"forward-euler", 1},
                   {"symplectic-euler", 1},
                   {"backward-euler", 1},
                   {"verlet", 2},
                   {"bdf2", 2},
                   {"midpoint", 2},
                   {"sdirk2", 2},
                   {"avf", 2},
                   {"avf4", 4}};
    int count = sizeof methods / sizeof *methods;
    Exact end = order_end();
    for (int i = 0; i < count; i++) {
        const IntegratorMethod *row = integrator_method(methods[i].name);
        CHECK(row != NULL);
        check_order(row, methods[i].order, "newton", &end);
        if (row->implicit && row->order > 1)
            check_order(row, methods[i].order, "multigrid", &end);
    }
    CHECK(integrator_methods[count].name == NULL);
}

/* Kinetic and elastic energy in extended precision. */
static long double exact_total(const TimeIntegrator *run)
{
    const System *system = run->system;
    IncrementalPotential E = {.system = system, .weight = 1};
    long double sum = exact_energy(&E, NULL, run->x);
    for (int i = 0; i < 2 * system->nodes; i++)
        sum += 0.5L * system->m[i / 2] * run->v[i] * run->v[i];
    return sum;
}

/* Energy of the start is kept within 1e-12 of it at every step. */
static void check_energy(const char *line, int steps)
{
    Simulation simulation;
    simulation_from_line(line, NULL, NULL, &simulation);
    const TimeIntegrator *run = &simulation.run[0];
    long double start = exact_total(run), worst = 0;
    for (int step = 0; step < steps; step++) {
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        worst = fmaxl(worst, fabsl(exact_total(run) / start - 1));
    }
    CHECK_AT_MOST(worst, 1e-12L);
    simulation_free(&simulation);
}

/* Over 10^4 steps, and five times 2000; the drift is in proportion to what
 * Newton leaves undone. */
TEST(average_vector_field_keeps_energy)
{
    check_energy("--segments 2 --integrator avf --tolerance 1e-14", 10000);
    check_energy("--segments 2 --integrator avf --tolerance 1e-13 "
                 "--filter on-demand --timestep 0.02",
                 2000);
    check_energy("--segments 2 --integrator avf4 --tolerance 1e-13 "
                 "--filter on-demand",
                 2000);
}

/* Linear and angular momentum, and the sizes of what they are sums of. */
typedef struct Momentum {
    long double linear[2], angular, linear_size, angular_size;
} Momentum;

static Momentum exact_momentum(const TimeIntegrator *run)
{
    Momentum sum = {{0, 0}, 0, 0, 0};
    for (int i = 0; i < run->system->nodes; i++) {
        long double m = run->system->m[i];
        const double *x = run->x + 2 * i, *v = run->v + 2 * i;
        sum.linear[0] += m * v[0];
        sum.linear[1] += m * v[1];
        sum.angular +=
            m * ((long double)x[0] * v[1] - (long double)x[1] * v[0]);
        sum.linear_size += m * hypotl(v[0], v[1]);
        sum.angular_size += m * hypotl(x[0], x[1]) * hypotl(v[0], v[1]);
    }
    return sum;
}

/* 40 steps with rotation, drift and noise; 1e-14 of the sizes for each. */
static void check_momentum(const char *line, bool angular, double tolerance)
{
    Simulation simulation;
    Random random = {91};
    simulation_from_line(line, NULL, NULL, &simulation);
    TimeIntegrator *run = &simulation.run[0];
    for (int i = 0; i < 2 * run->system->nodes; i++)
        run->v[i] =
            (i % 2 ? 5 : -5) * run->x[i ^ 1] + random_uniform(&random, -1, 3);
    Momentum start = exact_momentum(run);
    for (int step = 0; step < 40; step++) {
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        Momentum now = exact_momentum(run);
        for (int c = 0; c < 2; c++)
            CHECK_NEAR(now.linear[c], start.linear[c],
                       4e-13 * start.linear_size);
        if (angular)
            CHECK_NEAR(now.angular, start.angular,
                       tolerance * start.angular_size);
    }
    simulation_free(&simulation);
}

/* Linear momentum by all methods, however far from the minimum they stop;
 * angular momentum exactly by the symplectic explicit ones, and as far as
 * Newton goes by the midpoint rule. */
TEST(momentum_is_kept)
{
    char line[200];
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        for (int s = 0; s < SOLVER_COUNT; s++) {
            bool symplectic = strcmp(row->name, "verlet") == 0 ||
                              strcmp(row->name, "symplectic-euler") == 0;
            snprintf(line, sizeof line,
                     "--integrator %s --solver %s --timestep 1e-3", row->name,
                     solver_name((Solver)s));
            check_momentum(line, symplectic, 4e-13);
        }
    check_momentum("--integrator midpoint --tolerance 1e-12", true, 1e-11);
    check_momentum("--integrator midpoint --tolerance 1e-12 --solver multigrid",
                   true, 1e-11);
}

/* At rest, moved at 0.5 m/s: a step of h v = 5e-10 m is lost in the last digits
 * of x, but the velocity must not be. */
TEST(free_flight_keeps_its_velocity)
{
    char line[200];
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        for (int s = 0; s < SOLVER_COUNT; s++) {
            Simulation simulation;
            snprintf(line, sizeof line,
                     "--integrator %s --solver %s --stretch 1 --timestep 1e-9 "
                     "--tolerance 1e-14",
                     row->name, solver_name((Solver)s));
            simulation_from_line(line, NULL, NULL, &simulation);
            TimeIntegrator *run = &simulation.run[0];
            int size = 2 * run->system->nodes;
            for (int i = 0; i < size; i++)
                run->v[i] = i % 2 ? -0.25 : 0.5;
            for (int step = 0; step < 10; step++)
                CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
            for (int i = 0; i < size; i++)
                CHECK_NEAR(run->v[i], i % 2 ? -0.25 : 0.5, 1e-12);
            simulation_free(&simulation);
        }
}

/* The reference of the benchmark is another program for the same motion. */
TEST(benchmark_has_the_same_reference)
{
    Simulation simulation;
    Reference fine, coarse;
    double x[SIZE];
    order_create("verlet", "newton", 1, &simulation);
    const TimeIntegrator *run = &simulation.run[0];
    const System *system = run->system;
    Exact end = order_end();
    long intervals = reference_intervals(system, run->x, order_time);
    CHECK_STATUS(reference_create(system, run->x, run->v, order_time,
                                  4 * intervals, &fine),
                 STATUS_OK);
    CHECK_STATUS(reference_create(system, run->x, run->v, order_time,
                                  2 * intervals, &coarse),
                 STATUS_OK);
    for (int i = 0; i < 2 * system->nodes; i++) {
        x[i] = (double)end.x[i];
        CHECK_NEAR(fine.x[i], end.x[i], 1e-13);
        CHECK_NEAR(fine.v[i], end.v[i], 1e-11);
        CHECK_NEAR(coarse.x[i], fine.x[i], 1e-12);
    }
    CHECK_AT_MOST(reference_distance(&fine, x), 1e-13);
    x[3] += 0.3;
    CHECK_NEAR(reference_distance(&fine, x), 0.3 / sqrt(system->nodes), 1e-12);
    reference_free(&fine);
    reference_free(&coarse);
    simulation_free(&simulation);
}

TESTS(NULL, NULL)
