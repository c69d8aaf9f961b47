/* test_scenes.c - the table of scenes, the landscape and the envelope against
 * formulas written here, contact between bodies, and the ledger while hands
 * change a run (claims of pages: claims.txt) */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/self_contact.h"

/* Makes at most `limit` steps, to the scene's end. Returns the last status. */
static Status run_to_end(Simulation *simulation, int limit)
{
    Status status = simulation->status;
    for (int i = 0; i < limit && !simulation->is_over; i++)
        status = simulation_step(simulation);
    CHECK(simulation->is_over);
    return status;
}

/* ---- the table ---------------------------------------------------------- */

/* Each scene has a name, a short sentence, valid options, a first step. */
TEST(scenes_are_complete)
{
    for (const Scene *scene = scenes; scene->name; scene++) {
        char words[512], *rest = NULL;
        CHECK(scene_find(scene->name) == scene);
        CHECK(strlen(scene->description) > 20 &&
              strlen(scene->description) <= 60);
        CHECK(scene->picture < PICTURE_COUNT);
        snprintf(words, sizeof words, "%s",
                 scene->default_options ? scene->default_options : "");
        for (char *word = strtok_r(words, " ", &rest); word;
             word = strtok_r(NULL, " ", &rest))
            if (strncmp(word, "--", 2) == 0)
                CHECK(option_find(word + 2)->needs_any_trait & scene->traits);
        Simulation *simulation = simulate("%s", scene->name);
        CHECK(simulation->scene == scene && simulation->runs >= 1);
        CHECK(!simulation->is_over && simulation->steps == 0);
        simulation_step(simulation);
        CHECK(simulation->steps == 1);
        double time = simulation_get_time(simulation);
        CHECK((time > 0) == ((scene->traits & HAS_TIME) != 0));
    }
    CHECK(!scene_find("") && !scene_find("squar") && !scene_find("0"));
    CHECK(scene_find("1") == scenes && scene_find("2") == scenes + 1);
}

/* ---- landscape ---------------------------------------------------------- */

/* Checks that E decreases by the recorded changes, and that projection on
 * demand acts where the Hessian is not positive definite. */
static void check_descent_path(const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    bool on_demand = simulation->options.projection == PROJECTION_ON_DEMAND;
    for (int i = 0; i < descent->record_count; i++) {
        const NewtonRecord *record = &descent->record[i];
        const double *from = record->x_before, *to = record->x_after;
        CHECK(record->slope < 0 && record->energy_change < 0 &&
              record->alpha > 0);
        double E =
            descent_evaluate(simulation, PROJECTION_NONE, from[0], from[1])
                .energy;
        CHECK_NEAR(
            descent_evaluate(simulation, PROJECTION_NONE, to[0], to[1]).energy -
                E,
            record->energy_change, 1e-12 * (1 + fabs(E)));
        if (on_demand)
            CHECK((record->projected_blocks > 0) ==
                  (descent_classify_hessian(simulation, from[0], from[1]) > 0));
    }
}

/* From a grid of starts the clamped direction leads down to a minimum. The
 * unprojected one is downhill where E is convex, and uphill at other starts. */
TEST(landscape_is_downhill_from_everywhere)
{
    int uphill = 0, hollow = 0;
    for (int i = 0; i < 17 * 17; i++) {
        double at[2] = {0.2 * (i / 17 - 8), 0.2 * (i % 17 - 8)};
        Simulation *simulation =
            simulate("landscape --start %g,%g", at[0], at[1]);
        const double *x = simulation->run[0].x;
        CHECK(simulation->descent.slope < 0);
        bool convex = !descent_classify_hessian(simulation, at[0], at[1]);
        change_option(simulation, OPTION_SLOT(projection), PROJECTION_NONE);
        uphill += simulation->descent.slope > 0;
        hollow += convex;
        CHECK(!convex || simulation->descent.slope < 0);
        change_option(simulation, OPTION_SLOT(projection),
                      i % 2 ? PROJECTION_CLAMP : PROJECTION_ON_DEMAND);
        CHECK_OK(run_to_end(simulation, 100));
        check_descent_path(simulation);
        CHECK(!descent_classify_hessian(simulation, x[0], x[1]));
        free_simulations();
    }
    CHECK(uphill > 5 && hollow > 100);
}

/* ---- the envelope ------------------------------------------------------- */

static const ConvergenceCell *run_envelope_cell(Simulation *map, int column,
                                                int row)
{
    CHECK_OK(envelope_run_cell(map, column, row));
    return &map->exhibit.envelope.cell[row][column];
}

TEST(envelope_cells_are_runs)
{
    static const int cells[6][2] = {{13, 11}, {20, 8}, {24, 21},
                                    {0, 0},   {3, 20}, {4, 21}};
    Simulation *map = simulate("envelope --tolerance 1e-10");
    int refused = 0;
    for (int i = 0; i < 6; i++) {
        int column = cells[i][0], row = cells[i][1];
        const ConvergenceCell *cell = run_envelope_cell(map, column, row);
        Status worst = STATUS_OK;
        Simulation *run = simulate(
            "square --segments %d --stretch %.17g --timestep %.17g "
            "--stiffness %.17g --tolerance 1e-10",
            (int)map->options.segments, map->options.stretch,
            envelope_get_timestep(column), envelope_get_stiffness(row));
        for (int step = 0; step < ENVELOPE_STEPS; step++) {
            Status status = simulation_step(run);
            worst = status ? status : worst;
        }
        CHECK(cell->is_known);
        CHECK_STATUS(cell->run_status, worst);
        refused += worst != STATUS_OK;
        CHECK(cell->updates == simulation_sum_newton_counters(run).updates);
        CHECK_SAME_BITS(map->run[0].x, run->run[0].x, 2 * run->system.nodes);
    }
    CHECK(refused >= 1); /* at least one cell did not converge */
}

/* The check that obstacles do not overlap the body uses the present place of a
 * ball, not its start, and leaves out torn cells. */
TEST(obstacles_may_stand_where_cells_were_torn)
{
    char message[256];
    Simulation *beam = simulate("bend --segments 16");
    beam->run[0].x[0] = 0;
    beam->run[0].x[1] = 0.42;
    CHECK_OK(
        simulation_check_clearance(beam, &beam->options, MESSAGE(message)));
    beam->run[0].x[1] = -1;
    CHECK_STATUS(
        simulation_check_clearance(beam, &beam->options, MESSAGE(message)),
        STATUS_INVALID_INPUT);
}

/* Two bodies at rest, 0.2 m apart, share no entries of the Hessian. A body that
 * comes within half of d_hat inside a step adds entries once, and p solves
 * Newton's equation up to the rounding of a factor, 1e-10. */
TEST(pairs_that_come_up_inside_a_step_have_entries)
{
    Simulation *scene = simulate("return --segments 2 --body 0,0 --body 0,1.2");
    const System *system = &scene->system;
    const SelfContact *self = get_self_contact(system);
    Newton *newton = scene->run[0].newton;
    double u[36] = {0}, Hp[36];
    bool grown;
    CHECK(system->nodes == 18);
    make_steps(scene, 1);
    CHECK(self->pair_count == 0);
    CHECK_OK(incremental_potential_extend_pattern(&newton->iterate, &grown));
    CHECK(!grown);
    for (int i = 9; i < 18; i++)
        u[2 * i + 1] = -0.2 + 0.5 * self->d_hat;
    newton->settings.max_iterations = 1;
    newton_start(newton, scene->run[0].x, u, 1e-4, 1e-30);
    CHECK_STATUS(newton_minimise(newton), STATUS_ITERATION_LIMIT);
    Iterate before = newton->iterate; /* where p was computed */
    before.u = newton->u_trial;
    before.x = newton->x_trial;
    incremental_potential_gradient(&before.E, before.u, before.x, before.g);
    CHECK(self->pair_count > 0);
    incremental_potential_apply_hessian(
        &before, newton->factored_hessian.projection, before.p, Hp);
    for (int i = 0; i < 36; i++)
        CHECK_NEAR(Hp[i], -newton->iterate.g[i], 1e-10);
    CHECK_OK(incremental_potential_extend_pattern(&newton->iterate, &grown));
    CHECK(!grown);
}

/* A body of pinned nodes moves down and stops at another, 0.2 m below. */
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
        CHECK(edge_crossings(system, x) == 0);
    }
    CHECK(x[2 * 9 + 1] > 0.5 && x[2 * 9 + 1] < 0.5 + 1e-3);
}

/* ---- the ledger while hands are on ------------------------------------- */

static Status make_user_change(Simulation *scene, int deed)
{
    const double *x = scene->run[0].x + 2 * 7;
    const Options *now = &scene->options;
    switch (deed % 8) {
    case 0:
        return hold_node(scene, 7, x[0], x[1]);
    case 1:
        return hold_node(scene, 7, x[0] + 0.1, x[1] - 0.07);
    case 2:
        return hold_node(scene, -1, 0, 0);
    case 3:
    case 5:
        return pin_node(scene, 9, deed % 8 == 3);
    case 4:
        return change_option(scene, OPTION_SLOT(timestep), 0.4 * now->timestep);
    default:
        change_option(scene, OPTION_SLOT(stiffness),
                      now->stiffness * (deed % 2 ? 0.5 : 3));
        change_option(scene, OPTION_SLOT(friction),
                      now->friction * (deed % 2 ? 0.5 : 2));
        return change_option(scene, OPTION_SLOT(damping),
                             deed % 2 ? 0.01 : 0.02);
    }
}

/* A hand, a pin, another time step, stiffness, mu or eta is booked as work and
 * changes no loss. Later losses only grow, and no broken spring heals. */
TEST(changes_by_hand_are_booked_as_work)
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
        change_option(scene, OPTION_SLOT(tolerance), 1e-8);
        int blocked = 0; /* the pinned node blocks the ceiling */
        for (int n = 0; n < 24 * 5; n++) {
            Energies before = simulation_get_energies(scene, 0);
            int broken = count_broken_springs(scene);
            Status status =
                n % 5 ? simulation_step(scene) : make_user_change(scene, n / 5);
            Energies after = simulation_get_energies(scene, 0);
            double size = fabs(before.total) + fabs(after.total) +
                          fabs(after.work) + fabs(before.dissipated) + 1;
            blocked += status == STATUS_BLOCKED;
            CHECK(count_broken_springs(scene) >= broken);
            CHECK(status == STATUS_OK || (i == 2 && status == STATUS_BLOCKED));
            for (int k = 0; k < 4; k++) {
                double had = get_energy(&before, lost[k]);
                double has = get_energy(&after, lost[k]);
                CHECK(n % 5 ? has >= had : has == had);
                size += has;
            }
            if (n % 5 == 0)
                CHECK_NEAR(after.dissipated, before.dissipated, 1e-12 * size);
        }
        CHECK(i == 2 || blocked == 0);
        CHECK(fabs(simulation_get_energies(scene, 0).work) > 1e-3);
    }
}

TESTS(NULL, NULL)
