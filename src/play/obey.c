/* obey.c - what each command does: lists of deeds, one for each source that
 * has some.
 */
#include <stdio.h>
#include <stdlib.h>

#include "play/playing.h"

/* All of them. */
static const Deed *const deeds[] = {walk_deeds,   change_deeds, pane_deeds,
                                    hold_deeds,   begin_deeds,  keep_deeds,
                                    lesson_deeds, screen_deeds};

DeedFunction *player_deed(CommandKind kind)
{
    for (size_t i = 0; i < sizeof deeds / sizeof *deeds; i++)
        for (const Deed *deed = deeds[i]; deed->act; deed++)
            if (deed->kind == kind)
                return deed->act;
    return NULL;
}

Status player_refuse(Player *player, const char *why)
{
    snprintf(player->message, sizeof player->message, "%s", why);
    return STATUS_INVALID_INPUT;
}

const Settings *player_settings(const Player *player)
{
    return &player->lane[player->active].track.settings;
}

Options player_numbers(const Player *player)
{
    Options options = player_settings(player)->options;
    double h = player_simulation(player)->options.timestep;
    if (h != options.timestep) { /* nobody chose it: as the cards have it */
        char text[32];
        snprintf(text, sizeof text, "%.4g", h);
        options.timestep = strtod(text, NULL);
    }
    return options;
}

/* A switch becomes what it does now, so that a journal of it leads to the same
 * place whatever was before. */
static Command resolve(const Player *player, const Command *command)
{
    Command resolved = *command;
    if (command->kind == COMMAND_TOGGLE_PAUSE)
        resolved.kind = player->paused ? COMMAND_PLAY : COMMAND_PAUSE;
    return resolved;
}

/* Whether the message of before may stay. */
static bool keeps_note(const Player *player, CommandKind kind)
{
    if (kind == COMMAND_SET && player->mouse.drag != DRAG_NONE)
        return true;
    return kind == COMMAND_REDRAW || kind == COMMAND_DRAG ||
           kind == COMMAND_PLAY || kind == COMMAND_RELEASE;
}

/* Whether it changes the run from the shown step on: what is known of later
 * steps is forgotten then. */
static bool forgets(CommandKind kind)
{
    static const CommandKind kinds[] = {
        COMMAND_SET,      COMMAND_FILTER, COMMAND_SEARCH,  COMMAND_METHOD,
        COMMAND_ADD_PANE, COMMAND_GRAB,   COMMAND_DRAG,    COMMAND_PIN,
        COMMAND_HANDLE,   COMMAND_FLIP,   COMMAND_RELEASE,
    };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (kinds[i] == kind)
            return true;
    return false;
}

/* A hand that would make the run forget steps is asked first: its next gesture
 * does it.  Scripts know what they do. */
static Status ask_first(Player *player, CommandKind kind)
{
    long first = player->step + 1, last = player->newest;
    char steps[64];
    if (!player->by_hand || last < first || !forgets(kind) ||
        (player->asked > 0 && player->gesture == player->asked + 1))
        return STATUS_OK;
    player->asked = player->gesture;
    snprintf(steps, sizeof steps,
             first == last ? "step %ld" : "steps %ld ... %ld", first, last);
    snprintf(player->message, sizeof player->message,
             "%s would be forgotten: once more does it, End shows the newest",
             steps);
    return STATUS_INVALID_INPUT;
}

Status player_obey(Player *player, const Command *command)
{
    Command resolved = resolve(player, command);
    bool leaving = command->kind == COMMAND_ESCAPE && !player_is_open(player);
    size_t told = player->journal.count;
    player->changed = true;
    player->message[0] = '\0';
    if (resolved.kind != COMMAND_REDRAW)
        player->glide = 0;
    if (!keeps_note(player, resolved.kind))
        player->note[0] = '\0';
    if (command_row(resolved.kind)->kept &&
        script_add(&player->journal, player->step, &resolved))
        return STATUS_OUT_OF_MEMORY;
    DeedFunction *act = player_deed(resolved.kind);
    Status status = ask_first(player, resolved.kind);
    if (!status && act)
        status = act(player, &resolved);
    if (status == STATUS_INVALID_INPUT && player->journal.count == told + 1)
        player->journal.count = told; /* nothing was done */
    player_tell_forgotten(player);
    player->leaving = leaving;
    bool fatal = status == STATUS_OUT_OF_MEMORY ||
                 status == STATUS_INVALID_INPUT ||
                 status == STATUS_FILE_FAILED || status == STATUS_SCREEN_FAILED;
    if (status && !fatal && player->attended && player->given[0].steps < 0) {
        player->paused = true; /* a step that failed is shown */
        return STATUS_OK;
    }
    return status;
}
