/* test_past.c - the past: each state comes back to the last bit, whatever was
 * kept or discarded; commands; and that every step ends whatever the mouse
 * does. (Edits and undo: test_session; the energy of the hand: test_terms.) */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "play/past.h"

static Past past;

static uint64_t hash_past(void)
{
    uint64_t hash = STATE_HASH_SEED;
    for (int p = 0; p < past_count_panes(&past); p++)
        hash = hash_simulation(&past.pane[p].simulation, hash);
    return hash;
}

static void begin_past(const char *line)
{
    const Command restart = {.kind = COMMAND_RESTART};
    Options options = options_from_line(line);
    past_create(true, true, &past);
    CHECK_OK(past_begin_runs(&past, &options, 1, 0, &restart));
}

static uint64_t go_to_step(long step)
{
    past_set_goal(&past, step, false);
    Status status = past_finish_work(&past);
    CHECK(!status || status_is_unconverged(status));
    CHECK(past.shown_step == step);
    return hash_past();
}

static void edit_past(CommandKind kind, long number, double x, double y)
{
    const Command command = {.kind = kind, .number = number, .x = x, .y = y};
    CHECK_OK(past_edit(&past, &command, ALL_PANES, false, 0));
}

enum { STEPS = 48 };

/* Goes to each step `from` ... `to` and stores its hash. hash [to + 1] out */
static void go_to_each_step(long from, long to, uint64_t *hash)
{
    for (long step = from; step <= to; step++)
        hash[step] = go_to_step(step);
}

/* Returns the distance of tested steps: `all` in long tests, else `some`. */
static int choose_stride(int all, int some)
{
    return tests_are_long() ? all : some;
}

/* Checks that steps have the same bits in whichever order they are visited. */
static void check_all_steps(long steps, const uint64_t *hash)
{
    Random random = {7};
    for (long step = steps; step >= 0; step -= choose_stride(3, 9))
        CHECK(go_to_step(step) == hash[step]);
    for (int i = 0; i < 20; i += choose_stride(1, 3)) {
        int step = random_below(&random, (int)steps + 1);
        CHECK(go_to_step(step) == hash[step]);
    }
    for (long step = steps / 2; step <= steps; step++)
        CHECK(go_to_step(step) == hash[step]);
}

static const char *const lines[] = {
    "square --segments 3",
    "square --segments 3 --projection on-demand --stretch 0.6 --timestep 0.01",
    "square --segments 3 --integrator bdf2",
    "square --segments 3 --integrator verlet --timestep 0.0005",
    "square --segments 3 --integrator sdirk2 --solver multigrid",
    "circle",
    "hang --segments 3",
    "slope",
    "dent --segments 4",
    "tear --segments 4",
    "bend",
    "arrows",
    "spring",
};
enum { COMMAND_LINE_COUNT = sizeof lines / sizeof *lines };

/* States equal those of an uninterrupted simulation, also with memory for a few
 * states, of which only every 2^k-th is kept. */
TEST(states_come_back)
{
    for (int i = 0; i < 2 * COMMAND_LINE_COUNT; i += choose_stride(1, 3)) {
        uint64_t hash[STEPS + 1];
        Simulation plain;
        begin_past(lines[i % COMMAND_LINE_COUNT]);
        bool thinned = i >= COMMAND_LINE_COUNT;
        if (thinned)
            past.max_bytes = 5 * past.used_bytes;
        go_to_each_step(0, STEPS, hash);
        CHECK(past.used_bytes <= past.max_bytes);
        CHECK((past.branch[0].stride >= STEPS / 8) == thinned);
        simulation_from_line(lines[i % COMMAND_LINE_COUNT], NULL, NULL, &plain);
        for (int step = 0; step <= STEPS; step++) {
            CHECK(hash_simulation(&plain, STATE_HASH_SEED) == hash[step]);
            simulation_step(&plain);
        }
        simulation_free(&plain);
        check_all_steps(STEPS, hash);
        CHECK(past_find_newest(&past) == STEPS &&
              past.used_bytes <= past.max_bytes);
        past_free(&past);
    }
}

/* A pane that ended while another pane went on has the same states again at
 * random steps, with memory for all states or for a few. */
TEST(a_pane_that_has_ended_comes_back)
{
    enum { STEPS = 60 };
    const Command restart = {.kind = COMMAND_RESTART};
    Random random = {7};
    uint64_t hash[STEPS + 1];
    Options options[2];
    options[0] = options_from_line("square --integrator symplectic-euler "
                                   "--timestep 0.008");
    options[1] = options_from_line("square --timestep 0.008");
    for (int few = 0; few < 2; few++) {
        past_create(true, true, &past);
        CHECK_OK(past_begin_runs(&past, options, 2, 0, &restart));
        past.max_bytes = few ? 5 * past.used_bytes : PAST_BYTES;
        for (long step = 0; step <= STEPS; step++) {
            past_set_goal(&past, step, false);
            CHECK((past_finish_work(&past) == STATUS_NOT_FINITE) ==
                  (step == 12));
            CHECK(!few || hash[step] == hash_past());
            hash[step] = hash_past();
        }
        CHECK(past_find_made_step(&past, 0, STEPS) == 11 &&
              past.used_bytes <= past.max_bytes &&
              past_find_made_step(&past, 1, STEPS) == STEPS);
        for (int i = 0; i < 50; i++) {
            long step = random_below(&random, STEPS + 1);
            CHECK(go_to_step(step) == hash[step]);
        }
        past_free(&past);
    }
}

/* Each edit begins a branch; all branches share one limit of memory. */
TEST(states_of_many_edits_have_a_limit)
{
    begin_past("square --segments 3");
    past.max_bytes = 6 * past.used_bytes;
    for (int i = 1; i <= 30; i++) {
        edit_past(COMMAND_PIN, 1, i % 2, 0);
        go_to_step(i);
    }
    CHECK(past.branch_count == 31 && past.used_bytes <= past.max_bytes);
    past_free(&past);
}

/* An edit of the same gesture discards the edits that were undone before. */
TEST(an_edit_ends_what_was_undone)
{
    const Command grab = {.kind = COMMAND_GRAB, .number = 5};
    const Command add = {.kind = COMMAND_ADD_PANE};
    begin_past("square --segments 3");
    CHECK_OK(past_edit(&past, &grab, 0, false, 7));
    CHECK_OK(past_edit(&past, &add, ALL_PANES, false, 0));
    past_undo_or_redo(&past, -1);
    CHECK_OK(past_edit(&past, &grab, 0, false, 7));
    CHECK(!past_undo_or_redo(&past, 1));
    past_free(&past);
}

TEST(commands_are_written_as_they_are_read)
{
    char message[256], line[160], again[160];
    for (int kind = COMMAND_QUIT; kind < COMMAND_KIND_COUNT; kind++) {
        Command command = {(CommandKind)kind, 7, 0.1, -3, "word",
                           kind % 2 == 0},
                read;
        if (!command_rows[kind].name)
            continue;
        command_format(&command, line, sizeof line);
        CHECK_OK(command_parse(line, &read, MESSAGE(message)));
        command_format(&read, again, sizeof again);
        CHECK(read.kind == command.kind && strcmp(line, again) == 0);
    }
    static const char *const bad[] = {
        "", "jump", "goto -1", "goto 1 2", "drag 1", "drag 1 nan", "set a b c"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        Command command;
        CHECK_STATUS(command_parse(bad[i], &command, MESSAGE(message)),
                     STATUS_INVALID_INPUT);
        CHECK(message[0] != '\0');
    }
}

TEST(keys_are_given_once)
{
    CHECK(command_from_key("R", true, SCOPE_RUN).kind == COMMAND_NONE);
    for (int kind = 1; kind < COMMAND_TYPE_ANSWER; kind++) {
        const char *all = command_rows[kind].keys;
        for (; all && *all; all += *all == '|') {
            char key[16];
            size_t length = strcspn(all, "|");
            snprintf(key, sizeof key, "%.*s", (int)length, all);
            CHECK((int)command_from_key(key, false, SCOPE_RUN).kind == kind);
            all += length;
        }
    }
}

/* ---- the hand ------------------------------------------------------------ */

/* Returns the kinetic energy of the change of velocities, v - v_n, J. */
static double find_motion_change(const Simulation *simulation,
                                 const double *v_n)
{
    const double *v = simulation->run[0].v;
    double sum = 0;
    for (int i = 0; i < 2 * simulation->system.nodes; i++)
        sum += simulation->system.m[i / 2] * (v[i] - v_n[i]) * (v[i] - v_n[i]);
    return 0.5 * sum;
}

/* Changes the time step every ten steps; grabs, drags and releases a node. */
static void drag_randomly(Random *random, int step)
{
    double h = random_logarithmic(random, 1e-4, 1);
    if (step % 10 == 0)
        edit_past(COMMAND_SET, option_find("timestep") - option_rows, h, 0);
    if (step % 25 == 0)
        edit_past(COMMAND_GRAB,
                  random_below(random, past.pane[0].simulation.system.nodes),
                  random_uniform(random, -1, 1), random_uniform(random, -1, 1));
    else if (step % 25 == 20)
        edit_past(COMMAND_RELEASE, 0, 0, 0);
    else if (past_get_control(&past, 0)->held_node >= 0)
        edit_past(COMMAND_DRAG, 0, random_uniform(random, -5, 5),
                  random_uniform(random, -5, 5));
}

/* Makes a step after a jerk, and checks that no update raises E. After backward
 * Euler sum m |v - v_n|^2/2 + P is at most the start's sum m |v_n|^2/2 + P plus
 * the work of the hand, up to rounding (P: potential, v_n: old velocities).
 * Returns false above 1e20 J, which undamped methods may reach, and after an
 * explicit step that overflowed and changed nothing. */
static bool make_step_after_drag(bool descends)
{
    const Simulation *simulation = &past.pane[0].simulation;
    const TimeIntegrator *run = &simulation->run[0];
    int size = 2 * simulation->system.nodes;
    Energies energies = simulation_get_energies(simulation, 0);
    double v[MAX_COORDINATES * 3], high = energies.total - energies.work;
    long before = past.shown_step;
    memcpy(v, run->v, (size_t)size * sizeof *v);
    past_set_goal(&past, before + 1, false);
    Status status = past_finish_work(&past);
    if (status && !status_is_unconverged(status)) {
        CHECK(!run->newton && status == STATUS_NOT_FINITE);
        CHECK_SAME_BITS(run->v, v, size);
        return false;
    }
    CHECK(past.shown_step == before + 1);
    const NewtonRecords *records = &past.pane[0].newton_records;
    for (int i = 0; i < records->count; i++)
        CHECK(records->record[i].energy_change <= 0);
    for (int k = 0; k < size; k++)
        CHECK(isfinite(run->x[k]) && isfinite(run->v[k]));
    Energies now = simulation_get_energies(simulation, 0);
    if (!descends && !(now.total < 1e20))
        return false;
    CHECK(isfinite(now.total) && isfinite(now.work));
    if (descends)
        CHECK_AT_MOST(find_motion_change(simulation, v) + now.total -
                          now.kinetic - now.work,
                      high + 1e-12 * (now.total + fabs(now.work)));
    return true;
}

/* Every step ends, whatever the jerks of the mouse, the time step and the
 * method. A run with too much energy (runaway) begins again. */
TEST(random_drags_end)
{
    const int steps = choose_case_count(10000, 150);
    Random random = {2026};
    for (int i = 0; integrator_methods[i / 2].name; i++) {
        const IntegratorMethod *method = &integrator_methods[i / 2];
        bool euler = strcmp(method->name, "backward-euler") == 0;
        char line[160];
        snprintf(line, sizeof line,
                 "square --segments %d --integrator %s --solver %s", 2 + i % 3,
                 method->name, i % 2 ? "multigrid" : "newton");
        begin_past(line);
        int runaways = 0;
        for (int step = 0; step < steps; step++) {
            drag_randomly(&random, step);
            if (make_step_after_drag(euler))
                continue;
            past_free(&past);
            begin_past(line);
            runaways++;
        }
        /* Explicit steps overflow every twentieth time, above their stability
         * limit; backward Euler and BDF2 never do. */
        print_message("  %-16s %d runaways\n", method->name, runaways);
        bool damps = euler || strcmp(method->name, "bdf2") == 0;
        CHECK(damps ? runaways == 0 : method->stages > 0 || runaways > 0);
        past_free(&past);
    }
}

TESTS(NULL, NULL)
