/* session.c - state of a player for other files, messages, command queue. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "play/playing.h"
#include "lesson/pages.h"

enum {
    MAX_QUICK_NODES = 50000, /* largest mesh factorised within SLICE, nodes */
    NEWTON_SPEED = -5        /* log_speed if a step is a Newton update */
};

const PastPane *player_get_active_pane(const Player *player)
{
    return &player->past.pane[player->active_pane];
}

const Simulation *player_get_simulation(const Player *player)
{
    return &player_get_active_pane(player)->simulation;
}

const Options *player_get_active_options(const Player *player)
{
    return &past_get_control(&player->past, player->active_pane)->options;
}

Options player_get_shown_options(const Player *player)
{
    Options options = *player_get_active_options(player);
    options.timestep = player_get_simulation(player)->options.timestep;
    return options;
}

int player_copy_options(const Player *player,
                        Options options[OPTIONS_MAX_PANES])
{
    const Past *past = &player->past;
    for (int p = 0; p < past_count_panes(past); p++) {
        options[p] = past_get_control(past, p)->options;
        options[p].flips = exhibit_get_flip_bits(&past->pane[p].simulation);
    }
    return past_count_panes(past);
}

bool player_offers_option(const Player *player, const OptionRow *row)
{
    return (row->needs_any_trait &
            player_get_active_options(player)->scene->traits) &&
           row->kind != OPTION_SWITCH && row->kind != OPTION_TEXT;
}

int player_list_options(const Player *player, bool all,
                        const OptionRow *found[OPTIONS_MAX_ROWS])
{
    const Options options = player_get_shown_options(player);
    int own = all ? 0 : options_list_visible_rows(&options, found), count = own;
    for (const OptionRow *row = option_rows; row->name; row++) {
        bool more =
            all || player->input.added_option_rows >> (row - option_rows) & 1;
        more = more && player_offers_option(player, row);
        for (int i = 0; i < own; i++)
            more = more && found[i] != row;
        if (more)
            found[count++] = row;
    }
    return all || count < LAYOUT_MAX_SETTINGS ? count : LAYOUT_MAX_SETTINGS - 1;
}

const Options *player_find_page_options(const Player *player,
                                        const OptionRow *row)
{
    const Past *past = &player->past;
    const Options *own = player->tour.page_options;
    for (int p = 0; p < past_count_panes(past); p++)
        if (!option_is_equal(row, &own[p], &past_get_control(past, p)->options))
            return &own[p];
    return NULL;
}

bool player_has_changed_page(const Player *player)
{
    const OptionRow *row[OPTIONS_MAX_ROWS];
    const Options *own = player->tour.page_options;
    const Past *past = &player->past;
    const LecturePage *page = past_get_control(past, 0)->options.page;
    /* After undo the window may show another page than the one opened last. */
    if (!page || page != own->page || !player->setup.asks_guess)
        return false;
    bool is_changed =
        exhibit_get_flip_bits(&past->pane[0].simulation) != own->flips;
    for (int b = past->branch_index; !past->branch[b].begins_runs; b--)
        is_changed |= past->branch[b].edit.kind == COMMAND_HANDLE;
    int rows = player_list_options(player, true, row);
    for (int i = 0; i < rows && !is_changed; i++)
        is_changed = player_find_page_options(player, row[i]);
    return is_changed;
}

Status player_find_defaults(Player *player, const char *scene,
                            const LecturePage *page, Options *options)
{
    const Options *given = &player->setup.options[0];
    Status status =
        page ? lecture_make_options(page, options, MESSAGE(player->message))
             : options_parse_line(scene, options, MESSAGE(player->message));
    if (status)
        return status;
    options->big = given->big;
    if (page)
        return STATUS_OK;
    options->speed = given->speed;
    if (options->scene == given->scene && !given->page)
        memcpy(options, given, (size_t)given->panes * sizeof *given);
    return STATUS_OK;
}

bool player_panes_differ(const Player *player, const OptionRow *row)
{
    const Past *past = &player->past;
    bool differ = false;
    for (int i = 1; row->label && i < past_count_panes(past); i++)
        differ =
            differ || past_get_control(past, i)->options.number[row->slot] !=
                          past_get_control(past, 0)->options.number[row->slot];
    return differ;
}

bool player_is_stopped(const Player *player)
{
    return player->play.mode >= MODE_PAUSE;
}

uint64_t player_compute_hash(const Player *player)
{
    uint64_t hash = STATE_HASH_SEED;
    for (int i = 0; i < past_count_panes(&player->past); i++)
        hash = state_hash(&player->past.pane[i].simulation, hash);
    return hash;
}

bool player_factorises_slowly(const Player *player)
{
    const Simulation *simulation = player_get_simulation(player);
    return simulation->options.solver == SOLVER_NEWTON &&
           simulation->system.nodes > MAX_QUICK_NODES;
}

void player_sample_line_energy(Player *player)
{
    const FrameContent *content = &player->screen.frame.content;
    bool has_cards = content->has_document || !content->is_stage_only;
    bool is_drawn = player->screen.draws_frames && !player->screen.is_bare &&
                    has_cards &&
                    cards_need_line_energy(player_get_simulation(player),
                                           player->screen.toggled_cards);
    Past *past = &player->past;
    const PastPane *pane = player_get_active_pane(player);
    past->line_energy_pane = is_drawn ? player->active_pane : -1;
    bool lacks = is_drawn && pane->has_trace && !past_is_working(past) &&
                 step_trace_lacks_samples(
                     &pane->trace,
                     player->view_of_pane[player->active_pane].trace_index);
    for (int p = 0; p < past_count_panes(past); p++)
        lacks = lacks && !past->pane[p].has_failed;
    if (lacks)
        past_set_goal(past, past->shown_step, true);
}

int player_find_start_speed(const Player *player, const Options *options)
{
    double speed = options->speed;
    if (speed == 0 && !options->page && player->setup.is_attended)
        speed = options->scene->steps_per_frame;
    if (speed > 0)
        return (int)lrint(
            fmin(fmax(log2(speed), MIN_LOG_SPEED), MAX_LOG_SPEED));
    return options->scene->traits & HAS_TIME ? 0 : NEWTON_SPEED;
}

bool player_shows_list(const Player *player)
{
    return player->screen.column == COLUMN_PAGES ||
           player->screen.column == COLUMN_OPTIONS || player->screen.sheet;
}

void player_deselect(Player *player)
{
    player->input.selected_option = NULL;
    player->input.is_typing = false;
}

void player_format_value(const OptionRow *row, const Options *options,
                         const Simulation *simulation, char *text, size_t size)
{
    char value[COMMAND_TEXT_SIZE], unit[16] = "";
    option_write_short_value(row, options, value, sizeof value);
    if (strcmp(value, "none") != 0)
        option_write_unit(row, unit, sizeof unit);
    if (strcmp(row->name, "tolerance") == 0 && simulation->descent.tests_g)
        snprintf(unit, sizeof unit, "%s", /* unit of the gradient's norm */
                 simulation->scene->picture == PICTURE_CURVE ? "" : "kg m");
    if (row->slot == OPTION_SLOT(integrator) && simulation->runs > 1 &&
        simulation->run[0].method != simulation->run[1].method)
        snprintf(text, size, "three Eulers");
    else if (row->slot == OPTION_SLOT(integrator))
        snprintf(text, size, "%s",
                 integrator_methods[(int)fmax(options->integrator, 0)].label);
    else if (strcmp(row->name, "solver") == 0 && simulation->steps > 0 &&
             simulation->run[0].newton &&
             simulation->run[0].newton->active_solver != options->solver)
        snprintf(text, size, "%.12s: %s", value,
                 get_solver_name(simulation->run[0].newton->active_solver));
    else
        snprintf(text, size, "%.20s%s%s", value, unit[0] ? " " : "", unit);
}

void player_notify(Player *player, const char *format, ...)
{
    write_formatted(player->note, sizeof player->note, format);
    player->is_warning = player->explains_hover = false;
    player->screen.must_redraw = true;
}

Status player_show_refusal(Player *player, Status status)
{
    if (status != STATUS_INVALID_INPUT)
        return status;
    player_notify(player, "%s", player->message);
    player->message[0] = '\0';
    return STATUS_OK;
}

void player_pause(Player *player)
{
    if (!player_is_stopped(player))
        player->play.mode = MODE_PAUSE;
}

Status player_pause_after_failure(Player *player, Status status)
{
    bool fatal = status == STATUS_OUT_OF_MEMORY ||
                 status == STATUS_INVALID_INPUT ||
                 status == STATUS_FILE_FAILED || status == STATUS_SCREEN_FAILED;
    if (!status || fatal || !player->setup.is_attended ||
        player->setup.options[0].steps >= 0)
        return status;
    player_pause(player);
    return STATUS_OK;
}

void player_enqueue(Player *player, const Command *command)
{
    CommandQueue *queue = &player->commands.queue;
    Command *last = queue->command + (queue->count > 0 ? queue->count - 1 : 0);
    if (queue->count > 0 && command_replaces(command, last))
        *last = *command;
    else if (queue->count < MAX_QUEUED_COMMANDS)
        queue->command[queue->count++] = *command;
}

Command make_set_command(const OptionRow *row, double value)
{
    return (Command){
        .kind = COMMAND_SET,
        .number = row - option_rows,
        .x = row->kind == OPTION_NAME ? option_get_name_index(value) : value,
        .joins_gesture = true};
}

void player_enqueue_set(Player *player, const OptionRow *row, double value)
{
    const Command command = make_set_command(row, value);
    player_enqueue(player, &command);
}

Status player_enqueue_lines(Player *player, const char *lines)
{
    Status status = STATUS_OK;
    while (lines && *lines && !status) {
        char line[COMMAND_TEXT_SIZE];
        Command command;
        size_t length = strcspn(lines, ";");
        snprintf(line, sizeof line, "& %.*s", (int)length, lines);
        lines += length + (lines[length] == ';');
        status = command_parse(line, &command, MESSAGE(player->message));
        if (!status && player->commands.queue.count == MAX_QUEUED_COMMANDS)
            status = player_refuse(player, "too many commands at once");
        if (!status)
            player_enqueue(player, &command);
    }
    return status;
}
