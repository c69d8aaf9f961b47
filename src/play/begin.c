/* begin.c - from step 0: again, from another start, or another scene. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/playing.h"
#include "scenes/scene.h"

Status player_scene_options(Player *player, const char *name,
                            Options options[OPTIONS_MAX_PANES], int *count)
{
    char program[] = "elasto", word[COMMAND_TEXT_SIZE];
    char *arguments[] = {program, word, NULL};
    const Options *given = &player->given[0];
    snprintf(word, sizeof word, "%s", name);
    if (options_parse(2, arguments, 0, options, player->message,
                      sizeof player->message))
        return STATUS_INVALID_INPUT;
    *count = 1;
    if (options->scene == given->scene && !given->page) {
        *count = player->given_count;
        memcpy(options, given, (size_t)*count * sizeof *given);
        return STATUS_OK;
    }
    options->speed = given->speed;
    return STATUS_OK;
}

/* Another scene, from its start; it keeps the pause, and one that explains
 * something begins with one. */
static Status switch_scene(Player *player, const Command *command)
{
    Options options[OPTIONS_MAX_PANES];
    int count;
    bool halted = player->halted;
    Status status =
        player_scene_options(player, command->text, options, &count);
    if (!status)
        status = player_begin(player, options, count, command);
    if (status)
        return status;
    player->paused = player->paused && !halted;
    player->column = LECTURE_CARDS;
    if (options->scene->explains && !player->given[0].script)
        player->paused = true;
    return STATUS_OK;
}

/* Another start, where the scene has one. */
static Status pick_start(Player *player, const Command *command)
{
    Options options[OPTIONS_MAX_PANES];
    const Scene *scene = player_simulation(player)->scene;
    if (!(scene->needs & NEEDS_START))
        return player_refuse(player, "this scene has no start to choose");
    int panes = past_panes(&player->past);
    player_options(player, options);
    for (int i = 0; i < panes; i++) {
        options[i].start[0] = command->x;
        options[i].start[1] = command->y;
    }
    player->paused = true;
    return player_begin(player, options, panes, command);
}

/* From step 0 with the present numbers. */
static Status begin_again(Player *player, const Command *command)
{
    Options options[OPTIONS_MAX_PANES];
    player_options(player, options);
    if (player->halted && !player_explains(&options[0]))
        player->paused = false; /* nobody asked for this pause */
    player->lens = LENS_FITS;
    return player_begin(player, options, past_panes(&player->past), command);
}

const Deed begin_deeds[] = {
    {COMMAND_SCENE, switch_scene},
    {COMMAND_START, pick_start},
    {COMMAND_RESTART, begin_again},
    {COMMAND_NONE, NULL},
};
