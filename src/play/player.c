/* player.c - the application: creation, drawing, main loop, end. */
#include "play/player.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "picture/picture.h"
#include "play/playing.h"
#include "run/scene.h"

enum {
    FRAME_SIZE = 900,   /* pixels, without a window */
    UNSEEN_STEPS = 100, /* without a window, if nobody says how many */
    FRAME_RATE = 60,    /* frames a second at most */
    IDLE_WAIT = 200     /* ms between looks at the signals while paused */
};

static const double EARLY = 0.002; /* s, how early a frame may come */

Status player_draw(Player *player)
{
    player->changed = false;
    if (!player->draws)
        return STATUS_OK;
    if (player->past.works && !player->past.making) {
        player->changed = true; /* as soon as it is there */
        return STATUS_OK;
    }
    Paper *paper = player_paper(player);
    if (!paper)
        return STATUS_OUT_OF_MEMORY;
    bool fresh = player->sampled != player->past.step;
    bool filmed = film_runs(&player->recording.film);
    player->sampled = player->past.step;
    player_paint(player, paper);
    Status status = player->size[0] ? STATUS_OK : window_show(&paper->canvas);
    int shown = player->speed < 0 ? 1 << -player->speed : 1; /* in a film */
    if (!status && (fresh || filmed))
        status = recording_frame(&player->recording, &paper->canvas,
                                 player->past.step, shown);
    return status;
}

/* ---- the loop ------------------------------------------------------------ */

bool player_ended(const Player *player)
{
    const Options *options = &player->given[0];
    const Simulation *simulation = &player->past.machine[0].simulation;
    bool counted = options->steps >= 0;
    if (player->quit || *player->stop)
        return true;
    if (!script_is_over(&player->script) || player->past.works)
        return false;
    return (counted && player->past.step >= options->steps) ||
           ((!player->window || counted) && simulation->done) ||
           (!player->window && player_stands(player));
}

/* All lines of the script that are due. */
static Status obey_script(Player *player)
{
    Status status = STATUS_OK;
    while (!status && !player->quit) {
        bool done = player->past.machine[0].simulation.done;
        const Command *command = script_due(&player->script, player->past.step,
                                            !player_stands(player) && !done);
        if (!command)
            break;
        status = player_obey(player, command);
        if (status == STATUS_INVALID_INPUT) {
            char line[128];
            command_format(command, line, sizeof line);
            one_line(line, line, sizeof line);
            fprintf(stderr, "script: step %ld: '%s': %s\n", player->past.step,
                    line, player->message);
            player->message[0] = '\0';
            player->refused = true;
            status = STATUS_OK;
        }
    }
    return status;
}

/* The steps of one frame; fewer if they take long.  Without a window each step
 * is a frame. */
static Status step_frame(Player *player)
{
    const Past *past = &player->past;
    Status status = STATUS_OK;
    int count = player->window && player->speed > 0 ? 1 << player->speed : 1;
    double begin = count > 1 ? clock_now() : 0;
    for (int i = 0; i < count && !status; i++) {
        if (i > 0 && (player_ended(player) || clock_now() - begin > SLICE))
            break;
        if (player_stands(player) && !past->works)
            break;
        status = past->works ? player_continue(player) : player_step(player);
        if (past->works)
            break;
        if (!status)
            status = obey_script(player);
    }
    return status;
}

Status player_frame(Player *player)
{
    double period =
        ldexp(1.0 / FRAME_RATE, player->speed < 0 ? -player->speed : 0);
    double start = clock_now();
    Status status = STATUS_OK;
    while (player->window && !status && !player->quit) {
        Input input = window_input();
        if (input.kind == INPUT_NONE)
            break;
        status = player_tell(player, player_input(player, &input));
    }
    if (!status && !player->past.works)
        status = obey_script(player);
    double now = player->window ? clock_now() : 0; /* else nobody waits */
    if (player->sampled < 0) /* a new run: step 0 is a frame too */
        player->due = now + period;
    bool due = !player->window || now >= player->due - EARLY;
    bool first = player->sampled < 0 && player->draws;
    bool works = player->past.works;
    bool begins = works && player->began > start; /* first that is drawn */
    bool lives = player->sheet && player->window;
    bool goes = !lives && !player_stands(player) && due && !first &&
                !player_ended(player);
    if (!status && !begins && (works || goes)) {
        if (!works)
            player->due = fmax(player->due + period, now);
        status = step_frame(player);
    }
    if (lives && due) {
        player->due = now + 1.0 / FRAME_RATE;
        player_live(player);
    }
    if (!status && !player->quit && player->changed)
        status = player_draw(player);
    return status;
}

int player_wait(const Player *player)
{
    bool stands = player_stands(player);
    if (!player->window || player->past.works ||
        (stands && !script_is_over(&player->script)))
        return 0;
    double wait = stands && !player->sheet ? IDLE_WAIT
                                           : 1e3 * (player->due - clock_now());
    return (int)fmax(fmin(ceil(wait), IDLE_WAIT), 0);
}

Status player_run(Player *player)
{
    Status status = player_frame(player);
    while (!status && !player_ended(player)) {
        if (player->window)
            window_wait(player_wait(player));
        status = player_frame(player);
    }
    return status;
}

/* ---- beginning and end --------------------------------------------------- */

/* A window; or if there is no screen, a surface for the frames. */
static void open_view(Player *player)
{
    Options *options = &player->given[0];
    char reason[256], shown[256];
    const int size[] = {(int)options->size[0], (int)options->size[1]};
    if (!options->headless)
        player->window = window_open("elasto", size, options->fullscreen);
    if (!options->headless && !player->window) {
        one_line(window_failure(), reason, sizeof reason);
        window_close();
        if (!options->frames && !options->film)
            options->frames = "frames";
        one_line(options->frames ? options->frames : options->film, shown,
                 sizeof shown);
        fprintf(stderr, "no screen: %s; the frames go to %s%s\n", reason, shown,
                options->frames ? "/" : "");
    }
    if (!player->window && !options->script) {
        options->steps = options->steps < 0 ? UNSEEN_STEPS : options->steps;
        options->paused = 0; /* nobody could go on */
    }
    player->draws = player->window || options->frames || options->film;
    for (int i = 0; i < 2 && !player->window; i++)
        player->size[i] = size[i] > 0 ? size[i] : FRAME_SIZE;
}

Status player_create(const Options *options, int count, char *const *words,
                     const volatile sig_atomic_t *stop, Player *player)
{
    const Command begin = {.kind = COMMAND_RESTART};
    const Command pause = {.kind = COMMAND_PAUSE};
    *player = (Player){.words = words,
                       .stop = stop,
                       .left = options->page,
                       .written = -1,
                       .booked = -1};
    memcpy(player->given, options, (size_t)count * sizeof *options);
    player->started = clock_now();
    Status status = script_read(options->script, &player->script,
                                player->message, sizeof player->message);
    if (status)
        return status;
    open_view(player);
    player->asks = player->window && !options->script;
    player->attended = player->window || options->script || options->page;
    options = player->given;
    if (options->paused || (player->asks && options->steps < 0 &&
                            (options->page || options->scene->explains)))
        player->mode = MODE_PAUSE;
    status = recording_open(&player->given[0], count, &player->recording);
    past_create(player->attended || player->draws,
                player->attended && options->steps < 0, &player->past);
    if (!status)
        status = player_begin(player, player->given, count, &begin);
    if (!status && player_stands(player)) /* scripts begin to run */
        status = script_add(&player->journal, 0, &pause, 0);
    bool nodes = !status && player_simulation(player)->mesh.nodes > 0;
    if (!status && player->asks && options->page)
        status = player_obey_page(player);
    else if (!status && player->asks &&
             simulation_is_draggable(player_simulation(player)))
        player_note(player,
                    "pull at a %s with the mouse%s; G: scenes; Page "
                    "Down: the guided tour",
                    nodes ? "node" : "mass",
                    nodes ? "; right click pins it" : "");
    return status;
}

static void close_view(Player *player)
{
    paper_free(&player->paper);
    window_close();
    player->draws = false;
}

Status player_finish(Player *player, Status status)
{
    if (player->past.branches > 0) {
        Status rest = player_write_rest(player);
        status = status ? status : rest;
    }
    Keep keep = player->written < 0 ? KEEP_NOTHING
                : status            ? KEEP_PART
                                    : KEEP_WHOLE;
    close_view(player);
    Status closed = recording_close(&player->recording, keep);
    return status ? status : closed;
}

void player_free(Player *player)
{
    close_view(player);
    recording_close(&player->recording, KEEP_NOTHING);
    past_free(&player->past);
    player_leave_step(player);
    player_close_sheet(player);
    control_drop(player->queue.pins);
    script_free(&player->script);
    script_free(&player->journal);
}
