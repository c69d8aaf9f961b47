/* The scenes of contact, inelasticity and fracture from outside: rows of
 * options, starts that are refused, what is held fast, what changes while they
 * run, and the forces that their pictures show.
 */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "model/contact.h"
#include "model/damping.h"
#include "model/fracture.h"
#include "picture/square_pen.h"
#include "scenes/scene.h"
#include "scenes/state.h"

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
        {"dent",
         "square --segments 16 --stiffness 2e5 --stretch 1 --timestep 0.004 "
         "--tolerance 1e-4 --gravity 9.81 --cells on --at 0,0.62 --velocity "
         "0.02,-2 --friction 0.3 --yield 0.04 --hardening 0.1 --ball "
         "0,-0.75,0.35 --ground 0,1,0,-1.15",
         70, 0, 0},
        {"hang --segments 40", "hang --segments 40", 30, 0, 0},
        {"tear", "tear", 30, 0, 0},
        {"slope --friction 0.2", "slope", 20, 0.2, 0},
        {"drop --friction 0.4", "drop --friction 0", 100, 0.4, 0},
        {"dent --damping 0.003", "dent", 120, 0, 0.003},
        {"--damping 0.003", "--damping 1", 20, 0, 0.003},
        {"tear --damping 0.001", "tear", 120, 0, 0.001},
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
        CHECK(!damping_of(&other->system) == !(rows[i].damping > 0));
        make_steps(one, rows[i].steps);
        make_steps(other, rows[i].steps);
        CHECK(state_hash(one, 1) == state_hash(other, 1));
        CHECK(energy_now(one, 0, "damping") == energy_now(other, 0, "damping"));
        CHECK((energy_now(one, 0, "damping") > 0) == (rows[i].damping > 0));
    }
}

/* Who begins in an obstacle is told which node, and how deep. */
TEST(starts_that_make_no_sense_are_refused)
{
    static const char *const rows[][3] = {
        /* what the message says; NULL: the start is taken */
        {"--ground 0,1,0,-0.4", "--ground 0,1,0,-0.4: node 0 would begin at a",
         " distance of -0.1 m; it must be above 0"},
        {"--ground 0,2,0,-0.5", "--ground 0,2,0,-0.5: node 0", "of 0 m"},
        {"--ground 0,1,0,-0.6 --ball 0.75,0.5,0.3",
         "--ball 0.75,0.5,0.3: node 24", "-0.05 m"},
        {"--ball 0.125,0.125,0.05", NULL, NULL}, /* in a cell */
        {"--ground 0,0,1,0", "--ground 0,0,1,0: the normal is 0,0",
         "it must point somewhere"},
        {"--ball 3,0,0", "--ball 3,0,0: the radius", "must be above 0"},
        {"--stretch 0 --cells on", "--stretch: cell 0 begins turned over",
         "it must not, or --cells off"},
        {"--pin bottom --ground 0,1,0,-0.4", NULL, NULL},
        {"--pin bottom --ground 0,1,0,-0.2", "--ground 0,1,0,-0.2: node 1",
         "-0.05 m"},
        {"squeeze --at 0,1", NULL, NULL},
        {"squeeze --at 0,0.5 --turn 45 --segments 4", "the ceiling: node 24",
         "-0.197107 m"},
        {"bend --at 0,0.3 --segments 16", "the falling ball: node 34",
         "-0.125 m"},
        {"bend --ball 0,0.6,0.3", "--ball 0,0.6,0.3: the falling ball",
         "-0.2975 m"},
        {"tear --ground 1,0,-0.5,0 --segments 4", "--ground 1,0,-0.5,0: node 0",
         "of 0 m"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char *const *row = rows[i];
        char line[128], message[512];
        Options options;
        snprintf(line, sizeof line, "%s%s",
                 row[0][0] == '-' ? "square --stretch 1 " : "", row[0]);
        Status status = parse_line(line, 0, &options, message);
        CHECK_STATUS(status, row[1] ? STATUS_INVALID_INPUT : STATUS_OK);
        for (int k = 1; k < 3 && row[1]; k++)
            if (!strstr(message, row[k]))
                fail_msg("%s: %s", line, message);
    }
}

/* Only where x_(n+1) is the minimiser is (E - E_n)/h the rate that counts: by
 * the command line, while it runs, and in the system itself. */
TEST(other_methods_refuse_damping)
{
    const System *damped = &simulate("--damping 0.1")->system;
    for (const IntegratorMethod *method = integrator_methods; method->name;
         method++) {
        char message[512], line[80];
        Options options = simulate("--integrator %s", method->name)->options;
        Status wanted = method->at_end ? STATUS_OK : STATUS_INVALID_INPUT;
        CHECK_STATUS(options_set(&options, "damping", "0.1", message, 512),
                     wanted);
        snprintf(line, sizeof line, "--damping 0.1 --integrator %s",
                 method->name);
        CHECK_STATUS(parse_line(line, 0, &options, message), wanted);
        CHECK(!wanted || strstr(message, "damping"));
        CHECK(integrator_method_refuses(method, damped) == !!wanted);
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
        Simulation *scene = simulate("%s", lines[i]);
        double gap = INFINITY;
        int blocked = 0;
        for (int step = 0; step < 30; step++) {
            Status status = simulation_step(scene);
            CHECK(status == STATUS_OK || status == STATUS_BLOCKED);
            blocked += status == STATUS_BLOCKED;
            gap = fmin(gap, smallest_gap(&scene->system, scene->run[0].x));
        }
        CHECK(gap > 0 && gap < 1e-3);
        CHECK(blocked > 15 && blocked < 30);
    }
}

/* The sides of the sheet are drawn apart; a node that a hand pins stays. */
TEST(a_pin_set_by_hand_stays)
{
    Simulation *scene = simulate("tear --segments 6");
    const double *x = scene->run[0].x;
    double left = x[0], at[2] = {x[2 * 17], x[2 * 17 + 1]};
    CHECK_STATUS(simulation_pin(scene, 17, true), STATUS_OK);
    make_steps(scene, 10);
    CHECK_SAME_BITS(scene->run[0].x + 2 * 17, at, 2);
    CHECK_NEAR(scene->run[0].x[0], left - 0.2 * 10 * 0.002, 1e-14);
}

/* Negative curvature is looked for in the first minimisation, before any other
 * work has asked for its arrays. */
TEST(a_saddle_may_be_the_first_thing)
{
    Simulation *scene =
        make_steps(simulate("tear --stiffness 1e8 --minimum"), 1);
    CHECK(simulation_counters(scene).iterations > 0);
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

/* The arrows on the blocks of the slope: on the one that holds they add up to
 * its weight, straight up, and all sticks; on those that slide they take the
 * same part of it normal to the slope, and mu times that along it. */
TEST(arrows_are_the_forces)
{
    static const double part[3] = {0.5, 0.9, 1.1};
    const double angle = 20 * 0.017453292519943295, weight = 250 * 9.81;
    Simulation *slope = make_steps(simulate("slope"), 150);
    for (int r = 0; r < 3; r++) {
        const SpringPen pen = {.simulation = slope,
                               .run = r,
                               .system = slope->run[r].system,
                               .x = slope->run[r].x,
                               .contact = contact_of(slope->run[r].system)};
        double sum[2] = {0, 0};
        int slides = 0, touches = 0;
        for (Touch touch = {.pair = -1}; square_next_touch(&pen, &touch);) {
            touches++;
            slides += touch.slides;
            CHECK(touch.rough);
            sum[0] += touch.force[0];
            sum[1] += touch.force[1];
        }
        CHECK(touches == 7 && slides == (r < 2 ? 7 : 0));
        /* it still shakes a little: 1e-3 */
        CHECK_NEAR(-sin(angle) * sum[0] + cos(angle) * sum[1],
                   weight * cos(angle), 1e-3 * weight);
        CHECK_NEAR(cos(angle) * sum[0] + sin(angle) * sum[1],
                   fmin(part[r], 1) * weight * sin(angle), 1e-3 * weight);
        CHECK_NEAR(square_contact_most(&pen), hypot(sum[0], sum[1]) / 7,
                   0.5 * weight);
    }
}

/* ---- the ledger while hands are on ------------------------------------- */

/* What one does to a run between two steps. */
static Status meddle(Simulation *scene, int deed)
{
    const double *x = scene->run[0].x + 2 * 7;
    Options options = scene->options;
    switch (deed % 8) {
    case 0:
        return simulation_grab(scene, 7, x[0], x[1]);
    case 1:
        return simulation_grab(scene, 7, x[0] + 0.1, x[1] - 0.07);
    case 2:
        simulation_release(scene);
        return STATUS_OK;
    case 3:
    case 5:
        return simulation_pin(scene, 9, deed % 8 == 3);
    case 4:
        simulation_set(scene, OPTION_SLOT(timestep), 0.4 * options.timestep);
        return STATUS_OK;
    default:
        options.stiffness *= deed % 2 ? 0.5 : 3;
        options.friction *= deed % 2 ? 0.5 : 2;
        options.damping = deed % 2 ? 0.01 : 0.02;
        return simulation_change(scene, &options);
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
