/* pasts.h - a past without a player: what the tests of it begin with. */
#ifndef ELASTO_PASTS_H
#define ELASTO_PASTS_H

#include "test.h"

#include <stdio.h>
#include <string.h>

#include "play/past.h"

static Past past;

/* Of a state, and of what was lost until then. */
static inline uint64_t hash_of(const Simulation *simulation, uint64_t hash)
{
    hash = state_hash(simulation, hash);
    for (int i = 0; i < SYSTEM_MAX_TERMS; i++) {
        uint64_t bits;
        memcpy(&bits, &simulation->system.lost[i].energy, sizeof bits);
        hash = 31 * hash + bits;
    }
    return hash;
}

static inline uint64_t hash_now(void)
{
    uint64_t hash = STATE_HASH_SEED;
    for (int p = 0; p < past_panes(&past); p++)
        hash = hash_of(&past.machine[p].simulation, hash);
    return hash;
}

static inline void begin_past(const char *line)
{
    const Command restart = {.kind = COMMAND_RESTART};
    Options options = line_options(line);
    past_create(true, true, &past);
    CHECK_STATUS(past_begin(&past, &options, 1, 0, &restart), STATUS_OK);
}

/* Shows this step, also a new one. */
static inline uint64_t show(long step)
{
    past_aim(&past, step, false);
    Status status = past_finish(&past);
    CHECK(!status || status_is_unconverged(status));
    CHECK(past.step == step);
    return hash_now();
}

static inline Status try_edit(const Command *command, bool again, int gesture)
{
    return past_edit(&past, command, 0, past_panes(&past), again, gesture);
}

static inline void edit(CommandKind kind, long number, double x, double y)
{
    const Command command = {.kind = kind, .number = number, .x = x, .y = y};
    CHECK_STATUS(try_edit(&command, false, 0), STATUS_OK);
}

/* "timestep 0.01" */
static inline void set_option(const char *text, bool again)
{
    char line[96], message[128];
    Command command;
    snprintf(line, sizeof line, "set %s", text);
    CHECK_STATUS(command_parse(line, &command, message, sizeof message),
                 STATUS_OK);
    CHECK_STATUS(try_edit(&command, again, 0), STATUS_OK);
}

#endif
