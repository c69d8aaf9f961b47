/* bodies.c - pins, pulls and places nodes; moves obstacles and handles. */
#include <string.h>

#include "play/playing.h"

Status obey_toggle_pin(Player *player, const Command *command)
{
    long node = command->number;
    const Simulation *simulation = player_get_simulation(player);
    if (!(simulation->scene->traits & HAS_MESH) || simulation->scene->step)
        return player_refuse(player, "only nodes of a square can be pinned");
    bool pinned = simulation->system.is_pinned[node];
    Command change = {.kind = COMMAND_PIN, .number = node, .x = !pinned};
    Status status = player_edit_step(player, &change, ALL_PANES, false);
    if (!status)
        player_notify(player, "node %ld is %s", node,
                      pinned ? "free" : "pinned");
    return status;
}

/* Takes hold of a node or an obstacle without moving it. */
Status obey_grab_or_push(Player *player, const Command *command)
{
    const Simulation *simulation = player_get_simulation(player);
    bool pulls = command->kind == COMMAND_GRAB;
    double place[2];
    if (!simulation_is_draggable(simulation))
        return player_refuse(player, pulls ? "nothing to take hold of here"
                                           : "nothing to push here");
    if (pulls)
        memcpy(place, simulation->run[0].x + 2 * command->number, sizeof place);
    else
        simulation_locate_obstacle(simulation, 0, (int)command->number, place);
    Command change = *command;
    change.x = place[0];
    change.y = place[1];
    Status status = player_edit_step(player, &change, ALL_PANES, false);
    player->input.is_holding = player->input.is_holding || !status;
    if (!status && player_is_stopped(player))
        player_notify(player,
                      "paused: the hand %s as soon as time goes on (Space, N)",
                      pulls ? "pulls" : "pushes");
    return status;
}

Status obey_place_node(Player *player, const Command *command)
{
    if (!simulation_is_draggable(player_get_simulation(player)))
        return player_refuse(player, "nothing to be placed here");
    for (int p = 0; p < past_count_panes(&player->past); p++) {
        Simulation *simulation = &player->past.pane[p].simulation;
        if (simulation_move_node(simulation, (int)command->number, command->x,
                                 command->y, false))
            return player_refuse(player,
                                 "no room for it there: an obstacle, a "
                                 "body, or a cell that would turn over");
    }
    return player_edit_step(player, command, ALL_PANES, false);
}

Status obey_place_obstacle(Player *player, const Command *command)
{
    Options moved = *player_get_active_options(player);
    double *at = options_get_obstacle_point(&moved, (int)command->number);
    at[0] = command->x;
    at[1] = command->y;
    Status status = STATUS_OK;
    for (int p = 0; p < past_count_panes(&player->past) && !status; p++)
        status = simulation_check_clearance(&player->past.pane[p].simulation,
                                            &moved, MESSAGE(player->message));
    return status ? status
                  : player_edit_step(player, command, ALL_PANES, false);
}

Status obey_drag_or_release(Player *player, const Command *command)
{
    if (!control_is_holding(
            past_get_control(&player->past, player->active_pane)))
        return player_refuse(player, "the hand holds nothing");
    player->input.is_holding = command->kind == COMMAND_DRAG;
    player->input.last_pull_step = player->past.shown_step;
    return player_edit_step(player, command, ALL_PANES, false);
}

/* Moves a handle or flips a switch.  Moving the start leads back to step 0. */
Status obey_handle_or_switch(Player *player, const Command *command)
{
    Past *past = &player->past;
    Status status = STATUS_OK;
    unsigned needs = player_get_simulation(player)->scene->traits;
    long step = past->shown_step;
    int now = past->branch_index;
    if (command->kind == COMMAND_HANDLE && (needs & HAS_START) &&
        !(needs & HAS_TIME)) {
        player_pause(player);
        status = player_seek(player, 0, AFTER_NOTHING);
        status = status ? status : past_finish_work(past);
    }
    if (!status)
        status = player_edit_step(player, command, ALL_PANES, false);
    if (past->branch_index > now)
        past->branch[now].left_at_step = step; /* undo returns to `step` */
    return status;
}
