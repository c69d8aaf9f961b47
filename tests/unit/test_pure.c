/* test_pure.c - a step is a pure function of the state and the settings: the
 * next state has the same bits, whatever its simulation did before */
#include "test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 36 }; /* not divisible by 23, so 23 i % STEPS visits each step */

static void make_saved_step(Simulation *simulation, void *bytes)
{
    Status status = simulation_step(simulation);
    CHECK(!status || status_is_unconverged(status));
    state_save(simulation, bytes);
}

/* Makes a step with other settings, and restores the old settings. */
static void make_changed_step(const Options *options, Simulation *old)
{
    int last = old->system.nodes - 1;
    bool pinned = old->system.is_pinned[last];
    bool damps =
        old->run[0].method->supports_all_terms && old->system.springs > 0;
    change_option(old, OPTION_SLOT(timestep), 2 * options->timestep);
    CHECK_OK(pin_node(old, last, !pinned));
    CHECK_OK(hold_node(old, 0, 0.1, 0.2));
    if (damps)
        CHECK_OK(change_option(old, OPTION_SLOT(damping), 1e8));
    simulation_step(old);
    if (damps) {
        const Newton *newton = old->run[0].newton;
        CHECK(newton->rounding.max_stiffness ==
              system_max_stiffness(newton->system));
    }
    if (damps)
        CHECK_OK(change_option(old, OPTION_SLOT(damping), options->damping));
    CHECK_OK(hold_node(old, -1, 0, 0));
    CHECK_OK(pin_node(old, last, pinned));
    change_option(old, OPTION_SLOT(timestep), options->timestep);
}

/* Checks that step first + 1 has the saved bits in a new simulation, after
 * other steps, and after a step with other settings. */
static void check_step_is_pure(const Options *options, Simulation *old,
                               const unsigned char *states, size_t size,
                               int first)
{
    const unsigned char *from = states + (size_t)first * size;
    unsigned char *bytes = malloc(size);
    Simulation fresh;
    CHECK(bytes != NULL);
    CHECK_OK(simulation_create(options, NULL, NULL, &fresh));
    for (int i = 0; i < 3; i++) {
        static const char *const after[] = {"none", "other steps",
                                            "other settings"};
        Simulation *simulation = i == 0 ? &fresh : old;
        if (i == 2)
            make_changed_step(options, old);
        state_restore(from, simulation);
        make_saved_step(simulation, bytes);
        if (memcmp(bytes, from + size, size) != 0)
            fail_msg("%s, %s: step %d has other bits after %s",
                     options->scene->name, old->run[0].method->label, first + 1,
                     after[i]);
    }
    simulation_free(&fresh);
    free(bytes);
}

/* Makes steps in order, and then checks each of them again. Returns false if
 * the method refuses the scene. */
static bool check_steps_are_pure(const Options *options)
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
        make_saved_step(&simulation, states + (size_t)(i + 1) * size);
    for (int i = 0; i < STEPS && !status; i++)
        check_step_is_pure(options, &simulation, states, size, i * 23 % STEPS);
    simulation_free(&simulation);
    free(states);
    return !status;
}

TEST(steps_are_pure)
{
    int runs = 0;
    for (const Scene *scene = scenes; scene->name; scene++) {
        char line[80];
        snprintf(line, sizeof line, "%s%s", scene->name,
                 scene->traits & HAS_MESH ? " --segments 4" : "");
        if (!(scene->traits & HAS_TIME) || scene->step)
            continue;
        Options options = options_from_line(line);
        runs += check_steps_are_pure(&options);
        for (const IntegratorMethod *method = integrator_methods; method->name;
             method++) {
            options.integrator = method - integrator_methods;
            options.timestep = method->stages > 0 ? options.timestep : 1e-4;
            runs += check_steps_are_pure(&options);
        }
    }
    CHECK(runs > 40);
}

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
        Options options = options_from_line(lines[i]);
        CHECK(check_steps_are_pure(&options));
    }
}

TEST(changed_h_forgets_earlier_steps)
{
    static const char *const methods[] = {"bdf2", "verlet"};
    for (int m = 0; m < 2; m++) {
        Simulation *old =
            make_steps(simulate("--segments 3 --timestep 1e-3 --integrator %s",
                                methods[m]),
                       5);
        Simulation *fresh = simulate(
            "--segments 3 --timestep 2e-3 --integrator %s", methods[m]);
        unsigned char *bytes = malloc(state_save(old, NULL));
        CHECK(bytes != NULL);
        state_save(old, bytes);
        state_restore(bytes, fresh);
        free(bytes);
        fresh->run[0].history_h = 0;
        change_option(old, OPTION_SLOT(timestep), 2e-3);
        for (int i = 0; i < 3; i++)
            CHECK(state_hash(make_steps(old, 1), 1) ==
                  state_hash(make_steps(fresh, 1), 1));
    }
}

TESTS(NULL, NULL)
