/* panes.c - changes the method of a pane; adds and closes panes. */
#include "play/playing.h"

/* Returns the next method for a pane: key M can choose the method, all terms of
 * the energy allow it, and no pane has it.  NULL: the command is refused. */
static const IntegratorMethod *find_next_method(Player *player, int pane)
{
    const Simulation *simulation = &player->past.pane[pane].simulation;
    const IntegratorMethod *own = simulation->run[0].method, *next = own;
    bool time = simulation->scene->traits & HAS_TIME, taken;
    do {
        next = next[1].name ? next + 1 : &integrator_methods[0];
        taken = next->only_by_name ||
                integrator_method_refuses_system(next, &simulation->system);
        for (int p = 0; p < past_count_panes(&player->past); p++)
            taken =
                taken || player->past.pane[p].simulation.run[0].method == next;
    } while (next != own && taken);
    if (simulation->runs > 1)
        next = &integrator_methods[0];
    if (time && next != own)
        return next;
    player_refuse(player,
                  time ? "key M has no other method for this scene"
                       : "no time passes here: there is no other method");
    return NULL;
}

Status obey_next_method(Player *player, const Command *command)
{
    const IntegratorMethod *next =
        find_next_method(player, player->active_pane);
    if (!next)
        return STATUS_INVALID_INPUT;
    player_enqueue_set(player, option_find("integrator"),
                       (double)(next - integrator_methods));
    return STATUS_OK;
}

/* Adds a pane with the run of the last pane and the next method.  For a page
 * the method stays: further commands of the page set the differences. */
Status obey_add_pane(Player *player, const Command *command)
{
    int panes = past_count_panes(&player->past);
    if (panes >= OPTIONS_MAX_DRAWN_PANES)
        return player_refuse(player, "six are side by side: no room for more");
    if (player_get_simulation(player)->runs > 1)
        return player_refuse(player, "several runs are in this picture "
                                     "already: nothing goes beside it");
    const IntegratorMethod *next =
        player->tour.is_page_running
            ? player_get_simulation(player)->run->method
            : find_next_method(player, panes - 1);
    if (!next)
        return STATUS_INVALID_INPUT;
    const Command change = make_set_command(
        option_find("integrator"), (double)(next - integrator_methods));
    Status status = player_edit_step(player, command, ALL_PANES, false);
    if (!status && !player->tour.is_page_running)
        status = player_edit_step(player, &change, panes, false);
    if (status)
        return status;
    player->active_pane = panes;
    player_notify(player, "beside it: %s", next->label);
    return STATUS_OK;
}

Status obey_close_pane(Player *player, const Command *command)
{
    if (past_count_panes(&player->past) < 2)
        return player_refuse(player, "there is only one");
    return player_edit_step(player, command, ALL_PANES, false);
}
