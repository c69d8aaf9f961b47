/* The slides' algorithm in its naive form against newton.c: the same iterates
 * in the six sets of parameters of tests/data/reference.
 */
#include "testing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bench/plain_newton.h"

/* Squares of up to 8 segments; updates of a step. */
enum { SIZE = 2 * 81, UPDATES = 64 };

/* The iterates of one step of newton.c. */
typedef struct Iterates {
    const Simulation *simulation;
    int count;
    double x[UPDATES][SIZE];
} Iterates;

static bool keep_iterate(void *user, const NewtonRecord *record)
{
    Iterates *iterates = user;
    const Newton *newton = iterates->simulation->run[0].newton;
    if (record->iteration < 0)
        return true;
    CHECK(record->iteration == iterates->count && iterates->count < UPDATES);
    memcpy(iterates->x[iterates->count++], newton->at.x,
           2 * (size_t)newton->system->nodes * sizeof(double));
    return true;
}

static void check_positions(const double *got, const double *expected, int size)
{
    for (int i = 0; i < size; i++)
        CHECK_NEAR(got[i], expected[i], 1e-9);
}

/* One step: each iterate, by a limit of so many iterations, then the end. */
static void check_step(const Options *options, const System *system,
                       const Iterates *iterates, double *x, double *v)
{
    PlainCounters counters = {0};
    double h = options->timestep, tolerance = options->tolerance;
    int size = 2 * system->nodes;
    for (int i = 1; i < iterates->count; i++) {
        double y[SIZE], w[SIZE];
        memcpy(y, x, (size_t)size * sizeof *y);
        memcpy(w, v, (size_t)size * sizeof *w);
        CHECK_STATUS(
            plain_newton_step(system, h, tolerance, i, y, w, &counters),
            STATUS_ITERATION_LIMIT);
        check_positions(y, iterates->x[i - 1], size);
    }
    counters = (PlainCounters){0};
    CHECK_STATUS(
        plain_newton_step(system, h, tolerance, UPDATES, x, v, &counters),
        STATUS_OK);
    CHECK(counters.iterations == iterates->count);
    CHECK(counters.factorisations == counters.iterations + 1);
    if (iterates->count > 0)
        check_positions(x, iterates->x[iterates->count - 1], size);
}

/* Both run on their own, from the same start; velocities may differ by what
 * 1e-9 m at both ends of a step are over h. */
static void check_case(const char *line, int steps)
{
    static Iterates iterates;
    Simulation simulation;
    simulation_from_line(line, keep_iterate, &iterates, &simulation);
    const TimeIntegrator *run = &simulation.run[0];
    double x[SIZE], v[SIZE];
    int size = 2 * run->system->nodes;
    long updates = 0;
    iterates.simulation = &simulation;
    memcpy(x, run->x, (size_t)size * sizeof *x);
    memcpy(v, run->v, (size_t)size * sizeof *v);
    for (int step = 0; step < steps; step++) {
        iterates.count = 0;
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        check_step(&simulation.options, run->system, &iterates, x, v);
        check_positions(x, run->x, size);
        for (int i = 0; i < size; i++)
            CHECK_NEAR(v[i], run->v[i], 2e-9 / run->h);
        updates += iterates.count;
    }
    CHECK(updates > 0);
    simulation_free(&simulation);
}

static void default_scene(void **unused)
{
    (void)unused;
    check_case("square", 50);
}

static void one_cell(void **unused)
{
    (void)unused;
    check_case("--segments 1", 60);
}

static void gentle_8(void **unused)
{
    (void)unused;
    check_case("--segments 8 --stretch 1.1", 25);
}

static void compressed(void **unused)
{
    (void)unused;
    check_case("--stretch 0.5 --timestep 0.02", 25);
}

static void stiff_large_step(void **unused)
{
    (void)unused;
    check_case("--segments 3 --stiffness 1e8 --stretch 2.5 --timestep 0.1", 20);
}

static void squashed(void **unused)
{
    (void)unused;
    check_case("--segments 3 --stretch 0.05 --timestep 0.1 --tolerance 1e-3",
               15);
}

/* What is not finite changes nothing. */
static void overflow_changes_nothing(void **unused)
{
    (void)unused;
    Simulation simulation;
    PlainCounters counters = {0};
    simulation_from_line("square", NULL, NULL, &simulation);
    TimeIntegrator *run = &simulation.run[0];
    double before[SIZE];
    run->v[3] = 1e200;
    memcpy(before, run->x, sizeof(double) * 50);
    CHECK_STATUS(
        plain_newton_step(run->system, 1, 1e-2, 10, run->x, run->v, &counters),
        STATUS_NOT_FINITE);
    CHECK_SAME_BITS(run->x, before, 50);
    CHECK(run->v[3] == 1e200);
    simulation_free(&simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(default_scene),
        cmocka_unit_test(one_cell),
        cmocka_unit_test(gentle_8),
        cmocka_unit_test(compressed),
        cmocka_unit_test(stiff_large_step),
        cmocka_unit_test(squashed),
        cmocka_unit_test(overflow_changes_nothing),
    };
    return cmocka_run_group_tests_name("plain newton", tests, NULL, NULL);
}
