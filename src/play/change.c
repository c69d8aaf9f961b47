/* change.c - what changes a run.  From step 0: again, from another start,
 * another scene, a page of the lecture, a cell of the map.  While it goes on or
 * from its start: numbers and methods; the present step again; panes; pins and
 * hands.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "picture/plot.h"
#include "play/playing.h"
#include "run/body.h"
#include "lesson/pages.h"
#include "run/scene.h"
#include "scenes/small_scenes.h"

Status player_own_options(Player *player, const char *scene,
                          const LecturePage *page, Options *options, int *count)
{
    const Options *given = &player->given[0];
    *count = 1;
    Status status = page ? lecture_options(page, options, player->message,
                                           sizeof player->message)
                         : options_of_line(scene, options, player->message,
                                           sizeof player->message);
    if (status)
        return status;
    options->big = given->big;
    if (page)
        return STATUS_OK;
    options->speed = given->speed;
    if (options->scene == given->scene && !given->page) {
        *count = given->panes;
        memcpy(options, given, (size_t)*count * sizeof *given);
    }
    return STATUS_OK;
}

/* Another scene, from its start; it keeps the pause, and one that explains
 * something begins with one. */
Status obey_scene(Player *player, const Command *command)
{
    Options options[OPTIONS_MAX_PANES];
    int count;
    bool runs = player->mode >= MODE_END || !player_stands(player);
    Status status =
        player_own_options(player, command->text, NULL, options, &count);
    if (!status)
        status = player_begin(player, options, count, command);
    if (status)
        return status;
    player_close_sheet(player);
    bool explains = options->scene->explains && !player->given[0].script;
    player->mode = runs && !explains ? MODE_RUN : MODE_PAUSE;
    if (player->column != COLUMN_KEYS)
        player->column = COLUMN_CARDS;
    return STATUS_OK;
}

/* Whether a page has commands when it opens, and the nodes that they name. */
static bool opens_again(Player *player, const Options *now)
{
    Options own;
    const LecturePage *page = now->page;
    return page && page->open &&
           !lecture_options(page, &own, player->message,
                            sizeof player->message) &&
           own.segments == now->segments;
}

/* Whether the page runs once its answer is shown. */
static bool plays_again(const Player *player, const LecturePage *page)
{
    return page && page == player->told && page->tell &&
           strstr(page->tell, "play");
}

/* Obstacles that stand where the body begins go back to where they began.
 * INVALID_INPUT: one was not there then. */
static Status clear_start(Player *player, int pane, Options *options)
{
    Options began = past_start(&player->past, pane)->options;
    Options kept = *options;
    int count = (int)(options->grounds + options->balls);
    Refusal told = {player->message, sizeof player->message};
    if (!(options->scene->needs & NEEDS_BODY) || !body_check(options, told))
        return STATUS_OK;
    if (began.grounds != options->grounds || began.balls != options->balls)
        return STATUS_INVALID_INPUT;
    for (int k = 0; k < count; k++)
        memcpy(obstacle_at(&kept, k), obstacle_at(&began, k), sizeof began.at);
    for (int k = 0; k < count; k++) {
        double *at = obstacle_at(&kept, k);
        memcpy(at, obstacle_at(options, k), sizeof began.at);
        if (body_check(&kept, told))
            memcpy(at, obstacle_at(&began, k), sizeof began.at);
    }
    *options = kept;
    return body_check(options, told);
}

/* New runs in which the nodes are pinned that are pinned now, unless their
 * bodies have other nodes; then the page opens, where it is to. */
static Status begin_again(Player *player, const Options *options, int panes,
                          bool opens, const Command *edit)
{
    const Control *before = control_keep(past_control(&player->past, 0));
    Status status = player_begin(player, options, panes, edit);
    player->fine = opens ? 0 : player->fine;
    if (!status && opens && player->asks) /* a script has these commands */
        status = player_open_page(player);
    const Control *now = past_control(&player->past, 0);
    bool same = now->options.scene == before->options.scene &&
                now->options.page == before->options.page &&
                now->nodes == before->nodes;
    for (int i = 0; i < before->nodes && same && !status; i++) {
        const Command pin = {
            .kind = COMMAND_PIN, .number = i, .x = before->pinned[i]};
        now = past_control(&player->past, 0);
        if (now->pinned[i] != before->pinned[i])
            status = player_change(player, &pin, 0, past_panes(&player->past),
                                   false);
    }
    control_drop(before);
    return status;
}

/* From step 0 with the present numbers, pins, balls and grounds, or from
 * another start; a pause that nobody asked for ends.  A page opens again, and
 * runs again. */
Status obey_restart(Player *player, const Command *command)
{
    Options options[OPTIONS_MAX_PANES];
    int panes = player_options(player, options);
    for (int p = 0; p < panes; p++)
        if (clear_start(player, p, &options[p]))
            return STATUS_INVALID_INPUT;
    bool moves = command->kind == COMMAND_START;
    if (moves && !(options->scene->needs & NEEDS_START))
        return player_refuse(player, "this scene has no start to choose");
    for (int p = 0; p < panes && moves; p++) {
        options[p].start[0] = command->x;
        options[p].start[1] = command->y;
    }
    if (moves)
        player->mode = MODE_PAUSE;
    else if (player->mode >= MODE_END && !options->page &&
             !options->scene->explains)
        player->mode = MODE_RUN;
    if (!moves)
        player->show.lens = LENS_FITS;
    bool opens = !moves && opens_again(player, options);
    Status status =
        begin_again(player, options, opens ? 1 : panes, opens, command);
    if (!moves && plays_again(player, options->page))
        player->mode = MODE_RUN;
    return status;
}

/* ---- the lecture --------------------------------------------------------- */

Status player_obey_lines(Player *player, const char *lines)
{
    Status status = STATUS_OK;
    while (lines && *lines && !status) {
        char line[COMMAND_TEXT_SIZE];
        Command command;
        size_t length = strcspn(lines, ";");
        snprintf(line, sizeof line, "& %.*s", (int)length, lines);
        lines += length + (lines[length] == ';');
        status = command_parse(line, &command, player->message,
                               sizeof player->message);
        if (!status)
            status = player_obey(player, &command);
    }
    return status;
}

Status player_open_page(Player *player)
{
    const LecturePage *page = player_settings(player)->page;
    player->opens = true; /* nobody has asked for these steps */
    Status status = player_obey_lines(player, page ? page->open : NULL);
    player->opens = false;
    return status;
}

bool player_veils(const Player *player)
{
    const LecturePage *page = player_settings(player)->page;
    return page && page->ask && player->told != page && player->asks &&
           !player->opens;
}

/* Keeps what became of a guess for the page's card and for the score. */
static void judge_guess(Player *player, bool right, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(player->verdict, sizeof player->verdict, format, arguments);
    va_end(arguments);
    player->guesses++;
    player->right += right;
}

/* A guess within two percent is right, as it may be calculated on paper. */
Status player_unveil(Player *player, const char *typed)
{
    const LecturePage *page = player_settings(player)->page;
    const OptionRow any = {
        .kind = OPTION_NUMBER, .unit = "", .low = -HUGE_VAL, .high = HUGE_VAL};
    double truth = page->answer ? show_number(&player->show, page->answer) : 0;
    double guess = truth;
    if (typed && (!option_read(&any, typed, &guess) || !isfinite(guess)))
        return player_refuse(player, "a number is wanted: 0.25 or 1/4");
    bool right = fabs(guess - truth) <= 0.02 * fabs(truth);
    Number number = number_with(truth, 5);
    player->told = page;
    player->verdict[0] = '\0';
    if (typed && !page->answer)
        snprintf(player->verdict, sizeof player->verdict, "Your answer: %s.",
                 typed);
    else if (typed && !isnan(truth))
        judge_guess(player, right, right ? "%s is right." : "%s? It is %s.",
                    typed, number.text);
    Status status = player_obey_lines(player, page->tell);
    if (page->answer && !isnan(truth))
        player_note(player, "%s%sit is %s", typed ? typed : "",
                    !typed  ? ""
                    : right ? ": right, "
                            : ": no, ",
                    number.text);
    return status;
}

/* The page that is asked for, from its start with its settings: by its name;
 * the next one or the one before; the one that was left for another scene; or
 * the first. */
Status obey_page(Player *player, const Command *command)
{
    Options options;
    int count;
    const LecturePage *page = player_settings(player)->page;
    bool on = command->kind == COMMAND_PAGE_ON;
    if (command->kind == COMMAND_PAGE) {
        page = lecture_find(command->text);
        if (!page)
            return player_refuse(player,
                                 "there is no page '%s', they are 1 ... %d",
                                 command->text, lecture_count());
    } else if (page) {
        if (on ? !page[1].name : page == lecture_pages)
            return player_refuse(player, on ? "this is the last page"
                                            : "this is the first page");
        page += on ? 1 : -1;
    } else if (player->left) {
        page = player->left + (on && player->left[1].name);
    } else {
        page = &lecture_pages[0];
    }
    Status status = player_own_options(player, "", page, &options, &count);
    if (status)
        return status;
    status = player_begin(player, &options, 1, command);
    player->speed = player_first_speed(player, &options);
    player->left = page;
    player->told = NULL;
    player->verdict[0] = '\0';
    player->column = COLUMN_CARDS;
    player->fine = 0;
    player_close_sheet(player);
    if (status || !player->asks)
        return status;
    player->mode = MODE_PAUSE;
    return player_open_page(player);
}

/* A guess of where the next step leads; on a page that asks for a click it is
 * the answer.  A guess is right within a tenth of the way. */
Status obey_predict(Player *player, const Command *command)
{
    double at[2];
    Simulation *simulation = &player->past.machine[player->active].simulation;
    if (simulation->done || simulation_point(simulation, at) == 0)
        return player_refuse(player, "nothing to predict here");
    player_stop(player);
    scene_predict(simulation, command->x, command->y);
    const Prediction *guess = &simulation->prediction;
    if (!player_veils(player))
        return STATUS_OK;
    double way = math_hypot(guess->came[0] - at[0], guess->came[1] - at[1]);
    bool right = guess->distance <= 0.1 * way;
    Status status = player_unveil(player, NULL);
    judge_guess(player, right,
                right ? "Your click is right." : "Your click is %s off.",
                number_of(guess->distance).text);
    return status;
}

/* ---- the map ------------------------------------------------------------- */

/* Shows a cell of the envelope. */
Status obey_cell(Player *player, const Command *command)
{
    int cell = (int)command->number;
    return envelope_visit(&player->past.machine[player->active].simulation,
                          cell % ENVELOPE_COLUMNS, cell / ENVELOPE_COLUMNS);
}

/* ---- while it goes on ---------------------------------------------------- */

/* In all panes. */
static Status change_all(Player *player, const Command *change)
{
    return player_change(player, change, 0, past_panes(&player->past), false);
}

bool player_compares(const Player *player, const OptionRow *row)
{
    const Past *past = &player->past;
    bool differ = false;
    for (int i = 1; row->label && i < past_panes(past); i++)
        differ = differ || past_control(past, i)->options.number[row->slot] !=
                               past_control(past, 0)->options.number[row->slot];
    return differ;
}

int player_options(const Player *player, Options options[OPTIONS_MAX_PANES])
{
    const Past *past = &player->past;
    for (int p = 0; p < past_panes(past); p++) {
        options[p] = past_control(past, p)->options;
        options[p].flips = exhibit_flips(&past->machine[p].simulation);
    }
    return past_panes(past);
}

/* ---- numbers and methods ------------------------------------------------- */

/* The option that a command is about, or NULL. */
static const OptionRow *row_of(const Command *command)
{
    return command->number < 0 ? NULL : &option_rows[command->number];
}

/* Whether it is one that the scene can make use of. */
static bool is_number(const Player *player, const OptionRow *row)
{
    return (row->needs & player_settings(player)->scene->needs) &&
           row->kind != OPTION_SWITCH && row->kind != OPTION_TEXT;
}

int player_row(const Player *player, bool all,
               const OptionRow *found[OPTIONS_MOST])
{
    const Options options = player_numbers(player);
    int own = all ? 0 : options_row(&options, found), count = own;
    for (const OptionRow *row = option_rows; row->name; row++) {
        bool more = all || player->added >> (row - option_rows) & 1;
        more = more && is_number(player, row);
        for (int i = 0; i < own; i++)
            more = more && found[i] != row;
        if (more)
            found[count++] = row;
    }
    return all || count < LAYOUT_SETTINGS ? count : LAYOUT_SETTINGS - 1;
}

const char *player_idle(const Player *player, const OptionRow *row)
{
    const Simulation *simulation = player_simulation(player);
    bool minimises = simulation->scene->step;
    int slot = row->slot;
    for (int p = 0; p < past_panes(&player->past); p++)
        minimises =
            minimises || player->past.machine[p].simulation.run[0].newton;
    if (slot == OPTION_SLOT(projection) &&
        !simulation_has_projection(simulation))
        return "nothing to project here";
    if (slot == OPTION_SLOT(line_search) &&
        !simulation_has_line_search(simulation))
        return "no line search here";
    if ((slot == OPTION_SLOT(tolerance) || slot == OPTION_SLOT(solver)) &&
        !minimises)
        return "explicit methods minimise nothing";
    return row->idle ? row->idle(player_settings(player)) : NULL;
}

/* The row of numbers has this one, too, and it is lit. */
Status obey_add(Player *player, const Command *command)
{
    const OptionRow *row = row_of(command);
    if (!row || !is_number(player, row))
        return player_refuse(player, "this scene has no such number");
    const char *idle = player_idle(player, row);
    if (idle)
        return player_refuse(player, "%s: %s", row->name, idle);
    player->added |= (uint64_t)1 << (row - option_rows);
    player->column = COLUMN_CARDS;
    player_deselect(player);
    player->lit = row;
    player_note(player, "%s: %s; type a value and Enter", row->name, row->help);
    return STATUS_OK;
}

/* The value of a command into the options of a pane. */
static Status put_value(Player *player, int pane, const Command *command,
                        Options *options)
{
    const OptionRow *row = &option_rows[command->number];
    Status status = command->text[0]
                        ? options_set(options, row->name, command->text,
                                      player->message, sizeof player->message)
                        : options_put(options, row, command->x, player->message,
                                      sizeof player->message);
    if (!status && row->slot == OPTION_SLOT(integrator) &&
        integrator_method_refuses(options_method(options),
                                  &player_simulation(player)->system))
        return player_refuse(player, "a term of this scene refuses it");
    return status || !row->times
               ? status
               : simulation_has_room(&player->past.machine[pane].simulation,
                                     options, player->message,
                                     sizeof player->message);
}

/* An option while the run goes on, or from the start where it cannot change any
 * more: in the active pane where they are compared by it or a page opens, else
 * in all. */
Status obey_set(Player *player, const Command *command)
{
    const OptionRow *row = row_of(command);
    const Simulation *simulation = player_simulation(player);
    Options options[OPTIONS_MAX_PANES];
    if (!row || row->kind == OPTION_TEXT || row->kind == OPTION_PAGE)
        return player_refuse(player, "there is no option '%s' with a value",
                             row ? row->name : command->text);
    const char *idle = player_idle(player, row);
    if (idle)
        return player_refuse(player, "%s", idle);
    bool one = player->opens || player_compares(player, row);
    int from = one ? player->active : 0;
    int to = one ? player->active + 1 : past_panes(&player->past);
    player_options(player, options);
    double old = options[player->active].number[row->slot];
    Status status = STATUS_OK;
    for (int p = from; p < to && !status; p++)
        status = put_value(player, p, command, &options[p]);
    if (status)
        return status;
    Command change = *command;
    change.x = options[player->active].number[row->slot];
    bool again =
        (!past_is_given(&player->past) || player_machine(player)->failed) &&
        (row->effect == EFFECT_AGAIN ||
         (player_settings(player)->law && player->past.step > 0 &&
          player_stands(player)) ||
         (player->fine > 0 && player->side[player->active].place >= 0));
    if (simulation_effect(simulation, row) == EFFECT_START)
        return begin_again(player, options, past_panes(&player->past), false,
                           command);
    if (again && change.x != old)
        return player_retake(player, &change, from, to);
    return player_change(player, &change, from, to, false);
}

Status player_pace(Player *player, const OptionRow *row, int paces)
{
    const Options now = player_numbers(player);
    if (row->count > 1)
        return player_refuse(player, "several numbers: type them");
    return player_ask_set(player, row, option_paced(row, &now, paces));
}

/* The lit number, or else the first one, a pace up or down. */
Status obey_raise(Player *player, const Command *command)
{
    const OptionRow *number[OPTIONS_MOST];
    if (player_row(player, false, number) == 0)
        return player_refuse(player, "there is no number to change here");
    player->lit = player->lit ? player->lit : number[0];
    return player_pace(player, player->lit,
                       command->kind == COMMAND_RAISE ? 1 : -1);
}

/* The value of the page, or of the command line, or of the scene by itself. */
Status obey_default(Player *player, const Command *command)
{
    const OptionRow *row = row_of(command);
    const Options *now = &past_start(&player->past, 0)->options;
    Options options[OPTIONS_MAX_PANES];
    int count;
    if (!row || !row->label)
        return player_refuse(player, "there is no such number");
    Status status = player_own_options(player, now->scene->name, now->page,
                                       options, &count);
    return status ? status
                  : player_ask_set(player, row, options->number[row->slot]);
}

/* The next number, and after the last one none. */
Status obey_select(Player *player, const Command *command)
{
    const OptionRow *number[OPTIONS_MOST];
    int next = 0, count = player_row(player, false, number);
    for (int i = 0; i < count; i++)
        next = number[i] == player->lit ? i + 1 : next;
    player_deselect(player);
    player->lit = next < count ? number[next] : NULL;
    return STATUS_OK;
}

/* Off, or on again as the command line has it; where there is something to
 * switch. */
Status obey_switch(Player *player, const Command *command)
{
    bool search = command->kind == COMMAND_SEARCH;
    const OptionRow *row = option_find(search ? "line-search" : "projection");
    double off = search ? LINE_SEARCH_NONE : PROJECTION_NONE;
    double on = player->given[0].number[row->slot];
    if (on == off)
        on = search ? LINE_SEARCH_BACKTRACK : PROJECTION_CLAMP;
    bool was_off = player_settings(player)->number[row->slot] == off;
    return player_ask_set(player, row, was_off ? on : off);
}

/* The next method of the table for this pane: key M reaches it, all terms allow
 * it, and no pane has it.  NULL: refused. */
static const IntegratorMethod *find_method(Player *player, int pane)
{
    const Simulation *simulation = &player->past.machine[pane].simulation;
    const IntegratorMethod *own = simulation->run[0].method, *next = own;
    bool time = simulation->scene->needs & NEEDS_TIME, taken;
    do {
        next = next[1].name ? next + 1 : &integrator_methods[0];
        taken = next->by_name ||
                integrator_method_refuses(next, &simulation->system);
        for (int p = 0; p < past_panes(&player->past); p++)
            taken = taken ||
                    player->past.machine[p].simulation.run[0].method == next;
    } while (next != own && taken);
    if (simulation->runs > 1)
        next = &integrator_methods[0];
    if (time && next != own)
        return next;
    player_refuse(player,
                  time ? "key M has no other method for this scene"
                       : "no time passes here: there is no other method");
    return NULL;
}

Status obey_method(Player *player, const Command *command)
{
    const IntegratorMethod *next = find_method(player, player->active);
    return next ? player_ask_set(player, option_find("integrator"),
                                 (double)(next - integrator_methods))
                : STATUS_INVALID_INPUT;
}

/* ---- panes --------------------------------------------------------------- */

/* The same run with the next method beside the last one; a page says itself
 * what is another there. */
Status obey_add_pane(Player *player, const Command *command)
{
    int panes = past_panes(&player->past);
    const TimeIntegrator *run = player_simulation(player)->run;
    if (panes >= OPTIONS_MAX_DRAWN)
        return player_refuse(player, "six are side by side: no room for more");
    if (player_simulation(player)->runs > 1)
        return player_refuse(player, "several runs are in this picture "
                                     "already: nothing goes beside it");
    const IntegratorMethod *next =
        player->opens ? run->method : find_method(player, panes - 1);
    if (!next)
        return STATUS_INVALID_INPUT;
    const Command change = {.kind = COMMAND_SET,
                            .number = option_find("integrator") - option_rows,
                            .x = (double)(next - integrator_methods)};
    Status status = player_change(player, command, 0, 0, false);
    if (!status && !player->opens)
        status = player_change(player, &change, panes, panes + 1, false);
    if (status)
        return status;
    player->active = panes;
    player_note(player, "beside it: %s", next->label);
    return STATUS_OK;
}

/* The last pane goes. */
Status obey_end_pane(Player *player, const Command *command)
{
    if (past_panes(&player->past) < 2)
        return player_refuse(player, "there is only one");
    return player_change(player, command, 0, 0, false);
}

/* ---- hands --------------------------------------------------------------- */

/* Pins a node, or sets it free. */
Status obey_pin(Player *player, const Command *command)
{
    long node = command->number;
    const Simulation *simulation = player_simulation(player);
    if (!(simulation->scene->needs & NEEDS_MESH) || simulation->scene->step)
        return player_refuse(player, "only nodes of a square can be pinned");
    bool pinned = simulation->system.pinned[node];
    Command change = {.kind = COMMAND_PIN, .number = node, .x = !pinned};
    Status status = change_all(player, &change);
    if (!status)
        player_note(player, "node %ld is %s", node, pinned ? "free" : "pinned");
    return status;
}

/* The hand takes a node, or a ground or a ball, where it is. */
static Status take(Player *player, CommandKind kind, long number,
                   const double at[2])
{
    const Command change = {
        .kind = kind, .number = number, .x = at[0], .y = at[1]};
    Status status = change_all(player, &change);
    player->holds = player->holds || !status;
    if (!status && player_stands(player))
        player_note(player,
                    "paused: the hand %s as soon as time goes on (Space, N)",
                    kind == COMMAND_GRAB ? "pulls" : "pushes");
    return status;
}

Status obey_grab(Player *player, const Command *command)
{
    const Simulation *simulation = player_simulation(player);
    if (!simulation_is_draggable(simulation))
        return player_refuse(player, "nothing to take hold of here");
    return take(player, COMMAND_GRAB, command->number,
                simulation->run[0].x + 2 * command->number);
}

Status obey_push(Player *player, const Command *command)
{
    const Simulation *simulation = player_simulation(player);
    double at[2];
    if (!simulation_is_draggable(simulation))
        return player_refuse(player, "nothing to push here");
    simulation_obstacle(simulation, 0, (int)command->number, at);
    return take(player, COMMAND_PUSH, command->number, at);
}

/* A node is put somewhere: an experiment of one's own. */
Status obey_place(Player *player, const Command *command)
{
    if (!simulation_is_draggable(player_simulation(player)))
        return player_refuse(player, "nothing to be placed here");
    for (int p = 0; p < past_panes(&player->past); p++) {
        Simulation *simulation = &player->past.machine[p].simulation;
        if (simulation_place(simulation, (int)command->number, command->x,
                             command->y, false))
            return player_refuse(player,
                                 "no room for it there: an obstacle, a "
                                 "body, or a cell that would turn over");
    }
    return change_all(player, command);
}

/* A ground or a ball goes where the bodies leave room. */
Status obey_obstacle(Player *player, const Command *command)
{
    Options moved = *player_settings(player);
    double *at = obstacle_at(&moved, (int)command->number);
    at[0] = command->x;
    at[1] = command->y;
    Status status = STATUS_OK;
    for (int p = 0; p < past_panes(&player->past) && !status; p++)
        status =
            simulation_has_room(&player->past.machine[p].simulation, &moved,
                                player->message, sizeof player->message);
    return status ? status : change_all(player, command);
}

/* The hand pulls or pushes, or lets go. */
Status obey_drag(Player *player, const Command *command)
{
    if (!control_holds(past_control(&player->past, player->active)))
        return player_refuse(player, "the hand holds nothing");
    player->holds = command->kind == COMMAND_DRAG;
    player->pulled = player->past.step;
    return change_all(player, command);
}

/* A point or a switch of the scene; a minimisation begins anew with a point, at
 * step 0. */
Status obey_handle(Player *player, const Command *command)
{
    Past *past = &player->past;
    const Simulation *simulation = player_simulation(player);
    Status status = STATUS_OK;
    unsigned needs = simulation->scene->needs;
    long step = past->step;
    int now = past->now;
    if (command->kind == COMMAND_HANDLE && (needs & NEEDS_START) &&
        !(needs & NEEDS_TIME)) {
        player_stop(player);
        status = player_show(player, 0, THEN_NOTHING);
        status = status ? status : player_work(player);
    }
    if (!status)
        status = change_all(player, command);
    if (past->now > now)
        past->branch[now].shown = step; /* where undo leads back to */
    return status;
}
