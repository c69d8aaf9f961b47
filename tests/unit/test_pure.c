/* A step is a pure function of the state and the settings: whoever makes it,
 * whatever was made before, the next state has the same bits. */
#include "test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 36 }; /* no multiple of 37 */

/* The state after the next step; bytes out. */
static void step(Simulation *simulation, void *bytes)
{
    Status status = simulation_step(simulation);
    CHECK(!status || status_is_unconverged(status));
    state_save(simulation, bytes);
}

/* Other settings for a step, in which they count, and those from before again:
 * nothing of it may stay. */
static void disturb(const Options *options, Simulation *used)
{
    int last = used->system.nodes - 1;
    bool pinned = used->system.pinned[last];
    bool damps =
        used->run[0].method->supports_all_terms && used->system.springs > 0;
    simulation_set(used, OPTION_SLOT(timestep), 2 * options->timestep);
    CHECK_OK(simulation_pin(used, last, !pinned));
    CHECK_OK(simulation_hold(used, 0, 0.1, 0.2));
    if (damps)
        CHECK_OK(simulation_set(used, OPTION_SLOT(damping), 1e8));
    simulation_step(used);
    if (damps) {
        const Newton *newton = used->run[0].newton;
        CHECK(newton->rounding.max_curvature ==
              system_curvature_bound(newton->system));
    }
    if (damps)
        CHECK_OK(simulation_set(used, OPTION_SLOT(damping), options->damping));
    CHECK_OK(simulation_hold(used, -1, 0, 0));
    CHECK_OK(simulation_pin(used, last, pinned));
    simulation_set(used, OPTION_SLOT(timestep), options->timestep);
}

/* From `first`, a simulation that was never used makes the next step, and one
 * that has made many others does. */
static void check_step(const Options *options, Simulation *used,
                       const unsigned char *states, size_t size, int first)
{
    const unsigned char *from = states + (size_t)first * size;
    unsigned char *bytes = malloc(size);
    Simulation fresh;
    CHECK(bytes != NULL);
    CHECK_OK(simulation_create(options, NULL, NULL, &fresh));
    for (int i = 0; i < 3; i++) {
        static const char *const after[] = {"none", "other steps",
                                            "other settings"};
        Simulation *simulation = i == 0 ? &fresh : used;
        if (i == 2)
            disturb(options, used);
        state_restore(from, simulation);
        step(simulation, bytes);
        if (memcmp(bytes, from + size, size) != 0)
            fail_msg("%s, %s: step %d has other bits after %s",
                     options->scene->name, used->run[0].method->label,
                     first + 1, after[i]);
    }
    simulation_free(&fresh);
    free(bytes);
}

/* Steps made one after the other, and then each of them again, in another
 * order. Returns false where this method refuses the scene. */
static bool check_run(const Options *options)
{
    Simulation simulation;
    Status status = simulation_create(options, NULL, NULL, &simulation);
    size_t size = status ? 0 : state_save(&simulation, NULL);
    unsigned char *states = malloc((STEPS + 1) * size + 1);
    CHECK(states != NULL);
    CHECK(!status || status == STATUS_INVALID_INPUT);
    if (!status)
        state_save(&simulation, states);
    for (int i = 0; i < STEPS && !status; i++)
        step(&simulation, states + (size_t)(i + 1) * size);
    for (int i = 0; i < STEPS && !status; i++)
        check_step(options, &simulation, states, size, i * 37 % STEPS);
    simulation_free(&simulation);
    free(states);
    return !status;
}

/* Every scene in which time passes, with every method that can. */
TEST(steps_are_pure)
{
    int runs = 0;
    for (const Scene *scene = scenes; scene->name; scene++) {
        char line[80];
        snprintf(line, sizeof line, "%s%s", scene->name,
                 scene->parts & HAS_MESH ? " --segments 4" : "");
        if (!(scene->parts & HAS_TIME) || scene->step)
            continue;
        Options options = line_options(line);
        runs += check_run(&options);
        for (const IntegratorMethod *method = integrator_methods; method->name;
             method++) {
            options.integrator = method - integrator_methods;
            options.timestep = method->is_implicit ? options.timestep : 1e-4;
            runs += check_run(&options);
        }
    }
    CHECK(runs > 40);
}

/* With every way to find a step, and terms that remember something. */
TEST(all_solvers_are_pure)
{
    static const char *const lines[] = {
        "--segments 3 --projection on-demand --stretch 0.6 --timestep 0.01",
        "--segments 4 --projection on-demand --stretch 2.5 --timestep 0.01",
        "--segments 8 --projection on-demand --stretch 2.5 --timestep 0.01",
        "--segments 3 --projection none --stretch 1.1",
        "--segments 3 --projection abs",
        "--segments 3 --line-search none --stretch 1.1",
        "--segments 3 --solver multigrid",
        "--segments 5 --solver multigrid --damping 0.01",
        "hang --segments 4 --damping 0.05",
        "--segments 4 --yield 0.1 --hardening 0.1",
        "--segments 4 --tear 0.2 --stretch 1.3",
        "--segments 8 --tear 0.2 --stretch 1.3 --solver multigrid",
        "drop --segments 4 --damping 0.01",
        "dent --segments 4",
        "tear --segments 6",
        "squeeze --segments 4 --projection on-demand",
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        Options options = line_options(lines[i]);
        CHECK(check_run(&options));
    }
}

/* What a method remembers is of steps of one length: after a step of another
 * it begins as after a start. */
TEST(another_timestep_begins_anew)
{
    static const char *const methods[] = {"bdf2", "verlet"};
    for (int m = 0; m < 2; m++) {
        Simulation *used =
            make_steps(simulate("--segments 3 --timestep 1e-3 --integrator %s",
                                methods[m]),
                       5);
        Simulation *fresh = simulate(
            "--segments 3 --timestep 2e-3 --integrator %s", methods[m]);
        unsigned char *bytes = malloc(state_save(used, NULL));
        CHECK(bytes != NULL);
        state_save(used, bytes);
        state_restore(bytes, fresh);
        free(bytes);
        fresh->run[0].memory_h = 0;
        simulation_set(used, OPTION_SLOT(timestep), 2e-3);
        for (int i = 0; i < 3; i++)
            CHECK(state_hash(make_steps(used, 1), 1) ==
                  state_hash(make_steps(fresh, 1), 1));
    }
}

TESTS(NULL, NULL)
