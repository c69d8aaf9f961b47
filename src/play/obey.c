/* obey.c - from a command to its deed, and the journal of what was done. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "play/playing.h"

Status player_refuse(Player *player, const char *why)
{
    snprintf(player->message, sizeof player->message, "%s", why);
    return STATUS_INVALID_INPUT;
}

Status player_ask(Player *player, CommandKind kind, long number, double x,
                  double y)
{
    const Command command = {
        .kind = kind, .number = number, .x = x, .y = y, .joins = true};
    return player_obey(player, &command);
}

Status player_ask_set(Player *player, const OptionRow *row, double value)
{
    return player_ask(player, COMMAND_SET, row - option_rows, value, 0);
}

void player_next_gesture(Player *player)
{
    player->gesture = ++player->gestures;
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
        player_next_gesture(player);
    if (command->kind == COMMAND_GRAB)
        player->held = player->gesture;
}

/* Writes down what is going to be done, before what it does in turn.  Nothing
 * is ever taken out but the way of a drag: undo and redo are lines, too. */
static Status note_line(Player *player, const Command *command)
{
    Command line = *command;
    bool drags =
        command->kind == COMMAND_DRAG || command->kind == COMMAND_RELEASE;
    line.joins = player->gesture == player->noted && !drags;
    player->noted = player->gesture;
    return script_add(&player->journal, player->past.step, &line);
}

/* The line that was noted as number `at` was refused. */
static void forget_line(Player *player, size_t at, int noted)
{
    if (at + 1 == player->journal.count) {
        player->journal.count = at;
        player->noted = noted;
    }
}

/* Of two places of one drag the second one is enough. */
static void join_lines(Player *player, size_t at)
{
    Script *journal = &player->journal;
    ScriptLine *line = journal->line + at;
    if (at + 1 != journal->count || at == 0 || !line->command.joins)
        return;
    CommandKind kind = line->command.kind;
    if (line[-1].step != line->step || line[-1].command.kind != kind ||
        line[-1].command.number != line->command.number ||
        (kind != COMMAND_START && kind != COMMAND_HANDLE &&
         kind != COMMAND_PLACE && kind != COMMAND_OBSTACLE &&
         (kind != COMMAND_SET || line->command.text[0])))
        return;
    line->command.joins = line[-1].command.joins;
    line[-1] = *line;
    journal->count--;
}

/* ---- obeying ------------------------------------------------------------- */

/* Whether the message of before may stay. */
static bool keeps_note(const Player *player, CommandKind kind)
{
    if ((kind == COMMAND_SET || kind == COMMAND_PLACE) &&
        player->mouse.drag != COMMAND_NONE)
        return true;
    return kind == COMMAND_REDRAW || kind == COMMAND_DRAG ||
           kind == COMMAND_PLAY || kind == COMMAND_RELEASE;
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

Status player_obey(Player *player, const Command *asked)
{
    Past *past = &player->past;
    Command command = *asked;
    long step = past->step, newest = past_newest(past);
    int now = past->now;
    size_t at = player->journal.count;
    int noted = player->noted;
    if (command.kind == COMMAND_TOGGLE_PAUSE) /* so that a script of it leads */
        command.kind =                        /* to the same place */
            player_stands(player) ? COMMAND_PLAY : COMMAND_PAUSE;
    const CommandRow *row = command_row(command.kind);
    unsigned flags = row->flags;
    begin_gesture(player, &command);
    player->changed = true;
    player->message[0] = '\0';
    player->leaving = player->leaving && command.kind == COMMAND_ESCAPE;
    if (!keeps_note(player, command.kind))
        player->note[0] = '\0';
    if (past->works && command.kind == COMMAND_NEXT)
        return STATUS_OK; /* it is on its way */
    if (player_veils(player) &&
        (command.kind == COMMAND_NEXT || command.kind == COMMAND_PLAY)) {
        player->told = player_settings(player)->page;
        if (player->told->answer) { /* first the answer, then the step */
            player_note(player, "it is %.4g",
                        show_number(&player->show, player->told->answer));
            return STATUS_OK;
        }
    }
    if (past->works && !(flags & SCREEN)) {
        past_drop(past);
        player->then = THEN_NOTHING;
        if (command.kind == COMMAND_ESCAPE)
            return player_work(player);
    }
    if (flags & KEPT && note_line(player, &command))
        return STATUS_OUT_OF_MEMORY;
    Status status = STATUS_OK;
    if (row->deed)
        status = row->deed(player, &command);
    if (past->works && !(flags & SCREEN)) {
        Status shown = player_work(player);
        status = status ? status : shown;
    }
    if (past->now > now && command.kind != COMMAND_REDO)
        tell_left(player, step, newest);
    if (flags & KEPT && status == STATUS_INVALID_INPUT)
        forget_line(player, at, noted);
    else if (flags & KEPT)
        join_lines(player, at);
    return player_bear(player, status);
}
