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

/* |x| grows by sqrt(1 + (h w)^2) in a step of forward Euler, and shrinks by it
 * in backward Euler.  With s = sin(t/2) = h w/2 a step of symplectic Euler from
 * (1, 0) at speed w leads to x = cos(n t + t/2)/cos(t/2), y = sin(n
 * t)/cos(t/2), so |x|^2 = (1 - s sin(2 n t + t/2)) / (1 - s^2): between 1/(1 +
 * s) and 1/(1 - s), and near both. */
TEST(euler_methods_go_out_in_and_around)
{
    double factor = sqrt(1 + HW * HW), s = HW / 2, low = 2, high = 0;
    Simulation *simulation = simulate("circle");
    CHECK(simulation->runs == 3);
    CHECK_NEAR(radius(simulation, 0), 1, 0);
    for (int i = 0; i < 20000; i++) {
        double before[2] = {radius(simulation, 0), radius(simulation, 2)};
        make_steps(simulation, 1);
        double r = radius(simulation, 1);
        low = fmin(low, r);
        high = fmax(high, r);
        if (i >= 2000)
            continue;
        CHECK_NEAR(radius(simulation, 0) / before[0], factor, 1e-12);
        CHECK_NEAR(radius(simulation, 2) / before[1], 1 / factor, 1e-12);
    }
    CHECK_NEAR(low, 1 / sqrt(1 + s), 1e-5);
    CHECK_NEAR(high, 1 / sqrt(1 - s), 1e-5);
    CHECK(low >= 1 / sqrt(1 + s) - 1e-9 && high <= 1 / sqrt(1 - s) + 1e-9);
}

/* ---- overshoot ---------------------------------------------------------- */

/* From x the full step leads to x - sinh(2 x)/2.  A line search, also one that
 * a key turns on in the middle, makes it converge; starts without a direction
 * are unconverged at once, the minimum is not. */
TEST(overshoot_follows_its_closed_form)
{
    static const struct {
        const char *line;
        int full, updates; /* full steps at first; of them all, -1: some */
        Status status;
    } rows[] = {{"", 9, 2, STATUS_DIVERGED},
                {"--start 1e300", 0, 0, STATUS_DIVERGED},
                {"--start 0", 0, 0, STATUS_OK},
                {"--start 0.5", 0, -1, STATUS_OK},
                {"--line-search backtrack", 0, -1, STATUS_OK},
                {"--line-search backtrack --start -9", 0, -1, STATUS_OK},
                {"", 1, -1, STATUS_OK}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Simulation *simulation = simulate("overshoot %s", rows[i].line);
        const Descent *descent = &simulation->descent;
        if (rows[i].full == 1) {
            simulation_step(simulation);
            simulation_set(simulation, OPTION_SLOT(line_search),
                           LINE_SEARCH_BACKTRACK);
        }
        CHECK_STATUS(run_to_end(simulation, 100), rows[i].status);
        CHECK(rows[i].updates < 0 || rows[i].updates == descent->count);
        for (int k = 0; k < descent->count; k++) {
            const NewtonRecord *record = &descent->record[k];
            Real x = record->from[0], to = x - sinhl(2 * x) / 2;
            bool full = k < rows[i].full;
            CHECK(full ? record->change > 0 : record->change < 0);
            CHECK(record->step == k + 1 && record->iteration == k);
            CHECK_NEAR(record->residual, fabsl(tanhl(x)), 1e-15L);
            if (full)
                CHECK_NEAR(record->to[0], to, 1e-12L * fabsl(to));
        }
        if (rows[i].status)
            continue;
        CHECK_NEAR(simulation->run[0].x[0], 0, 1e-10);
        CHECK_NEAR(simulation->run[0].x[1], logl(2), 1e-15);
        long steps = simulation->steps;
        CHECK_STATUS(simulation_step(simulation), STATUS_OK);
        CHECK(simulation->steps == steps); /* it is over */
    }
}

/* ---- unprojected -------------------------------------------------------- */

/* Without projection the first direction points uphill; with it, chosen at once
 * or by the key, every step converges. */
TEST(projection_is_switched_while_running)
{
    Simulation *simulation = simulate("unprojected");
    for (int i = 0; i < 3; i++) {
        CHECK_STATUS(simulation_step(simulation), STATUS_NOT_DESCENT);
        const NewtonRecord *record = &simulation->run[0].newton->record;
        CHECK(record->slope > 0 && record->alpha == 0);
        CHECK(record->projected == 0);
    }
    simulation_set(simulation, OPTION_SLOT(filter), FILTER_CLAMP);
    make_steps(simulation, 50);
    CHECK(simulation->unconverged == 3);
    CHECK(simulation_counters(simulation).projected > 0);
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

/* E decreases from record to record, each begins where the last one ended, on
 * demand the Hessian is projected where it is not positive definite, and the
 * pins stay. */
static void check_path(const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    const double *x = simulation->run[0].x, pins[] = {-1, 0, 1, 0};
    bool on_demand = simulation->options.filter == FILTER_ON_DEMAND;
    for (int i = 0; i < descent->count; i++) {
        const NewtonRecord *record = &descent->record[i];
        const double *from = record->from, *to = record->to;
        CHECK(record->slope < 0 && record->change < 0 && record->alpha > 0);
        CHECK(record->step == i + 1 && record->iteration == i);
        if (i > 0)
            CHECK_SAME_BITS(from, record[-1].to, 2);
        double E = descent_value(simulation, from[0], from[1]);
        CHECK_NEAR(descent_value(simulation, to[0], to[1]) - E, record->change,
                   1e-12 * (1 + fabs(E)));
        if (on_demand)
            CHECK((record->projected > 0) ==
                  (descent_bends_down(simulation, from[0], from[1]) > 0));
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
        simulation_set(simulation, OPTION_SLOT(filter),
                       i % 2 ? FILTER_CLAMP : FILTER_ON_DEMAND);
        CHECK_STATUS(run_to_end(simulation, 100), STATUS_OK);
        check_path(simulation);
        CHECK(!descent_bends_down(simulation, x[0], x[1]));
        free_all_begun();
    }
    CHECK(uphill > 5 && hollow > 100);
}

TESTS(NULL, NULL)
