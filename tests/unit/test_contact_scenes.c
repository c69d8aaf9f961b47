/* The scenes of contact, inelasticity and fracture from outside: rows of
 * options, starts that are refused, what is held fast, and the forces that
 * their pictures show.
 */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/contact.h"
#include "model/friction.h"
#include "picture/show.h"
#include "picture/square_pen.h"
#include "scenes/scene.h"
#include "scenes/state.h"

/* A scene is a row of defaults: the square with the same options makes the
 * same bits, with normals of any length. */
TEST(the_square_with_options_is_the_scene)
{
    static const char *const lines[][2] = {
        {"hang", "square --segments 12 --stiffness 1e4 --stretch 1 --timestep "
                 "0.01 --tolerance 1e-3 --gravity 9.81 --pin top-corners"},
        {"drop",
         "square --segments 16 --stretch 1 --timestep 0.005 --tolerance 1e-4 "
         "--gravity 9.81 --cells on --turn 25 --at -0.3,0.75 --velocity 0.9,-1 "
         "--friction 0.3 --ground 0,2,0,-0.5 --ground 1,0,-1.1,0 --ground "
         "-0.5,0,1.1,0"},
        {"dent",
         "square --segments 16 --stiffness 2e5 --stretch 1 --timestep 0.004 "
         "--tolerance 1e-4 --gravity 9.81 --cells on --at 0,0.62 --velocity "
         "0.02,-2 --friction 0.3 --yield 0.04 --hardening 0.1 --ball "
         "0,-0.75,0.35 --ground 0,1,0,-1.15"},
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        Simulation run[2];
        for (int k = 0; k < 2; k++) {
            simulation_from_line(lines[i][k], NULL, NULL, &run[k]);
            for (int step = 0; step < 70; step++)
                CHECK_STATUS(simulation_step(&run[k]), STATUS_OK);
        }
        CHECK(state_hash(&run[0], 1) == state_hash(&run[1], 1));
        CHECK_SAME_BITS(run[0].run[0].x, run[1].run[0].x,
                        2 * run[0].system.nodes);
        simulation_free(&run[0]);
        simulation_free(&run[1]);
    }
}

/* The words of options_parse about a line; "" where it is accepted. */
static void message_of(const char *line, char message[512])
{
    char copy[256], *words[32] = {"elasto"};
    int count = 1;
    Options options;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word = strtok(copy, " "); word; word = strtok(NULL, " "))
        words[count++] = word;
    message[0] = '\0';
    Status status = options_parse(count, words, &options, message, 512);
    CHECK_STATUS(status, message[0] ? STATUS_INVALID_INPUT : STATUS_OK);
}

/* Who begins in an obstacle is told which node, and how deep. */
TEST(starts_that_touch_are_refused)
{
    static const struct {
        const char *line, *message;
    } cases[] = {
        {"square --stretch 1 --ground 0,1,0,-0.4",
         "--ground 0,1,0,-0.4: node 0 would begin at a distance of -0.1 m; it "
         "must be above 0"},
        {"square --stretch 1 --ground 0,2,0,-0.5", /* exactly on it */
         "--ground 0,2,0,-0.5: node 0 would begin at a distance of 0 m; it "
         "must be above 0"},
        {"square --stretch 1 --ground 0,1,0,-0.6 --ball 0.75,0.5,0.3",
         "--ball 0.75,0.5,0.3: node 24 would begin at a distance of -0.05 m; "
         "it must be above 0"},
        {"square --stretch 1 --ball 0.125,0.125,0.05", ""}, /* in a cell */
        {"square --stretch 1 --ground 0,0,1,0",
         "--ground 0,0,1,0: the normal is 0,0; it must point somewhere"},
        {"square --stretch 1 --ball 3,0,0",
         "--ball 3,0,0: the radius must be above 0"},
        {"square --stretch 0 --cells on",
         "--stretch: 0 turns cell 0 over (0 of its area), and all others; "
         "above 0, or --cells off"},
        {"square --stretch 1 --pin bottom --ground 0,1,0,-0.4", ""},
        {"square --stretch 1 --pin bottom --ground 0,1,0,-0.2",
         "--ground 0,1,0,-0.2: node 1 would begin at a distance of -0.05 m; it "
         "must be above 0"},
        {"squeeze --at 0,1", ""},
        {"squeeze --at 0,0.5 --turn 45 --segments 4",
         "the ceiling: node 24 would begin at a distance of -0.197107 m; it "
         "must be above 0"},
        {"bend --at 0,0.3 --segments 16",
         "the falling ball: node 34 would begin at a distance of -0.125 m; it "
         "must be above 0"},
        {"bend --ball 0,0.6,0.3",
         "--ball 0,0.6,0.3: the falling ball would begin at a distance of "
         "-0.2975 m; it must be above 0"},
        {"tear --ground 1,0,-0.5,0 --segments 4",
         "--ground 1,0,-0.5,0: node 0 would begin at a distance of 0 m; it "
         "must be above 0"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char message[512];
        message_of(cases[i].line, message);
        assert_string_equal(message, cases[i].message);
    }
}

/* Pins are no way out: a ceiling ends at nodes that are held, and pins that are
 * drawn against a wall stop before it; the steps say so. */
TEST(pins_and_walls_stop_each_other)
{
    static const char *const lines[] = {
        "squeeze --segments 4 --pin top",
        "tear --segments 4 --ground 1,0,-0.52,0 --timestep 0.01"};
    for (int i = 0; i < 2; i++) {
        Simulation simulation;
        double gap = INFINITY;
        int blocked = 0;
        simulation_from_line(lines[i], NULL, NULL, &simulation);
        for (int step = 0; step < 30; step++) {
            Status status = simulation_step(&simulation);
            CHECK(status == STATUS_OK || status == STATUS_BLOCKED);
            blocked += status == STATUS_BLOCKED;
            gap = fmin(gap,
                       smallest_gap(&simulation.system, simulation.run[0].x));
        }
        CHECK(gap > 0 && gap < 1e-3);
        CHECK(blocked > 15 && blocked < 30);
        simulation_free(&simulation);
    }
}

/* The sides of the sheet are drawn apart; a node that a hand pins stays. */
TEST(a_pin_set_by_hand_stays)
{
    Simulation simulation;
    simulation_from_line("tear --segments 6", NULL, NULL, &simulation);
    double left = simulation.run[0].x[0];
    double at[2] = {simulation.run[0].x[2 * 17], simulation.run[0].x[35]};
    CHECK_STATUS(simulation_pin(&simulation, 17, true), STATUS_OK);
    for (int step = 0; step < 10; step++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK_SAME_BITS(simulation.run[0].x + 2 * 17, at, 2);
    CHECK_NEAR(simulation.run[0].x[0], left - 0.2 * 10 * 0.002, 1e-14);
    simulation_free(&simulation);
}

/* Negative curvature is looked for in the first minimisation, before any other
 * work has asked for its arrays. */
TEST(a_saddle_may_be_the_first_thing)
{
    Simulation simulation;
    simulation_from_line("tear --stiffness 1e8 --minimum", NULL, NULL,
                         &simulation);
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK(simulation_counters(&simulation).iterations > 0);
    simulation_free(&simulation);
}

/* What falls on the middle of a ball without a turn stays symmetric: 150 steps,
 * tolerance 1e-8; the two halves are added in different orders. */
TEST(what_is_symmetric_stays_so)
{
    Simulation simulation;
    simulation_from_line("dent --segments 8 --velocity 0,-2 --tolerance 1e-8",
                         NULL, NULL, &simulation);
    for (int step = 0; step < 150; step++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    const double *x = simulation.run[0].x;
    for (int node = 0; node < 81; node++) {
        int image = (8 - node / 9) * 9 + node % 9;
        CHECK_NEAR(x[2 * node], -x[2 * image], 1e-10);
        CHECK_NEAR(x[2 * node + 1], x[2 * image + 1], 1e-10);
    }
    CHECK(energy_now(&simulation, 0, "plastic") > 1000);
    simulation_free(&simulation);
}

/* A beam of another size has the cells of the one that is shown. */
TEST(a_beam_has_its_cells_at_every_size)
{
    static const char *const lines[] = {"bend", "bend --side 0.01",
                                        "bend --side 1"};
    for (int i = 0; i < 3; i++) {
        Simulation simulation;
        simulation_from_line(lines[i], NULL, NULL, &simulation);
        CHECK(simulation.mesh.segments == 32 && simulation.mesh.rows == 6);
        simulation_free(&simulation);
    }
}

/* The three blocks of the slope begin as high above their grounds, whatever
 * their size.  1e-15: rounding of coordinates of size 1. */
TEST(blocks_begin_alike)
{
    Simulation simulation;
    simulation_from_line("slope --side 0.3", NULL, NULL, &simulation);
    const TimeIntegrator *run = simulation.run;
    double gap = smallest_gap(run[0].system, run[0].x);
    CHECK(gap > 0 && simulation.runs == 3);
    for (int r = 1; r < 3; r++) {
        CHECK_NEAR(smallest_gap(run[r].system, run[r].x), gap, 1e-15);
        CHECK_NEAR(run[0].x[1] - run[r].x[1], r * 2.6 * 0.3, 1e-15);
    }
    simulation_free(&simulation);
}

/* The arrows on the blocks of the slope: on the one that holds they add up to
 * its weight, straight up, and all sticks; on those that slide they take the
 * same part of it normal to the slope, and mu times that along it. */
TEST(arrows_are_the_forces)
{
    static const double part[3] = {0.5, 0.9, 1.1};
    const double angle = 20 * 0.017453292519943295, weight = 250 * 9.81;
    Simulation simulation;
    simulation_from_line("slope", NULL, NULL, &simulation);
    for (int step = 0; step < 150; step++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    for (int r = 0; r < 3; r++) {
        const SpringPen pen = {.simulation = &simulation,
                               .run = r,
                               .system = simulation.run[r].system,
                               .x = simulation.run[r].x,
                               .contact = contact_of(simulation.run[r].system)};
        double sum[2] = {0, 0};
        int slides = 0, touches = 0;
        for (Touch touch = {.pair = -1}; square_next_touch(&pen, &touch);) {
            touches++;
            slides += touch.slides;
            CHECK(touch.rough);
            sum[0] += touch.force[0];
            sum[1] += touch.force[1];
        }
        double normal = -sin(angle) * sum[0] + cos(angle) * sum[1];
        double along = cos(angle) * sum[0] + sin(angle) * sum[1];
        CHECK(touches == 7 && slides == (r < 2 ? 7 : 0));
        /* it still shakes a little: 1e-3 */
        CHECK_NEAR(normal, weight * cos(angle), 1e-3 * weight);
        CHECK_NEAR(along, fmin(part[r], 1) * weight * sin(angle),
                   1e-3 * weight);
        CHECK_NEAR(square_contact_most(&pen), hypot(sum[0], sum[1]) / 7,
                   0.5 * weight);
    }
    simulation_free(&simulation);
}

/* Coulomb's cone in a tumbling square: friction is never more than mu times the
 * normal force that it was given, never pushes on, and both happens: contacts
 * that stick, with less, and contacts that slide, with all of it. */
TEST(friction_stays_in_its_cone)
{
    Simulation simulation;
    int sticks = 0, slides = 0;
    simulation_from_line("drop --segments 6", NULL, NULL, &simulation);
    const System *system = &simulation.system;
    const Contact *contact = contact_of(system);
    const Friction *friction = system_find_term(system, &friction_energy)->data;
    double *x = malloc(2 * (size_t)system->nodes * sizeof *x);
    CHECK(x != NULL);
    for (int step = 0; step < 250; step++) {
        memcpy(x, simulation.run[0].x, 2 * (size_t)system->nodes * sizeof *x);
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        for (int s = 0; s < friction->slides; s++) {
            const Slide *slide = &friction->slide[s];
            double T = slide->weight * friction_slope(slide->y, friction->e);
            Gap gap = contact_pair_gap(contact, x, slide->pair.node,
                                       slide->pair.obstacle);
            double cone = 0.3 * contact_force(&contact->barrier, &gap);
            CHECK_AT_MOST(fabs(T), cone * (1 + 1e-14));
            CHECK(T * slide->y >= 0);
            sticks += fabs(T) < 0.999 * cone;
            slides += fabs(slide->y) > friction->e;
            if (fabs(slide->y) > friction->e)
                CHECK_NEAR(fabs(T), cone, 1e-14 * cone);
        }
    }
    CHECK(sticks > 100 && slides > 100);
    free(x);
    simulation_free(&simulation);
}

/* The curves of the card add up: what was there at the start and the work that
 * was done is what is there now and what was lost. */
TEST(the_curves_are_the_ledger)
{
    static const char *const lines[] = {"drop --segments 6", "squeeze",
                                        "dent --segments 6",
                                        "tear --segments 8", "bend"};
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        static History history;
        Simulation simulation;
        simulation_from_line(lines[i], NULL, NULL, &simulation);
        memset(&history, 0, sizeof history);
        show_sample(&simulation, &history, NULL);
        for (int step = 0; step < 120; step++) {
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
            show_sample(&simulation, &history, NULL);
        }
        CHECK(history.count == 121);
        double lost = 0;
        for (int p = 0; p < history.count; p++) {
            double now = 0, gone = 0, work = 0, size = 0;
            for (int s = 1; s < history.series; s++) {
                double value = history.value[s][p];
                const char *name = history.name[s];
                size += fabs(value);
                if (strcmp(name, "work") == 0)
                    work = value;
                else if (strstr("plastic fracture friction dissipated", name))
                    gone += value;
                else
                    now += value;
            }
            CHECK_NEAR(now, history.value[0][p], 1e-13 * size);
            CHECK_NEAR(history.value[0][0] + work, now + gone, 1e-12 * size);
            CHECK(p == 0 || gone > lost - 1e-3 * size);
            lost = gone;
        }
        CHECK(lost > 1);
        simulation_free(&simulation);
    }
}

/* ---- the ledger while hands are on -------------------------------------- */

/* What one does to a run between two steps. */
static void meddle(Simulation *simulation, int deed)
{
    const double *x = simulation->run[0].x + 2 * 7;
    Options options = simulation->options;
    options.stiffness *= deed % 2 ? 0.5 : 3;
    switch (deed % 8) {
    case 0:
        CHECK_STATUS(simulation_grab(simulation, 7, x[0], x[1]), STATUS_OK);
        break;
    case 1:
        CHECK_STATUS(simulation_grab(simulation, 7, x[0] + 0.1, x[1] - 0.07),
                     STATUS_OK);
        break;
    case 2:
        simulation_release(simulation);
        break;
    case 3:
        CHECK_STATUS(simulation_pin(simulation, 9, true), STATUS_OK);
        break;
    case 4:
        simulation_set_timestep(simulation, 0.4 * options.timestep);
        break;
    case 5:
        CHECK_STATUS(simulation_pin(simulation, 9, false), STATUS_OK);
        break;
    default:
        CHECK_STATUS(simulation_change(simulation, &options), STATUS_OK);
    }
}

/* A hand, a pin, another time step or stiffness is booked as work: nothing that
 * is lost changes with it, and in the steps after it all that is lost grows. */
TEST(what_hands_do_is_work)
{
    static const char *const lines[] = {"drop --segments 4 --at -0.3,0.4",
                                        "slope --segments 3",
                                        "squeeze --segments 4",
                                        "dent --segments 4 --at 0,0.2",
                                        "tear --segments 6 --timestep 0.01",
                                        "bend --segments 16"};
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        Simulation simulation;
        simulation_from_line(lines[i], NULL, NULL, &simulation);
        simulation_set_tolerance(&simulation, 1e-8);
        int blocked = 0; /* the ceiling, by the node that is pinned */
        for (int deed = 0; deed < 24; deed++) {
            Energies before = simulation_energies(&simulation, 0);
            double size = fabs(before.kinetic) + fabs(OF(&before, elastic)) +
                          fabs(before.gravity) + fabs(OF(&before, plastic)) +
                          fabs(before.work) + fabs(before.dissipated) + 1;
            meddle(&simulation, deed);
            Energies after = simulation_energies(&simulation, 0);
            size += fabs(OF(&after, elastic)) + fabs(OF(&after, hand));
            CHECK_NEAR(after.dissipated, before.dissipated, 1e-12 * size);
            CHECK(OF(&after, plastic) == OF(&before, plastic) &&
                  OF(&after, fracture) == OF(&before, fracture) &&
                  OF(&after, friction) == OF(&before, friction));
            for (int step = 0; step < 4; step++) {
                before = simulation_energies(&simulation, 0);
                Status status = simulation_step(&simulation);
                CHECK(status == STATUS_OK || status == STATUS_BLOCKED);
                blocked += status == STATUS_BLOCKED;
                after = simulation_energies(&simulation, 0);
                CHECK(OF(&after, plastic) >= OF(&before, plastic) &&
                      OF(&after, fracture) >= OF(&before, fracture) &&
                      OF(&after, friction) >= OF(&before, friction));
            }
        }
        CHECK(i == 2 || blocked == 0);
        CHECK(fabs(simulation_energies(&simulation, 0).work) > 1e-3);
        simulation_free(&simulation);
    }
}

TESTS(NULL, NULL)
