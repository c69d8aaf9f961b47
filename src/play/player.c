#include "play/player.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/one_line.h"
#include "picture/draw.h"
#include "picture/landscape_picture.h"
#include "play/png_file.h"
#include "scenes/scene.h"

enum {
    FRAME_SIZE = 900,   /* pixels, without a window */
    UNSEEN_STEPS = 100, /* without a window, if nobody says how many */
    FRAME_RATE = 60,    /* frames a second at most */
    SPEED_LEAST = -5,   /* a frame every half second */
    SPEED_MOST = 10,    /* 1024 steps a frame */
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

/* One step a frame through time; iterations one at a time, to be watched. */
static int first_speed(const Options *options)
{
    return options->scene->needs & NEEDS_TIME ? 0 : SPEED_LEAST;
}

/* The speed in the texts; it is measured anew from here. */
static void reset_speed(Player *player)
{
    player->hud.speed =
        player_rate(player) * player->simulation.options.timestep;
    player->hud.measured = 0;
    player->clock_mark = player_clock();
    player->time_mark = simulation_time(&player->simulation);
}

/* After each Newton iteration: log it, and look whether to go on. */
static bool watch_newton(void *user, const NewtonRecord *record)
{
    Player *player = user;
    hud_add_update(&player->hud, record);
    player->recorded = recording_update(&player->recording, record);
    if (*player->stop || (player->window && view_quit_waits(player->view)))
        player->quit = true;
    return !player->quit && !player->recorded;
}

/* Simulation, states and energies at step 0. */
static Status begin_run(Player *player)
{
    hud_restart(&player->hud);
    player->sampled = -1;
    player->warned = false;
    player->changed = true;
    player->recorded = STATUS_OK;
    Status status = simulation_create(&player->options, watch_newton, player,
                                      &player->simulation);
    if (status)
        return status;
    hud_end_step(&player->hud, &player->simulation);
    reset_speed(player);
    if (!player->options.quiet)
        player->start = simulation_energies(&player->simulation, 0);
    return recording_states(&player->recording, &player->simulation);
}

/* Of the window. */
static void format_title(char *title, size_t size, const char *scene)
{
    snprintf(title, size, "elasto: %s (press ? for the keys)", scene);
}

/* A window; or if there is no screen, a surface for the frames. */
static Status open_view(Player *player)
{
    Options *options = &player->options;
    char reason[256] = "", title[128], folder[256];
    Status status = STATUS_OK;
    format_title(title, sizeof title, options->scene->name);
    if (!options->headless) {
        status =
            view_create_window(title, &player->view, reason, sizeof reason);
        if (status == STATUS_OUT_OF_MEMORY)
            return status;
        player->window = status == STATUS_OK;
        if (!player->window && !options->frames)
            options->frames = "frames";
        one_line(options->frames, folder, sizeof folder);
        if (!player->window)
            fprintf(stderr, "no screen: %s; the frames go to %s/\n", reason,
                    folder);
    }
    if (!player->window && options->steps < 0)
        options->steps = UNSEEN_STEPS;
    if (!player->window && options->frames)
        status = view_create_surface(FRAME_SIZE, FRAME_SIZE, &player->view);
    return player->view ? STATUS_OK : status;
}

Status player_create(const Options *options, const volatile sig_atomic_t *stop,
                     Player *player)
{
    *player = (Player){.options = *options, .given = *options, .stop = stop};
    player->started = player_clock();
    player->speed = first_speed(options);
    hud_create(&player->hud);
    Status status = open_view(player);
    if (status)
        return status;
    player->hud.hints = player->window;
    status = recording_open(&player->options, &player->recording);
    return status ? status : begin_run(player);
}

bool player_ended(const Player *player)
{
    const Options *options = &player->options;
    const Simulation *simulation = &player->simulation;
    bool unattended = !player->window || options->steps >= 0;
    return player->quit || *player->stop ||
           (options->steps >= 0 && simulation->steps >= options->steps) ||
           (unattended && simulation->done);
}

bool player_unconverged(const Player *player)
{
    const Simulation *simulation = &player->simulation;
    return simulation->unconverged > 0 ||
           (simulation->done && simulation->status != STATUS_OK);
}

/* Whether the failure is what the scene shows: the end of its iteration. */
static bool is_scene_end(const Simulation *simulation, Status status)
{
    return simulation->done && status != STATUS_OUT_OF_MEMORY &&
           status != STATUS_TOO_LARGE;
}

Status player_step(Player *player)
{
    Simulation *simulation = &player->simulation;
    long before = simulation->steps;
    hud_begin_step(&player->hud);
    Status status = simulation_step(simulation);
    if (player->recorded)
        return player->recorded;
    hud_end_step(&player->hud, simulation);
    if (simulation->steps != before) {
        player->changed = true;
        Status recorded = recording_states(&player->recording, simulation);
        if (recorded)
            return recorded;
    }
    if (status && is_scene_end(simulation, status)) {
        player->sampled = -1; /* draw the last frame again, and why it ends */
        player->changed = true;
        return STATUS_OK;
    }
    if (status == STATUS_INTERRUPTED || status_is_unconverged(status))
        return STATUS_OK;
    return status;
}

Status player_draw(Player *player)
{
    Simulation *simulation = &player->simulation;
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
    draw_frame(paper, simulation, &player->hud);
    Status status = view_show(player->view);
    if (!status && fresh)
        status = recording_frame(&player->recording, &paper->canvas,
                                 simulation->steps);
    return status;
}

/* A bar that fills, on a terminal. */
static void show_progress(const Player *player)
{
    char bar[BAR_LENGTH + 1] = {0};
    long steps = player->simulation.steps, all = player->options.steps;
    if (player->options.quiet || all < 1 || !isatty(STDERR_FILENO))
        return;
    int filled = (int)(BAR_LENGTH * ((double)steps / (double)all));
    memset(bar, '.', BAR_LENGTH);
    memset(bar, '#', (size_t)filled);
    fprintf(stderr, "\r[%s] %ld/%ld", bar, steps, all);
    if (player_ended(player))
        fprintf(stderr, "\r%*s\r", BAR_LENGTH + 44, "");
}

Status player_run(Player *player)
{
    Status status = player_draw(player);
    while (!status && !player_ended(player)) {
        status = player_step(player);
        if (!status && player->changed)
            status = player_draw(player);
        show_progress(player);
    }
    return status;
}

/* Begins again, with the options as they are now. */
static Status restart_run(Player *player)
{
    simulation_free(&player->simulation);
    Status status = recording_restart(&player->recording, &player->options);
    return status ? status : begin_run(player);
}

/* The options of a scene: those of the command line if it was called for
 * there, else its defaults; files and ends are those of the command line.
 * Returns false if there is no such scene. */
static bool find_options(const Options *given, int number, Options *options)
{
    char program[] = "elasto", name[64], message[512];
    char *arguments[] = {program, name, NULL};
    int known = 0;
    while (scenes[known].name)
        known++;
    if (number >= known)
        return false;
    *options = *given;
    if (given->scene == &scenes[number])
        return true;
    snprintf(name, sizeof name, "%s", scenes[number].name);
    if (options_parse(2, arguments, options, message, sizeof message))
        return false;
    options->steps = given->steps;
    options->quiet = given->quiet;
    options->frames = given->frames;
    options->states = given->states;
    options->log = given->log;
    return true;
}

/* Another scene, from its start. */
static Status switch_scene(Player *player, int number)
{
    char title[128];
    Options options;
    if (!find_options(&player->given, number, &options))
        return STATUS_OK;
    player->options = options;
    player->speed = first_speed(&options);
    player->hud.paused = false;
    format_title(title, sizeof title, options.scene->name);
    view_set_title(player->view, title);
    return restart_run(player);
}

/* Another start, where the scene has one on a map. */
static Status pick_start(Player *player, const Command *command)
{
    Paper *paper = view_paper(player->view);
    if (!paper || player->options.scene->picture != PICTURE_LANDSCAPE ||
        !landscape_picture_pick(paper, player->hud.text, command->x, command->y,
                                player->options.start))
        return STATUS_OK;
    player->hud.paused = true;
    return restart_run(player);
}

/* The frame as it is, in the present folder. */
static void save_screenshot(Player *player)
{
    char name[HUD_NOTE_SIZE - 16];
    Paper *paper = view_paper(player->view);
    snprintf(name, sizeof name, "elasto_%06ld.png", player->simulation.steps);
    Status status = STATUS_OUT_OF_MEMORY;
    if (paper) {
        player->hud.note[0] = '\0';
        draw_frame(paper, &player->simulation, &player->hud);
        status = png_file_write(name, &paper->canvas);
    }
    if (status)
        snprintf(player->hud.note, HUD_NOTE_SIZE, "not saved: %s",
                 status == STATUS_FILE_FAILED ? strerror(errno)
                                              : status_text(status));
    else
        snprintf(player->hud.note, HUD_NOTE_SIZE, "saved %s", name);
}

/* Off, or on again as the command line has it, if there is anything to
 * project. */
static bool switch_filter(Player *player)
{
    Filter given = player->given.filter, *filter = &player->options.filter;
    if (!simulation_has_filter(&player->simulation)) {
        snprintf(player->hud.note, HUD_NOTE_SIZE, "nothing to project here");
        return false;
    }
    if (*filter != FILTER_NONE)
        *filter = FILTER_NONE;
    else
        *filter = given != FILTER_NONE ? given : FILTER_CLAMP;
    simulation_set_filter(&player->simulation, *filter);
    return true;
}

/* The same, if there is a line to search. */
static bool switch_line_search(Player *player)
{
    LineSearch given = player->given.line_search;
    LineSearch *search = &player->options.line_search;
    if (!simulation_has_line_search(&player->simulation)) {
        snprintf(player->hud.note, HUD_NOTE_SIZE, "no line search here");
        return false;
    }
    if (*search != LINE_SEARCH_NONE)
        *search = LINE_SEARCH_NONE;
    else
        *search = given != LINE_SEARCH_NONE ? given : LINE_SEARCH_BACKTRACK;
    simulation_set_line_search(&player->simulation, *search);
    return true;
}

/* While it runs; a scene that is at its end starts again with the new one. */
static Status switch_method(Player *player, CommandKind kind)
{
    char note[HUD_NOTE_SIZE];
    const Options *options = &player->options;
    bool ended = player->simulation.done;
    bool filter = kind == COMMAND_FILTER;
    if (!(filter ? switch_filter(player) : switch_line_search(player)))
        return STATUS_OK;
    snprintf(note, sizeof note, "%s: %s%s",
             filter ? "projection" : "line search",
             filter ? filter_name(options->filter)
                    : line_search_name(options->line_search),
             ended ? ", from the start" : "");
    player->hud.paused = player->hud.paused && !ended;
    Status status = ended ? restart_run(player) : STATUS_OK;
    memcpy(player->hud.note, note, sizeof note);
    return status;
}

/* value + 1 or - 1, limited. */
static void change_speed(Player *player, int change)
{
    int speed = player->speed + change;
    if (speed >= SPEED_LEAST && speed <= SPEED_MOST)
        player->speed = speed;
    reset_speed(player);
}

/* What only switches something on or off. */
static void apply_switch(Player *player, CommandKind kind)
{
    Hud *hud = &player->hud;
    switch (kind) {
    case COMMAND_PAUSE:
        hud->paused = !hud->paused;
        reset_speed(player);
        break;
    case COMMAND_FASTER:
        change_speed(player, 1);
        break;
    case COMMAND_SLOWER:
        change_speed(player, -1);
        break;
    case COMMAND_COLOURS:
        hud->strain = !hud->strain;
        break;
    case COMMAND_TEXT:
        hud->text = !hud->text;
        hud_sample(hud, &player->simulation);
        break;
    case COMMAND_KEYS:
        hud->keys = !hud->keys;
        break;
    default:
        break;
    }
}

/* Does what a command asks for. */
static Status apply_command(Player *player, const Command *command)
{
    player->changed = true;
    if (command->kind != COMMAND_REDRAW)
        player->hud.note[0] = '\0';
    switch (command->kind) {
    case COMMAND_QUIT:
        player->quit = true;
        return STATUS_OK;
    case COMMAND_STEP:
        player->hud.paused = true;
        return player_step(player);
    case COMMAND_RESTART:
        player->hud.paused = false;
        return restart_run(player);
    case COMMAND_SCENE:
        return switch_scene(player, command->number);
    case COMMAND_PICK:
        return pick_start(player, command);
    case COMMAND_SCREENSHOT:
        save_screenshot(player);
        return STATUS_OK;
    case COMMAND_FILTER:
    case COMMAND_LINE_SEARCH:
        return switch_method(player, command->kind);
    default:
        apply_switch(player, command->kind);
        return STATUS_OK;
    }
}

/* All commands that wait; stops at the first failure. */
static Status apply_commands(Player *player)
{
    Status status = STATUS_OK;
    Command command = view_command(player->view);
    while (!status && !player->quit && command.kind != COMMAND_NONE) {
        status = apply_command(player, &command);
        command = view_command(player->view);
    }
    return status;
}

/* Pauses at the first step that did not converge, and at the end; a run of a
 * given number of steps ends by itself and does not. */
static void pause_if_due(Player *player)
{
    const Simulation *simulation = &player->simulation;
    if (player->options.steps >= 0)
        return;
    if (simulation->done)
        player->hud.paused = true;
    if (simulation->status && !player->warned) {
        player->warned = true;
        player->hud.paused = true;
    }
}

/* The steps of one frame; fewer if they take long. */
static Status step_frame(Player *player)
{
    double begin = player_clock();
    Status status = STATUS_OK;
    int count = player->speed > 0 ? 1 << player->speed : 1;
    for (int i = 0; i < count && !status && !player->hud.paused; i++) {
        if (player_ended(player) || player_clock() - begin > BATCH_LIMIT)
            break;
        status = player_step(player);
        pause_if_due(player);
    }
    return status;
}

/* Simulated over real time, twice a second. */
static void measure_speed(Player *player)
{
    double now = player_clock(), time = simulation_time(&player->simulation);
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
    return player->options.steps < 0 && status == player->simulation.status;
}

/* Commands, steps and a frame, as far as they are due.  next s, in/out */
static Status run_frame(Player *player, double *next)
{
    double period = 1 / fmin(FRAME_RATE, player_rate(player));
    Status status = apply_commands(player);
    if (player->sampled < 0) /* a new run: step 0 is a frame too */
        *next = player_clock() + period;
    if (!status && !player->quit && !player->hud.paused &&
        player_clock() >= *next - EARLY) {
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

Status player_run_window(Player *player)
{
    double next = player_clock();
    Status status = player_draw(player);
    while (!status && !player_ended(player)) {
        status = run_frame(player, &next);
        double wait =
            player->hud.paused ? IDLE_WAIT : 1e3 * (next - player_clock());
        if (!status && !player_ended(player))
            view_wait(player->view, (int)fmin(ceil(wait), IDLE_WAIT));
    }
    if (!status && !player->quit && player->simulation.status &&
        !status_is_unconverged(player->simulation.status))
        status = player->simulation.status;
    return status;
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
    simulation_free(&player->simulation);
}
