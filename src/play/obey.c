/* obey.c - from a command to its deed, and the journal of what was done. */
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "picture/picture.h"
#include "play/playing.h"
#include "run/scene.h"
#include "scenes/small_scenes.h"

Status player_tell(Player *player, Status status)
{
    if (status != STATUS_INVALID_INPUT)
        return status;
    player_note(player, "%s", player->message);
    player->message[0] = '\0';
    return STATUS_OK;
}

Status player_ask_set(Player *player, const OptionRow *row, double value)
{
    const Command command = {.kind = COMMAND_SET,
                             .number = row - option_rows,
                             .x = value,
                             .joins = true};
    return player_obey(player, &command);
}

void player_note(Player *player, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(player->note, sizeof player->note, format, arguments);
    va_end(arguments);
    player->warning = player->explains = false;
    player->changed = true;
}

/* ---- the journal --------------------------------------------------------- */

/* What is done from now on is undone at once with what was done before, if the
 * command says so, or drags what was grabbed. */
static void begin_gesture(Player *player, const Command *command)
{
    if (command->kind == COMMAND_DRAG || command->kind == COMMAND_RELEASE)
        player->gesture = player->held;
    else if (!command->joins)
        player->gesture = ++player->gestures;
    if (command->kind == COMMAND_GRAB || command->kind == COMMAND_PUSH)
        player->held = player->gesture;
}

/* ---- obeying ------------------------------------------------------------- */

/* How many there are of what the number of a command counts. */
static long parts_of(const Player *player, int pane, CommandKind kind)
{
    const Simulation *simulation = &player->past.machine[pane].simulation;
    const Scene *scene = simulation->scene;
    double at[SCENE_MAX_HANDLES][2];
    Switch part[SCENE_MAX_SWITCHES];
    bool cells = scene->picture == PICTURE_ENVELOPE;
    switch (kind) {
    case COMMAND_PIN:
    case COMMAND_GRAB:
    case COMMAND_PLACE:
        return simulation->system.nodes;
    case COMMAND_HANDLE:
        return exhibit_handles(simulation, at);
    case COMMAND_FLIP:
        return exhibit_switches(simulation, part);
    case COMMAND_OBSTACLE:
    case COMMAND_PUSH:
        return (long)(simulation->options.grounds + simulation->options.balls);
    case COMMAND_PANE:
        return past_panes(&player->past);
    case COMMAND_CARD:
    case COMMAND_ENLARGE:
        return picture_of(scene)->count;
    case COMMAND_CELL:
        return cells ? (long)ENVELOPE_ROWS * ENVELOPE_COLUMNS : 0;
    default:
        return LONG_MAX;
    }
}

/* Whether all panes have what the command is about. */
static Status check_number(Player *player, const Command *command)
{
    long count = LONG_MAX;
    for (int p = 0; p < past_panes(&player->past); p++) {
        long parts = parts_of(player, p, command->kind);
        count = parts < count ? parts : count;
    }
    if (command->number < count)
        return STATUS_OK;
    return player_refuse(
        player,
        count > 0 ? "%s: there are 0 ... %ld, no %ld" : "%s: none is here",
        command_rows[command->kind].word, count - 1, command->number);
}

/* What a key means here, so that a script of it leads to the same place. */
static Command meant_by(const Player *player, const Command *asked)
{
    const double *x = player_simulation(player)->run[0].x;
    Command meant = *asked;
    if (asked->kind == COMMAND_TOGGLE_PAUSE)
        meant.kind = player_stands(player) ? COMMAND_PLAY : COMMAND_PAUSE;
    if (asked->kind == COMMAND_NEXT && !player_veils(player) &&
        player_settings(player)->next == NEXT_NEARER)
        meant =
            (Command){.kind = COMMAND_HANDLE, .x = 0.8 * x[0], .y = 0.8 * x[1]};
    return meant;
}

/* Where a page waits for a guess, N and Space show its answer and make no step.
 * Returns whether they did. */
static bool unveils(Player *player, const Command *command, Status *status)
{
    if (!player_veils(player) ||
        (command->kind != COMMAND_NEXT && command->kind != COMMAND_PLAY))
        return false;
    *status = player_unveil(player, NULL);
    return true;
}

/* The step that is made is not wanted any more; what a drag does is not to be
 * done behind it, but now. */
static Status give_up(Player *player)
{
    const Command later = player->later;
    int gesture = player->gesture;
    bool leaves = player->mouse.leaves;
    Status status = STATUS_OK;
    past_aim(&player->past, player->past.step, false);
    player->then = THEN_NOTHING;
    player->later.kind = COMMAND_NONE;
    player->mouse.leaves = false;
    if (later.kind)
        status = player_tell(player, player_obey(player, &later));
    if (!status && leaves)
        status = player_tell(player, player_release(player));
    player->gesture = gesture;
    return status;
}

Status player_obey(Player *player, const Command *asked)
{
    Past *past = &player->past;
    Command command = meant_by(player, asked);
    long step = past->step, newest = past_newest(past);
    int now = past->now;
    const CommandRow *row = &command_rows[command.kind];
    unsigned flags = row->flags;
    begin_gesture(player, &command);
    player->changed = true;
    player->message[0] = '\0';
    if (player->leaving != command.kind)
        player->leaving = COMMAND_NONE;
    if (!(flags & QUIET || (flags & LATEST && player->mouse.drag)))
        player->note[0] = '\0';
    if (past->works && command.kind == COMMAND_NEXT)
        return STATUS_OK; /* it is on its way */
    if (past->making && flags & LATEST &&
        (player->mouse.drag || command.kind == COMMAND_DRAG)) {
        player->later = command; /* a mouse that moves holds up no step */
        return STATUS_OK;
    }
    Status status = STATUS_OK;
    if (unveils(player, &command, &status))
        return status; /* the step is the next press */
    if (past->works && !(flags & SCREEN)) {
        status = give_up(player);
        if (command.kind == COMMAND_ESCAPE) {
            player_note(player, "given up: the last whole step stands");
            return player_work(player);
        }
    }
    status = status ? status : check_number(player, &command);
    size_t at = player->journal.count;
    bool noted = !status && flags & KEPT; /* before what it does in turn */
    if (noted && script_add(&player->journal, step, &command, player->gesture))
        return STATUS_OUT_OF_MEMORY;
    if (!status)
        status = row->deed(player, &command);
    if (past->works && !(flags & SCREEN)) {
        Status shown = player_work(player);
        status = status ? status : shown;
    }
    if (noted && past->now > now && command.kind != COMMAND_REDO &&
        !past->branch[past->now].fresh && step < newest) /* later steps */
        append(player->note, sizeof player->note,
               "%ssteps %ld ... %ld: Ctrl+Z leads back",
               player->note[0] ? "; " : "", step + 1, newest);
    if (noted && player->journal.count == at + 1 &&
        status == STATUS_INVALID_INPUT)
        player->journal.count = at;
    return player_bear(player, status);
}
