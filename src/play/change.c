/* change.c - the settings of the run: numbers and methods, while it goes on or
 * from its start.
 */
#include <stdio.h>
#include <string.h>

#include "play/playing.h"
#include "scenes/pages.h"
#include "scenes/scene.h"

/* Which lanes a change of this option is for: the active one where they are
 * compared by it, else all.  from, to out: lanes from ... to - 1. */
static void find_lanes(const Player *player, const char *option, int *from,
                       int *to)
{
    bool one = option && player_compares(player, option);
    *from = one ? player->active : 0;
    *to = one ? player->active + 1 : player->lanes;
}

Status player_change_lanes(Player *player, const Command *change, int from,
                           int to)
{
    Status status = player_forget_later(player);
    player->changed = true;
    if (player->rests && player->halted) /* something may move again */
        player->paused = player->halted = false;
    player->rests = player->drifts = false;
    for (int i = from; i < to && !status; i++) {
        player->lane[i].rigid = player->lane[i].idle = 0;
        player->lane[i].ended = 0;
        status = track_change(&player->lane[i].track, change, player->message,
                              sizeof player->message);
        lane_sample_again(&player->lane[i], player->step);
    }
    return status;
}

Status player_change_all(Player *player, const Command *change)
{
    player->sampled = -1;
    return player_change_lanes(player, change, 0, player->lanes);
}

int player_options(const Player *player, Options options[OPTIONS_MAX_PANES])
{
    for (int i = 0; i < player->lanes; i++)
        options[i] = player->lane[i].track.settings.options;
    return player->lanes;
}

/* New runs with this option in these lanes. */
static Status restart_with(Player *player, const char *option,
                           const char *value, int from, int to)
{
    Options options[OPTIONS_MAX_PANES];
    int active = player->active;
    long newest = player->newest;
    player_options(player, options);
    for (int i = from; i < to; i++)
        if (options_set(&options[i], option, value, player->message,
                        sizeof player->message))
            return STATUS_INVALID_INPUT;
    Status status = player_try_restart(player, options);
    if (status)
        return status;
    player->active = active;
    player->forgotten[0] = 1;
    player->forgotten[1] = player->attended ? newest : 0;
    return STATUS_OK;
}

/* An option while the run goes on, or from the start where it cannot change
 * any more. */
static Status set_option(Player *player, const char *text)
{
    const Simulation *simulation = player_simulation(player);
    const Scene *scene = simulation->scene;
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
    Options options = player_settings(player)->options;
    if (options_set(&options, name, value, player->message,
                    sizeof player->message))
        return STATUS_INVALID_INPUT;
    if (strcmp(name, "integrator") == 0 &&
        integrator_method_refuses(options_integrator(&options),
                                  &simulation->system))
        return player_refuse(player, "a term of this scene refuses it");
    find_lanes(player, name, &from, &to);
    const OptionRow *row = option_find(name);
    option_value(row, &player_settings(player)->options, old, sizeof old);
    option_value(row, &options, now, sizeof now);
    bool time = scene->needs & NEEDS_TIME;
    bool method = filter || search;
    bool iterates = scene->needs & NEEDS_START; /* a step is an update */
    bool live = row->live && (time || (method && iterates)) &&
                (simulation->runs == 1 || strcmp(name, "integrator") != 0);
    if (!live) {
        Status status = restart_with(player, name, value, from, to);
        if (!status && method) /* races and maps of other runs */
            player_note(player, "from the start: %s %s", row->label, value);
        player_reset_speed(player);
        return status;
    }
    bool within = player->fine > 0 && player_lane(player)->place >= 0;
    Status status =
        (method || within) && strcmp(old, now) != 0
            ? retake_step(player, &change, name, value, old, from, to)
            : player_change_lanes(player, &change, from, to);
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
    const Options *now = &player->lane[0].track.options;
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
    int count = options_row(&player_settings(player)->options, number);
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
    const Options *now = &player_settings(player)->options;
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

const Deed change_deeds[] = {
    {COMMAND_SET, set},
    {COMMAND_DEFAULT, set_default},
    {COMMAND_SELECT, select_number},
    {COMMAND_RAISE, pace_number},
    {COMMAND_LOWER, pace_number},
    {COMMAND_FILTER, switch_method},
    {COMMAND_SEARCH, switch_method},
    {COMMAND_METHOD, switch_integrator},
    {COMMAND_NONE, NULL},
};
