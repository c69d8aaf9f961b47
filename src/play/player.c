#include "play/player.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/one_line.h"
#include "picture/draw.h"
#include "play/playing.h"
#include "scenes/pages.h"
#include "scenes/scene.h"

enum {
    FRAME_SIZE = 900,   /* pixels, without a window */
    UNSEEN_STEPS = 100, /* without a window, if nobody says how many */
    FRAME_RATE = 60,    /* frames a second at most */
    WATCHED_SPEED = -5, /* of iterations that are watched one by one */
    IDLE_WAIT = 200,    /* ms between looks at the signals while paused */
    BAR_LENGTH = 40     /* letters of the progress bar */
};

static const double BATCH_LIMIT = 0.05; /* s, steps of one frame */
static const double EARLY = 0.002;      /* s, a frame may be: vsync waits */
static const double MEASURE_TIME = 0.5; /* s, that a speed is taken over */

double player_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Steps a second that the speed asks for. */
static double player_rate(const Player *player)
{
    return FRAME_RATE * ldexp(1, player->speed);
}

/* What the command line says; else one step a frame through time, and
 * iterations one at a time. */
int player_first_speed(const Options *options)
{
    if (options->speed > 0)
        return (int)lrint(
            fmin(fmax(log2(options->speed), SPEED_LEAST), SPEED_MOST));
    return options->scene->needs & NEEDS_TIME ? 0 : WATCHED_SPEED;
}

void player_reset_speed(Player *player)
{
    const Simulation *simulation = &player->track.simulation;
    player->hud.speed = player_rate(player) * simulation->options.timestep;
    player->hud.measured = 0;
    player->clock_mark = player_clock();
    player->time_mark = simulation_time(simulation);
}

void player_note(Player *player, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(player->hud.note, HUD_NOTE_SIZE, format, arguments);
    va_end(arguments);
    player->changed = true;
}

uint64_t player_hash(const Player *player)
{
    return state_hash(&player->track.simulation, STATE_HASH_SEED);
}

bool player_escape_ends(const Player *player)
{
    return !player->hud.keys && !player->hud.column && !player->blank &&
           !(player->view && view_is_full(player->view));
}

/* ---- stepping ----------------------------------------------------------- */

/* After each Newton iteration: log it, and look whether to go on. */
static bool watch_newton(void *user, const NewtonRecord *record)
{
    Player *player = user;
    if (*player->stop ||
        (player->window &&
         view_quit_waits(player->view, player_escape_ends(player))))
        player->quit = true;
    if (player->track.repeating)
        return !player->quit;
    hud_add_update(&player->hud, record);
    player->recorded = recording_update(&player->recording, record);
    return !player->quit && !player->recorded;
}

/* Simulation, states and energies at step 0. */
static Status begin_run(Player *player, const Options *options)
{
    hud_restart(&player->hud);
    player->sampled = -1;
    player->warned = false;
    player->changed = true;
    player->recorded = STATUS_OK;
    Status status = track_create(options, player->attended, watch_newton,
                                 player, &player->track);
    if (status)
        return status;
    const Simulation *simulation = &player->track.simulation;
    hud_end_step(&player->hud, simulation);
    player_reset_speed(player);
    if (!options->quiet)
        player->start = simulation_energies(simulation, 0);
    return recording_states(&player->recording, simulation);
}

Status player_restart(Player *player, const Options *options)
{
    const Options copy = *options; /* it may be the track's own */
    bool other = copy.scene != player->track.options.scene;
    track_free(&player->track);
    Status status = recording_restart(&player->recording, &copy);
    if (other)
        player->speed = player_first_speed(&copy);
    return status ? status : begin_run(player, &copy);
}

Status player_show(Player *player, long step)
{
    player->changed = true;
    player->holds = false;
    player->hud.paused = true;
    Status status = track_show(&player->track, step);
    if (status == STATUS_INTERRUPTED)
        return STATUS_OK;
    hud_begin_step(&player->hud);
    hud_end_step(&player->hud, &player->track.simulation);
    return status;
}

/* Whether the failure is what the scene shows: the end of its iteration. */
static bool is_scene_end(const Simulation *simulation, Status status)
{
    return simulation->done && status != STATUS_OUT_OF_MEMORY &&
           status != STATUS_TOO_LARGE;
}

/* Going on from an old step: what came after it leaves the files too. */
static Status forget_later(Player *player)
{
    Track *track = &player->track;
    if (!track->keeps || track_step_shown(track) >= track->newest)
        return STATUS_OK;
    track_forget(track);
    return recording_cut(&player->recording, track_step_shown(track));
}

Status player_step(Player *player)
{
    const Simulation *simulation = &player->track.simulation;
    long before = simulation->steps;
    Status status = forget_later(player);
    if (!status && player->track.settings.held && !player->holds) {
        Command release = {.kind = COMMAND_RELEASE};
        status = player_obey(player, &release); /* it was held long ago */
    }
    if (status)
        return status;
    hud_begin_step(&player->hud);
    status = track_step(&player->track);
    if (player->recorded)
        return player->recorded;
    hud_end_step(&player->hud, simulation);
    player->changed = true;
    if (simulation->steps != before) {
        Status recorded = recording_states(&player->recording, simulation);
        if (recorded)
            return recorded;
    }
    if (status && is_scene_end(simulation, status)) {
        player->sampled = -1; /* draw the last frame again, and why it ends */
        return STATUS_OK;
    }
    if (status == STATUS_INTERRUPTED || status_is_unconverged(status))
        return STATUS_OK;
    return status;
}

bool player_ended(const Player *player)
{
    const Options *options = &player->given;
    const Simulation *simulation = &player->track.simulation;
    bool unattended = !player->window || options->steps >= 0;
    bool waits = player->script.next < player->script.count;
    if (player->quit || *player->stop)
        return true;
    if (waits)
        return false;
    return (options->steps >= 0 && simulation->steps >= options->steps) ||
           (unattended && simulation->done) ||
           (!player->window && player->hud.paused);
}

bool player_unconverged(const Player *player)
{
    const Simulation *simulation = &player->track.simulation;
    return simulation->unconverged > 0 ||
           (simulation->done && simulation->status != STATUS_OK);
}

/* Pauses at the first step that did not converge, and at the end; a run of a
 * given number of steps ends by itself and does not. */
static void pause_if_due(Player *player)
{
    const Simulation *simulation = &player->track.simulation;
    if (player->given.steps >= 0 || !player->attended)
        return;
    if (simulation->done)
        player->hud.paused = true;
    if (simulation->status && !player->warned) {
        player->warned = true;
        player->hud.paused = true;
    }
}

/* ---- drawing ------------------------------------------------------------ */

/* For how many frames' time a film shows a frame. */
static int frames_shown(const Player *player)
{
    return player->speed < 0 ? 1 << -player->speed : 1;
}

Status player_draw(Player *player)
{
    Simulation *simulation = &player->track.simulation;
    player->changed = false;
    if (!player->view)
        return STATUS_OK;
    Paper *paper = view_paper(player->view);
    if (!paper)
        return STATUS_OUT_OF_MEMORY;
    bool fresh = player->sampled != simulation->steps;
    player->sampled = simulation->steps;
    if (fresh)
        hud_sample(&player->hud, simulation);
    if (player->blank)
        canvas_clear(&paper->canvas, 0xff000000u);
    else
        draw_frame(paper, simulation, &player->hud);
    Status status = view_show(player->view);
    if (!status && fresh)
        status = recording_frame(&player->recording, &paper->canvas,
                                 simulation->steps, frames_shown(player));
    return status;
}

/* A bar that fills, on a terminal. */
static void show_progress(const Player *player)
{
    char bar[BAR_LENGTH + 1] = {0};
    long steps = player->track.simulation.steps, all = player->given.steps;
    if (player->given.quiet || all < 1 || !isatty(STDERR_FILENO))
        return;
    int filled = (int)(BAR_LENGTH * ((double)steps / (double)all));
    memset(bar, '.', BAR_LENGTH);
    memset(bar, '#', (size_t)filled);
    fprintf(stderr, "\r[%s] %ld/%ld", bar, steps, all);
    if (player_ended(player))
        fprintf(stderr, "\r%*s\r", BAR_LENGTH + 44, "");
}

/* ---- the loop ----------------------------------------------------------- */

/* Keys and what else the window says. */
static Status obey_inputs(Player *player)
{
    Status status = STATUS_OK;
    while (player->window && !status && !player->quit) {
        Command command = {.kind = COMMAND_NONE};
        Input input = view_input(player->view);
        if (input.kind == INPUT_NONE)
            break;
        if (input.kind == INPUT_KEY)
            command_from_key(input.key, input.repeats, &command);
        if (input.kind == INPUT_CLOSE)
            command.kind = COMMAND_QUIT;
        if (input.kind == INPUT_REDRAW)
            command.kind = COMMAND_REDRAW;
        if (command.kind != COMMAND_NONE)
            status = player_obey(player, &command);
        if (status == STATUS_INVALID_INPUT) {
            player_note(player, "%s", player->message);
            player->message[0] = '\0';
            status = STATUS_OK;
        }
    }
    return status;
}

/* All lines of the script that are due. */
static Status obey_script(Player *player)
{
    Status status = STATUS_OK;
    while (!status && !player->quit) {
        const Simulation *simulation = &player->track.simulation;
        bool waits = !player->hud.paused && !simulation->done;
        const Command *command =
            script_due(&player->script, simulation->steps, waits);
        if (!command)
            break;
        status = player_obey(player, command);
        if (status == STATUS_INVALID_INPUT) {
            char line[128];
            command_format(command, line, sizeof line);
            fprintf(stderr, "script: step %ld: '%s': %s\n", simulation->steps,
                    line, player->message);
            player->message[0] = '\0';
            status = STATUS_OK;
        }
    }
    return status;
}

/* The steps of one frame; fewer if they take long.  Without a window each step
 * is a frame. */
static Status step_frame(Player *player)
{
    double begin = player_clock();
    Status status = STATUS_OK;
    int count = player->window && player->speed > 0 ? 1 << player->speed : 1;
    for (int i = 0; i < count && !status && !player->hud.paused; i++) {
        if (i > 0 &&
            (player_ended(player) || player_clock() - begin > BATCH_LIMIT))
            break;
        status = player_step(player);
        pause_if_due(player);
        if (!status)
            status = obey_script(player);
    }
    return status;
}

/* Simulated over real time, twice a second. */
static void measure_speed(Player *player)
{
    double now = player_clock();
    double time = simulation_time(&player->track.simulation);
    double passed = now - player->clock_mark;
    if (passed < MEASURE_TIME)
        return;
    player->hud.measured = (time - player->time_mark) / passed;
    player->clock_mark = now;
    player->time_mark = time;
}

/* Whether a failure is one to show and go on from: of this step only. */
static bool is_shown(const Player *player, Status status)
{
    return player->attended && player->given.steps < 0 &&
           status == player->track.simulation.status;
}

/* Commands, steps and a frame, as far as they are due.  next s, in/out */
static Status run_frame(Player *player, double *next)
{
    double period = 1 / fmin(FRAME_RATE, player_rate(player));
    Status status = obey_inputs(player);
    if (!status)
        status = obey_script(player);
    if (player->sampled < 0) /* a new run: step 0 is a frame too */
        *next = player_clock() + period;
    bool due = !player->window || player_clock() >= *next - EARLY;
    bool first = player->sampled < 0 && player->view;
    if (!status && !player_ended(player) && !player->hud.paused && due &&
        !first) {
        *next = fmax(*next + period, player_clock());
        status = step_frame(player);
        measure_speed(player);
    }
    if (status && is_shown(player, status)) {
        player->hud.paused = true;
        player->changed = true;
        status = STATUS_OK;
    }
    if (!status && !player->quit && player->changed)
        status = player_draw(player);
    return status;
}

Status player_run(Player *player)
{
    double next = player_clock();
    Status status = player_draw(player);
    while (!status && !player_ended(player)) {
        status = run_frame(player, &next);
        double wait =
            player->hud.paused ? IDLE_WAIT : 1e3 * (next - player_clock());
        bool busy = !script_is_over(&player->script) && player->hud.paused;
        if (!player->window)
            show_progress(player);
        else if (!status && !busy && !player_ended(player))
            view_wait(player->view, (int)fmin(ceil(wait), IDLE_WAIT));
    }
    Status last = player->track.simulation.status;
    if (!status && player->window && !player->quit && last &&
        !status_is_unconverged(last) && !player->track.simulation.done)
        status = last;
    return status;
}

/* ---- beginning and end -------------------------------------------------- */

void player_title(const Player *player, char *title, size_t size)
{
    snprintf(title, size, "elasto: %s (press ? for the keys)",
             player->track.simulation.scene ? player->track.options.scene->name
                                            : player->given.scene->name);
}

/* A window; or if there is no screen, a surface for the frames. */
static Status open_view(Player *player)
{
    Options *options = &player->given;
    char reason[256] = "", title[128];
    Status status = STATUS_OK;
    player_title(player, title, sizeof title);
    if (!options->headless) {
        status = view_create_window(title, options->size, options->fullscreen,
                                    &player->view, reason, sizeof reason);
        if (status == STATUS_OUT_OF_MEMORY)
            return status;
        player->window = status == STATUS_OK;
        if (!player->window && !options->frames && !options->film)
            options->frames = "frames";
        if (!player->window)
            fprintf(stderr, "no screen: %s; the frames go to %s%s\n", reason,
                    options->frames ? options->frames : options->film,
                    options->frames ? "/" : "");
    }
    if (!player->window && options->steps < 0 && !options->script)
        options->steps = UNSEEN_STEPS;
    if (!player->window && (options->frames || options->film))
        status = view_create_surface(
            options->size[0] > 0 ? options->size[0] : FRAME_SIZE,
            options->size[1] > 0 ? options->size[1] : FRAME_SIZE,
            &player->view);
    return player->view ? STATUS_OK : status;
}

/* The commands of the command line's file. */
static Status read_script(Player *player)
{
    const char *name = player->given.script;
    char why[160];
    if (!name)
        return STATUS_OK;
    Status status = script_read(name, &player->script, why, sizeof why);
    if (status == STATUS_FILE_FAILED)
        snprintf(player->message, sizeof player->message, "--script: %.90s: %s",
                 name, strerror(errno));
    if (status == STATUS_INVALID_INPUT)
        snprintf(player->message, sizeof player->message,
                 "--script: %.80s, %.150s", name, why);
    return status == STATUS_FILE_FAILED ? STATUS_INVALID_INPUT : status;
}

void player_keep_files(const Player *player, Options *options)
{
    const Options *given = &player->given;
    options->steps = given->steps;
    options->quiet = given->quiet;
    options->frames = given->frames;
    options->film = given->film;
    options->states = given->states;
    options->log = given->log;
}

/* Whether the window begins with a pause. */
static bool explains(const Options *options)
{
    return options->page ? !options->page->plays : options->scene->explains;
}

Status player_create(const Options *options, const volatile sig_atomic_t *stop,
                     Player *player)
{
    *player = (Player){.given = *options, .stop = stop};
    player->started = player_clock();
    player->speed = player_first_speed(options);
    hud_create(&player->hud);
    Status status = read_script(player);
    if (!status)
        status = open_view(player);
    if (status)
        return status;
    player->attended = player->window || options->script;
    player->hud.hints = player->window;
    player->hud.paused =
        options->paused || (player->window && !options->script &&
                            options->steps < 0 && explains(options));
    status = recording_open(&player->given, &player->recording);
    return status ? status : begin_run(player, &player->given);
}

Status player_finish(Player *player)
{
    view_free(player->view);
    player->view = NULL;
    return recording_close(&player->recording);
}

void player_free(Player *player)
{
    view_free(player->view);
    recording_close(&player->recording);
    track_free(&player->track);
    script_free(&player->script);
    script_free(&player->journal);
}
