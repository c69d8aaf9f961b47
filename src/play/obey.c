/* obey.c - what each command does: lists of deeds, one for each source that
 * has some.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/playing.h"

/* All of them. */
static const Deed *const deeds[] = {walk_deeds, change_deeds, begin_deeds,
                                    keep_deeds, lesson_deeds, screen_deeds};

static DeedFunction *find_deed(CommandKind kind)
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

const Options *player_settings(const Player *player)
{
    return &past_control(&player->past, player->active)->options;
}

Options player_numbers(const Player *player)
{
    Options options = *player_settings(player);
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

/* Writes down what was done: in the journal of the branch that it began, in
 * front of what it did in turn, else in that of before. */
static Status note_line(Player *player, const Command *command, long step,
                        long runs, int now, size_t told)
{
    Past *past = &player->past;
    bool same = past->now == now && past->runs == runs;
    if (!(command_row(command->kind)->flags & KEPT))
        return STATUS_OK;
    return script_insert(&past->branch[past->now].journal,
                         same ? told : past->branch[past->now].carried, step,
                         command);
}

/* Later steps that a change has left behind. */
static void tell_left(Player *player, long step, long newest)
{
    const Branch *branch = &player->past.branch[player->past.now];
    size_t used = strlen(player->note);
    if (branch->fresh || branch->count > 2 || step >= newest ||
        used >= sizeof player->note)
        return;
    snprintf(player->note + used, sizeof player->note - used,
             "%ssteps %ld ... %ld: Ctrl+Z leads back", used ? "; " : "",
             step + 1, newest);
}

Status player_obey(Player *player, const Command *command)
{
    Past *past = &player->past;
    Command resolved = resolve(player, command);
    bool leaving = command->kind == COMMAND_ESCAPE && !player_is_open(player);
    long step = past->step, newest = past_newest(past), runs = past->runs;
    int now = past->now;
    size_t told = past->branch[now].journal.count;
    player->changed = true;
    player->message[0] = '\0';
    if (resolved.kind != COMMAND_REDRAW)
        player->glide = 0;
    if (!keeps_note(player, resolved.kind))
        player->note[0] = '\0';
    if (past->works && resolved.kind == COMMAND_NEXT)
        return STATUS_OK; /* it is on its way */
    if (past->works && !(command_row(resolved.kind)->flags & SCREEN)) {
        past_drop(past);
        player->then = THEN_NOTHING;
        if (resolved.kind == COMMAND_ESCAPE)
            return player_work(player);
    }
    DeedFunction *act = find_deed(resolved.kind);
    Status status = act ? act(player, &resolved) : STATUS_OK;
    bool undo = resolved.kind == COMMAND_UNDO || resolved.kind == COMMAND_REDO;
    if (!undo && past->now > now)
        tell_left(player, step, newest);
    if (status != STATUS_INVALID_INPUT && !undo &&
        note_line(player, &resolved, step, runs, now, told))
        return STATUS_OUT_OF_MEMORY;
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
