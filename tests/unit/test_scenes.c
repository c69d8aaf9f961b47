/* The table of scenes, and the small ones among them, held to formulas written
 * here once more.  (What pages say of them is test_pages' matter.)
 */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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

/* ---- landscape ---------------------------------------------------------- */

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
        double E = descent_at(simulation, FILTER_NONE, from[0], from[1]).value;
        CHECK_NEAR(descent_at(simulation, FILTER_NONE, to[0], to[1]).value - E,
                   record->change, 1e-12 * (1 + fabs(E)));
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

/* ---- one mass ----------------------------------------------------------- */

/* The mass keeps its velocity and the tip its place where the other is dragged;
 * the exact path is the ellipse from there, also after another method is
 * chosen.  All runs follow. */
TEST(mass_is_dragged)
{
    Simulation *scene = simulate("arrows"), *one;
    double at[SCENE_MAX_HANDLES][2], now[2], later[2];
    make_steps(scene, 1);
    exhibit_drag(scene, 0, 0.25, -0.5);
    exhibit_drag(scene, 1, 0.25 + 2, -0.5 + 3);
    CHECK(exhibit_handles(scene, at) == 2);
    CHECK(at[0][0] == 0.25 && at[1][1] == 2.5);
    const double x[2] = {0.25, -0.5}, v[2] = {2, 3};
    for (int run = 0; run < 3; run++) {
        CHECK_SAME_BITS(scene->run[run].x, x, 2);
        CHECK_SAME_BITS(scene->run[run].v, v, 2);
    }
    one = simulate("arrows --integrator forward-euler");
    exhibit_drag(one, 0, 0.25, -0.5);
    exhibit_drag(one, 1, 0.25 + 2, -0.5 + 3);
    for (int changed = 0; changed < 2; changed++) {
        mass_exact(one, 0, now);
        mass_exact(one, 0.5 * M_PI, later);
        CHECK_SAME_BITS(now, x, 2);
        for (int i = 0; i < 2; i++)
            CHECK_NEAR(later[i], v[i], 1e-15);
        make_steps(one, 1);
        CHECK_STATUS(simulation_set(one, OPTION_SLOT(integrator),
                                    integrator_method("symplectic-euler") -
                                        integrator_methods),
                     STATUS_OK);
    }
}

/* ---- two unknowns ------------------------------------------------------- */

/* What is switched off is not minimised either: the part that is left falls in
 * each update, to its own minimum, with every method. */
TEST(landscape_minimises_what_it_shows)
{
    static const char *const lines[] = {
        "landscape --start 0.6,0.9", "landscape --start 0.2,-0.3 --filter abs",
        "landscape --start 0.6,0.9 --filter on-demand",
        "landscape --start 0.6,0.9 --filter none",
        "landscape --start 0.6,0.9 --filter none --line-search none"};
    for (int i = 0; i < 10; i++) {
        Simulation *scene = simulate("%s", lines[i / 2]);
        const Descent *descent = &scene->descent;
        bool off = i % 2;
        make_steps(scene, 1);
        exhibit_flip(scene, off);
        unsigned part = off ? PART_INERTIA : PART_ELASTICITY;
        CHECK(scene->exhibit.parts == part && descent->count == 0);
        while (!scene->done) {
            double before = descent->value;
            make_steps(scene, 1);
            CHECK(descent->value < before);
        }
        CHECK(!off || descent->count == 1);
        CHECK_AT_MOST(descent->residual, scene->options.tolerance);
        /* p <= h 1e-6, twice: E <= 10 p^2 */
        const double *at = descent->point;
        CHECK_AT_MOST(landscape_part_value(scene, part, at[0], at[1]), 1e-12);
    }
    /* both springs along x: elasticity alone has no H^-1 */
    Simulation *flat = simulate("landscape --start 0.3,0");
    exhibit_flip(flat, 0);
    CHECK_STATUS(flat->status, STATUS_SINGULAR);
    CHECK(flat->done && flat->descent.direction[0] == 0);
}

/* ---- the envelope ------------------------------------------------------- */

static const EnvelopeCell *visit(Simulation *map, int column, int row)
{
    CHECK_STATUS(envelope_visit(map, column, row), STATUS_OK);
    return &map->exhibit.map.cell[row][column];
}

/* A cell is the run that its command line makes. */
TEST(envelope_cells_are_runs)
{
    static const int cells[6][2] = {{13, 11}, {20, 8},  {24, 21},
                                    {0, 0},   {22, 21}, {24, 20}};
    Simulation *map = simulate("envelope");
    int refused = 0;
    for (int i = 0; i < 6; i++) {
        int column = cells[i][0], row = cells[i][1];
        const EnvelopeCell *cell = visit(map, column, row);
        Status worst = STATUS_OK;
        Simulation *run =
            simulate("square --segments %d --stretch %.17g --timestep %.17g "
                     "--stiffness %.17g",
                     (int)map->options.segments, map->options.stretch,
                     envelope_timestep(column), envelope_stiffness(row));
        for (int step = 0; step < ENVELOPE_STEPS; step++) {
            Status status = simulation_step(run);
            worst = status ? status : worst;
        }
        CHECK(cell->known);
        CHECK_STATUS(cell->worst, worst);
        refused += worst != STATUS_OK;
        CHECK(cell->updates == simulation_counters(run).iterations);
        CHECK_SAME_BITS(map->run[0].x, run->run[0].x, 2 * run->system.nodes);
    }
    CHECK(refused >= 1); /* such cells are compared too */
}

/* ---- predict, then show ------------------------------------------------- */

TEST(predictions_are_compared)
{
    Simulation *scene = simulate("arrows --integrator forward-euler");
    const Prediction *guess = &scene->prediction;
    simulation_predict(scene, 1.3, 0.9); /* it will be (1, 0.5) */
    CHECK(guess->made && !guess->shown);
    make_steps(scene, 1);
    CHECK(guess->shown);
    CHECK_NEAR(guess->distance, 0.5, 1e-15);
    make_steps(scene, 1);
    CHECK(!guess->made && !guess->shown);
    /* along x alone: from 2 to 2 - sinh(4)/2 */
    scene = simulate("overshoot");
    simulation_predict(scene, -11, 123);
    make_steps(scene, 1);
    CHECK_NEAR(scene->prediction.distance, 0.644958598563875, 1e-12);
    exhibit_drag(scene, 0, 1.5, NAN); /* x alone counts */
    exhibit_drag(scene, 0, NAN, 1);
    CHECK(scene->descent.point[0] == 1.5 && scene->steps == 0);
    scene = simulate("square"); /* no single point */
    simulation_predict(scene, 1, 1);
    CHECK(!scene->prediction.made);
}

TESTS(NULL, NULL)
