/* The hand: its work is booked; it wins; whatever the mouse does, every step
 * ends.  The derivatives of its energy are in test_terms.c.
 */
#include "pasts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/pull_energy.h"

/* Averaged vector field conserves energy exactly, so all that is there was
 * there at the start or is the work of the hand: taking, moving, letting go. */
TEST(work_is_what_energy_gains)
{
    const char *lines[] = {
        "square --segments 3 --integrator avf --tolerance 1e-10",
        ("square --segments 2 --timestep 0.002 --integrator avf4 "
         "--tolerance 1e-10"),
        "circle --integrator avf",
    };
    for (int line = 0; line < 3; line++) {
        begin_past(lines[line]);
        const Simulation *simulation = &past.machine[0].simulation;
        double start = simulation_energies(simulation, 0).total, high = start;
        for (int step = 0; step < 60; step++) {
            const double *x = simulation->run[0].x;
            if (step == 5)
                edit(COMMAND_GRAB, 0, x[0], x[1]);
            if (step > 5 && step < 40)
                edit(COMMAND_DRAG, 0, -1 - 0.05 * step, 0.3 * sin(step));
            if (step == 40)
                edit(COMMAND_RELEASE, 0, 0, 0);
            show(step + 1);
            Energies energies = simulation_energies(simulation, 0);
            high = fmax(high, energies.total);
            /* What Newton's tolerance leaves: measured 2e-9 of the highest. */
            CHECK_NEAR(energies.total - energies.work, start, 1e-7 * high);
        }
        Energies end = simulation_energies(simulation, 0);
        CHECK(fabs(end.work) > 1e-3 * start);
        past_free(&past);
    }
}

/* A node that is pulled is where the mouse is: within 2 % of the way after half
 * a second and from then on, inside of a square, at its corner, and held by
 * pins; in no step does it jump further than a cell. */
TEST(the_hand_wins)
{
    static const struct {
        const char *line;
        int node;
        double way[2];
    } rows[] = {
        {"square --segments 4 --stretch 1 --timestep 0.02", 24, {1, 0.5}},
        {"square --stretch 1 --stiffness 1e3 --timestep 0.01", 12, {0.3, 0.2}},
        {"square --stretch 1 --stiffness 1e7 --timestep 0.01", 12, {0.3, 0.2}},
        {"square --segments 64 --stretch 1 --timestep 0.05", 4224, {0.1, 0}},
        {"hang", 6, {0, -0.66}},
        {"hang --integrator bdf2", 6, {0, -0.66}},
        {"hang --segments 6 --integrator sdirk2", 3, {0.1, -0.5}},
        {"hang --segments 6 --integrator midpoint", 3, {0.1, -0.5}},
        {"hang --segments 6 --integrator avf", 3, {0.1, -0.5}},
        {"hang --segments 6 --integrator avf4", 3, {0.1, -0.5}},
        {"hang --segments 6 --integrator verlet --timestep 0.001", 3, {0, -1}},
        {"hang --segments 6 --integrator symplectic-euler --timestep 0.001",
         3,
         {0, -1}},
        {"return --segments 4 --stretch 1", 24, {0.4, 0.2}},
        {"circle --integrator backward-euler", 0, {1, 1}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        begin_past(rows[i].line);
        const Simulation *simulation = &past.machine[0].simulation;
        double *x = simulation->run[0].x + 2 * rows[i].node, last[2];
        double to[2] = {x[0] + rows[i].way[0], x[1] + rows[i].way[1]};
        double way = hypot(rows[i].way[0], rows[i].way[1]), furthest = 0;
        double cell = simulation->mesh.nodes ? simulation->mesh.spacing : way;
        edit(COMMAND_GRAB, rows[i].node, x[0], x[1]);
        edit(COMMAND_DRAG, 0, to[0], to[1]);
        while (simulation_time(simulation) < 1) {
            memcpy(last, x, sizeof last);
            show(past.step + 1);
            furthest = fmax(furthest, hypot(x[0] - last[0], x[1] - last[1]));
            if (simulation_time(simulation) > 0.5)
                CHECK_AT_MOST(hypot(x[0] - to[0], x[1] - to[1]), 0.02 * way);
        }
        CHECK_AT_MOST(furthest, 1.001 * cell); /* 4e-5 more: the tolerance */
        double stiffest = 0, force = 0;
        system_bounds(&simulation->system, &stiffest, &force);
        const Pull *hand = system_data(&simulation->system, &hand_energy);
        CHECK(stiffest >= hand->k);
        edit(COMMAND_RELEASE, 0, 0, 0);
        CHECK(!system_data(&simulation->system, &hand_energy));
        past_free(&past);
    }
}

/* sum m |v - v_n|^2/2, J */
static double change_of_motion(const Simulation *simulation, const double *v_n)
{
    const double *v = simulation->run[0].v;
    double sum = 0;
    for (int i = 0; i < 2 * simulation->system.nodes; i++)
        sum += simulation->system.m[i / 2] * (v[i] - v_n[i]) * (v[i] - v_n[i]);
    return 0.5 * sum;
}

/* A timestep every ten steps; a node is taken, jerked about and let go. */
static void jerk(Random *random, int step)
{
    char text[64];
    double h = random_logarithmic(random, 1e-4, 1);
    snprintf(text, sizeof text, "timestep %.17g", h);
    if (step % 10 == 0)
        set_option(text, false);
    if (step % 25 == 0)
        edit(COMMAND_GRAB,
             random_below(random, past.machine[0].simulation.system.nodes),
             random_uniform(random, -1, 1), random_uniform(random, -1, 1));
    else if (step % 25 == 20)
        edit(COMMAND_RELEASE, 0, 0, 0);
    else if (past_control(&past, 0)->hand >= 0)
        edit(COMMAND_DRAG, 0, random_uniform(random, -5, 5),
             random_uniform(random, -5, 5));
}

/* One step after a jerk, in which E never rises.  A step of backward Euler ends
 * where E is at most what it was at x_n, so sum m |v - v_n|^2/2 + P <= sum m
 * |v_n|^2/2 + P_n, and what the hand's energy falls by is its work, up to
 * rounding.  Methods that damp nothing gather the hand's work: beyond 1e20 J,
 * false, and nothing is NaN.  A step of explicit ones may lead beyond all
 * numbers: false, and it changes nothing. */
static bool jerked_step(bool descends)
{
    const Simulation *simulation = &past.machine[0].simulation;
    const TimeIntegrator *run = &simulation->run[0];
    int size = 2 * simulation->system.nodes;
    Energies energies = simulation_energies(simulation, 0);
    double v[MAX_SIZE * 3], high = energies.total - energies.work;
    long before = past.step;
    memcpy(v, run->v, (size_t)size * sizeof *v);
    past_aim(&past, before + 1, false);
    Status status = past_finish(&past);
    if (status && !status_is_unconverged(status)) {
        CHECK(!run->newton && status == STATUS_NOT_FINITE);
        CHECK_SAME_BITS(run->v, v, size);
        return false;
    }
    CHECK(past.step == before + 1);
    const Records *records = &past.machine[0].records;
    for (int i = 0; i < records->count; i++)
        CHECK(records->row[i].change <= 0);
    for (int k = 0; k < size; k++)
        CHECK(isfinite(run->x[k]) && isfinite(run->v[k]));
    Energies now = simulation_energies(simulation, 0);
    if (!descends && !(now.total < 1e20))
        return false;
    CHECK(isfinite(now.total) && isfinite(now.work));
    if (descends)
        CHECK_AT_MOST(change_of_motion(simulation, v) + now.total -
                          now.kinetic - now.work,
                      high + 1e-12 * (now.total + fabs(now.work)));
    return true;
}

/* Random jerks of the mouse, any timestep, every method: every step ends.  A
 * run with too much energy begins again.  10 000 steps of each with all
 * variations.
 */
TEST(random_drags_end)
{
    static const char *const methods[] = {"backward-euler",
                                          "backward-euler",
                                          "bdf2",
                                          "sdirk2",
                                          "avf",
                                          "avf4",
                                          "midpoint",
                                          "symplectic-euler",
                                          "verlet",
                                          "forward-euler"};
    enum { METHODS = sizeof methods / sizeof *methods };
    enum { DAMPING = 3, EXPLICIT = METHODS - 3 };
    const int steps = tests_are_long() ? 10000 : 150;
    Random random = {2026};
    for (int i = 0; i < METHODS; i++) {
        char line[160];
        snprintf(line, sizeof line,
                 "square --segments %d --integrator %s --solver %s", 2 + i % 3,
                 methods[i], i % 2 ? "multigrid" : "newton");
        begin_past(line);
        int runaways = 0;
        for (int step = 0; step < steps; step++) {
            jerk(&random, step);
            if (jerked_step(i < 2))
                continue;
            past_free(&past);
            begin_past(line);
            runaways++;
        }
        /* Explicit steps run away every twentieth time, as they must beyond
         * their stable timestep; backward Euler and BDF2 never do. */
        print_message("  %-16s %d runaways\n", methods[i], runaways);
        CHECK(i < DAMPING ? runaways == 0 : i < EXPLICIT || runaways > 0);
        past_free(&past);
    }
}

TESTS(NULL, NULL)
