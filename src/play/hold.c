/* hold.c - what a hand does: it pins nodes, pulls them, and moves the points of
 * a scene.
 */
#include "play/playing.h"
#include "scenes/scene.h"

/* Pins a node, or sets it free. */
static Status switch_pin(Player *player, const Command *command)
{
    long node = command->number;
    const Simulation *simulation = player_simulation(player);
    if (!(simulation->scene->needs & NEEDS_MESH) || simulation->scene->step)
        return player_refuse(player, "only nodes of a square can be pinned");
    bool pinned = node < simulation->system.nodes &&
                  simulation_is_pinned(simulation, (int)node);
    Command change = {.kind = COMMAND_PIN, .number = node, .x = !pinned};
    Status status = player_change_all(player, &change);
    if (!status)
        player_note(player, "node %ld is %s", node, pinned ? "free" : "pinned");
    return status;
}

/* The hand takes a node where it is. */
static Status grab(Player *player, const Command *command)
{
    long node = command->number;
    const Simulation *simulation = player_simulation(player);
    if (state_size(simulation) == 0)
        return player_refuse(player, "nothing to take hold of here");
    Command change = {.kind = COMMAND_GRAB, .number = node};
    if (node < simulation->system.nodes) {
        change.x = simulation->run[0].x[2 * node];
        change.y = simulation->run[0].x[2 * node + 1];
    }
    Status status = player_change_all(player, &change);
    player->holds = player->holds || !status;
    if (!status && player->paused)
        player_note(player, "paused: the hand pulls as soon as time goes on "
                            "(Space, N)");
    return status;
}

/* It pulls, or lets go. */
static Status pull(Player *player, const Command *command)
{
    if (!player_settings(player)->held)
        return player_refuse(player, "the hand holds nothing");
    player->holds = command->kind == COMMAND_DRAG;
    return player_change_all(player, command);
}

/* A point of the scene moves; a minimisation begins anew with it, at step 0. */
static Status move_handle(Player *player, const Command *command)
{
    const Simulation *simulation = player_simulation(player);
    Status status = STATUS_OK;
    unsigned needs = simulation->scene->needs;
    if ((needs & NEEDS_START) && !(needs & NEEDS_TIME) &&
        simulation->scene->grips)
        status = player_show(player, 0);
    return status ? status : player_change_all(player, command);
}

const Deed hold_deeds[] = {
    {COMMAND_PIN, switch_pin},     {COMMAND_GRAB, grab},
    {COMMAND_DRAG, pull},          {COMMAND_RELEASE, pull},
    {COMMAND_HANDLE, move_handle}, {COMMAND_FLIP, player_change_all},
    {COMMAND_NONE, NULL},
};
