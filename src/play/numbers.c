/* numbers.c - the row of numbers: adds, selects, types and sets numbers. */
#include <ctype.h>
#include <string.h>

#include "play/playing.h"

/* Returns the option that a command names, or NULL. */
static const OptionRow *find_command_option(const Command *command)
{
    return command->number < 0 ? NULL : &option_rows[command->number];
}

const char *player_find_idle_reason(const Player *player, const OptionRow *row)
{
    const Simulation *simulation = player_get_simulation(player);
    bool minimises = simulation->scene->step;
    int slot = row->slot;
    for (int p = 0; p < past_count_panes(&player->past); p++)
        minimises = minimises || player->past.pane[p].simulation.run[0].newton;
    if (slot == OPTION_SLOT(projection) &&
        !simulation_has_projection(simulation))
        return "nothing to project here";
    if (slot == OPTION_SLOT(line_search) &&
        !simulation_has_line_search(simulation))
        return "no line search here";
    if ((slot == OPTION_SLOT(tolerance) || slot == OPTION_SLOT(solver)) &&
        !minimises)
        return "explicit methods minimise nothing";
    return row->get_idle_reason
               ? row->get_idle_reason(player_get_active_options(player))
               : NULL;
}

Status obey_add_option(Player *player, const Command *command)
{
    const OptionRow *row = find_command_option(command);
    if (!row || !player_offers_option(player, row))
        return player_refuse(player, "this scene has no such number");
    const char *idle = player_find_idle_reason(player, row);
    if (idle)
        return player_refuse(player, "%s: %s", row->name, idle);
    player->input.added_option_rows |= (uint64_t)1 << (row - option_rows);
    player->screen.column = COLUMN_CARDS;
    player_deselect(player);
    player->input.selected_option = row;
    player_notify(player, "%s: %s; type a value and Enter", row->name,
                  row->help);
    return STATUS_OK;
}

Status obey_select_option(Player *player, const Command *command)
{
    const OptionRow *number[OPTIONS_MAX_ROWS];
    int next = 0, count = player_list_options(player, false, number);
    for (int i = 0; i < count; i++)
        next = number[i] == player->input.selected_option ? i + 1 : next;
    player_deselect(player);
    player->input.selected_option = next < count ? number[next] : NULL;
    return STATUS_OK;
}

/* Types or deletes a letter; the first letter opens the field. */
Status obey_type_letter(Player *player, const Command *command)
{
    char *typed = player->input.typed_text;
    bool list = player_shows_list(player),
         shift = strncmp(command->text, "Shift+", 6) == 0;
    const char *key = command->text + (shift ? 6 : 0);
    const LecturePage *page = player_get_active_options(player)->page;
    if (!list && !player->input.selected_option && !page_wants_number(page))
        return player_refuse(player, page_wants_click(page)
                                         ? "a click on the picture is the "
                                           "answer here; N shows it"
                                         : "say your answer; N shows it");
    if (!player->input.is_typing)
        typed[0] = '\0';
    player->input.is_typing = true;
    size_t length = strlen(typed);
    if (strcmp(key, "Backspace") == 0)
        typed[length > 0 ? length - 1 : 0] = '\0';
    else if (strcmp(key, "Space") == 0)
        append(typed, sizeof player->input.typed_text, " ");
    else if (!key[1])
        append(typed, sizeof player->input.typed_text, "%c",
               shift ? key[0] : tolower(key[0]));
    if (player->input.selected_option)
        player_notify(player, "type a value: Enter sets it, Esc leaves it");
    else
        player_notify(player, "%s %s_: Enter %s it, Esc leaves it",
                      !list                                     ? "your answer"
                      : player->screen.column == COLUMN_OPTIONS ? "number"
                                                                : "page",
                      typed, list ? "opens" : "checks");
    return STATUS_OK;
}

/* Sets an option in all panes, or only in the active one if the panes differ in
 * it or a page sets it.  Begins new runs if the option needs a new start. */
Status obey_set_option(Player *player, const Command *command)
{
    const OptionRow *row = find_command_option(command);
    const Simulation *simulation = player_get_simulation(player);
    Options options[OPTIONS_MAX_PANES];
    if (!row || row->kind == OPTION_TEXT || row->kind == OPTION_PAGE ||
        row->kind == OPTION_SWITCH)
        return player_refuse(player, "there is no option '%.*s' with a value",
                             (int)strcspn(row ? row->name : command->text, " "),
                             row ? row->name : command->text);
    const char *idle = player_find_idle_reason(player, row);
    if (idle)
        return player_refuse(player, "%s", idle);
    bool one = player->tour.is_page_running || player_panes_differ(player, row);
    int pane = one ? player->active_pane : ALL_PANES;
    int panes = player_copy_options(player, options);
    double old = options[player->active_pane].number[row->slot];
    Status status = STATUS_OK;
    const Message message = MESSAGE(player->message);
    for (int p = 0; p < panes && !status; p++) {
        if (pane != ALL_PANES && pane != p)
            continue;
        status =
            options_set(&options[p], row, command->text, command->x, message);
        if (!status &&
            row->max_repetitions) /* bodies and obstacles: no overlap */
            status = simulation_check_clearance(
                &player->past.pane[p].simulation, &options[p], message);
    }
    if (status)
        return status;
    Command change = *command;
    change.x = options[player->active_pane].number[row->slot];
    const SavedState *state =
        past_find_entry(&player->past, 0, player->past.shown_step)->state;
    bool is_set =
        state && state->is_set_by_user; /* the user has set the state */
    bool again = (!is_set || player_get_active_pane(player)->has_failed) &&
                 (row->effect == EFFECT_REPEATED_STEP ||
                  (player_get_active_options(player)->law_name &&
                   player->past.shown_step > 0 && player_is_stopped(player)) ||
                  (player->play.walk_unit != UNIT_STEP &&
                   player->view_of_pane[player->active_pane].trace_index >= 0));
    if (simulation_find_option_effect(simulation, row) == EFFECT_NEW_RUN)
        return player_restart_runs(player, options, panes, command);
    if (again && change.x != old)
        return player_repeat_step(player, &change, pane);
    return player_edit_step(player, &change, pane, false);
}

Status player_enqueue_notches(Player *player, const OptionRow *row, int notches)
{
    const Options now = player_get_shown_options(player);
    if (row->number_count > 1)
        return player_refuse(player, "several numbers: type them");
    player_enqueue_set(player, row,
                       option_find_value_after_wheel(row, &now, notches));
    return STATUS_OK;
}

Status obey_change_number(Player *player, const Command *command)
{
    const OptionRow *number[OPTIONS_MAX_ROWS];
    player_list_options(player, false, number); /* finds at least one number */
    player->input.selected_option = player->input.selected_option
                                        ? player->input.selected_option
                                        : number[0];
    return player_enqueue_notches(player, player->input.selected_option,
                                  command->kind == COMMAND_RAISE ? 1 : -1);
}

/* Sets an option to its default (player_find_defaults). */
Status obey_reset_option(Player *player, const Command *command)
{
    const OptionRow *row = find_command_option(command);
    const Options *now = &past_get_start_control(&player->past, 0)->options;
    Options options[OPTIONS_MAX_PANES];
    if (!row || !row->label)
        return player_refuse(player, "there is no such number");
    Status status =
        player_find_defaults(player, now->scene->name, now->page, options);
    if (!status)
        player_enqueue_set(player, row, options->number[row->slot]);
    return status;
}

Status obey_switch_option(Player *player, const Command *command)
{
    bool search = command->kind == COMMAND_SEARCH;
    const OptionRow *row = option_find(search ? "line-search" : "projection");
    double off = search ? LINE_SEARCH_NONE : PROJECTION_NONE;
    double on = player->setup.options[0].number[row->slot];
    if (on == off)
        on = search ? LINE_SEARCH_BACKTRACK : PROJECTION_CLAMP;
    bool was_off = player_get_active_options(player)->number[row->slot] == off;
    player_enqueue_set(player, row, was_off ? on : off);
    return STATUS_OK;
}
