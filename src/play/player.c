/* player.c - creates a player, draws its frames, runs its loop, ends it. */
#include "play/player.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "play/playing.h"

enum {
    FRAME_SIZE = 900,       /* pixels of a frame without a window */
    WINDOWLESS_STEPS = 100, /* default number of steps without a window */
    FRAME_RATE = 60,        /* frames a second at most */
    MAX_IDLE_WAIT = 200     /* longest wait for an input or a signal, ms */
};

static const double EARLY = 0.002; /* s by which a frame may be drawn early */

Status player_draw(Player *player)
{
    player->screen.must_redraw = false;
    if (!player->screen.draws_frames)
        return STATUS_OK;
    if (past_is_working(&player->past) && !past_makes_step(&player->past)) {
        /* The frame of the step is drawn when the work is done. */
        player->screen.must_redraw = true;
        return STATUS_OK;
    }
    Paper *paper = player_prepare_paper(player);
    if (!paper)
        return STATUS_OUT_OF_MEMORY;
    bool fresh = player->screen.drawn_step != player->past.shown_step;
    player->screen.drawn_step = player->past.shown_step;
    player_paint_frame(player, paper);
    Status status = player->screen.paper_size[0]
                        ? STATUS_OK
                        : player->screen.window->show(&paper->canvas);
    int slow = player->play.log_speed < 0 ? -player->play.log_speed : 0;
    if (!status && (fresh || film_is_open(&player->recording.film)))
        status = recording_write_frame(&player->recording, &paper->canvas,
                                       player->past.shown_step, 1 << slow);
    return status;
}

/* ---- the loop ------------------------------------------------------------ */

bool player_has_ended(const Player *player)
{
    const Options *options = &player->setup.options[0];
    const Simulation *simulation = &player->past.pane[0].simulation;
    bool counted = options->steps >= 0;
    if (player->is_quitting || *player->setup.stop_signal)
        return true;
    if (!script_is_over(&player->setup.script) ||
        past_is_working(&player->past))
        return false;
    return (counted && player->past.shown_step >= options->steps) ||
           ((!player->screen.window || counted) && simulation->is_over) ||
           (!player->screen.window && player_is_stopped(player));
}

static Status obey_due_script_lines(Player *player)
{
    Status status = STATUS_OK;
    while (!status && !player->is_quitting) {
        bool done = player->past.pane[0].simulation.is_over;
        const Command *command = script_take_due_command(
            &player->setup.script, player->past.shown_step,
            !player_is_stopped(player) && !done);
        if (!command)
            break;
        status = player_obey(player, command);
        if (status == STATUS_INVALID_INPUT) {
            char line[128];
            command_format(command, line, sizeof line);
            print_line(stderr, "script: step %ld: '%s': %s",
                       player->past.shown_step, line, player->message);
            player->message[0] = '\0';
            player->commands.has_refused_line = true;
            status = STATUS_OK;
        }
    }
    return status;
}

/* Makes the steps of one frame, within SLICE.  Without a window, one step. */
static Status make_due_steps(Player *player)
{
    const Past *past = &player->past;
    Status status = STATUS_OK;
    int count = player->screen.window && player->play.log_speed > 0
                    ? 1 << player->play.log_speed
                    : 1;
    double begin = count > 1 ? clock_now() : 0;
    for (int i = 0; i < count && !status; i++) {
        if (i > 0 && (player_has_ended(player) || clock_now() - begin > SLICE))
            break;
        if (player_is_stopped(player) && !past_is_working(past))
            break;
        status = player_make_step(player);
        if (past_is_working(past))
            break;
        if (!status)
            status = obey_due_script_lines(player);
    }
    return status;
}

Status player_make_frame(Player *player)
{
    double period =
        ldexp(1.0 / FRAME_RATE,
              player->play.log_speed < 0 ? -player->play.log_speed : 0);
    double start = clock_now();
    Status status = STATUS_OK;
    while (player->screen.window && !status && !player->is_quitting) {
        Input input = player->screen.window->read_input();
        if (input.kind == INPUT_NONE)
            break;
        status = player_show_refusal(player, player_obey_input(player, &input));
    }
    if (!status && !past_is_working(&player->past))
        status = obey_due_script_lines(player);
    double now = player->screen.window ? clock_now() : 0;
    if (player->screen.drawn_step < 0) /* draw a run before its first step */
        player->play.due_time = now + period;
    bool due = !player->screen.window || now >= player->play.due_time - EARLY;
    bool first = player->screen.drawn_step < 0 && player->screen.draws_frames;
    bool works = past_is_working(&player->past);
    /* Work that begins in this frame waits until the frame is drawn. */
    bool begins = works && player->play.work_start_time > start;
    bool lives = player->screen.sheet && player->screen.window;
    bool goes = !lives && !player_is_stopped(player) && due && !first &&
                !player_has_ended(player);
    if (!status && !begins && (works || goes)) {
        if (!works)
            player->play.due_time = fmax(player->play.due_time + period, now);
        status = make_due_steps(player);
    }
    if (lives && due) {
        player->play.due_time = now + 1.0 / FRAME_RATE;
        sheet_advance_cells(player);
    }
    if (!status && !player->is_quitting && player->screen.must_redraw)
        status = player_draw(player);
    return status;
}

bool player_is_idle(const Player *player)
{
    return player->screen.window && player_is_stopped(player) &&
           !player->screen.sheet && !past_is_working(&player->past) &&
           script_is_over(&player->setup.script);
}

int player_find_wait_time(const Player *player)
{
    double wait = 1e3 * (player->play.due_time - clock_now());
    if (player_is_idle(player))
        return MAX_IDLE_WAIT;
    if (!player->screen.window || past_is_working(&player->past) ||
        (player_is_stopped(player) && !script_is_over(&player->setup.script)))
        return 0;
    return (int)fmax(fmin(ceil(wait), MAX_IDLE_WAIT), 0);
}

Status player_run(Player *player)
{
    Status status = player_make_frame(player);
    while (!status && !player_has_ended(player)) {
        if (player->screen.window)
            player->screen.window->wait_for_input(
                player_find_wait_time(player));
        status = player_make_frame(player);
    }
    return status;
}

/* ---- beginning and end --------------------------------------------------- */

/* Opens the window.  If there is no screen, the frames are written to files. */
static void open_window(Player *player, const Window *window)
{
    Options *options = &player->setup.options[0];
    const int size[] = {(int)options->size[0], (int)options->size[1]};
    if (!options->headless && window->open(size, options->fullscreen))
        player->screen.window = window;
    if (!options->headless && !player->screen.window) {
        if (!options->frames && !options->film)
            options->frames = "frames";
        print_line(stderr, "no screen: %.300s; the frames go to %.300s%s",
                   window->get_failure_reason(),
                   options->frames ? options->frames : options->film,
                   options->frames ? "/" : "");
        window->close();
    }
    if (!player->screen.window && !options->script) {
        options->steps = options->steps < 0 ? WINDOWLESS_STEPS : options->steps;
        options->paused = 0; /* without a window no key can end a pause */
    }
    player->screen.draws_frames =
        player->screen.window || options->frames || options->film;
    for (int i = 0; i < 2 && !player->screen.window; i++)
        player->screen.paper_size[i] = size[i] > 0 ? size[i] : FRAME_SIZE;
}

Status player_create(const Options *options, char *const *words,
                     const Window *window, const volatile sig_atomic_t *stop,
                     Player *player)
{
    const Command begin = {.kind = COMMAND_RESTART};
    const Command pause = {.kind = COMMAND_PAUSE};
    memset(player, 0, sizeof *player); /* too large for a value on the stack */
    player->setup.arguments = words;
    player->setup.stop_signal = stop;
    player->tour.tour_page = options->page;
    memcpy(player->setup.options, options,
           (size_t)options->panes * sizeof *options);
    player->setup.start_time = clock_now();
    Status status = script_read(options->script, &player->setup.script,
                                MESSAGE(player->message));
    if (status)
        return status;
    open_window(player, window);
    player->setup.asks_guess = player->screen.window && !options->script;
    player->setup.is_attended =
        player->screen.window || options->script || options->page;
    options = player->setup.options;
    if (options->page)
        player_store_page_options(player, options);
    if (options->paused || (player->setup.asks_guess && options->steps < 0 &&
                            (options->page || options->scene->starts_paused)))
        player->play.mode = MODE_PAUSE;
    status = recording_open(options, &player->recording);
    past_create(player->setup.is_attended || player->screen.draws_frames,
                player->setup.is_attended && options->steps < 0, &player->past);
    if (!status)
        status = player_begin_runs(player, options, options->panes, &begin);
    /* Scripts begin unpaused: a paused run's journal begins with `pause`. */
    if (!status && player_is_stopped(player))
        status = script_add(&player->commands.journal, 0, &pause, 0);
    bool nodes = !status && player_get_simulation(player)->mesh.nodes > 0;
    if (!status && player->setup.asks_guess && options->page) {
        status = player_enqueue_page(player);
        status = status ? status : player_obey_queue(player, false);
    } else if (!status && player->setup.asks_guess &&
               simulation_is_draggable(player_get_simulation(player)))
        player_notify(player, "pull at a %s%s; G: scenes; Page Down: the tour",
                      nodes ? "node" : "mass",
                      nodes ? "; right click pins it" : "");
    return status;
}

static void close_window(Player *player)
{
    paper_free(&player->screen.paper);
    if (player->screen.window)
        player->screen.window->close();
    player->screen.draws_frames = false;
}

Status player_close_files(Player *player, Status status)
{
    if (player->past.branch_count > 0) {
        Status rest = player_write_missing_rows(player);
        status = status ? status : rest;
    }
    CloseAction keep = player->past.written_step < 0 ? KEEP_NOTHING
                       : status                      ? KEEP_PART_FILE
                                                     : KEEP_FILE;
    close_window(player);
    Status closed = recording_close(&player->recording, keep);
    return status ? status : closed;
}

void player_free(Player *player)
{
    close_window(player);
    recording_close(&player->recording, KEEP_NOTHING);
    free(player->recording.is_old_frame);
    past_free(&player->past);
    player_reset_view(player);
    sheet_close(player);
    control_release(player->commands.queue.pins);
    script_free(&player->setup.script);
    script_free(&player->commands.journal);
}
