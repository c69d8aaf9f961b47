/* panes.c - runs side by side: one more, one less, the one to look at. */
#include <stdio.h>

#include "play/playing.h"
#include "scenes/scene.h"

/* The same run with the next method beside the last one. */
static Status add_pane(Player *player, const Command *command)
{
    (void)command;
    const Lane *last = &player->lane[player->lanes - 1];
    const Simulation *simulation = &last->track.simulation;
    Command change = {.kind = COMMAND_SET};
    const IntegratorMethod *next = player_next_method(simulation);
    if (player->lanes == OPTIONS_MAX_PANES)
        return player_refuse(player, "six are side by side: no room for more");
    if (!(simulation->scene->needs & NEEDS_TIME))
        return player_refuse(player, "no time passes here: there is no other "
                                     "method to put beside it");
    if (simulation->runs > 1)
        return player_refuse(player, "several runs are in this picture "
                                     "already: nothing goes beside it");
    if (next == simulation->run[0].method)
        return player_refuse(player, "no other method knows all terms of this "
                                     "scene: nothing goes beside it");
    if (!player->attended)
        return player_refuse(player, "nothing to be put beside it here");
    snprintf(change.text, sizeof change.text, "integrator %s", next->name);
    Status status = player_forget_later(player);
    Lane *lane = &player->lane[player->lanes];
    if (!status)
        status = lane_clone(last, player->lanes, player_watch, lane);
    if (status) {
        lane_free(lane);
        return status;
    }
    player->start[player->lanes] = player->start[player->lanes - 1];
    player->active = player->lanes++;
    player_note(player, "beside it: %s", next->label);
    return track_change(&lane->track, &change, player->message,
                        sizeof player->message);
}

/* The last pane goes. */
static Status end_pane(Player *player, const Command *command)
{
    (void)command;
    if (player->lanes < 2)
        return player_refuse(player, "there is only one");
    lane_free(&player->lane[--player->lanes]);
    if (player->active >= player->lanes)
        player->active = player->lanes - 1;
    return STATUS_OK;
}

/* The pane whose numbers are shown. */
static Status choose_pane(Player *player, const Command *command)
{
    if (command->number >= player->lanes)
        return player_refuse(player, "there is no such pane");
    player->active = (int)command->number;
    return STATUS_OK;
}

const Deed pane_deeds[] = {
    {COMMAND_ADD_PANE, add_pane},
    {COMMAND_END_PANE, end_pane},
    {COMMAND_PANE, choose_pane},
    {COMMAND_NONE, NULL},
};
