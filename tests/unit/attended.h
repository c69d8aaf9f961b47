/* attended.h - a player that a script leads, without a window */
#ifndef ELASTO_ATTENDED_H
#define ELASTO_ATTENDED_H

#include "testing.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "play/playing.h"

static Player player;
static volatile sig_atomic_t stop;

/* Creates a player with a script, which makes it store its past steps. */
static inline void begin_scripted_player(const char *script, const char *line)
{
    static Options options[OPTIONS_MAX_PANES];
    static char name[] = "/tmp/elasto-test-XXXXXX";
    static char copy[256]; /* the options point into this text */
    char message[256] = "";
    char *argv[32] = {(char[]){"elasto"}, (char[]){"--script"}, name,
                      (char[]){"--headless"}, (char[]){"--quiet"}};
    int argc = 5, count = 1;
    stop = 0;
    memcpy(name + strlen(name) - 6, "XXXXXX", 6);
    int file = mkstemp(name);
    ssize_t size = (ssize_t)strlen(script);
    assert_true(file >= 0 && write(file, script, (size_t)size) == size);
    close(file);
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word = strtok(copy, " "); word; word = strtok(NULL, " "))
        argv[argc++] = word;
    for (int i = 0; i < count; i++) {
        CHECK_OK(options_parse(argc, argv, i, &options[i], MESSAGE(message)));
        count = options[0].panes;
    }
    CHECK_OK(player_create(options, NULL, NULL, &stop, &player));
    unlink(name);
}

static inline void begin_player(const char *line)
{
    begin_scripted_player("0 play\n", line);
}

static inline void end_player(void)
{
    CHECK_OK(player_close_files(&player, STATUS_OK));
    player_free(&player);
}

static inline Status obey_command(const char *line)
{
    Command command;
    char message[128];
    CHECK_OK(command_parse(line, &command, MESSAGE(message)));
    return player_obey(&player, &command);
}

static inline const PastPane *get_past_pane(int pane)
{
    return &player.past.pane[pane];
}

#endif
