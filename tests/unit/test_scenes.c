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

/* Steps until the scene is done, at most `limit`; the status of the last. */
static Status run_to_end(Simulation *simulation, int limit)
{
    Status status = simulation->status;
    for (int i = 0; i < limit && !simulation->done; i++)
        status = simulation_step(simulation);
    CHECK(simulation->done);
    return status;
}

/* ---- the table ---------------------------------------------------------- */

/* A name by which it is found, a sentence of one line, numbers of its own that
 * mean something in it, and a first step. */
TEST(scenes_are_complete)
{
    for (const Scene *scene = scenes; scene->name; scene++) {
        char words[512], *rest = NULL;
        CHECK(scene_find(scene->name) == scene);
        CHECK(strlen(scene->sentence) > 20 && strlen(scene->sentence) <= 60);
        CHECK(scene->picture < PICTURE_COUNT);
        snprintf(words, sizeof words, "%s", scene->line ? scene->line : "");
        for (char *word = strtok_r(words, " ", &rest); word;
             word = strtok_r(NULL, " ", &rest))
            if (strncmp(word, "--", 2) == 0)
                CHECK(option_find(word + 2)->needs & scene->needs);
        Simulation *simulation = simulate("%s", scene->name);
        CHECK(simulation->scene == scene && simulation->runs >= 1);
        CHECK(!simulation->done && simulation->steps == 0);
        simulation_step(simulation);
        CHECK(simulation->steps == 1);
        double time = simulation_time(simulation);
        CHECK((time > 0) == ((scene->needs & NEEDS_TIME) != 0));
    }
    CHECK(!scene_find("") && !scene_find("squar") && !scene_find("0"));
    CHECK(scene_find("1") == scenes && scene_find("2") == scenes + 1);
}

/* ---- circle ------------------------------------------------------------- */

/* |x| grows by sqrt(1 + (h w)^2) in forward Euler, shrinks by it in backward
 * Euler, in every step. */
TEST(euler_spirals_by_its_factor)
{
    double factor = sqrt(1 + HW * HW);
    Simulation *simulation = simulate("circle");
    CHECK(simulation->runs == 3);
    CHECK_NEAR(radius(simulation, 0), 1, 0);
    for (int i = 0; i < 2000; i++) {
        double before[2] = {radius(simulation, 0), radius(simulation, 2)};
        CHECK_STATUS(simulation_step(simulation), STATUS_OK);
        CHECK_NEAR(radius(simulation, 0) / before[0], factor, 1e-12);
        CHECK_NEAR(radius(simulation, 2) / before[1], 1 / factor, 1e-12);
    }
    CHECK(radius(simulation, 0) > 1e6 && radius(simulation, 2) < 1e-6);
}

/* With s = sin(t/2) = h w/2 a step of symplectic Euler from (1, 0) at speed w
 * leads to x = cos(n t + t/2)/cos(t/2), y = sin(n t)/cos(t/2), so
 *   |x|^2 = (1 - s sin(2 n t + t/2)) / (1 - s^2),
 * which lies between 1/(1 + s) and 1/(1 - s), and comes near both. */
TEST(symplectic_euler_stays_in_its_bound)
{
    double s = HW / 2, low = INFINITY, high = 0;
    Simulation *simulation = simulate("circle --integrator symplectic-euler");
    CHECK(simulation->runs == 1);
    for (int i = 0; i < 1000000; i++) {
        if (simulation_step(simulation))
            fail_msg("step %d", i);
        double r = radius(simulation, 0);
        low = fmin(low, r);
        high = fmax(high, r);
    }
    CHECK_NEAR(low, 1 / sqrt(1 + s), 1e-6);
    CHECK_NEAR(high, 1 / sqrt(1 - s), 1e-6);
    CHECK(low >= 1 / sqrt(1 + s) - 1e-9 && high <= 1 / sqrt(1 - s) + 1e-9);
}

/* ---- overshoot ---------------------------------------------------------- */

/* From x the update leads to x - sinh(2 x)/2. */
TEST(overshoot_follows_its_closed_form)
{
    Simulation *simulation = simulate("overshoot");
    const Descent *descent = &simulation->descent;
    CHECK_STATUS(run_to_end(simulation, 10), STATUS_DIVERGED);
    CHECK(descent->count == 2 && descent->record[0].from[0] == 2);
    for (int i = 0; i < descent->count; i++) {
        const NewtonRecord *record = &descent->record[i];
        Real x = record->from[0], to = x - sinhl(2 * x) / 2;
        CHECK_NEAR(record->to[0], to, 1e-12L * fabsl(to));
        CHECK_NEAR(record->alpha, 1, 0);
        CHECK(record->slope < 0 && record->change > 0);
        CHECK(record->step == i + 1 && record->iteration == i);
        CHECK_NEAR(record->residual, fabsl(tanhl(x)), 1e-15L);
    }
    CHECK_SAME_BITS(simulation->run[0].x, descent->record[1].to, 2);
    CHECK_STATUS(simulation_step(simulation), STATUS_OK); /* does nothing */
    CHECK(simulation->steps == 2 && simulation->unconverged == 1);
}

/* In the middle a key may turn the line search on. */
TEST(overshoot_converges_with_line_search)
{
    static const char *const lines[] = {"--line-search backtrack",
                                        "--line-search backtrack --start -9,0",
                                        "--start 0.5,0", ""};
    for (int i = 0; i < 4; i++) {
        Simulation *simulation = simulate("overshoot %s", lines[i]);
        const Descent *descent = &simulation->descent;
        if (i == 3) {
            simulation_step(simulation);
            simulation_set(simulation, OPTION_SLOT(line_search),
                           LINE_SEARCH_BACKTRACK);
        }
        CHECK_STATUS(run_to_end(simulation, 100), STATUS_OK);
        CHECK_NEAR(simulation->run[0].x[0], 0, 1e-10);
        CHECK_NEAR(simulation->run[0].x[1], logl(2), 1e-15);
        for (int k = i == 3; k < descent->count; k++)
            CHECK(descent->record[k].change < 0);
    }
}

/* Starts without a direction are unconverged at once; the minimum is not. */
TEST(overshoot_may_end_at_its_start)
{
    Simulation *simulation = simulate("overshoot --start 1e300,0");
    CHECK(simulation->done && simulation->steps == 0);
    CHECK_STATUS(simulation->status, STATUS_DIVERGED);
    simulation = simulate("overshoot --start 0,0");
    CHECK(simulation->done);
    CHECK_STATUS(simulation->status, STATUS_OK);
}

/* ---- unprojected -------------------------------------------------------- */

/* Without projection the first direction points uphill; with it, chosen at once
 * or by the key, every step converges. */
TEST(projection_is_switched_while_running)
{
    Simulation *simulation = simulate("unprojected");
    CHECK(simulation->options.timestep == 0.02);
    CHECK(simulation->options.stretch == 0.5);
    for (int i = 0; i < 3; i++) {
        CHECK_STATUS(simulation_step(simulation), STATUS_NOT_DESCENT);
        const NewtonRecord *record = &simulation->run[0].newton->record;
        CHECK(record->slope > 0 && record->alpha == 0);
        CHECK(record->projected == 0);
    }
    simulation_set(simulation, OPTION_SLOT(filter), FILTER_CLAMP);
    make_steps(simulation, 50);
    CHECK(simulation->options.filter == FILTER_CLAMP);
    CHECK(simulation->unconverged == 3);
    CHECK(simulation_counters(simulation).projected > 0);
    simulation = simulate("unprojected --filter clamp");
    simulation_set(simulation, OPTION_SLOT(filter), FILTER_NONE);
    CHECK_STATUS(simulation_step(simulation), STATUS_NOT_DESCENT);
}

/* ---- landscape ---------------------------------------------------------- */

/* The raw direction at the start is uphill, the clamped one down; a key turns
 * it round on the spot, and a search that failed leaves it to be seen. */
TEST(landscape_starts_where_newton_goes_uphill)
{
    Simulation *simulation = simulate("landscape --filter none");
    for (int i = 0; i < 3; i++) {
        simulation_set(simulation, OPTION_SLOT(filter),
                       i % 2 ? FILTER_CLAMP : FILTER_NONE);
        CHECK(i % 2 ? simulation->descent.slope < -0.1
                    : simulation->descent.slope > 0.1);
    }
    CHECK_STATUS(run_to_end(simulation, 1), STATUS_NOT_DESCENT);
    CHECK(simulation->descent.record[0].slope > 0);
    CHECK(simulation->descent.slope > 0.1 && simulation->run[0].x[0] == 0.1);
}

/* E decreases from record to record, each begins where the last one ended, and
 * the pins stay. */
static void check_path(const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    const double *x = simulation->run[0].x, pins[] = {-1, 0, 1, 0};
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
    CHECK_SAME_BITS(x + 2, pins, 4);
    if (descent->count > 0)
        CHECK_SAME_BITS(x, descent->record[descent->count - 1].to, 2);
}

/* From a grid of starts the clamped direction is downhill and the run ends at
 * a minimum; the raw one is downhill where E is convex, uphill elsewhere from
 * some. */
TEST(landscape_is_downhill_from_everywhere)
{
    int uphill = 0, hollow = 0;
    for (int i = 0; i < 17 * 17; i++) {
        double at[2] = {0.2 * (i / 17 - 8), 0.2 * (i % 17 - 8)};
        Simulation *simulation =
            simulate("landscape --start %g,%g", at[0], at[1]);
        const double *x = simulation->run[0].x;
        CHECK(simulation->descent.slope < 0);
        bool convex = !descent_bends_down(simulation, at[0], at[1]);
        simulation_set(simulation, OPTION_SLOT(filter), FILTER_NONE);
        uphill += simulation->descent.slope > 0;
        hollow += convex;
        CHECK(!convex || simulation->descent.slope < 0);
        simulation_set(simulation, OPTION_SLOT(filter), FILTER_CLAMP);
        CHECK_STATUS(run_to_end(simulation, 100), STATUS_OK);
        check_path(simulation);
        CHECK(!descent_bends_down(simulation, x[0], x[1]));
        free_all_begun();
    }
    CHECK(uphill > 5 && hollow > 100);
}

/* On demand the Hessian is projected where it is not positive definite. */
TEST(landscape_projects_on_demand)
{
    Simulation *simulation = simulate("landscape --filter on-demand");
    const Descent *descent = &simulation->descent;
    while (!simulation->done) {
        const double *x = simulation->run[0].x;
        bool convex = !descent_bends_down(simulation, x[0], x[1]);
        CHECK_STATUS(simulation_step(simulation), STATUS_OK);
        CHECK((descent->record[descent->count - 1].projected == 0) == convex);
    }
    CHECK(descent->record[0].projected > 0);
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
    Simulation *simulation = simulate("landscape --start 0.7,0.9");
    for (int i = 0; i < 4; i++) {
        for (double x = -2; x < 2; x += 0.37)
            CHECK_NEAR(descent_value(simulation, x, 0.8 * x - 0.3),
                       energy_by_hand(x, 0.8 * x - 0.3), 1e-12);
        CHECK_NEAR(
            simulation->descent.value,
            energy_by_hand(simulation->run[0].x[0], simulation->run[0].x[1]),
            1e-14);
        CHECK_STATUS(simulation_step(simulation), STATUS_OK);
        simulation_set(simulation, OPTION_SLOT(filter),
                       i % 2 ? FILTER_CLAMP : FILTER_NONE);
    }
}

TESTS(NULL, NULL)
