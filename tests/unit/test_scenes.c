/* The table of scenes, and the small ones among them, held to formulas written
 * here once more (what pages say of them: claims.txt); those of contact,
 * inelasticity and fracture from outside: rows of options, starts that are
 * refused, what is held fast, and what changes while they run.
 */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/damping.h"
#include "model/self_contact.h"

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

/* E decreases from record to record by what each says, and on demand the
 * Hessian is projected where it is not positive definite. */
static void check_path(const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    bool on_demand = simulation->options.projection == PROJECTION_ON_DEMAND;
    for (int i = 0; i < descent->count; i++) {
        const NewtonRecord *record = &descent->record[i];
        const double *from = record->from, *to = record->to;
        CHECK(record->slope < 0 && record->change < 0 && record->alpha > 0);
        double E =
            descent_evaluate(simulation, PROJECTION_NONE, from[0], from[1])
                .value;
        CHECK_NEAR(
            descent_evaluate(simulation, PROJECTION_NONE, to[0], to[1]).value -
                E,
            record->change, 1e-12 * (1 + fabs(E)));
        if (on_demand)
            CHECK((record->projected > 0) ==
                  (descent_hessian_index(simulation, from[0], from[1]) > 0));
    }
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
        bool convex = !descent_hessian_index(simulation, at[0], at[1]);
        simulation_set(simulation, OPTION_SLOT(projection), PROJECTION_NONE);
        uphill += simulation->descent.slope > 0;
        hollow += convex;
        CHECK(!convex || simulation->descent.slope < 0);
        simulation_set(simulation, OPTION_SLOT(projection),
                       i % 2 ? PROJECTION_CLAMP : PROJECTION_ON_DEMAND);
        CHECK_OK(run_to_end(simulation, 100));
        check_path(simulation);
        CHECK(!descent_hessian_index(simulation, x[0], x[1]));
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
    CHECK(exhibit_list_handles(scene, at) == 2);
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
        mass_find_exact(one, 0, now);
        mass_find_exact(one, 0.5 * M_PI, later);
        CHECK_SAME_BITS(now, x, 2);
        for (int i = 0; i < 2; i++)
            CHECK_NEAR(later[i], v[i], 1e-15);
        make_steps(one, 1);
        CHECK_OK(simulation_set(one, OPTION_SLOT(integrator),
                                integrator_method("symplectic-euler") -
                                    integrator_methods));
    }
}

/* ---- two unknowns ------------------------------------------------------- */

/* What is switched off is not minimised either: the part that is left falls in
 * each update, to its own minimum, with every method. */
TEST(landscape_minimises_what_it_shows)
{
    static const char *const lines[] = {
        "landscape --start 0.2,-0.3 --projection abs",
        "landscape --start 0.6,0.9 --projection on-demand",
        "landscape --start 0.6,0.9 --projection none --line-search none"};
    for (int i = 0; i < 6; i++) {
        Simulation *scene = simulate("%s", lines[i / 2]);
        const Descent *descent = &scene->descent;
        bool off = i % 2;
        make_steps(scene, 1);
        exhibit_flip(scene, off);
        unsigned part = off ? PART_INERTIA : PART_ELASTICITY;
        CHECK(scene->exhibit.switches == part && descent->count == 0);
        while (!scene->done) {
            double before = descent->value;
            make_steps(scene, 1);
            CHECK(descent->value < before);
        }
        CHECK(!off || descent->count == 1);
        CHECK_AT_MOST(descent->residual, scene->options.tolerance);
        /* p <= h 1e-6, twice: E <= 10 p^2 */
        const double *at = descent->point;
        CHECK_AT_MOST(landscape_evaluate_parts(scene, part, at[0], at[1]),
                      1e-12);
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
    CHECK_OK(envelope_run_cell(map, column, row));
    return &map->exhibit.map.cell[row][column];
}

/* A cell is the run that its command line makes. */
TEST(envelope_cells_are_runs)
{
    static const int cells[6][2] = {{13, 11}, {20, 8}, {24, 21},
                                    {0, 0},   {3, 20}, {4, 21}};
    Simulation *map = simulate("envelope --tolerance 1e-10");
    int refused = 0;
    for (int i = 0; i < 6; i++) {
        int column = cells[i][0], row = cells[i][1];
        const EnvelopeCell *cell = visit(map, column, row);
        Status worst = STATUS_OK;
        Simulation *run =
            simulate("square --segments %d --stretch %.17g --timestep %.17g "
                     "--stiffness %.17g --tolerance 1e-10",
                     (int)map->options.segments, map->options.stretch,
                     envelope_timestep(column), envelope_stiffness(row));
        for (int step = 0; step < ENVELOPE_STEPS; step++) {
            Status status = simulation_step(run);
            worst = status ? status : worst;
        }
        CHECK(cell->known);
        CHECK_STATUS(cell->worst, worst);
        refused += worst != STATUS_OK;
        CHECK(cell->updates == simulation_sum_counters(run).iterations);
        CHECK_SAME_BITS(map->run[0].x, run->run[0].x, 2 * run->system.nodes);
    }
    CHECK(refused >= 1); /* cells that did not converge are compared, too */
}

/* ---- predict, then show ------------------------------------------------- */

TEST(predictions_are_compared)
{
    Simulation *scene = simulate("arrows --integrator forward-euler");
    const Prediction *guess = &scene->prediction;
    scene_predict(scene, 1.3, 0.9);        /* the step leads to (1, 0.5) */
    for (int step = 0; step < 2; step++) { /* the guess stays beside its step */
        CHECK(guess->made);
        CHECK_NEAR(guess->end[1], 0.5, 1e-15);
        CHECK_NEAR(guess->distance, 0.5, 1e-15);
        make_steps(scene, 1);
    }
    CHECK(!guess->made);
    /* along x alone: from 2 to 2 - sinh(4)/2 */
    scene = simulate("overshoot");
    scene_predict(scene, -11, 123);
    CHECK_NEAR(scene->prediction.distance, 0.644958598563875, 1e-12);
    exhibit_drag(scene, 0, 1.5, NAN); /* x alone counts */
    exhibit_drag(scene, 0, NAN, 1);
    CHECK(scene->descent.point[0] == 1.5 && scene->steps == 0);
    scene = simulate("square"); /* no single point */
    scene_predict(scene, 1, 1);
    CHECK(!scene->prediction.made);
}

/* A scene is a row of defaults: the square with the same options makes the
 * same bits, with normals of any length.  And a number that is set at the
 * beginning of a run is the option: long enough to meet what needs it; with
 * damping that is taken back it is as if there never was any. */
TEST(scenes_are_rows_of_options)
{
    static const struct {
        const char *one, *other;
        int steps;
        double friction, damping; /* set in the other, if it is > 0 */
    } rows[] = {
        {"hang",
         "square --segments 12 --stiffness 1e4 --stretch 1 --timestep 0.01 "
         "--tolerance 1e-3 --gravity 9.81 --pin top-corners",
         70, 0, 0},
        {"drop",
         "square --segments 16 --stretch 1 --timestep 0.005 --tolerance 1e-4 "
         "--gravity 9.81 --cells on --turn 25 --at -0.3,0.75 --velocity 0.9,-1 "
         "--friction 0.3 --ground 0,2,0,-0.5 --ground 1,0,-1.1,0 --ground "
         "-0.5,0,1.1,0",
         70, 0, 0},
        {"rub --friction 0.4", "rub --friction 0", 20, 0.4, 0},
        {"slope --friction 0.2", "slope", 20, 0.2, 0},
        {"drop --friction 0.4 --segments 8", "drop --friction 0 --segments 8",
         100, 0.4, 0},
        {"dent --damping 0.003 --segments 8", "dent --segments 8", 90, 0,
         0.003},
        {"--damping 0.003", "--damping 1", 20, 0, 0.003},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Simulation *one = simulate("%s", rows[i].one);
        Simulation *other = simulate("%s", rows[i].other);
        if (rows[i].friction > 0)
            CHECK(!simulation_set(other, OPTION_SLOT(friction),
                                  rows[i].friction));
        for (int k = 0; k < 2; k++)
            CHECK(!simulation_set(other, OPTION_SLOT(damping),
                                  k ? rows[i].damping : 0.1));
        CHECK(!system_term_data(&other->system, &damping) ==
              !(rows[i].damping > 0));
        make_steps(one, rows[i].steps);
        make_steps(other, rows[i].steps);
        CHECK(state_hash(one, 1) == state_hash(other, 1));
        CHECK(energy_now(one, 0, "damping") == energy_now(other, 0, "damping"));
        CHECK((energy_now(one, 0, "damping") > 0) == (rows[i].damping > 0));
    }
}

/* Of a run that goes on only what may be moved counts: not where a ball began,
 * nor a cell that is torn. */
TEST(obstacles_have_room_in_what_was_torn)
{
    char message[256];
    Simulation *beam = simulate("bend --segments 16");
    beam->run[0].x[0] = 0;
    beam->run[0].x[1] = 0.42;
    CHECK_OK(simulation_has_room(beam, &beam->options, MESSAGE(message)));
    beam->run[0].x[1] = -1;
    CHECK_STATUS(simulation_has_room(beam, &beam->options, MESSAGE(message)),
                 STATUS_INVALID_INPUT);
}

/* Pins are no way out: a ceiling ends at nodes that are held, and pins that are
 * drawn against a wall stop before it; the steps say so.  What a ceiling has
 * pressed flat takes few updates: 706, and 2642 with parts as short as a
 * millionth of the way. */
TEST(pins_and_walls_stop_each_other)
{
    static const struct {
        const char *line;
        int blocked, updates; /* more than this, less than that */
    } rows[] = {
        {"squeeze --segments 4 --pin top", 15, 100},
        {"tear --segments 4 --ground 1,0,-0.52,0 --timestep 0.01", 15, 200},
        {"return --segments 4 --body 0,0 --body 0,1.1 --ground 0,1,0,-0.6 "
         "--ceiling 1.7,-50,-5",
         5, 1300}};
    for (int i = 0; i < 3; i++) {
        Simulation *scene = simulate("%s", rows[i].line);
        double gap = INFINITY;
        int blocked = 0;
        for (int step = 0; step < 30; step++) {
            Status status = simulation_step(scene);
            CHECK(status == STATUS_OK || status == STATUS_BLOCKED);
            blocked += status == STATUS_BLOCKED;
            gap = fmin(gap, smallest_gap(&scene->system, scene->run[0].x));
        }
        CHECK(gap > 0 && gap < 1e-3);
        CHECK(blocked > rows[i].blocked && blocked < 30);
        CHECK(scene->run[0].newton->counters.iterations < rows[i].updates);
    }
}

/* Two bodies at rest, 0.2 m apart, have no entries for each other.  One that is
 * inside a step as near as half the barrier's width gets them there, once, and
 * the direction solves Newton's equation: 1e-10, rounding of a factor. */
TEST(pairs_that_come_up_inside_a_step_have_entries)
{
    Simulation *scene = simulate("return --segments 2 --body 0,0 --body 0,1.2");
    const System *system = &scene->system;
    const SelfContact *self = self_contact_of(system);
    Newton *newton = scene->run[0].newton;
    double u[36] = {0}, Hp[36];
    bool grown;
    CHECK(system->nodes == 18);
    make_steps(scene, 1);
    CHECK(self->pairs == 0);
    CHECK_OK(incremental_potential_grow(&newton->at, &grown));
    CHECK(!grown);
    for (int i = 9; i < 18; i++)
        u[2 * i + 1] = -0.2 + 0.5 * self->d_hat;
    newton->settings.max_iterations = 1;
    newton_start(newton, scene->run[0].x, u, 1e-4, 1e-30);
    CHECK_STATUS(newton_minimise(newton), STATUS_ITERATION_LIMIT);
    Iterate before = newton->at; /* residual of the last direction */
    before.u = newton->u_trial;
    before.x = newton->x_trial;
    incremental_potential_gradient(&before.E, before.u, before.x, before.g);
    CHECK(self->pairs > 0);
    incremental_potential_product(&before, newton->search.projection, before.p,
                                  Hp);
    for (int i = 0; i < 36; i++)
        CHECK_NEAR(Hp[i], -newton->at.g[i], 1e-10);
    CHECK_OK(incremental_potential_grow(&newton->at, &grown));
    CHECK(!grown);
}

/* Pinned all over, one is moved down on the other, 0.2 m below it. */
TEST(a_body_that_is_pushed_stops_at_another)
{
    Simulation *scene = simulate("--segments 2 --body 0,0 --body 0.1,1.2 "
                                 "--pin all --timestep 0.01");
    System *system = &scene->system;
    const double *x = scene->run[0].x;
    system->pin_v = calloc(2 * (size_t)system->nodes, sizeof *system->pin_v);
    CHECK(system->pin_v != NULL);
    for (int i = 9; i < 18; i++)
        system->pin_v[2 * i + 1] = -1;
    for (int step = 1; step <= 30; step++) {
        CHECK_STATUS(simulation_step(scene),
                     step < 20 ? STATUS_OK : STATUS_BLOCKED);
        CHECK(exact_crossings(system, x) == 0);
    }
    CHECK(x[2 * 9 + 1] > 0.5 && x[2 * 9 + 1] < 0.5 + 1e-3);
}

/* Neither into another body nor through all of it. */
TEST(no_node_is_placed_in_another_body)
{
    Simulation *scene = simulate("--segments 4 --body 0,0 --body 0,1.1");
    for (int i = 0; i < 2; i++)
        CHECK_STATUS(simulation_place(scene, 25, 0, -2 * i, true),
                     STATUS_INVALID_INPUT);
    CHECK_OK(simulation_place(scene, 25, -0.5, 0.55, true));
    CHECK(exact_crossings(&scene->system, scene->run[0].x) == 0);
}

/* The sides of the sheet are drawn apart; a node that a hand pins stays. */
TEST(a_pin_set_by_hand_stays)
{
    Simulation *scene = simulate("tear --segments 6");
    const double *x = scene->run[0].x;
    double left = x[0], at[2] = {x[2 * 17], x[2 * 17 + 1]};
    CHECK_OK(simulation_pin(scene, 17, true));
    make_steps(scene, 10);
    CHECK_SAME_BITS(scene->run[0].x + 2 * 17, at, 2);
    CHECK_NEAR(scene->run[0].x[0], left - 0.2 * 10 * 0.002, 1e-14);
}

/* A beam of another size has the cells of the one that is shown; the blocks of
 * the slope begin as high above their grounds, whatever their size.  1e-15:
 * rounding of coordinates of size 1. */
TEST(scenes_begin_alike_at_every_size)
{
    static const char *const beams[] = {"bend", "bend --side 0.01",
                                        "bend --side 1"};
    for (int i = 0; i < 3; i++) {
        const SquareMesh *mesh = &simulate("%s", beams[i])->mesh;
        CHECK(mesh->segments == 32 && mesh->rows == 6);
    }
    const Simulation *slope = simulate("slope --side 0.3");
    const TimeIntegrator *run = slope->run;
    double gap = smallest_gap(run[0].system, run[0].x);
    CHECK(gap > 0 && slope->runs == 3);
    for (int r = 1; r < 3; r++) {
        CHECK_NEAR(smallest_gap(run[r].system, run[r].x), gap, 1e-15);
        CHECK_NEAR(run[0].x[1] - run[r].x[1], r * 2.6 * 0.3, 1e-15);
    }
}

/* ---- the ledger while hands are on ------------------------------------- */

/* What one does to a run between two steps. */
static Status meddle(Simulation *scene, int deed)
{
    const double *x = scene->run[0].x + 2 * 7;
    const Options *now = &scene->options;
    switch (deed % 8) {
    case 0:
        return simulation_hold(scene, 7, x[0], x[1]);
    case 1:
        return simulation_hold(scene, 7, x[0] + 0.1, x[1] - 0.07);
    case 2:
        return simulation_hold(scene, -1, 0, 0);
    case 3:
    case 5:
        return simulation_pin(scene, 9, deed % 8 == 3);
    case 4:
        return simulation_set(scene, OPTION_SLOT(timestep),
                              0.4 * now->timestep);
    default:
        simulation_set(scene, OPTION_SLOT(stiffness),
                       now->stiffness * (deed % 2 ? 0.5 : 3));
        simulation_set(scene, OPTION_SLOT(friction),
                       now->friction * (deed % 2 ? 0.5 : 2));
        return simulation_set(scene, OPTION_SLOT(damping),
                              deed % 2 ? 0.01 : 0.02);
    }
}

static int broken_springs(const Simulation *scene)
{
    int count = 0;
    for (int s = 0; s < scene->system.springs; s++)
        count += spring_is_broken(&scene->system, s);
    return count;
}

/* A hand, a pin, another time step, stiffness, mu or eta is booked as work:
 * nothing that is lost changes with it, in the steps after it all that is lost
 * grows, and no broken spring heals. */
TEST(what_hands_do_is_work)
{
    static const char *const lines[] = {"drop --segments 4 --at -0.3,0.4",
                                        "slope --segments 3",
                                        "squeeze --segments 4",
                                        "dent --segments 4 --at 0,0.2",
                                        "tear --segments 6 --timestep 0.01",
                                        "bend --segments 16"};
    static const char *const lost[] = {"plastic", "fracture", "friction",
                                       "damping"};
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        Simulation *scene = simulate("%s", lines[i]);
        simulation_set(scene, OPTION_SLOT(tolerance), 1e-8);
        int blocked = 0; /* the ceiling, by the node that is pinned */
        for (int n = 0; n < 24 * 5; n++) {
            Energies before = simulation_energies(scene, 0);
            int broken = broken_springs(scene);
            Status status =
                n % 5 ? simulation_step(scene) : meddle(scene, n / 5);
            Energies after = simulation_energies(scene, 0);
            double size = fabs(before.total) + fabs(after.total) +
                          fabs(after.work) + fabs(before.dissipated) + 1;
            blocked += status == STATUS_BLOCKED;
            CHECK(broken_springs(scene) >= broken);
            CHECK(status == STATUS_OK || (i == 2 && status == STATUS_BLOCKED));
            for (int k = 0; k < 4; k++) {
                double had = energies_of(&before, lost[k]);
                double has = energies_of(&after, lost[k]);
                CHECK(n % 5 ? has >= had : has == had);
                size += has;
            }
            if (n % 5 == 0)
                CHECK_NEAR(after.dissipated, before.dissipated, 1e-12 * size);
        }
        CHECK(i == 2 || blocked == 0);
        CHECK(fabs(simulation_energies(scene, 0).work) > 1e-3);
    }
}

TESTS(NULL, NULL)
