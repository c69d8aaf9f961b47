/* walk.c - through time: run and pause, on and back by steps, by updates of
 * Newton's method, or by lines of Algorithm 3, undo.  From one line to the next
 * the square of a window glides, arrows grow and points drop, for a quarter of
 * a second.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "play/playing.h"
#include "scenes/scene.h"

static const double GLIDE_TIME = 0.25; /* s */

static const Machine *machine_of(const Player *player, int pane)
{
    return &player->past.machine[pane];
}

/* Whether there is more to walk through than the start and the end. */
static bool walks(const Player *player, int pane)
{
    const Machine *machine = machine_of(player, pane);
    return machine->known && machine->rounds.places > 2;
}

void player_leave_rounds(Player *player)
{
    for (int p = 0; p < OPTIONS_MAX_PANES; p++)
        player->side[p].place = -1;
}

/* ---- gliding ------------------------------------------------------------- */

/* Positions that a pane shows now, [2n] m. */
static const double *shown(const Player *player, int pane)
{
    const Machine *machine = machine_of(player, pane);
    Trace trace;
    const double *x = NULL;
    if (machine->known)
        x = rounds_trace(&machine->rounds, player->side[pane].place, &trace);
    return x ? x : machine->simulation.run[0].x;
}

/* From what is shown now, before another line is; only in a window. */
static void glide_begin(Player *player)
{
    if (!player->window)
        return;
    for (int p = 0; p < past_panes(&player->past); p++) {
        Side *side = &player->side[p];
        size_t bytes = 2 *
                       (size_t)machine_of(player, p)->simulation.system.nodes *
                       sizeof *side->from;
        double *from = realloc(side->from, 2 * bytes);
        if (!from)
            return; /* the square jumps */
        side->from = from;
        memcpy(from, shown(player, p), bytes);
    }
    player->glide = clock_now();
}

double glide_rest(Player *player)
{
    double part = (clock_now() - player->glide) / GLIDE_TIME;
    if (player->glide == 0)
        return 0;
    if (!(part < 1)) {
        player->glide = 0;
        return 0;
    }
    return 1 - part * part * (3 - 2 * part);
}

const double *glide_between(Player *player, int pane, double rest)
{
    const double *to = shown(player, pane);
    int size = 2 * machine_of(player, pane)->simulation.system.nodes;
    double *from = player->side[pane].from, *x = from + size;
    for (int i = 0; i < size; i++)
        x[i] = to[i] + rest * (from[i] - to[i]);
    return x;
}

/* ---- lines --------------------------------------------------------------- */

/* All panes that can be walked through, at their first or at their last
 * place. */
static void enter_rounds(Player *player, bool at_end)
{
    for (int p = 0; p < past_panes(&player->past); p++)
        if (walks(player, p))
            player->side[p].place =
                at_end ? machine_of(player, p)->rounds.places - 1 : 0;
}

/* A pace on (1) or back (-1) in all panes; false: each was at its end. */
static bool walk(Player *player, int way)
{
    bool moved = false;
    glide_begin(player);
    for (int p = 0; p < past_panes(&player->past); p++) {
        const Rounds *rounds = &machine_of(player, p)->rounds;
        int last = rounds->places - 1, place = player->side[p].place;
        if (place < 0)
            continue;
        int next = rounds_walk(rounds, player->fine, place, way);
        player->side[p].place = next < 0 ? 0 : next > last ? last : next;
        moved = moved || player->side[p].place != place;
    }
    return moved;
}

/* Where E has risen beyond all proportion within a step that was taken by
 * itself, that is what is shown. */
static void show_peaks(Player *player)
{
    for (int p = 0; p < past_panes(&player->past); p++) {
        const Machine *machine = machine_of(player, p);
        double rise;
        int peak = walks(player, p) ? rounds_peak(&machine->rounds, &rise) : -1;
        if (peak < 0)
            continue;
        player->side[p].place = peak;
        player_note(
            player,
            "update %d of %d: E has risen by %.3g J s\u00b2, and nodes "
            "are %.4g m away; N goes on",
            machine->rounds.place[peak].round + 1, machine->rounds.count, rise,
            fmax(machine->outcome.extent, rounds_extent(&machine->rounds)));
        player->warning = true;
    }
}

Status player_wish(Player *player, Then then)
{
    char note[sizeof player->note];
    if (then == THEN_ENTER || then == THEN_LEAVE)
        enter_rounds(player, then == THEN_LEAVE);
    if (then != THEN_PEAK && then != THEN_TELL)
        return STATUS_OK;
    Status status = then == THEN_TELL ? player_tell_retake(player) : STATUS_OK;
    memcpy(note, player->note, sizeof note);
    if (then == THEN_PEAK || past_panes(&player->past) > 1)
        show_peaks(player);
    if (then == THEN_TELL)
        memcpy(player->note, note, sizeof note);
    return status;
}

/* ---- commands ------------------------------------------------------------ */

static Status set_paused(Player *player, const Command *command)
{
    bool paused = command->kind == COMMAND_PAUSE;
    player->paused = paused;
    player->halted = false;
    player->rests = player->rests && paused;
    if (!paused)
        player_leave_rounds(player);
    player_reset_speed(player);
    return STATUS_OK;
}

/* One on: a step, an update or a line. */
static Status go_on(Player *player, const Command *command)
{
    (void)command;
    const Past *past = &player->past;
    bool peaked = player->fine == 0 && player->side[player->active].place >= 0;
    Then then = player->fine > 0 ? THEN_ENTER : THEN_PEAK;
    player->paused = true;
    if (player->fine > 0 && walk(player, 1))
        return STATUS_OK;
    if (peaked) { /* from the height of an explosion to its end */
        player_leave_rounds(player);
        return STATUS_OK;
    }
    if (past->step < past_newest(past) && player->fine > 0)
        return player_show(player, past->step + 1, true, then);
    return player_go_on(player, then);
}

/* Whether the steps of any pane are made of updates that are shown. */
static bool has_updates(const Player *player)
{
    for (int p = 0; p < past_panes(&player->past); p++) {
        const Simulation *simulation = &machine_of(player, p)->simulation;
        if ((simulation->scene->needs & NEEDS_TIME) &&
            simulation->run[0].newton)
            return true;
    }
    return false;
}

/* One back, the same; from the first line of a step to the end of the one
 * before. */
static Status go_back(Player *player, const Command *command)
{
    (void)command;
    long step = player->past.step;
    bool inside = player->side[player->active].place >= 0;
    player->paused = true;
    if (player->fine == 0 || !has_updates(player))
        return player_show(player, step - 1, false, THEN_NOTHING);
    if (!inside && step > 0) {
        if (!player_machine(player)->known)
            return player_show(player, step, true, THEN_LEAVE);
        enter_rounds(player, true);
        inside = player->side[player->active].place >= 0;
    }
    if (inside && walk(player, -1))
        return STATUS_OK;
    return player_show(player, step - 1, true, THEN_LEAVE);
}

/* Steps, updates, lines, and steps again. */
static Status go_finer(Player *player, const Command *command)
{
    (void)command;
    static const char *const text[] = {
        "N and \u2190 go by whole steps",
        "N and \u2190 go by updates of Newton's method",
        "N and \u2190 go by lines of Algorithm 3",
    };
    if (!has_updates(player) && player->fine == 0)
        return player_refuse(player, player_simulation(player)->scene->turn
                                         ? "a step here has no finer ones"
                                         : "no step here has updates of "
                                           "Newton's method");
    player->fine = (player->fine + 1) % 3;
    if (player->fine == 0)
        player_leave_rounds(player);
    player->paused = true;
    player_note(player, "%s", text[player->fine]);
    return STATUS_OK;
}

/* Step 0, the newest one, or the one with this number. */
static Status go_to(Player *player, const Command *command)
{
    long step = command->kind == COMMAND_HOME  ? 0
                : command->kind == COMMAND_END ? past_newest(&player->past)
                                               : command->number;
    return player_show(player, step, false, THEN_NOTHING);
}

static Status make_step(Player *player, const Command *command)
{
    (void)command;
    player->paused = true;
    return player_step(player);
}

/* What was done last, or undone: "set stretch 1.2". */
static Status undo(Player *player, const Command *command)
{
    Past *past = &player->past;
    char line[2 * COMMAND_TEXT_SIZE];
    int way = command->kind == COMMAND_UNDO ? -1 : 1;
    long fork;
    const Command *made = past_undo(past, way, &fork);
    if (!made)
        return player_refuse(player, way < 0 ? "nothing is to be undone"
                                             : "nothing was undone");
    player->paused = true;
    player->halted = player->holds = player->drifts = false;
    Command edit = *made;
    edit.joins = false;
    command_format(&edit, line, sizeof line);
    Status status = player_fork(player, fork);
    player->by_run = false;
    player->then = THEN_NOTHING;
    for (int p = 0; p < past_panes(past); p++)
        player->side[p].rigid = player->side[p].idle = 0;
    player_leave_step(player);
    player_note(player, "%s: %s", way < 0 ? "undone" : "done again", line);
    return status ? status : player_work(player);
}

const Deed walk_deeds[] = {
    {COMMAND_PLAY, set_paused}, {COMMAND_PAUSE, set_paused},
    {COMMAND_NEXT, go_on},      {COMMAND_BACK, go_back},
    {COMMAND_STEP, make_step},  {COMMAND_FINER, go_finer},
    {COMMAND_HOME, go_to},      {COMMAND_END, go_to},
    {COMMAND_GOTO, go_to},      {COMMAND_UNDO, undo},
    {COMMAND_REDO, undo},       {COMMAND_NONE, NULL},
};
