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

int player_gesture(const Player *player)
{
    return player->by_hand ? player->gesture : player->grip;
}

void player_next_gesture(Player *player, CommandKind kind)
{
    bool holds = kind == COMMAND_DRAG || kind == COMMAND_RELEASE;
    player->grip = holds ? player->held : --player->lines;
    if (kind == COMMAND_GRAB)
        player->held = player->grip;
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

/* Whether a drag goes on: of two lines the last one is enough. */
static bool replaces(const ScriptLine *line, const Command *command, long step)
{
    const Command *last = &line->command;
    size_t name = strcspn(command->text, " ");
    return line->step == step && last->kind == command->kind &&
           last->number == command->number &&
           (command->kind == COMMAND_START || command->kind == COMMAND_HANDLE ||
            (command->kind == COMMAND_SET &&
             strncmp(last->text, command->text, name + 1) == 0));
}

/* Writes down what was done, in front of what it did in turn.  Nothing is ever
 * taken out but the way of a drag: undo and redo are lines, too. */
static Status note_line(Player *player, const Command *command, long step,
                        size_t at)
{
    Script *journal = &player->journal;
    Command line = *command;
    bool drags = player->by_hand && player->gesture == player->noted;
    if (!(command_row(command->kind)->flags & KEPT))
        return STATUS_OK;
    bool held =
        command->kind == COMMAND_DRAG || command->kind == COMMAND_RELEASE;
    bool within = player->within > 0 &&
                  (player->outermost_kept || journal->count > player->before);
    line.joins = command->joins || within || (drags && !held);
    if (drags && at > 0 && at == journal->count &&
        replaces(&journal->line[at - 1], &line, step)) {
        line.joins = journal->line[at - 1].command.joins;
        journal->line[at - 1].command = line;
        return STATUS_OK;
    }
    player->noted = player->by_hand ? player->gesture : 0;
    return script_insert(journal, at, step, &line);
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
    long step = past->step, newest = past_newest(past);
    int now = past->now;
    size_t at = player->journal.count;
    if (player->within == 0) {
        player->before = at;
        player->outermost_kept = command_row(resolved.kind)->flags & KEPT;
    }
    if (!player->by_hand && player->within == 0 && !command->joins)
        player_next_gesture(player, command->kind);
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
    player->within++;
    Status status = act ? act(player, &resolved) : STATUS_OK;
    player->within--;
    bool undo = resolved.kind == COMMAND_UNDO || resolved.kind == COMMAND_REDO;
    if (!undo && past->now > now)
        tell_left(player, step, newest);
    if (status != STATUS_INVALID_INPUT &&
        note_line(player, &resolved, step, at))
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
