/* walk.c - through time: run and pause, on and back by steps, by updates of
 * Newton's method, or by lines of Algorithm 3, undo.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/playing.h"
#include "scenes/scene.h"

int player_place(const Player *player, int pane)
{
    return player->mode == MODE_WALK ? player->side[pane].place : -1;
}

/* ---- lines --------------------------------------------------------------- */

void player_stand_at(Player *player, int pane, int place)
{
    for (int p = 0; p < OPTIONS_MAX_PANES; p++)
        player->side[p].place = player_place(player, p);
    player->mode = MODE_WALK;
    player->side[pane].place = place;
}

void player_enter(Player *player, Then then)
{
    for (int p = 0; p < past_panes(&player->past); p++) {
        const Machine *machine = &player->past.machine[p];
        const Rounds *rounds = &machine->rounds;
        int place = rounds->places <= 2  ? -1 /* the start and the end */
                    : then == THEN_ENTER ? 0
                    : then == THEN_LEAVE ? rounds->places - 1
                                         : rounds_peak(rounds);
        if (place >= 0)
            player_stand_at(player, p, place);
        if (place < 0 || then != THEN_PEAK)
            continue;
        player_note(player, "update %d of %d: nodes are %.4g m away; N goes on",
                    rounds->place[place].round + 1, rounds->made.count,
                    fmax(machine->outcome.extent, rounds_extent(rounds)));
        player->warning = true;
    }
}

/* A pace on (1) or back (-1) in all panes; false: each was at its end. */
static bool walk(Player *player, int way)
{
    bool moved = false;
    for (int p = 0; p < past_panes(&player->past); p++) {
        const Rounds *rounds = &player->past.machine[p].rounds;
        int last = rounds->places - 1, place = player_place(player, p);
        if (place < 0)
            continue;
        int next = rounds_walk(rounds, player->fine, place, way);
        player->side[p].place = next < 0 ? 0 : next > last ? last : next;
        moved = moved || player->side[p].place != place;
    }
    return moved;
}

/* ---- commands ------------------------------------------------------------ */

void player_stop(Player *player)
{
    if (!player_stands(player))
        player->mode = MODE_PAUSE;
}

Status obey_pause(Player *player, const Command *command)
{
    player->mode = command->kind == COMMAND_PLAY ? MODE_RUN
                   : player->mode == MODE_WALK   ? MODE_WALK
                                                 : MODE_PAUSE;
    player->changed = true;
    return STATUS_OK;
}

Status obey_next(Player *player, const Command *command)
{
    const Past *past = &player->past;
    Then then = player->fine > 0 ? THEN_ENTER : THEN_PEAK;
    player_stop(player);
    if (command->kind == COMMAND_STEP)
        return player_go_on(player, THEN_NOTHING);
    if (player->fine > 0 && walk(player, 1))
        return STATUS_OK;
    if (player->fine == 0 && player_place(player, player->active) >= 0) {
        player->mode = MODE_PAUSE; /* from an explosion's height to its end */
        return STATUS_OK;
    }
    if (past->step < past_newest(past) && player->fine > 0)
        return player_show(player, past->step + 1, true, then);
    return player_go_on(player, then);
}

/* Whether the steps of any pane are made of updates that are shown. */
static bool has_updates(const Player *player)
{
    bool any = false;
    for (int p = 0; p < past_panes(&player->past); p++) {
        const Simulation *simulation = &player->past.machine[p].simulation;
        any = any || ((simulation->scene->needs & NEEDS_TIME) &&
                      simulation->run[0].newton);
    }
    return any;
}

/* From the first line of a step to the end of the one before. */
Status obey_back(Player *player, const Command *command)
{
    long step = player->past.step;
    player_stop(player);
    if (step == 0)
        player_note(player, "this is step 0: nothing was before it");
    if (player->fine == 0 || !has_updates(player))
        return player_show(player, step - 1, false, THEN_NOTHING);
    if (player_place(player, player->active) < 0 && step > 0) {
        if (!player_machine(player)->known)
            return player_show(player, step, true, THEN_LEAVE);
        player_enter(player, THEN_LEAVE);
    }
    if (player_place(player, player->active) >= 0 && walk(player, -1))
        return STATUS_OK;
    return player_show(player, step - 1, true, THEN_LEAVE);
}

/* Steps, updates, lines, and steps again. */
Status obey_finer(Player *player, const Command *command)
{
    static const char *const paces[] = {
        "whole steps", "updates of Newton's method", "lines of Algorithm 3"};
    if (!has_updates(player) && player->fine == 0)
        return player_refuse(player, "a step here has no finer ones");
    player->fine = (player->fine + 1) % 3;
    if (player->fine == 0 || !player_stands(player))
        player->mode = MODE_PAUSE;
    player_note(player, "N and \u2190 go by %s", paces[player->fine]);
    return STATUS_OK;
}

/* Step 0, the newest one, or the one with this number. */
Status obey_goto(Player *player, const Command *command)
{
    long step = command->kind == COMMAND_HOME  ? 0
                : command->kind == COMMAND_END ? past_newest(&player->past)
                                               : command->number;
    return player_show(player, step, false, THEN_NOTHING);
}

/* What was done last, or undone: "set stretch 1.2". */
Status obey_undo(Player *player, const Command *command)
{
    Past *past = &player->past;
    char line[2 * COMMAND_TEXT_SIZE];
    int way = command->kind == COMMAND_UNDO ? -1 : 1;
    const Command *made = past_undo(past, way);
    if (!made)
        return player_refuse(player, way < 0 ? "nothing is to be undone"
                                             : "nothing was undone");
    Command edit = *made;
    double *at[] = {&edit.x, &edit.y};
    edit.joins = false;
    for (int k = 0; k < 2; k++) { /* digits as the row of numbers has them */
        snprintf(line, sizeof line, "%g", *at[k]);
        *at[k] = strtod(line, NULL);
    }
    command_format(&edit, line, sizeof line);
    player->mode = MODE_PAUSE;
    player->holds = false;
    player->mouse.gesture = ++player->gestures; /* if a drag goes on */
    Status status = player_follow(player);
    player_leave_step(player);
    player_note(player, "%s: %s", way < 0 ? "undone" : "done again", line);
    return status;
}
