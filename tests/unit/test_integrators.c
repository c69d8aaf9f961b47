/* Steps in time: each method against its order, and against what it conserves.
 * The exact motion is extrapolated from two runs of velocity Verlet: where it
 * were wrong, no other method's order would come out.
 */
#include "test.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The methods of the table, each with every solver that it can have. */
typedef struct Way {
    const IntegratorMethod *method;
    Solver solver;
} Way;

static bool next_way(Way *way)
{
    if (!way->method)
        way->method = integrator_methods;
    else if (way->method->implicit && way->solver + 1 < SOLVER_COUNT)
        way->solver++;
    else
        *way = (Way){.method = way->method + 1};
    return way->method->name != NULL;
}

static Simulation *go(const Way *way, const char *line)
{
    return simulate("%s --integrator %s --solver %s", line, way->method->name,
                    solver_name(way->solver));
}

/* ---- orders ------------------------------------------------------------ */

/* Nine nodes for 0.064 s, in which they move by a tenth; not alike along x and
 * y, and with velocities of some m/s. */
static const double TIME = 0.064;

static Simulation *moving_square(const Way *way, int steps)
{
    char line[120];
    Random random = {90};
    snprintf(line, sizeof line,
             "--segments 2 --stretch 1.1 --gravity 9.81 --tolerance 1e-13 "
             "--timestep %.17g",
             TIME / steps);
    Simulation *square = go(way, line);
    for (size_t i = 0; i < square->run[0].size; i++)
        square->run[0].v[i] += random_uniform(&random, -1, 1);
    return square;
}

/* It falls, too.  Halving h divides the error by 2^order: two halvings, from
 * steps so small that the next term of the error changes the slope by less than
 * 0.05. */
TEST(orders_are_as_in_the_table)
{
    enum { FINEST = 16384 };
    const Way verlet = {integrator_method("verlet"), SOLVER_NEWTON};
    const TimeIntegrator *start = &moving_square(&verlet, FINEST)->run[0];
    Simulation *far = make_steps(moving_square(&verlet, FINEST), FINEST);
    Simulation *near =
        make_steps(moving_square(&verlet, 2 * FINEST), 2 * FINEST);
    double fallen = 0; /* what springs do does not move the middle */
    for (int i = 1; i < 2 * 9; i += 2)
        fallen += (far->run[0].x[i] - start->x[i] - TIME * start->v[i]) / 9;
    CHECK_NEAR(fallen, -9.81 / 2 * TIME * TIME, 1e-12);
    for (Way way = {0}; next_way(&way);) {
        int order = way.method->order;
        int steps = order == 1 ? 2048 : order == 2 ? 256 : 32;
        double last = 0;
        for (int k = 0; k < 3; k++, steps *= 2) {
            Simulation *square = make_steps(moving_square(&way, steps), steps);
            double error = 0;
            for (size_t i = 0; i < square->run[0].size; i++)
                error =
                    fmax(error,
                         fabs(square->run[0].x[i] -
                              (4 * near->run[0].x[i] - far->run[0].x[i]) / 3));
            if (k > 0)
                CHECK_NEAR(log2(last / error), order, 0.05);
            last = error;
        }
    }
}

/* ---- what is conserved ------------------------------------------------- */

/* Linear and angular momentum, and the sizes of what they are sums of. */
typedef struct Momentum {
    long double linear[2], angular, linear_size, angular_size;
} Momentum;

static Momentum momentum_of(const TimeIntegrator *run)
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

/* 40 steps with rotation, drift and noise; angular <= 0: it may change. */
static void check_momentum(Simulation *square, double angular)
{
    Random random = {91};
    TimeIntegrator *run = &square->run[0];
    for (size_t i = 0; i < run->size; i++)
        run->v[i] =
            (i % 2 ? 5 : -5) * run->x[i ^ 1] + random_uniform(&random, -1, 3);
    Momentum start = momentum_of(run);
    for (int step = 0; step < 40; step++) {
        Momentum now = momentum_of(&make_steps(square, 1)->run[0]);
        for (int c = 0; c < 2; c++)
            CHECK_NEAR(now.linear[c], start.linear[c],
                       4e-13 * start.linear_size);
        if (angular > 0)
            CHECK_NEAR(now.angular, start.angular,
                       angular * start.angular_size);
    }
}

/* Linear momentum by all methods, however far from the minimum they stop;
 * angular momentum exactly by the symplectic explicit ones, and as far as
 * Newton goes by the midpoint rule. */
TEST(momentum_is_kept)
{
    for (Way way = {0}; next_way(&way);) {
        bool midpoint = strcmp(way.method->name, "midpoint") == 0;
        bool symplectic = strcmp(way.method->name, "verlet") == 0 ||
                          strcmp(way.method->name, "symplectic-euler") == 0;
        check_momentum(go(&way, "--timestep 1e-3"), symplectic ? 4e-13 : 0);
        if (way.method->implicit)
            check_momentum(go(&way, "--stretch 0.6 --timestep 0.01"), 0);
        if (midpoint)
            check_momentum(go(&way, "--tolerance 1e-12"), 1e-11);
    }
}

static Real total_of(const TimeIntegrator *run)
{
    Real sum = exact_potential(run->system, run->x);
    for (size_t i = 0; i < run->size; i++)
        sum += 0.5L * run->system->m[i / 2] * run->v[i] * run->v[i];
    return sum;
}

/* The energy of the start is kept within 1e-12 of it at every step; the drift
 * is in proportion to what Newton leaves undone. */
TEST(average_vector_field_keeps_energy)
{
    static const struct {
        const char *line;
        int steps;
    } rows[] = {
        {"--integrator avf --tolerance 1e-14", 10000},
        {"--integrator avf --tolerance 1e-13 --filter on-demand --timestep "
         "0.02",
         2000},
        {"--integrator avf4 --tolerance 1e-13 --filter on-demand", 2000}};
    for (int i = 0; i < 3; i++) {
        Simulation *square = simulate("--segments 2 %s", rows[i].line);
        Real start = total_of(&square->run[0]);
        for (int step = 0; step < rows[i].steps; step++)
            CHECK_NEAR(total_of(&make_steps(square, 1)->run[0]), start,
                       1e-12L * start);
    }
}

/* What flies undisturbed keeps its velocity, for every length of step and also
 * far out, where x + h v is rounded and so springs are strained a little. */
TEST(free_flight_is_straight)
{
    for (int i = 0; i < 26; i++) {
        double h = pow(10, i / 2 - 9), far = i % 2 ? 1e6 : 0, off = 0;
        double strain = (far + 10 * h) * DBL_EPSILON;
        Simulation *square =
            simulate("--segments 3 --stretch 1 --tolerance 1e-10 --timestep %g "
                     "--at %g,%g --velocity 3,-2",
                     h, far, far);
        for (int s = 0; s < square->system.springs; s++)
            square->system.l2[s] *=
                1 + (double)exact_strain(&square->system, square->run[0].x, s);
        make_steps(square, 3);
        for (int c = 0; c < 2 * 16; c++)
            off = fmax(off, fabs(square->run[0].v[c] - (c % 2 ? -2 : 3)));
        CHECK_AT_MOST(off, 1e-10 + 1e4 * fmin(strain * h, strain / h));
    }
}

/* ---- the table --------------------------------------------------------- */

/* After a step that ran off, Verlet asks for the acceleration again: what it
 * remembered was that of a place where it never came to be. */
TEST(a_failed_step_is_not_remembered)
{
    Simulation *pair[2];
    for (int i = 0; i < 2; i++) {
        pair[i] =
            make_steps(simulate("--integrator verlet --timestep 1e-3"), 1);
        double *v = pair[i]->run[0].v, kept = v[0];
        v[0] = i ? 1e300 : v[0];
        if (i)
            CHECK_STATUS(simulation_step(pair[i]), STATUS_NOT_FINITE);
        v[0] = kept;
        make_steps(pair[i], 1);
    }
    CHECK_SAME_BITS(pair[0]->run[0].x, pair[1]->run[0].x, 2 * 25);
    CHECK_SAME_BITS(pair[0]->run[0].v, pair[1]->run[0].v, 2 * 25);
}

TESTS(NULL, NULL)
