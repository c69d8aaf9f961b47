#include "play/player.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/one_line.h"
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

double player_rate(const Player *player)
{
    return FRAME_RATE * ldexp(1, player->speed);
}

Lane *player_lane(Player *player)
{
    return &player->lane[player->active];
}

const Simulation *player_simulation(const Player *player)
{
    return &player->lane[player->active].track.simulation;
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
    player->measured = 0;
    player->clock_mark = clock_now();
    player->time_mark = lane_time(player_lane(player));
}

void player_note(Player *player, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(player->note, sizeof player->note, format, arguments);
    va_end(arguments);
    player->warning = false;
    player->changed = true;
}

uint64_t player_hash(const Player *player)
{
    uint64_t hash = STATE_HASH_SEED;
    for (int i = 0; i < player->lanes; i++)
        hash = state_hash(&player->lane[i].track.simulation, hash);
    return hash;
}

bool player_escape_ends(const Player *player)
{
    return !player->help && !player->column && !player->blank &&
           !(player->view && view_is_full(player->view));
}

/* ---- stepping ----------------------------------------------------------- */

/* The Newton object that an observer hears of. */
static const Newton *listened_to(const Simulation *simulation)
{
    for (int r = 0; r < simulation->runs; r++)
        if (simulation->run[r].newton)
            return simulation->run[r].newton;
    return NULL;
}

/* After each Newton iteration: log it, and look whether to go on. */
bool player_watch(void *user, const NewtonRecord *record)
{
    Lane *lane = user;
    Player *player = lane->player;
    const Newton *newton = listened_to(&lane->track.simulation);
    if (*player->stop ||
        (player->window &&
         view_quit_waits(player->view, player_escape_ends(player))))
        player->quit = true;
    if (lane->track.keeps && newton && lane->track.simulation.scene &&
        !lane->track.simulation.scene->step)
        tape_add(&lane->tape, newton, record);
    if (!lane->track.repeating && lane->number == 0)
        player->recorded = recording_update(&player->recording, record);
    return !player->quit && !player->recorded;
}

/* The states of all lanes. */
static Status record_states(Player *player)
{
    const Simulation *simulation[OPTIONS_MAX_PANES];
    for (int i = 0; i < player->lanes; i++)
        simulation[i] = &player->lane[i].track.simulation;
    return recording_states(&player->recording, simulation, player->lanes,
                            player->step);
}

/* Simulations, states and energies at step 0. */
static Status begin_run(Player *player, const Options *options, int count)
{
    player->sampled = -1;
    player->warned = player->rests = player->holds = false;
    player->changed = true;
    player->recorded = STATUS_OK;
    player->step = player->newest = 0;
    player->active = 0;
    player->lanes = 0;
    for (int i = 0; i < count; i++) {
        /* pictures show the steps behind them: residuals, the time line */
        bool keeps = player->attended || player->view;
        Status status = lane_create(player, i, &options[i], keeps, player_watch,
                                    &player->lane[i]);
        player->lanes++;
        if (status)
            return status;
    }
    player_reset_speed(player);
    if (!options[0].quiet)
        player->start = simulation_energies(player_simulation(player), 0);
    return record_states(player);
}

Status player_restart(Player *player, const Options *options, int count)
{
    Options copy[OPTIONS_MAX_PANES]; /* they may be those of the lanes */
    memcpy(copy, options, (size_t)count * sizeof *copy);
    bool other = copy[0].scene != player->lane[0].track.options.scene;
    for (int i = 0; i < player->lanes; i++)
        lane_free(&player->lane[i]);
    Status status = recording_restart(&player->recording, &copy[0]);
    if (other) {
        player->speed = player_first_speed(&copy[0]);
        player->lens = LENS_FITS;
        player->closed = 0;
        player->large = player->selected = -1;
        player->show.hover = (Pick){.kind = PICK_NONE};
        player->mouse.drag = DRAG_NONE;
    }
    return status ? status : begin_run(player, copy, count);
}

/* What goes whenever another step is shown. */
static void leave_step(Player *player)
{
    player->changed = true;
    player->rests = false;
    for (int i = 0; i < player->lanes; i++) {
        player->lane[i].place = -1;
        lane_drop_ghost(&player->lane[i]);
    }
}

static long clamp_step(const Player *player, long step)
{
    return step < 0 ? 0 : step > player->newest ? player->newest : step;
}

Status player_show(Player *player, long step)
{
    Status status = STATUS_OK;
    leave_step(player);
    player->holds = false;
    player->paused = true;
    if (!player->attended)
        return STATUS_OK;
    step = clamp_step(player, step);
    for (int i = 0; i < player->lanes && !status; i++)
        status = lane_show(&player->lane[i], step);
    player->step = step;
    return status == STATUS_INTERRUPTED ? STATUS_OK : status;
}

Status player_retape(Player *player, long step)
{
    Status status = STATUS_OK;
    if (step < 1 || step > player->newest)
        return player_show(player, step);
    leave_step(player);
    player->holds = false;
    player->paused = true;
    for (int i = 0; i < player->lanes && !status; i++)
        status = lane_retape(&player->lane[i], step);
    player->step = step;
    return status == STATUS_INTERRUPTED ? STATUS_OK : status;
}

Status player_forget_later(Player *player)
{
    if (!player->attended || player->step >= player->newest)
        return STATUS_OK;
    for (int i = 0; i < player->lanes; i++)
        lane_forget(&player->lane[i], player->step);
    player->newest = player->step;
    return recording_cut(&player->recording, player->step);
}

/* Where the lane with the longest timestep will be. */
static double next_time(const Player *player)
{
    double pace = -1, time = 0;
    for (int i = 0; i < player->lanes; i++) {
        const Lane *lane = &player->lane[i];
        if (!lane->failed && lane_pace(lane) > pace) {
            pace = lane_pace(lane);
            time = lane_time(lane);
        }
    }
    return time + pace;
}

/* Whether nothing moves any more: no update was needed, and nothing is held. */
static bool is_at_rest(const Lane *lane)
{
    const Simulation *simulation = &lane->track.simulation;
    const TimeIntegrator *run = &simulation->run[0];
    if (!(simulation->scene->needs & NEEDS_TIME) || !run->newton ||
        simulation->runs > 1 || lane->track.settings.held ||
        lane->track.now.updates > 0 || simulation->steps == 0)
        return false;
    for (int i = 0; i < 2 * simulation->system.nodes; i++)
        if (fabs(run->v[i]) > simulation->options.tolerance)
            return false;
    return true;
}

/* Of the statuses of several lanes the one that ends most. */
static Status worse(Status one, Status other)
{
    bool first = one && !status_is_unconverged(one);
    return first || !other ? one : other;
}

/* A failure beyond all numbers: what is shown then is the last state that can
 * be seen, at most ten times as large as the first. */
static Status show_last_good(Player *player)
{
    enum { TIMES = 10 };
    Lane *lane = &player->lane[0];
    const Track *track = &lane->track;
    long failed = player->step + 1, step = player->step;
    if (player->lanes > 1 || !track->keeps || track->newest < 1 ||
        state_size(&track->simulation) == 0)
        return STATUS_OK;
    double limit = TIMES * fmax(track_row(track, 1)->extent, 1e-300);
    while (step > 0 && !(track_row(track, step)->extent <= limit))
        step--;
    if (step == player->step)
        return STATUS_OK;
    Status status = player_show(player, step);
    player_note(player,
                "step %ld ends beyond all numbers; shown is step %ld, the last "
                "below ten times the size",
                failed, step);
    player->warning = true;
    return status;
}

/* Whether the failure is what the scene shows: the end of its iteration. */
static bool is_scene_end(const Simulation *simulation, Status status)
{
    return simulation->done && status != STATUS_OUT_OF_MEMORY &&
           status != STATUS_TOO_LARGE;
}

/* A node that was held when this step was shown, long ago. */
static Status let_go(Player *player)
{
    Command release = {.kind = COMMAND_RELEASE};
    if (!player->lane[0].track.settings.held || player->holds)
        return STATUS_OK;
    return player_obey(player, &release);
}

/* All lanes, one step of the player. */
static Status advance_lanes(Player *player)
{
    double target = next_time(player);
    Status worst = STATUS_OK;
    bool moved = false;
    for (int i = 0; i < player->lanes; i++) {
        Lane *lane = &player->lane[i];
        long before = track_step_shown(&lane->track);
        Status status = lane_advance(lane, target, player->step + 1);
        moved = moved || track_step_shown(&lane->track) > before;
        if (is_scene_end(&lane->track.simulation, status))
            status = STATUS_OK;
        worst = worse(status, worst);
        if (status == STATUS_OUT_OF_MEMORY || status == STATUS_INTERRUPTED ||
            player->recorded)
            break;
    }
    if (moved) {
        player->step++;
        player->newest = player->step;
    }
    return worst;
}

/* What curves and trails keep of states not seen before. */
static void sample(Player *player)
{
    for (int i = 0; i < player->lanes; i++) {
        Lane *lane = &player->lane[i];
        if (lane->sampled >= player->step)
            continue;
        lane->sampled = player->step;
        show_sample(&lane->track.simulation, &lane->history, &lane->trail);
    }
}

Status player_step(Player *player)
{
    long before = player->step;
    Status status = player_forget_later(player);
    if (!status)
        status = let_go(player);
    if (status)
        return status;
    leave_step(player);
    status = advance_lanes(player);
    if (player->recorded)
        return player->recorded;
    if (player->step != before) {
        if (player->attended)
            sample(player);
        Status recorded = record_states(player);
        if (recorded)
            return recorded;
    } else {
        player->sampled = -1; /* draw the last frame again, and why it ends */
    }
    if (status == STATUS_INTERRUPTED || status_is_unconverged(status))
        return STATUS_OK;
    return status;
}

bool player_ended(const Player *player)
{
    const Options *options = &player->given[0];
    const Simulation *simulation = &player->lane[0].track.simulation;
    bool unattended = !player->window || options->steps >= 0;
    if (player->quit || *player->stop)
        return true;
    if (!script_is_over(&player->script))
        return false;
    return (options->steps >= 0 && player->step >= options->steps) ||
           (unattended && simulation->done) ||
           (!player->window && player->paused);
}

bool player_unconverged(const Player *player)
{
    bool any = false;
    for (int i = 0; i < player->lanes; i++) {
        const Simulation *simulation = &player->lane[i].track.simulation;
        any = any || simulation->unconverged > 0 ||
              (simulation->done && simulation->status != STATUS_OK);
    }
    return any;
}

/* Pauses at the first step that did not converge, at the end, and at rest; a
 * run of a given number of steps ends by itself and does not. */
static void pause_if_due(Player *player)
{
    bool ended = true, rests = true, trouble = false;
    if (player->given[0].steps >= 0 || !player->attended)
        return;
    for (int i = 0; i < player->lanes; i++) {
        const Lane *lane = &player->lane[i];
        ended = ended && (lane->track.simulation.done || lane->failed);
        rests = rests && is_at_rest(lane);
        trouble = trouble || lane->outcome;
    }
    if (rests && !player->rests)
        player_note(player, "at rest: nothing moves any more; pull a node, "
                            "change a number, or R begins again");
    player->rests = rests;
    player->paused = player->paused || ended || rests;
    if (trouble && !player->warned && player->lanes == 1) {
        player->warned = true;
        player->paused = true;
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
    player->changed = false;
    if (!player->view)
        return STATUS_OK;
    Paper *paper = view_paper(player->view);
    if (!paper)
        return STATUS_OUT_OF_MEMORY;
    bool fresh = player->sampled != player->step;
    bool filmed = film_runs(&player->recording.film);
    player->sampled = player->step;
    sample(player);
    player_paint(player, paper);
    Status status = view_show(player->view);
    if (!status && (fresh || filmed))
        status = recording_frame(&player->recording, &paper->canvas,
                                 player->step, frames_shown(player));
    return status;
}

/* A bar that fills, on a terminal. */
static void show_progress(const Player *player)
{
    char bar[BAR_LENGTH + 1] = {0};
    long steps = player->step, all = player->given[0].steps;
    if (player->given[0].quiet || all < 1 || !isatty(STDERR_FILENO))
        return;
    int filled = (int)(BAR_LENGTH * ((double)steps / (double)all));
    memset(bar, '.', BAR_LENGTH);
    memset(bar, '#', (size_t)(filled < BAR_LENGTH ? filled : BAR_LENGTH));
    fprintf(stderr, "\r[%s] %ld/%ld", bar, steps, all);
    if (player_ended(player))
        fprintf(stderr, "\r%*s\r", BAR_LENGTH + 44, "");
}

/* ---- the loop ----------------------------------------------------------- */

/* Keys, mouse, and what else the window says. */
static Status obey_inputs(Player *player)
{
    Status status = STATUS_OK;
    while (player->window && !status && !player->quit) {
        Input input = view_input(player->view);
        if (input.kind == INPUT_NONE)
            break;
        status = player_input(player, &input);
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
        bool done = player->lane[0].track.simulation.done;
        const Command *command =
            script_due(&player->script, player->step, !player->paused && !done);
        if (!command)
            break;
        status = player_obey(player, command);
        if (status == STATUS_INVALID_INPUT) {
            char line[128];
            command_format(command, line, sizeof line);
            fprintf(stderr, "script: step %ld: '%s': %s\n", player->step, line,
                    player->message);
            player->message[0] = '\0';
            status = STATUS_OK;
        }
    }
    return status;
}

/* A failed step is shown, and somebody may go on from it. */
static Status show_failure(Player *player, Status status)
{
    if (!status || !player->attended || player->given[0].steps >= 0 ||
        player->recorded || status == STATUS_OUT_OF_MEMORY ||
        status == STATUS_SCREEN_FAILED || status == STATUS_FILE_FAILED ||
        status == STATUS_INVALID_INPUT)
        return status;
    if (player->lanes == 1)
        player->paused = true;
    player->changed = true;
    return status == STATUS_NOT_FINITE ? show_last_good(player) : STATUS_OK;
}

/* The steps of one frame; fewer if they take long.  Without a window each step
 * is a frame. */
static Status step_frame(Player *player)
{
    double begin = clock_now();
    Status status = STATUS_OK;
    int count = player->window && player->speed > 0 ? 1 << player->speed : 1;
    for (int i = 0; i < count && !status && !player->paused; i++) {
        if (i > 0 &&
            (player_ended(player) || clock_now() - begin > BATCH_LIMIT))
            break;
        status = show_failure(player, player_step(player));
        pause_if_due(player);
        if (!status)
            status = obey_script(player);
    }
    return status;
}

/* Simulated over real time, twice a second. */
static void measure_speed(Player *player)
{
    double now = clock_now(), time = lane_time(player_lane(player));
    double passed = now - player->clock_mark;
    if (passed < MEASURE_TIME)
        return;
    player->measured = (time - player->time_mark) / passed;
    player->clock_mark = now;
    player->time_mark = time;
}

/* Commands, steps and a frame, as far as they are due.  next s, in/out */
static Status run_frame(Player *player, double *next)
{
    double period = 1 / fmin(FRAME_RATE, player_rate(player));
    Status status = obey_inputs(player);
    if (!status)
        status = obey_script(player);
    if (player->sampled < 0) /* a new run: step 0 is a frame too */
        *next = clock_now() + period;
    bool due = !player->window || clock_now() >= *next - EARLY;
    bool first = player->sampled < 0 && player->view;
    if (!status && !player_ended(player) && !player->paused && due && !first) {
        *next = fmax(*next + period, clock_now());
        status = step_frame(player);
        measure_speed(player);
    }
    if (!status && !player->quit && player->changed)
        status = player_draw(player);
    return status;
}

Status player_run(Player *player)
{
    double next = clock_now();
    Status status = player_draw(player);
    while (!status && !player_ended(player)) {
        status = run_frame(player, &next);
        double wait = player->paused ? IDLE_WAIT : 1e3 * (next - clock_now());
        bool busy = !script_is_over(&player->script) && player->paused;
        if (!player->window)
            show_progress(player);
        else if (!status && !busy && !player_ended(player))
            view_wait(player->view, (int)fmin(ceil(wait), IDLE_WAIT));
    }
    return status;
}

/* ---- beginning and end -------------------------------------------------- */

void player_title(const Player *player, char *title, size_t size)
{
    snprintf(title, size, "elasto: %s (press ? for the keys)",
             player->lanes > 0 ? player->lane[0].track.options.scene->name
                               : player->given[0].scene->name);
}

/* A window; or if there is no screen, a surface for the frames. */
static Status open_view(Player *player)
{
    Options *options = &player->given[0];
    char reason[256] = "", title[128], shown[256];
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
        one_line(options->frames ? options->frames : options->film, shown,
                 sizeof shown);
        if (!player->window)
            fprintf(stderr, "no screen: %s; the frames go to %s%s\n", reason,
                    shown, options->frames ? "/" : "");
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
    const char *name = player->given[0].script;
    char why[160], shown[80];
    if (!name)
        return STATUS_OK;
    one_line(name, shown, sizeof shown);
    Status status = script_read(name, &player->script, why, sizeof why);
    if (status == STATUS_FILE_FAILED)
        snprintf(player->message, sizeof player->message, "--script: %s: %s",
                 shown, strerror(errno));
    if (status == STATUS_INVALID_INPUT)
        snprintf(player->message, sizeof player->message,
                 "--script: %s, %.150s", shown, why);
    return status == STATUS_FILE_FAILED ? STATUS_INVALID_INPUT : status;
}

void player_keep_files(const Player *player, Options *options)
{
    const Options *given = &player->given[0];
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

Status player_create(const Options *options, int count, const char *line,
                     const volatile sig_atomic_t *stop, Player *player)
{
    *player = (Player){.given_count = count, .line = line, .stop = stop};
    memcpy(player->given, options, (size_t)count * sizeof *options);
    player->started = clock_now();
    player->speed = player_first_speed(options);
    player->lens = LENS_FITS;
    player->large = player->selected = -1;
    if (count > 1 && options->log) {
        snprintf(player->message, sizeof player->message,
                 "--log: it is that of one run; %d side by side have no log",
                 count);
        return STATUS_INVALID_INPUT;
    }
    Status status = read_script(player);
    if (!status)
        status = open_view(player);
    if (status)
        return status;
    player->attended = player->window || options->script || options->page;
    player->paused =
        options->paused || (player->window && !options->script &&
                            options->steps < 0 && explains(options));
    Command pause = {.kind = COMMAND_PAUSE}; /* scripts begin to run */
    if (player->paused && script_add(&player->journal, 0, &pause))
        return STATUS_OUT_OF_MEMORY;
    status = recording_open(&player->given[0], &player->recording);
    if (!status)
        status = begin_run(player, player->given, count);
    player->left = options->page;
    if (!status && options->page && player->window && !options->script)
        status = lesson_prepare(player);
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
    for (int i = 0; i < player->lanes; i++)
        lane_free(&player->lane[i]);
    script_free(&player->script);
    script_free(&player->journal);
}
