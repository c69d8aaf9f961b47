/* The one past: every state comes back to the last bit, whatever was kept,
 * thrown away, changed, undone and done again; commands.
 */
#include "pasts.h"

#include <stdio.h>

#include "model/contact.h"

enum { STEPS = 48 };

/* hash [to + 1] out: of the steps from ... to. */
static void run(long from, long to, uint64_t *hash)
{
    for (long step = from; step <= to; step++)
        hash[step] = show(step);
}

/* From one step to the next that is looked at. */
static int stride(int all, int some)
{
    return tests_are_long() ? all : some;
}

/* Every way back to a step gives its bits: backwards, at random, forwards. */
static void check_all_steps(long steps, const uint64_t *hash)
{
    Random random = {7};
    for (long step = steps; step >= 0; step -= stride(3, 9))
        CHECK(show(step) == hash[step]);
    for (int i = 0; i < 20; i += stride(1, 3)) {
        int step = random_below(&random, (int)steps + 1);
        CHECK(show(step) == hash[step]);
    }
    for (long step = steps / 2; step <= steps; step++)
        CHECK(show(step) == hash[step]);
}

static const char *const lines[] = {
    "square --segments 3",
    "square --segments 3 --solver multigrid",
    "square --segments 3 --filter on-demand --stretch 0.6 --timestep 0.01",
    "square --segments 3 --integrator bdf2",
    "square --segments 3 --integrator verlet --timestep 0.0005",
    "square --segments 3 --integrator sdirk2 --solver multigrid",
    "square --segments 3 --integrator avf4",
    "circle",
    "unprojected --segments 2",
    "square --segments 9 --solver multigrid",
    "hang --segments 3",
    "drop --segments 3",
    "slope",
    "dent --segments 4",
    "tear --segments 4",
    "squeeze --segments 4",
    "bend",
    "arrows",
    "spring",
};
enum { LINES = sizeof lines / sizeof *lines };

/* As a simulation makes them that nobody ever stops; also where there is room
 * for a few states: then only every 2^k-th is kept. */
TEST(states_come_back)
{
    for (int i = 0; i < 2 * LINES; i += stride(1, 3)) {
        uint64_t hash[STEPS + 1];
        Simulation plain;
        begin_past(lines[i % LINES]);
        bool thinned = i >= LINES;
        if (thinned)
            past.limit = 5 * past.bytes;
        run(0, STEPS, hash);
        CHECK(past.bytes <= past.limit);
        CHECK((past.branch[0].stride >= STEPS / 8) == thinned);
        simulation_from_line(lines[i % LINES], NULL, NULL, &plain);
        for (int step = 0; step <= STEPS; step++) {
            CHECK(hash_of(&plain, STATE_HASH_SEED) == hash[step]);
            simulation_step(&plain);
        }
        simulation_free(&plain);
        check_all_steps(STEPS, hash);
        CHECK(past_newest(&past) == STEPS && past.bytes <= past.limit);
        past_free(&past);
    }
}

/* A pane that has ended beside another one: the same states from random steps,
 * with all states kept and with a handful. */
TEST(a_pane_that_has_ended_comes_back)
{
    enum { STEPS = 60 };
    const Command restart = {.kind = COMMAND_RESTART};
    Random random = {7};
    uint64_t hash[STEPS + 1];
    Options options[2];
    options[0] = line_options("square --integrator symplectic-euler "
                              "--timestep 0.008");
    options[1] = line_options("square --timestep 0.008");
    for (int few = 0; few < 2; few++) {
        past_create(true, true, &past);
        CHECK_STATUS(past_begin(&past, options, 2, 0, &restart), STATUS_OK);
        past.limit = few ? 5 * past.bytes : PAST_BYTES;
        for (long step = 0; step <= STEPS; step++) {
            past_aim(&past, step, false);
            CHECK((past_finish(&past) == STATUS_NOT_FINITE) == (step == 12));
            CHECK(!few || hash[step] == hash_now());
            hash[step] = hash_now();
        }
        CHECK(past_ended(&past, 0, STEPS) == 11 && past.bytes <= past.limit &&
              past_ended(&past, 1, STEPS) < 0);
        for (int i = 0; i < 50; i++) {
            long step = random_below(&random, STEPS + 1);
            CHECK(show(step) == hash[step]);
        }
        past_free(&past);
    }
}

/* A change that counts from the step before leaves what was changed after it,
 * also where work on it is given up. */
TEST(a_step_is_made_again)
{
    begin_past("square --segments 3");
    show(1);
    show(2);
    set_option("stiffness 2e5", false);
    set_option("timestep 0.003", true);
    past_aim(&past, 2, false);
    past_iterate(&past);
    past_iterate(&past);
    past_aim(&past, past.step, false);
    show(2);
    CHECK(past_control(&past, 0)->options.stiffness == 2e5);
    CHECK(past_entry(&past, 0, 1)->control->options.stiffness != 2e5);
    past_free(&past);
}

/* Changes of one gesture are one branch, which goes on with its steps. */
TEST(a_gesture_is_undone_as_a_whole)
{
    uint64_t hash[9];
    begin_past("square --segments 3");
    run(0, 3, hash);
    const double *x = past.machine[0].simulation.run[0].x;
    Command grab = {.kind = COMMAND_GRAB, .number = 5, .x = x[10], .y = x[11]};
    CHECK_STATUS(try_edit(&grab, false, 7), STATUS_OK);
    for (long step = 4; step <= 8; step++) {
        Command drag = {.kind = COMMAND_DRAG, .x = 0.1 * (double)step, .y = 1};
        CHECK_STATUS(try_edit(&drag, false, 7), STATUS_OK);
        hash[step] = show(step);
    }
    CHECK(past.branches == 2);
    check_all_steps(8, hash);
    show(8);
    past_undo(&past, -1);
    CHECK_STATUS(past_finish(&past), STATUS_OK);
    CHECK(past.step == 3 && hash_now() == hash[3] && past_newest(&past) == 3);
    past_undo(&past, 1);
    CHECK_STATUS(past_finish(&past), STATUS_OK);
    CHECK(past.step == 8 && hash_now() == hash[8]);
    const Command add = {.kind = COMMAND_ADD_PANE};
    CHECK_STATUS(past_edit(&past, &add, 0, 0, false, 0), STATUS_OK);
    past_undo(&past, -1);
    CHECK_STATUS(try_edit(&grab, false, 7), STATUS_OK); /* goes on with it: */
    CHECK(!past_undo(&past, 1)); /* the panes were of another end */
    past_free(&past);
    begin_past("arrows --integrator backward-euler");
    show(1);
    for (int i = 1; i <= 3; i++) {
        Command drag = {.kind = COMMAND_HANDLE, .x = i, .y = 0.5};
        CHECK_STATUS(try_edit(&drag, false, 7), STATUS_OK);
        CHECK(past.branches == 2);
    }
    uint64_t dragged = hash_now();
    show(2);
    CHECK(show(0) != dragged && show(1) == dragged);
    past_free(&past);
}

/* ---- anything in any order ------------------------------------------------
 */

/* What was seen when a step was first made, as each branch has it. */
enum { LAST = 12, DEPTH = 40, PANES = 3 };
static uint64_t truth[DEPTH][LAST + 1][PANES];

/* The state that is shown, if it is a new one; else it has been seen. */
static void look(bool fresh)
{
    for (int p = 0; p < past_panes(&past); p++) {
        const Simulation *simulation = &past.machine[p].simulation;
        uint64_t hash = hash_of(simulation, STATE_HASH_SEED);
        CHECK(fresh || truth[past.now][past.step][p] == hash);
        truth[past.now][past.step][p] = hash;
    }
}

static void visit(long step, bool again)
{
    bool fresh = step > past_newest(&past);
    past_aim(&past, step, again);
    CHECK_STATUS(past_finish(&past), STATUS_OK);
    CHECK(past.step == step);
    look(fresh);
}

/* Work that is given up somewhere, or not. */
static void visit_in_part(Random *random)
{
    long newest = past_newest(&past);
    past_aim(&past, random_below(random, (int)newest + 2),
             random_below(random, 2));
    for (int k = random_below(random, 9); k > 0 && past.works; k--)
        past_iterate(&past);
    past_aim(&past, past.step, false);
    CHECK_STATUS(past_finish(&past), STATUS_OK);
    look(past_newest(&past) > newest);
}

/* A change of a random kind in all panes, or a number in one. */
static Command random_edit(Random *random, int kind)
{
    static const char *const settings[] = {
        "timestep 0.01",  "timestep 0.003", "stiffness 2e4",
        "stiffness 1e5",  "filter none",    "filter clamp",
        "tolerance 1e-6", "integrator avf", "integrator backward-euler"};
    const Simulation *simulation = &past.machine[0].simulation;
    const double *x = simulation->run[0].x;
    double at[SCENE_MAX_HANDLES][2];
    int nodes = simulation->system.nodes;
    int node = random_below(random, nodes < 2 ? nodes : 2);
    bool pinned = simulation->system.pinned[node];
    Command edit = {0};
    char message[256], line[40];
    bool mesh = simulation->scene->needs & NEEDS_MESH;
    int all = contact_of(&simulation->system) ? 7 : mesh ? 9 : 2;
    snprintf(line, sizeof line, "set %s", settings[random_below(random, all)]);
    CHECK_STATUS(command_parse(line, &edit, message, sizeof message),
                 STATUS_OK);
    if (kind < 2)
        return edit;
    edit = (Command){.number = node};
    edit.x = x[0] + random_uniform(random, -0.1, 0.1);
    edit.y = x[1] + random_uniform(random, -0.1, 0.1);
    if (kind < 4)
        edit.kind = COMMAND_PIN;
    else if (exhibit_handles(simulation, at) > 0)
        edit.kind = COMMAND_HANDLE;
    else if (past_control(&past, 0)->hand < 0)
        edit.kind = COMMAND_GRAB;
    else
        edit.kind = kind < 5 ? COMMAND_DRAG : COMMAND_RELEASE;
    if (edit.kind == COMMAND_PIN)
        edit.x = !pinned;
    return edit;
}

static void change_at_random(Random *random, int gesture)
{
    int kind = random_below(random, 6), panes = past_panes(&past);
    int now = past.now, one = random_below(random, 2 * panes);
    bool all = kind > 1 || one >= panes;
    bool again = kind < 2 && past.step > 0 && random_below(random, 3) == 0;
    const Command edit = random_edit(random, kind);
    CHECK_STATUS(past_edit(&past, &edit, all ? 0 : one, all ? panes : one + 1,
                           again, gesture),
                 STATUS_OK);
    const double *x = past.machine[0].simulation.run[0].x;
    CHECK(edit.kind != COMMAND_HANDLE || (x[0] == edit.x && x[1] == edit.y));
    if (past.now != now)
        memcpy(truth[past.now], truth[now], sizeof *truth);
    past_aim(&past, past.step, false);
    CHECK_STATUS(past_finish(&past), STATUS_OK);
    look(true); /* a node that was pinned has stopped */
    if (again)
        visit(past.step + 1, false);
}

static void change_panes(int panes)
{
    int had = past_panes(&past), now = past.now;
    const Command edit = {.kind = panes > had ? COMMAND_ADD_PANE
                                              : COMMAND_END_PANE};
    if (panes < 1 || panes > PANES)
        return;
    CHECK_STATUS(past_edit(&past, &edit, 0, 0, false, 0), STATUS_OK);
    memcpy(truth[past.now], truth[now], sizeof *truth);
    for (int step = 0; step <= LAST && panes > had; step++)
        truth[past.now][step][had] = truth[now][step][had - 1];
    look(false);
}

static void undo_at_random(int way)
{
    if (past_undo(&past, way)) {
        CHECK_STATUS(past_finish(&past), STATUS_OK);
        look(false);
    }
}

static void play_at_random(const char *line, uint64_t seed, size_t states)
{
    Random random = {seed};
    int gesture = 1;
    begin_past(line);
    past.limit = states * past.bytes;
    look(true);
    for (int i = 0; i < 80; i++) {
        long newest = past_newest(&past), step = past.step;
        int kind = random_below(&random, 16), way = random_below(&random, 2);
        bool deep = past.now + 2 == DEPTH;
        gesture += random_below(&random, 6) == 0;
        if (kind < 4 && newest < LAST)
            visit(newest + 1, false);
        else if (kind < 6)
            visit(random_below(&random, (int)newest + 1), way);
        else if (kind < 8)
            undo_at_random(2 * way - 1);
        else if (kind < 11 && newest < LAST)
            visit_in_part(&random);
        else if (kind < 12 && !deep)
            change_panes(past_panes(&past) + 2 * way - 1);
        else if (!deep)
            change_at_random(&random, gesture);
        else if (step > 0)
            visit(step - 1, false);
    }
    while (past_undo(&past, -1))
        continue;
    do {
        CHECK_STATUS(past_finish(&past), STATUS_OK);
        for (long step = past_newest(&past); step >= 0; step--)
            visit(step, false);
        for (long step = 0; step <= past_newest(&past); step++)
            visit(step, false);
    } while (past_undo(&past, 1));
    past_free(&past);
}

/* Steps, changes of all kinds, undo, work that is given up, with plenty of
 * memory or little: each step as each branch has it is always the same. */
TEST(anything_in_any_order)
{
    static const char *const some[] = {
        "square --segments 2", "drop --segments 2",
        "square --segments 2 --integrator avf4", "squeeze --segments 2",
        "arrows --integrator backward-euler"};
    static const size_t states[] = {1, 6, 1000};
    for (int seed = 1; seed <= (tests_are_long() ? 100 : 6); seed++)
        for (int i = 0; i < 5; i++)
            play_at_random(some[i], (uint64_t)seed, states[seed % 3]);
}

/* What is written can be read, and is the same. */
TEST(commands_are_written_as_they_are_read)
{
    char message[256], line[160], again[160];
    for (int kind = COMMAND_QUIT; kind < COMMAND_KINDS; kind++) {
        Command command = {(CommandKind)kind, 7, 0.1, -3, "word",
                           kind % 2 == 0},
                read;
        if (!command_row((CommandKind)kind)->word)
            continue;
        command_format(&command, line, sizeof line);
        CHECK_STATUS(command_parse(line, &read, message, sizeof message),
                     STATUS_OK);
        command_format(&read, again, sizeof again);
        CHECK(read.kind == command.kind && strcmp(line, again) == 0);
    }
    static const char *const bad[] = {
        "",         "jump",   "goto",       "goto -1", "goto x",
        "goto 1 2", "drag 1", "drag 1 nan", "quit 1",  "set a b c"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        Command command;
        CHECK_STATUS(command_parse(bad[i], &command, message, sizeof message),
                     STATUS_INVALID_INPUT);
        CHECK(message[0] != '\0');
    }
}

/* No key asks for two things at once. */
TEST(keys_are_given_once)
{
    CHECK(command_from_key("R", true, AT_RUN).kind == COMMAND_NONE);
    for (int kind = 1; kind < COMMAND_TYPE_NUMBER; kind++) {
        const char *all = command_row((CommandKind)kind)->keys;
        for (; all && *all; all += *all == '|') {
            char key[16];
            size_t length = strcspn(all, "|");
            snprintf(key, sizeof key, "%.*s", (int)length, all);
            CHECK((int)command_from_key(key, false, AT_RUN).kind == kind);
            all += length;
        }
    }
}

TESTS(NULL, NULL)
