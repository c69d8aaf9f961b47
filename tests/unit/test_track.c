/* Going back and on: every state is the same to the last bit, whatever was kept
 * and whatever was changed; scripts and commands.
 */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "model/contact.h"
#include "model/fracture.h"
#include "model/plasticity.h"
#include "play/track.h"

enum { STEPS = 70 };

/* Options of this command line. */
static Options line_options(const char *line)
{
    Simulation simulation;
    simulation_from_line(line, NULL, NULL, &simulation);
    Options options = simulation.options;
    simulation_free(&simulation);
    return options;
}

static void begin(const char *line, Track *track)
{
    Options options = line_options(line);
    CHECK_STATUS(track_create(&options, true, NULL, NULL, track), STATUS_OK);
}

static uint64_t hash_of(const Track *track)
{
    return state_hash(&track->simulation, STATE_HASH_SEED);
}

/* hash [steps + 1] out: of each step. */
static void run(Track *track, int steps, uint64_t *hash)
{
    hash[0] = hash_of(track);
    for (int i = 1; i <= steps; i++) {
        Status status = track_step(track);
        CHECK(!status || status_is_unconverged(status));
        CHECK(track_step_shown(track) == i);
        hash[i] = hash_of(track);
    }
}

/* From one step to the next that is looked at. */
static int stride(int all, int some)
{
    return tests_are_long() ? all : some;
}

/* Every way back to a step gives its bits: forwards, backwards, at random. */
static void check_all_steps(Track *track, int steps, const uint64_t *hash)
{
    Random random = {7};
    for (int i = steps; i >= 0; i -= stride(3, 9)) {
        CHECK_STATUS(track_show(track, i), STATUS_OK);
        CHECK(track_step_shown(track) == i && hash_of(track) == hash[i]);
    }
    for (int i = 0; i < 20; i += stride(1, 3)) {
        int step = random_below(&random, steps + 1);
        CHECK_STATUS(track_show(track, step), STATUS_OK);
        CHECK(hash_of(track) == hash[step]);
    }
}

/* From an old step on: the same steps again. */
static void check_going_on(Track *track, int from, int steps,
                           const uint64_t *hash)
{
    CHECK_STATUS(track_show(track, from), STATUS_OK);
    for (int i = from + 1; i <= steps; i++) {
        Status status = track_step(track);
        CHECK(!status || status_is_unconverged(status));
        CHECK(hash_of(track) == hash[i]);
        CHECK(track->newest == i);
    }
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
    "bend",
};

TEST(states_come_back)
{
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        Track track;
        uint64_t hash[STEPS + 1];
        begin(lines[i], &track);
        run(&track, STEPS, hash);
        check_all_steps(&track, STEPS, hash);
        for (int from = STEPS - 1; from > 0; from -= stride(14, 42))
            check_going_on(&track, from, STEPS, hash);
        track_free(&track);
    }
}

/* With room for five states only every 2^k-th is kept, within the limit. */
TEST(thinned_states_come_back)
{
    for (size_t i = 0; i < sizeof lines / sizeof *lines;
         i += (size_t)stride(1, 2)) {
        Track track;
        uint64_t hash[STEPS + 1];
        begin(lines[i], &track);
        track.limit = track_bytes(&track) + STEPS * TRACK_STEP_BYTES +
                      4 * state_size(&track.simulation);
        run(&track, STEPS, hash);
        CHECK(track_bytes(&track) <= track.limit && track.stride >= STEPS / 8);
        CHECK(track_bytes(&track) >= track.used + STEPS * TRACK_STEP_BYTES);
        CHECK(track.kept_count >= 2);
        check_all_steps(&track, STEPS, hash);
        check_going_on(&track, 33, STEPS, hash);
        CHECK(track_bytes(&track) <= track.limit);
        size_t used = 0;
        for (long k = 0; k < track.kept_count; k++)
            used += track.kept[k].size;
        CHECK(track.used == used);
        track_free(&track);
    }
}

/* A state that fits nowhere leaves step 0, from which all can be repeated. */
TEST(one_state_is_enough)
{
    Track track;
    uint64_t hash[13];
    begin("square --segments 2", &track);
    track.limit = 1;
    run(&track, 12, hash);
    CHECK(track.kept_count == 1);
    check_all_steps(&track, 12, hash);
    track_free(&track);
}

/* Scenes without time have no state: they are begun again. */
TEST(iterations_come_back)
{
    const char *scene[] = {"overshoot --line-search backtrack", "landscape"};
    for (int i = 0; i < 2; i++) {
        Track track;
        uint64_t hash[5];
        begin(scene[i], &track);
        CHECK(state_size(&track.simulation) == 0);
        run(&track, 4, hash);
        check_all_steps(&track, 4, hash);
        track_free(&track);
    }
}

static void change(Track *track, const char *line)
{
    Command command;
    char message[256];
    CHECK_STATUS(command_parse(line, &command, message, sizeof message),
                 STATUS_OK);
    if (command.kind == COMMAND_PIN)
        command.x = command.number < 100;
    CHECK_STATUS(track_change(track, &command, message, sizeof message),
                 STATUS_OK);
}

/* All that may change, each while the run goes on; time goes on with the new
 * timestep. */
TEST(changes_are_repeated)
{
    static const char *const changes[] = {
        "set timestep 0.01",   "set stiffness 2e4",     "pin 3",
        "set filter none",     "set solver multigrid",  "set timestep 0.002",
        "set integrator bdf2", "set filter on-demand",  "pin 12",
        "set tolerance 1e-6",  "set integrator verlet", "set timestep 0.0003",
        "set integrator avf",  "set line-search none",  "set timestep 0.005",
    };
    enum { CHANGES = sizeof changes / sizeof *changes, ALL = 4 * CHANGES + 4 };
    for (int limit = 0; limit < 2; limit++) {
        Track track;
        uint64_t hash[ALL + 1];
        begin("square --segments 3", &track);
        if (limit)
            track.limit = track_bytes(&track) + ALL * TRACK_STEP_BYTES +
                          CHANGES * sizeof(ScriptLine) +
                          5 * state_size(&track.simulation);
        hash[0] = hash_of(&track);
        for (int i = 0; i < ALL; i++) {
            if (i % 4 == 3 && i / 4 < CHANGES)
                change(&track, changes[i / 4]);
            hash[i] = hash_of(&track); /* a pinned node has stopped */
            Status status = track_step(&track);
            CHECK(!status || status_is_unconverged(status));
            hash[i + 1] = hash_of(&track);
        }
        CHECK_NEAR(simulation_time(&track.simulation),
                   3 * 0.004 + 20 * 0.01 + 24 * 0.002 + 12 * 0.0003 + 5 * 0.005,
                   1e-12);
        CHECK(simulation_is_pinned(&track.simulation, 3));
        check_all_steps(&track, ALL, hash);
        CHECK_STATUS(track_show(&track, 2), STATUS_OK);
        CHECK(!simulation_is_pinned(&track.simulation, 3));
        CHECK(track.settings.options.timestep == 0.004);
        track_free(&track);
    }
}

/* Another stiffness while the run goes on leaves what elements have been
 * through: plastic strains, broken springs, obstacles that moved; and the
 * ledger books what it did to the energy as work, so that nothing else in it
 * jumps. */
TEST(elements_keep_their_past)
{
    static const struct {
        const char *line;
        int steps;
    } rows[] = {{"dent --segments 5", 130},
                {"tear --segments 8", 90},
                {"squeeze --segments 3", 40},
                {"slope", 20}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Track track;
        uint64_t hash[201];
        int steps = rows[i].steps;
        begin(rows[i].line, &track);
        run(&track, steps, hash);
        Simulation *simulation = &track.simulation;
        System *system = &simulation->system;
        Plasticity *plastic = plasticity_of(system);
        Energies before = simulation_energies(simulation, 0);
        size_t springs = (size_t)system->springs;
        double *k = calloc(3 * springs, sizeof *k);
        memcpy(k, system->k, springs * sizeof *k);
        double stored = 0;
        for (size_t s = 0; plastic && s < springs; s++)
            stored += fabs(k[springs + s] = plastic->ep[s]);
        int broken = system->breaks ? fracture_of(system)->broken : -1;
        CHECK(!plastic || stored > 0.1);
        CHECK(!system->breaks || broken > 0);
        Obstacle wall = {0};
        int last = contact_of(system) ? contact_of(system)->obstacles - 1 : 0;
        if (contact_of(system))
            wall = contact_of(system)->obstacle[last];
        change(&track, "set stiffness 3e4");
        plastic = plasticity_of(system);
        for (size_t s = 0; s < springs; s++) {
            CHECK(system->k[s] == (k[s] == 0 ? 0 : 3e4));
            CHECK(!plastic || plastic->ep[s] == k[springs + s]);
        }
        if (contact_of(system))
            CHECK(memcmp(&wall, contact_of(system)->obstacle + last,
                         sizeof wall) == 0);
        CHECK(broken < 0 || fracture_of(system)->broken == broken);
        CHECK(hash_of(&track) == hash[steps]);
        Energies after = simulation_energies(simulation, 0);
        CHECK(OF(&before, plastic) == OF(&after, plastic));
        CHECK(OF(&before, fracture) == OF(&after, fracture));
        CHECK_NEAR(after.dissipated, before.dissipated,
                   1e-9 * (1 + fabs(after.total)));
        for (int s = steps; s < steps + 3; s++) {
            CHECK(!track_step(&track));
            hash[s + 1] = hash_of(&track);
        }
        check_all_steps(&track, steps + 3, hash);
        free(k);
        track_free(&track);
    }
}

/* A step or a change at an old step forgets the later ones. */
TEST(going_on_forgets)
{
    Track track;
    uint64_t hash[11];
    begin("square --segments 2", &track);
    run(&track, 10, hash);
    CHECK_STATUS(track_show(&track, 6), STATUS_OK);
    CHECK(track.newest == 10);
    change(&track, "set timestep 0.008");
    CHECK(track.newest == 6 && track_row(&track, 6)->updates >= 0);
    CHECK_STATUS(track_step(&track), STATUS_OK);
    CHECK(track.newest == 7 && hash_of(&track) != hash[7]);
    CHECK_STATUS(track_show(&track, 5), STATUS_OK);
    CHECK_STATUS(track_step(&track), STATUS_OK);
    CHECK(track.newest == 6 && hash_of(&track) == hash[6]);
    CHECK(track.settings.options.timestep == 0.004);
    track_free(&track);
}

TEST(bad_changes_change_nothing)
{
    Track track;
    char message[256];
    begin("square --segments 2", &track);
    const Command bad[] = {
        {.kind = COMMAND_SET, .text = "timestep -1"},
        {.kind = COMMAND_SET, .text = "start 1,2"},
        {.kind = COMMAND_SET, .text = "nothing 3"},
        {.kind = COMMAND_SET, .text = "filter"},
        {.kind = COMMAND_PIN, .number = 9, .x = 1},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        CHECK_STATUS(track_change(&track, &bad[i], message, sizeof message),
                     STATUS_INVALID_INPUT);
        CHECK(message[0] != '\0' && track.changes.count == 0);
    }
    track_free(&track);
}

/* A pinned node stays where it is, in every method. */
TEST(pins_hold)
{
    for (const IntegratorMethod *row = integrator_methods; row->name; row++) {
        char line[128];
        Track track;
        snprintf(line, sizeof line,
                 "square --segments 2 --timestep 0.0005 --integrator %s",
                 row->name);
        begin(line, &track);
        for (int i = 0; i < 5; i++)
            CHECK_STATUS(track_step(&track), STATUS_OK);
        const double *x = track.simulation.run[0].x;
        double at[2] = {x[0], x[1]}, other = x[2];
        change(&track, "pin 0");
        for (int i = 0; i < 5; i++)
            CHECK_STATUS(track_step(&track), STATUS_OK);
        x = track.simulation.run[0].x;
        CHECK(x[0] == at[0] && x[1] == at[1] && x[2] != other);
        CHECK(track.simulation.run[0].v[0] == 0);
        track_free(&track);
    }
}

/* What is written can be read, and is the same. */
TEST(commands_are_written_as_they_are_read)
{
    char message[256], line[160], again[160];
    static const char *const good[] = {
        "quit",        "set timestep 0.01",
        "goto 12",     "drag 0.10000000000000001 -0.5",
        "default k",   "zoom 110 0.5 1",
        "line-search", "scene landscape",
    };
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        Command command;
        CHECK_STATUS(command_parse(good[i], &command, message, sizeof message),
                     STATUS_OK);
        command_format(&command, line, sizeof line);
        CHECK(strcmp(line, good[i]) == 0);
    }
    for (int kind = COMMAND_QUIT; kind < COMMAND_KINDS; kind++) {
        Command command = {(CommandKind)kind, 7, 0.1, -3, "a b"}, read;
        CHECK((int)command_row((CommandKind)kind)->kind == kind);
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

/* No key asks for two things. */
TEST(keys_are_given_once)
{
    static const char *const keys[] = {
        "Space", "N", "Right", "Left",  "Home",   "End", "R", "I",   "Shift+N",
        "P",     "L", "M",     "Tab+M", "Ctrl+R", "?",   "+", "F11", "Escape",
    };
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        Command command;
        int rows = 0;
        command_from_key(keys[i], false, &command);
        CHECK(command.kind != COMMAND_NONE);
        for (int kind = 0; kind < COMMAND_KINDS; kind++) {
            const char *all = command_row((CommandKind)kind)->keys;
            const char *at = all ? strstr(all, keys[i]) : NULL;
            size_t length = strlen(keys[i]);
            rows += at && (at == all || at[-1] == '|') &&
                    (at[length] == '\0' || at[length] == '|');
        }
        CHECK(rows == 1);
    }
    Command command;
    command_from_key("3", false, &command);
    CHECK(command.kind == COMMAND_SCENE && strcmp(command.text, "3") == 0);
    command_from_key("R", true, &command);
    CHECK(command.kind == COMMAND_NONE);
    command_from_key("X", false, &command);
    CHECK(command.kind == COMMAND_NONE);
}

/* Lines wait for their step unless nothing moves. */
/* Writes the text to a file and reads it as a script. */
static Status read_script(const char *name, const char *text, Script *script,
                          char *message, size_t size)
{
    FILE *file = fopen(name, "w");
    CHECK(file != NULL);
    fputs(text, file);
    fclose(file);
    return script_read(name, script, message, size);
}

TEST(scripts_wait)
{
    char name[] = "/tmp/elasto-script-XXXXXX", message[256];
    int file = mkstemp(name);
    CHECK(file >= 0);
    close(file);
    Script script; /* its last line needs no end */
    CHECK_STATUS(
        read_script(name, "# a comment\n\n0 pause\n  3 goto 2 # back\n3 play",
                    &script, message, sizeof message),
        STATUS_OK);
    CHECK(script.count == 3);
    const Command *command = script_due(&script, 0, true);
    CHECK(command && command->kind == COMMAND_PAUSE);
    CHECK(!script_due(&script, 2, true));
    command = script_due(&script, 3, true);
    CHECK(command && command->kind == COMMAND_GOTO && command->number == 2);
    command = script_due(&script, 2, false);
    CHECK(command && command->kind == COMMAND_PLAY);
    CHECK(script_is_over(&script) && !script_due(&script, 9, false));
    CHECK_STATUS(script_write(name, &script), STATUS_OK);
    script_free(&script);
    CHECK_STATUS(script_read(name, &script, message, sizeof message),
                 STATUS_OK);
    CHECK(script.count == 3 && script.line[1].step == 3);
    script_free(&script);
    CHECK_STATUS(read_script(name, "0 pause\n1 nonsense\n", &script, message,
                             sizeof message),
                 STATUS_INVALID_INPUT);
    CHECK(strstr(message, "line 2") && strstr(message, "nonsense"));
    script_free(&script);
    char line[1000];
    int most;
    memset(line, '#', sizeof line);
    memcpy(line + sizeof line - 2, "\n", 2);
    CHECK_STATUS(read_script(name, line, &script, message, sizeof message),
                 STATUS_INVALID_INPUT);
    CHECK(sscanf(message, "line 1: a line of more than %d", &most) == 1);
    for (int more = 0; more < 2; more++) { /* as it says */
        CHECK_STATUS(read_script(name, line + sizeof line - 2 - most - more,
                                 &script, message, sizeof message),
                     more ? STATUS_INVALID_INPUT : STATUS_OK);
        script_free(&script);
    }
    unlink(name);
    CHECK_STATUS(script_read(name, &script, message, sizeof message),
                 STATUS_FILE_FAILED);
    script_free(&script);
}

TESTS(NULL, NULL)
