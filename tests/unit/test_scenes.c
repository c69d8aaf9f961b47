/* Each scene shows what its sentence claims, with the numbers of the slides.
 */
#include "test.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scenes/small_scenes.h"
#include "scenes/scene.h"

/* Of the circle: one turn a second, h = 0.02 s. */
static const double HW = 0.02 * 6.283185307179586;

static double radius(const Simulation *simulation, int run)
{
    const double *x = simulation->run[run].x;
    return hypot(x[0], x[1]);
}

/* Steps until the scene is done, at most `limit`. */
static Status run_to_end(Simulation *simulation, int limit)
{
    Status status = simulation->status;
    for (int i = 0; i < limit && !simulation->done; i++)
        status = simulation_step(simulation);
    CHECK(simulation->done);
    return status;
}

/* ---- the table ---------------------------------------------------------- */

TEST(scenes_have_names_and_sentences)
{
    const char *expected[] = {"square", "circle", "overshoot", "landscape",
                              "unprojected"};
    int count = 0;
    for (const Scene *scene = scenes; scene->name; scene++, count++) {
        Simulation simulation;
        CHECK(count >= 5 || strcmp(scene->name, expected[count]) == 0);
        CHECK(scene->sentence && strlen(scene->sentence) > 20);
        CHECK(strlen(scene->sentence) <= 60);
        CHECK(scene->picture < PICTURE_COUNT && scene->create);
        CHECK(scene_find(scene->name) == scene);
        simulation_from_line(scene->name, NULL, NULL, &simulation);
        CHECK(simulation.scene == scene && simulation.runs >= 1);
        CHECK(!simulation.done && simulation.steps == 0);
        simulation_step(&simulation);
        CHECK(simulation.steps == 1);
        simulation_free(&simulation);
    }
    CHECK(count >= 5 && !scene_find("") && !scene_find("squar"));
}

/* No time passes while Newton iterates. */
TEST(iterations_take_no_time)
{
    Simulation simulation;
    simulation_from_line("landscape", NULL, NULL, &simulation);
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK_NEAR(simulation_time(&simulation), 0, 0);
    simulation_free(&simulation);
    simulation_from_line("circle", NULL, NULL, &simulation);
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK_NEAR(simulation_time(&simulation), 0.02, 0);
    simulation_free(&simulation);
}

/* ---- circle ------------------------------------------------------------- */

/* |x| grows by sqrt(1 + (h w)^2) in forward Euler, shrinks by it in backward
 * Euler, in every step. */
TEST(euler_spirals_by_its_factor)
{
    Simulation simulation;
    double factor = sqrt(1 + HW * HW);
    simulation_from_line("circle", NULL, NULL, &simulation);
    CHECK(simulation.runs == 3);
    CHECK_NEAR(radius(&simulation, 0), 1, 0);
    for (int i = 0; i < 2000; i++) {
        double before[2] = {radius(&simulation, 0), radius(&simulation, 2)};
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        CHECK_NEAR(radius(&simulation, 0) / before[0], factor, 1e-12);
        CHECK_NEAR(radius(&simulation, 2) / before[1], 1 / factor, 1e-12);
    }
    CHECK(radius(&simulation, 0) > 1e6 && radius(&simulation, 2) < 1e-6);
    simulation_free(&simulation);
}

/* With s = sin(t/2) = h w/2 a step of symplectic Euler from (1, 0) at speed w
 * leads to x = cos(n t + t/2)/cos(t/2), y = sin(n t)/cos(t/2), so
 *   |x|^2 = (1 - s sin(2 n t + t/2)) / (1 - s^2),
 * which lies between 1/(1 + s) and 1/(1 - s), and comes near both. */
TEST(symplectic_euler_stays_in_its_bound)
{
    Simulation simulation;
    double s = HW / 2, low = INFINITY, high = 0;
    simulation_from_line("circle --integrator symplectic-euler", NULL, NULL,
                         &simulation);
    CHECK(simulation.runs == 1);
    for (int i = 0; i < 1000000; i++) {
        if (simulation_step(&simulation))
            fail_msg("step %d", i);
        double r = radius(&simulation, 0);
        low = fmin(low, r);
        high = fmax(high, r);
    }
    CHECK_NEAR(low, 1 / sqrt(1 + s), 1e-6);
    CHECK_NEAR(high, 1 / sqrt(1 - s), 1e-6);
    CHECK(low >= 1 / sqrt(1 + s) - 1e-9 && high <= 1 / sqrt(1 - s) + 1e-9);
    simulation_free(&simulation);
}

/* ---- overshoot ---------------------------------------------------------- */

/* From x the update leads to x - sinh(2 x)/2. */
TEST(overshoot_follows_its_closed_form)
{
    Simulation simulation;
    const Descent *descent = &simulation.descent;
    simulation_from_line("overshoot", NULL, NULL, &simulation);
    CHECK_STATUS(run_to_end(&simulation, 10), STATUS_DIVERGED);
    CHECK(descent->count == 2 && simulation.steps == 2);
    CHECK_NEAR(descent->record[0].from[0], 2, 0);
    CHECK_NEAR(descent->record[0].to[0], -11.644958598563875L, 1e-12 * 11.7);
    for (int i = 0; i < descent->count; i++) {
        const NewtonRecord *record = &descent->record[i];
        long double x = record->from[0], to = x - sinhl(2 * x) / 2;
        CHECK_NEAR(record->to[0], to, 1e-12L * fabsl(to));
        CHECK_NEAR(record->alpha, 1, 0);
        CHECK(record->slope < 0 && record->change > 0);
        CHECK(record->step == i + 1 && record->iteration == i);
        CHECK_NEAR(record->residual, fabsl(tanhl(x)), 1e-15L);
    }
    CHECK_SAME_BITS(simulation.run[0].x, descent->record[1].to, 2);
    CHECK_NEAR(simulation.run[0].x[1], simulation.run[0].x[0], 1e-5);
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK); /* does nothing */
    CHECK(simulation.steps == 2 && simulation.unconverged == 1);
    simulation_free(&simulation);
}

TEST(overshoot_converges_with_line_search)
{
    const char *lines[] = {"overshoot --line-search backtrack",
                           "overshoot --line-search backtrack --start -9,0",
                           "overshoot --start 0.5,0"};
    for (int i = 0; i < 3; i++) {
        Simulation simulation;
        const Descent *descent = &simulation.descent;
        simulation_from_line(lines[i], NULL, NULL, &simulation);
        CHECK_STATUS(run_to_end(&simulation, 100), STATUS_OK);
        CHECK_NEAR(simulation.run[0].x[0], 0, 1e-10);
        CHECK_NEAR(simulation.run[0].x[1], logl(2), 1e-15);
        for (int k = 0; k < descent->count; k++)
            CHECK(descent->record[k].change < 0);
        CHECK(simulation.unconverged == 0);
        simulation_free(&simulation);
    }
}

/* A key may turn the line search on in the middle. */
TEST(overshoot_is_caught_by_the_line_search)
{
    Simulation simulation;
    simulation_from_line("overshoot", NULL, NULL, &simulation);
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    simulation_set_line_search(&simulation, LINE_SEARCH_BACKTRACK);
    CHECK_STATUS(run_to_end(&simulation, 100), STATUS_OK);
    CHECK_NEAR(simulation.run[0].x[0], 0, 1e-10);
    simulation_free(&simulation);
}

/* Starts without a direction are unconverged at once; the minimum is not. */
TEST(overshoot_may_end_at_its_start)
{
    Simulation simulation;
    simulation_from_line("overshoot --start 1e300,0", NULL, NULL, &simulation);
    CHECK(simulation.done && simulation.steps == 0);
    CHECK_STATUS(simulation.status, STATUS_DIVERGED);
    simulation_free(&simulation);
    simulation_from_line("overshoot --start 0,0", NULL, NULL, &simulation);
    CHECK(simulation.done);
    CHECK_STATUS(simulation.status, STATUS_OK);
    simulation_free(&simulation);
}

/* ---- unprojected -------------------------------------------------------- */

TEST(unprojected_points_uphill)
{
    Simulation simulation;
    simulation_from_line("unprojected", NULL, NULL, &simulation);
    CHECK_NEAR(simulation.options.timestep, 0.02, 0);
    CHECK_NEAR(simulation.options.stretch, 0.5, 0);
    CHECK_STATUS(simulation_step(&simulation), STATUS_NOT_DESCENT);
    const NewtonRecord *record = &simulation.run[0].newton->record;
    CHECK(record->slope > 0 && record->alpha == 0 && record->projected == 0);
    CHECK(simulation.steps == 1 && simulation.unconverged == 1);
    simulation_free(&simulation);
}

TEST(unprojected_converges_when_projected)
{
    const char *lines[] = {"unprojected --filter clamp",
                           "square --timestep 0.02 --stretch 0.5"};
    double *x[2];
    Simulation simulation[2];
    for (int i = 0; i < 2; i++) {
        simulation_from_line(lines[i], NULL, NULL, &simulation[i]);
        for (int step = 0; step < 100; step++)
            CHECK_STATUS(simulation_step(&simulation[i]), STATUS_OK);
        CHECK(simulation_counters(&simulation[i]).projected > 0);
        x[i] = simulation[i].run[0].x;
    }
    CHECK_SAME_BITS(x[0], x[1], 2 * simulation[0].system.nodes);
    simulation_free(&simulation[0]);
    simulation_free(&simulation[1]);
}

/* As by the key: while it runs, both ways. */
TEST(projection_is_switched_while_running)
{
    Simulation simulation;
    simulation_from_line("unprojected", NULL, NULL, &simulation);
    for (int i = 0; i < 3; i++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_NOT_DESCENT);
    simulation_set_filter(&simulation, FILTER_CLAMP);
    CHECK(simulation.options.filter == FILTER_CLAMP);
    for (int i = 0; i < 50; i++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK(simulation.unconverged == 3);
    simulation_free(&simulation);
    simulation_from_line("unprojected --filter clamp", NULL, NULL, &simulation);
    simulation_set_filter(&simulation, FILTER_NONE);
    CHECK_STATUS(simulation_step(&simulation), STATUS_NOT_DESCENT);
    simulation_free(&simulation);
}

/* ---- landscape ---------------------------------------------------------- */

/* The start of the scene: its raw direction is uphill, the clamped one down;
 * a key turns it round on the spot. */
TEST(landscape_starts_where_newton_goes_uphill)
{
    Simulation simulation;
    simulation_from_line("landscape --filter none", NULL, NULL, &simulation);
    CHECK(simulation.descent.slope > 0.1);
    simulation_set_filter(&simulation, FILTER_CLAMP);
    CHECK(simulation.descent.slope < -0.1);
    simulation_set_filter(&simulation, FILTER_NONE);
    CHECK(simulation.descent.slope > 0.1 && simulation.steps == 0);
    CHECK_STATUS(run_to_end(&simulation, 1), STATUS_NOT_DESCENT);
    CHECK(simulation.descent.record[0].slope > 0);
    CHECK(simulation.descent.slope > 0.1); /* still there to be seen */
    CHECK_NEAR(simulation.run[0].x[0], 0.1, 0);
    simulation_free(&simulation);
    simulation_from_line("landscape", NULL, NULL, &simulation);
    CHECK_STATUS(run_to_end(&simulation, 50), STATUS_OK);
    simulation_free(&simulation);
}

/* E decreases from record to record, each begins where the last one ended. */
static void check_path(const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    for (int i = 0; i < descent->count; i++) {
        const NewtonRecord *record = &descent->record[i];
        CHECK(record->slope < 0 && record->change < 0 && record->alpha > 0);
        CHECK(record->step == i + 1 && record->iteration == i);
        if (i > 0)
            CHECK_SAME_BITS(record->from, record[-1].to, 2);
        double from =
            descent_value(simulation, record->from[0], record->from[1]);
        double to = descent_value(simulation, record->to[0], record->to[1]);
        CHECK_NEAR(to - from, record->change, 1e-12 * (1 + fabs(from)));
    }
}

/* From a grid of starts the clamped direction is downhill and the run ends at
 * a minimum; the raw one is downhill where E is convex, uphill elsewhere from
 * some. */
TEST(landscape_is_downhill_from_everywhere)
{
    int uphill = 0, hollow = 0;
    for (int i = -8; i <= 8; i++)
        for (int j = -8; j <= 8; j++) {
            char line[96];
            Simulation simulation;
            snprintf(line, sizeof line, "landscape --start %g,%g", 0.2 * i,
                     0.2 * j);
            simulation_from_line(line, NULL, NULL, &simulation);
            CHECK(simulation.descent.slope < 0);
            bool convex = !descent_bends_down(&simulation, 0.2 * i, 0.2 * j);
            simulation_set_filter(&simulation, FILTER_NONE);
            uphill += simulation.descent.slope > 0;
            hollow += convex;
            CHECK(!convex || simulation.descent.slope < 0);
            simulation_set_filter(&simulation, FILTER_CLAMP);
            CHECK_STATUS(run_to_end(&simulation, 100), STATUS_OK);
            check_path(&simulation);
            CHECK(!descent_bends_down(&simulation, simulation.run[0].x[0],
                                        simulation.run[0].x[1]));
            simulation_free(&simulation);
        }
    CHECK(uphill > 5 && hollow > 100);
}

/* E = |x - (0.2, 0.3)|^2 / 2 + 0.2^2 sum 2.25 100/2 (|x - pin|^2/2.25 - 1)^2,
 * J s^2. */
static double energy_by_hand(double x, double y)
{
    double E = 0.5 * ((x - 0.2) * (x - 0.2) + (y - 0.3) * (y - 0.3));
    for (int pin = -1; pin <= 1; pin += 2) {
        double s = ((x - pin) * (x - pin) + y * y) / 2.25 - 1;
        E += 0.04 * 2.25 * 100 / 2 * s * s;
    }
    return E;
}

/* Wherever Newton is, and after the keys too, the map is the same. */
TEST(landscape_does_not_change)
{
    Simulation simulation;
    simulation_from_line("landscape --start 0.7,0.9", NULL, NULL, &simulation);
    for (int i = 0; i < 4; i++) {
        for (double x = -2; x < 2; x += 0.37)
            CHECK_NEAR(descent_value(&simulation, x, 0.8 * x - 0.3),
                       energy_by_hand(x, 0.8 * x - 0.3), 1e-12);
        CHECK_NEAR(
            simulation.descent.value,
            energy_by_hand(simulation.run[0].x[0], simulation.run[0].x[1]),
            1e-14);
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        simulation_set_filter(&simulation, i % 2 ? FILTER_CLAMP : FILTER_NONE);
    }
    simulation_free(&simulation);
}

/* The pins never move, and the log's points are those of the states. */
TEST(landscape_moves_one_node)
{
    Simulation simulation;
    simulation_from_line("landscape --start 0.5,0.25", NULL, NULL, &simulation);
    const double *x = simulation.run[0].x;
    CHECK_NEAR(x[0], 0.5, 0);
    CHECK_NEAR(x[1], 0.25, 0);
    while (!simulation.done) {
        simulation_step(&simulation);
        const Descent *descent = &simulation.descent;
        CHECK_SAME_BITS(x, descent->record[descent->count - 1].to, 2);
        CHECK(x[2] == -1 && x[3] == 0 && x[4] == 1 && x[5] == 0);
        CHECK_NEAR(descent->value, descent_value(&simulation, x[0], x[1]), 0);
    }
    simulation_free(&simulation);
}

TESTS(NULL, NULL)
