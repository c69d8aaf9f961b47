/* start.c - begins runs of scenes and pages; answers the questions of pages. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mathematics.h"
#include "picture/live_values.h"
#include "picture/plot.h"
#include "play/playing.h"
#include "simulation/body.h"
#include "lesson/pages.h"
#include "scenes/small_scenes.h"

/* Begins another scene.  The scene begins paused if the last one was paused, or
 * if the user is to step through it (Scene.starts_paused). */
Status obey_open_scene(Player *player, const Command *command)
{
    Options options[OPTIONS_MAX_PANES];
    bool runs = player->play.mode >= MODE_END || !player_is_stopped(player);
    Status status = player_find_defaults(player, command->text, NULL, options);
    if (!status)
        status = player_begin_runs(player, options, options->panes, command);
    if (status)
        return status;
    sheet_close(player);
    bool explains =
        options->scene->starts_paused && !player->setup.options[0].script;
    player->play.mode = runs && !explains ? MODE_RUN : MODE_PAUSE;
    if (player->screen.column != COLUMN_KEYS)
        player->screen.column = COLUMN_CARDS;
    return STATUS_OK;
}

/* Makes room for the body at its start.  Obstacles that overlap the body go
 * back to their places when the run began.  Returns OK, or INVALID_INPUT if the
 * run began with another number of obstacles. */
static Status restore_obstacles(Player *player, int pane, Options *options)
{
    Options began = past_get_start_control(&player->past, pane)->options;
    Options kept = *options;
    int count = (int)(options->grounds + options->balls);
    Message message = MESSAGE(player->message);
    if (!(options->scene->traits & HAS_BODY) ||
        !body_check_start(options, message))
        return STATUS_OK;
    if (began.grounds != options->grounds || began.balls != options->balls)
        return STATUS_INVALID_INPUT;
    for (int k = 0; k < count; k++)
        memcpy(options_get_obstacle_point(&kept, k),
               options_get_obstacle_point(&began, k), sizeof began.at);
    for (int k = 0; k < count; k++) {
        double *at = options_get_obstacle_point(&kept, k);
        memcpy(at, options_get_obstacle_point(options, k), sizeof began.at);
        if (body_check_start(&kept, message))
            memcpy(at, options_get_obstacle_point(&began, k), sizeof began.at);
    }
    *options = kept;
    return body_check_start(options, message);
}

Status player_restore_pins(Player *player, const UserControl *before)
{
    if (!before)
        return STATUS_OK;
    const UserControl *now = past_get_control(&player->past, 0);
    bool same = now->options.scene == before->options.scene &&
                now->options.page == before->options.page &&
                now->nodes == before->nodes;
    Status status = STATUS_OK;
    for (int i = 0; i < before->nodes && same && !status; i++) {
        const Command pin = {
            .kind = COMMAND_PIN, .number = i, .x = before->is_pinned[i]};
        now = past_get_control(&player->past, 0);
        if (now->is_pinned[i] != before->is_pinned[i])
            status = player_edit_step(player, &pin, ALL_PANES, false);
    }
    control_release(before);
    return status;
}

Status player_restart_runs(Player *player, const Options *options, int panes,
                           const Command *edit)
{
    const UserControl *before =
        control_retain(past_get_control(&player->past, 0));
    const LecturePage *page = options->page;
    Options own; /* defaults of the page; on_open names nodes of its mesh */
    bool opens = edit->kind == COMMAND_RESTART && page && page->on_open &&
                 !lecture_make_options(page, &own, MESSAGE(player->message)) &&
                 own.segments == options->segments;
    Status status = player_begin_runs(player, options, opens ? 1 : panes, edit);
    if (opens)
        player->play.walk_unit = UNIT_STEP;
    /* A script contains the opening commands of its pages. */
    if (!status && opens && player->setup.asks_guess) {
        player->commands.queue.pins = before;
        return player_enqueue_page(player);
    }
    if (!status)
        return player_restore_pins(player, before);
    control_release(before);
    return status;
}

/* Begins the run again with the present numbers, pins and obstacles; in a
 * window a page pauses.  COMMAND_START also moves the start, and pauses.  Any
 * other run that had ended plays again unless its scene starts paused. */
Status obey_restart(Player *player, const Command *command)
{
    Options options[OPTIONS_MAX_PANES];
    int panes = player_copy_options(player, options);
    for (int p = 0; p < panes; p++)
        if (restore_obstacles(player, p, &options[p]))
            return STATUS_INVALID_INPUT;
    bool moves = command->kind == COMMAND_START;
    if (moves && !(options->scene->traits & HAS_START))
        return player_refuse(player, "this scene has no start to choose");
    for (int p = 0; p < panes && moves; p++) {
        options[p].start[0] = command->x;
        options[p].start[1] = command->y;
    }
    if (moves || (options->page && player->setup.asks_guess))
        player->play.mode = MODE_PAUSE;
    else if (player->play.mode >= MODE_END && !options->page &&
             !options->scene->starts_paused)
        player->play.mode = MODE_RUN;
    if (!moves)
        player->screen.view.lens = LENS_FITS;
    return player_restart_runs(player, options, panes, command);
}

Status player_enqueue_page(Player *player)
{
    const LecturePage *page = player_get_active_options(player)->page;
    player->commands.queue.is_from_page = true;
    return player_enqueue_lines(player, page ? page->on_open : NULL);
}

void player_store_page_options(Player *player, const Options *options)
{
    for (int p = 0; p < OPTIONS_MAX_DRAWN_PANES; p++)
        player->tour.page_options[p] = *options;
}

bool player_hides_answer(const Player *player)
{
    const LecturePage *page = player_get_active_options(player)->page;
    return page && page->question && player->tour.revealed_page != page &&
           player->setup.asks_guess && !player->tour.is_page_running;
}

/* A guess may be wrong by 2.5 percent, since it is calculated on paper. */
Status player_reveal_answer(Player *player, const char *typed)
{
    const LecturePage *page = player_get_active_options(player)->page;
    const OptionRow any = {
        .kind = OPTION_NUMBER, .unit = "", .low = -HUGE_VAL, .high = HUGE_VAL};
    FrameContent *content = &player->screen.frame.content;
    double truth =
        frame_find_value(content, page->answer_name ? page->answer_name : "");
    double guess = truth;
    if (typed && (!option_parse(&any, 1, typed, &guess) || !isfinite(guess)))
        return player_refuse(player, "a number is wanted: 0.25 or 1/4");
    bool right = fabs(guess - truth) <= 0.025 * fabs(truth);
    bool judged = typed && page->answer_name && !isnan(truth);
    player->tour.revealed_page = page;
    player->tour.guess_count += judged;
    player->tour.right_guess_count += judged && right;
    player->tour.verdict[0] = '\0';
    TextLine asked =
        text_find_known_line(&active_pane(content)->values, page->question);
    /* The numbers in the question are known once the page has been drawn. */
    bool is_filled = content->lecture.page == page;
    snprintf(player->tour.asked_question, ANSWER_SIZE, "%s",
             is_filled ? asked.text : page->question);
    if (judged)
        append(player->tour.verdict, VALUE_SIZE, "%s%s%s.", typed,
               right ? " is right" : "? It is ",
               right ? "" : format_digits(truth, 5).text);
    snprintf(player->commands.queue.end_note, SENTENCE_SIZE, "%s",
             player->tour.verdict);
    player->commands.queue.is_from_page = true;
    return player_enqueue_lines(player, page->on_answer);
}

/* Opens a page by its name, the next page, or the previous page.  From a scene,
 * "previous" is the last open page, "next" the page after the last open page;
 * if no page was open, both are the first page. */
Status obey_open_page(Player *player, const Command *command)
{
    Options options;
    const LecturePage *page = player_get_active_options(player)->page;
    bool on = command->kind == COMMAND_PAGE_ON;
    if (command->kind == COMMAND_PAGE) {
        page = lecture_find_page(command->text);
        if (!page)
            return player_refuse(player,
                                 "there is no page '%s', they are 1 ... %d",
                                 command->text, lecture_count_pages());
    } else if (page) {
        if (on ? !page[1].name : page == lecture_pages)
            return player_refuse(player, on ? "this is the last page"
                                            : "this is the first page");
        page += on ? 1 : -1;
    } else if (player->tour.tour_page) {
        page = player->tour.tour_page + (on && player->tour.tour_page[1].name);
    } else {
        page = &lecture_pages[0];
    }
    Status status = player_find_defaults(player, "", page, &options);
    if (status)
        return status;
    player_store_page_options(player, &options);
    status = player_begin_runs(player, &options, 1, command);
    player->play.log_speed = player_find_start_speed(player, &options);
    player->tour.tour_page = page;
    player->tour.revealed_page = NULL;
    player->tour.verdict[0] = '\0';
    player_deselect(player);
    player->screen.column = COLUMN_CARDS;
    player->play.walk_unit = UNIT_STEP;
    sheet_close(player);
    if (status || !player->setup.asks_guess)
        return status;
    player->play.mode = MODE_PAUSE;
    return player_enqueue_page(player);
}

/* Stores a guess of the point to which the next step leads.  A page that asks
 * for the guess judges it: the guess may be wrong by a tenth of the way. */
Status obey_store_guess(Player *player, const Command *command)
{
    double at[2];
    Simulation *simulation = &player->past.pane[player->active_pane].simulation;
    if (simulation->is_over || simulation_find_shown_point(simulation, at) == 0)
        return player_refuse(player, "nothing to predict here");
    player_pause(player);
    scene_store_guess(simulation, command->x, command->y);
    const UserPrediction *guess = &simulation->prediction;
    if (!player_hides_answer(player))
        return STATUS_OK;
    double way =
        math_hypot(guess->outcome[0] - at[0], guess->outcome[1] - at[1]);
    bool right = guess->error <= 0.1 * way;
    Status status = player_reveal_answer(player, NULL);
    player->tour.guess_count++;
    player->tour.right_guess_count += right;
    append(player->tour.verdict, VALUE_SIZE, "Your click is %s%s.",
           right ? "right" : format_number(guess->error).text,
           right ? "" : "\u00a0m off");
    return status;
}

Status obey_run_envelope_cell(Player *player, const Command *command)
{
    int cell = (int)command->number;
    return envelope_run_cell(&player->past.pane[player->active_pane].simulation,
                             cell % ENVELOPE_COLUMNS, cell / ENVELOPE_COLUMNS);
}
