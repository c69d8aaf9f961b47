/* change.c - what changes a run: numbers and methods, while it goes on or from
 * its start; the present step again; panes; pins and hands.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/playing.h"
#include "scenes/pages.h"
#include "scenes/scene.h"

/* Which panes a change of this option is for: the active one where they are
 * compared by it, else all.  from, to out: panes from ... to - 1. */
static void find_panes(const Player *player, const char *option, int *from,
                       int *to)
{
    bool one = option && player_compares(player, option);
    *from = one ? player->active : 0;
    *to = one ? player->active + 1 : past_panes(&player->past);
}

/* A change; again: of the step that is shown, which is to be made once more. */
static Status change_panes(Player *player, const Command *change, int from,
                           int to, bool again)
{
    Past *past = &player->past;
    long step = past->step;
    player->changed = true;
    if (player->rests && player->halted) /* something may move again */
        player->paused = player->halted = false;
    player->rests = player->drifts = false;
    Status status =
        past_edit(past, change, from, to, again, player_gesture(player),
                  player->message, sizeof player->message);
    if (status)
        return status;
    for (int p = from; p < to; p++)
        player->side[p].rigid = player->side[p].idle = 0;
    return player_fork(player, step - again);
}

Status player_change(Player *player, const Command *change, int from, int to)
{
    Status status = change_panes(player, change, from, to, false);
    if (!status)
        player_sample(player);
    return status;
}

Status player_change_all(Player *player, const Command *change)
{
    player->sampled = -1;
    return player_change(player, change, 0, past_panes(&player->past));
}

int player_options(const Player *player, Options options[OPTIONS_MAX_PANES])
{
    for (int p = 0; p < past_panes(&player->past); p++)
        options[p] = past_control(&player->past, p)->options;
    return past_panes(&player->past);
}

/* ---- the step once more: the counterfactual ------------------------------ */

/* "E +206 in 12 updates" */
static void tell_outcome(const Outcome *outcome, char *text, size_t size)
{
    snprintf(text, size, "E %+.3g in %d update%s%s%s", outcome->change,
             outcome->updates, outcome->updates == 1 ? "" : "s",
             outcome->status ? ", " : "",
             outcome->status ? status_text(outcome->status) : "");
}

/* What a value is called in a sentence. */
static void value_words(const char *option, const char *value, char *text,
                        size_t size)
{
    if (strcmp(value, "none") == 0)
        snprintf(text, size, "%s",
                 strcmp(option, "filter") == 0 ? "no projection" : "full step");
    else
        snprintf(text, size, "%s %s", option_find(option)->label, value);
}

/* Whether it is the projection or the line search that changes. */
static bool is_method(const char *option)
{
    return strcmp(option, "filter") == 0 || strcmp(option, "line-search") == 0;
}

/* The largest coordinate in the whole step, m. */
static double extent_of(const Machine *machine)
{
    return fmax(machine->outcome.extent,
                machine->known ? rounds_extent(&machine->rounds) : 0);
}

/* Keeps the positions of the active pane as a ghost. */
static void keep_ghost(Player *player, const char *label)
{
    const Simulation *simulation = player_simulation(player);
    Side *side = &player->side[player->active];
    size_t bytes = 2 * (size_t)simulation->system.nodes * sizeof(double);
    double *ghost = realloc(side->ghost, bytes);
    if (!ghost)
        return;
    side->ghost = ghost;
    memcpy(ghost, simulation->run[0].x, bytes);
    snprintf(side->ghost_label, sizeof side->ghost_label, "%s", label);
}

/* The change, and the present step once more with it, from its own start; what
 * it was before stays as a ghost. */
static Status retake_step(Player *player, const Command *change,
                          const char *option, const char *value,
                          const char *old, int from, int to)
{
    enum { SOON = 64 }; /* steps that are made again without a wait */
    Past *past = &player->past;
    Retake *retake = &player->retake;
    const Machine *machine = player_machine(player);
    const Side *side = &player->side[player->active];
    bool failed = machine->failed, simple = machine->simulation.scene->step;
    char was[64], had[80];
    long step = past->step + failed;
    if (step < 1)
        return player_change(player, change, from, to);
    *retake = (Retake){.edit = *change, .round = -1};
    if (side->place >= 0 && player->fine > 0) {
        retake->round = machine->rounds.place[side->place].round;
        retake->line = machine->rounds.place[side->place].line;
    }
    retake->extent = extent_of(machine);
    retake->alone = is_method(option) && past_panes(past) == 1 && past->keeps &&
                    step < SOON && !failed &&
                    (machine->simulation.scene->needs & NEEDS_MESH) &&
                    simulation_is_handled(&machine->simulation);
    value_words(option, old, was, sizeof was);
    value_words(option, value, retake->is, sizeof retake->is);
    tell_outcome(failed ? &machine->outcome
                        : &past_entry(past, player->active, step)->outcome,
                 had, sizeof had);
    snprintf(retake->had, sizeof retake->had, "%s: %s", was, had);
    bool paused = player->paused, holds = player->holds;
    player_leave_step(player);
    if (is_method(option) && !failed && !simple)
        keep_ghost(player, was);
    Status status = change_panes(player, change, from, to, !failed);
    if (status)
        return status;
    player->paused = paused;
    player->holds = holds;
    player->by_run = false;
    player->sampled = -1;
    past_aim(past, step, false);
    player->then = THEN_TELL;
    return player_work(player);
}

/* Two outcomes that no one picture can show are put beside each other: the step
 * as it was in a second pane. */
static Status put_beside(Player *player)
{
    Past *past = &player->past;
    const Command beside = {.kind = COMMAND_ADD_PANE};
    long step = past->step;
    player->retake.alone = false;
    long fork;
    past_undo(past, -1, &fork);
    player_next_gesture(player, COMMAND_ADD_PANE);
    Status status = past_set_panes(past, 2, player->grip, &beside);
    if (!status)
        status = past_edit(past, &player->retake.edit, 0, 1, true, player->grip,
                           player->message, sizeof player->message);
    if (!status)
        status = player_fork(player, step - 1);
    player_leave_step(player);
    past_aim(past, step, true);
    player->then = THEN_TELL;
    return status ? status : player_work(player);
}

Status player_tell_retake(Player *player)
{
    enum { TIMES = 5 };
    const Retake *retake = &player->retake;
    const Machine *machine = player_machine(player);
    double extent = extent_of(machine);
    char has[80];
    bool unlike = !(extent <= TIMES * retake->extent) ||
                  !(retake->extent <= TIMES * extent);
    if (retake->alone && unlike)
        return put_beside(player);
    if (retake->round >= 0 && machine->known && machine->rounds.places > 2)
        player->side[player->active].place =
            rounds_find(&machine->rounds, retake->round, retake->line);
    tell_outcome(&machine->outcome, has, sizeof has);
    player_note(player, "%s; %s: %s", retake->had, retake->is, has);
    return STATUS_OK;
}

/* ---- numbers and methods ------------------------------------------------- */

/* New runs with this option in these panes. */
static Status restart_with(Player *player, const char *option,
                           const char *value, int from, int to)
{
    Options options[OPTIONS_MAX_PANES];
    Command edit = {.kind = COMMAND_SET};
    int active = player->active;
    player_options(player, options);
    for (int i = from; i < to; i++)
        if (options_set(&options[i], option, value, player->message,
                        sizeof player->message))
            return STATUS_INVALID_INPUT;
    snprintf(edit.text, sizeof edit.text, "%.20s %.40s", option, value);
    Status status =
        player_begin(player, options, past_panes(&player->past), &edit);
    player->active = status ? player->active : active;
    return status;
}

/* An option while the run goes on, or from the start where it cannot change
 * any more. */
static Status set_option(Player *player, const char *text)
{
    const Simulation *simulation = player_simulation(player);
    Command change = {.kind = COMMAND_SET};
    char name[COMMAND_TEXT_SIZE], value[COMMAND_TEXT_SIZE];
    char old[COMMAND_TEXT_SIZE], now[COMMAND_TEXT_SIZE];
    size_t length = strcspn(text, " ");
    int from, to;
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    snprintf(value, sizeof value, "%s", text[length] ? text + length + 1 : "");
    snprintf(change.text, sizeof change.text, "%s", text);
    bool filter = strcmp(name, "filter") == 0;
    bool search = strcmp(name, "line-search") == 0;
    if (search && !simulation_has_line_search(simulation))
        return player_refuse(player, "no line search here");
    if (filter && !simulation_has_filter(simulation))
        return player_refuse(player, "nothing to project here");
    Options options = *player_settings(player);
    if (options_set(&options, name, value, player->message,
                    sizeof player->message))
        return STATUS_INVALID_INPUT;
    if (strcmp(name, "integrator") == 0 &&
        integrator_method_refuses(options_integrator(&options),
                                  &simulation->system))
        return player_refuse(player, "a term of this scene refuses it");
    find_panes(player, name, &from, &to);
    const OptionRow *row = option_find(name);
    option_value(row, player_settings(player), old, sizeof old);
    option_value(row, &options, now, sizeof now);
    Effect effect = simulation_effect(simulation, row);
    bool method = row->effect == EFFECT_AGAIN;
    if (effect == EFFECT_START) {
        Status status = restart_with(player, name, value, from, to);
        if (!status && method) /* races and maps of other runs */
            player_note(player, "from the start: %s %s", row->label, value);
        player_reset_speed(player);
        return status;
    }
    bool within = player->fine > 0 && player->side[player->active].place >= 0;
    Status status =
        (method || within) && strcmp(old, now) != 0
            ? retake_step(player, &change, name, value, old, from, to)
            : player_change(player, &change, from, to);
    player_reset_speed(player);
    return status;
}

static Status set(Player *player, const Command *command)
{
    return set_option(player, command->text);
}

/* What the journal keeps of it: the number and its new value. */
static Status obey_set(Player *player, const char *option, const char *value)
{
    Command command = {.kind = COMMAND_SET};
    snprintf(command.text, sizeof command.text, "%.20s %.40s", option, value);
    return player_obey(player, &command);
}

/* The selected number a pace up or down. */
static Status pace_number(Player *player, const Command *command)
{
    char value[COMMAND_TEXT_SIZE];
    const OptionRow *number[OPTIONS_MOST];
    const Options now = player_numbers(player), *options = &now;
    int count = options_row(options, number);
    if (count == 0)
        return player_refuse(player, "there is no number to change here");
    if (player->selected < 0 || player->selected >= count)
        player->selected = 0;
    option_write(number[player->selected],
                 option_paced(number[player->selected], options,
                              command->kind == COMMAND_RAISE ? 1 : -1),
                 value, sizeof value);
    return obey_set(player, number[player->selected]->name, value);
}

/* The value of the page, or of the command line, or of the scene by itself. */
static Status set_default(Player *player, const Command *command)
{
    const char *option = command->text;
    char value[COMMAND_TEXT_SIZE];
    const OptionRow *row = option_find(option);
    const Options *now = &past_start(&player->past, 0)->options;
    Options options[OPTIONS_MAX_PANES];
    int count;
    if (!row || !row->label)
        return player_refuse(player, "there is no such number");
    Status status =
        now->page
            ? lecture_options(now->page, options, player->message,
                              sizeof player->message)
            : player_scene_options(player, now->scene->name, options, &count);
    if (status)
        return status;
    option_value(row, options, value, sizeof value);
    return obey_set(player, option, value);
}

/* Tab: the next number, and after the last one none. */
static Status select_number(Player *player, const Command *command)
{
    (void)command;
    const OptionRow *number[OPTIONS_MOST];
    int count = options_row(player_settings(player), number);
    int next = player->selected + 1;
    player_deselect(player);
    player->selected = next < count ? next : -1;
    return STATUS_OK;
}

/* Off, or on again as the command line has it; where there is something to
 * switch. */
static Status switch_method(Player *player, const Command *command)
{
    char text[COMMAND_TEXT_SIZE];
    const Options *now = &*player_settings(player);
    const Options *given = &player->given[0];
    bool search = command->kind == COMMAND_SEARCH;
    LineSearch l = given->line_search, line = LINE_SEARCH_NONE;
    Filter f = given->filter, filter = FILTER_NONE;
    if (now->line_search == LINE_SEARCH_NONE)
        line = l != LINE_SEARCH_NONE ? l : LINE_SEARCH_BACKTRACK;
    if (now->filter == FILTER_NONE)
        filter = f != FILTER_NONE ? f : FILTER_CLAMP;
    snprintf(text, sizeof text, "%s %s", search ? "line-search" : "filter",
             search ? line_search_name(line) : filter_name(filter));
    return set_option(player, text);
}

const IntegratorMethod *player_next_method(const Simulation *simulation)
{
    const IntegratorMethod *next = simulation->run[0].method;
    if (simulation->runs > 1)
        return &integrator_methods[0];
    do {
        next = next[1].name ? next + 1 : &integrator_methods[0];
    } while (next != simulation->run[0].method &&
             integrator_method_refuses(next, &simulation->system));
    return next;
}

static Status switch_integrator(Player *player, const Command *command)
{
    (void)command;
    char text[COMMAND_TEXT_SIZE];
    const Simulation *simulation = player_simulation(player);
    if (!(simulation->scene->needs & NEEDS_TIME))
        return player_refuse(player, "no time passes here");
    const IntegratorMethod *next = player_next_method(simulation);
    if (next == simulation->run[0].method)
        return player_refuse(player, "no other method knows all terms of this "
                                     "scene");
    snprintf(text, sizeof text, "integrator %s", next->name);
    Status status = set_option(player, text);
    if (!status)
        player_note(player, "method: %s", next->label);
    return status;
}

/* ---- panes --------------------------------------------------------------- */

/* The same run with the next method beside the last one. */
static Status add_pane(Player *player, const Command *command)
{
    Past *past = &player->past;
    int panes = past_panes(past);
    const Simulation *simulation = &past->machine[panes - 1].simulation;
    Command change = {.kind = COMMAND_SET};
    const IntegratorMethod *next = player_next_method(simulation);
    if (panes == OPTIONS_MAX_PANES)
        return player_refuse(player, "six are side by side: no room for more");
    if (!(simulation->scene->needs & NEEDS_TIME))
        return player_refuse(player, "no time passes here: there is no other "
                                     "method to put beside it");
    if (simulation->runs > 1)
        return player_refuse(player, "several runs are in this picture "
                                     "already: nothing goes beside it");
    if (next == simulation->run[0].method)
        return player_refuse(player, "no other method knows all terms of this "
                                     "scene: nothing goes beside it");
    if (!past->keeps)
        return player_refuse(player, "nothing to be put beside it here");
    snprintf(change.text, sizeof change.text, "integrator %s", next->name);
    Status status =
        past_set_panes(past, panes + 1, player_gesture(player), command);
    if (!status)
        status = player_work(player);
    if (!status)
        status = player_change(player, &change, panes, panes + 1);
    player->active = panes;
    player_note(player, "beside it: %s", next->label);
    return status;
}

/* The last pane goes. */
static Status end_pane(Player *player, const Command *command)
{
    Past *past = &player->past;
    if (past_panes(past) < 2)
        return player_refuse(player, "there is only one");
    Status status = past_set_panes(past, past_panes(past) - 1,
                                   player_gesture(player), command);
    if (!status)
        status = player_fork(player, past->step);
    return status ? status : player_work(player);
}

/* The pane whose numbers are shown. */
static Status choose_pane(Player *player, const Command *command)
{
    if (command->number >= past_panes(&player->past))
        return player_refuse(player, "there is no such pane");
    player->active = (int)command->number;
    return STATUS_OK;
}

/* ---- hands --------------------------------------------------------------- */

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
    if (!simulation_is_handled(simulation))
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
    if (past_control(&player->past, player->active)->hand < 0)
        return player_refuse(player, "the hand holds nothing");
    player->holds = command->kind == COMMAND_DRAG;
    return player_change_all(player, command);
}

/* A point of the scene moves; a minimisation begins anew with it, at step 0. */
static Status move_handle(Player *player, const Command *command)
{
    Past *past = &player->past;
    const Simulation *simulation = player_simulation(player);
    Status status = STATUS_OK;
    unsigned needs = simulation->scene->needs;
    double at[SCENE_MAX_HANDLES][2];
    long step = past->step;
    int now = past->now;
    if ((needs & NEEDS_START) && !(needs & NEEDS_TIME) &&
        command->number < exhibit_handles(simulation, at))
        status = player_show(player, 0, false, THEN_NOTHING);
    if (!status)
        status = player_change_all(player, command);
    if (past->now > now)
        past->branch[now].left = step; /* where undo leads back to */
    return status;
}

const Deed change_deeds[] = {
    {COMMAND_SET, set},
    {COMMAND_DEFAULT, set_default},
    {COMMAND_SELECT, select_number},
    {COMMAND_RAISE, pace_number},
    {COMMAND_LOWER, pace_number},
    {COMMAND_FILTER, switch_method},
    {COMMAND_SEARCH, switch_method},
    {COMMAND_METHOD, switch_integrator},
    {COMMAND_ADD_PANE, add_pane},
    {COMMAND_END_PANE, end_pane},
    {COMMAND_PANE, choose_pane},
    {COMMAND_PIN, switch_pin},
    {COMMAND_GRAB, grab},
    {COMMAND_DRAG, pull},
    {COMMAND_RELEASE, pull},
    {COMMAND_HANDLE, move_handle},
    {COMMAND_FLIP, player_change_all},
    {COMMAND_NONE, NULL},
};
