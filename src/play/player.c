#include "play/player.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "scenes/one_line.h"
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

const Machine *player_machine(const Player *player)
{
    return &player->past.machine[player->active];
}

double player_time(const Player *player)
{
    const Past *past = &player->past;
    int pane = player->active;
    for (int p = 0; p < past_panes(past) && past_ended(past, pane) >= 0; p++)
        pane = p;
    return machine_time(&past->machine[pane]);
}

const Simulation *player_simulation(const Player *player)
{
    return &player_machine(player)->simulation;
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
    player->time_mark = player_time(player);
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
    for (int i = 0; i < past_panes(&player->past); i++)
        hash = state_hash(&player->past.machine[i].simulation, hash);
    return hash;
}

bool player_is_open(const Player *player)
{
    return player->help || player->column || player->blank ||
           player->selected >= 0 ||
           (player->view && view_is_full(player->view));
}

bool player_escape_ends(const Player *player)
{
    return player->leaving && !player_is_open(player);
}

void player_deselect(Player *player)
{
    player->selected = -1;
    player->typing = false;
    player->typed[0] = '\0';
}

bool player_ended(const Player *player)
{
    const Options *options = &player->given[0];
    const Simulation *simulation = &player->past.machine[0].simulation;
    bool unattended = !player->window || options->steps >= 0;
    if (player->quit || *player->stop)
        return true;
    if (!script_is_over(&player->script) || player->past.works)
        return false;
    return (options->steps >= 0 && player->past.step >= options->steps) ||
           (unattended && simulation->done) ||
           (!player->window && player->paused);
}

bool player_unconverged(const Player *player)
{
    bool any = false;
    for (int i = 0; i < past_panes(&player->past); i++) {
        const Simulation *simulation = &player->past.machine[i].simulation;
        any = any || simulation->unconverged > 0 ||
              (simulation->done && simulation->status != STATUS_OK);
    }
    return any;
}

/* ---- drawing ------------------------------------------------------------ */

/* For how many frames' time a film shows a frame. */
static int frames_shown(const Player *player)
{
    return player->speed < 0 ? 1 << -player->speed : 1;
}

void player_know_step(Player *player)
{
    enum { LONG = 800000, SOON = 20000 }; /* nodes times updates */
    Past *past = &player->past;
    long work = 0;
    for (int p = 0; p < past_panes(past); p++) {
        const Machine *machine = &past->machine[p];
        const Simulation *simulation = &machine->simulation;
        if (machine->known || machine->failed || player->side[p].retried ||
            !simulation->run[0].newton || !simulation_is_handled(simulation) ||
            past_entry(past, p, past->step)->substeps == 0)
            continue;
        work += 2 * simulation->system.nodes * /* with the step before it */
                (1 + past_entry(past, p, past->step)->outcome.updates);
    }
    if (!player->paused || !player->attended || past->works ||
        past->step == 0 || work == 0 || work > LONG ||
        (player->mouse.drag == DRAG_TIME && work > SOON))
        return;
    for (int p = 0; p < past_panes(past); p++)
        player->side[p].retried = true;
    past_aim(past, past->step, true);
    player->then = THEN_NOTHING;
    player_work(player);
}

Status player_draw(Player *player)
{
    player->changed = false;
    if (!player->view)
        return STATUS_OK;
    player_know_step(player);
    if (player->past.works && !player->past.making) {
        player->changed = true; /* as soon as it is there */
        return STATUS_OK;
    }
    Paper *paper = view_paper(player->view);
    if (!paper)
        return STATUS_OUT_OF_MEMORY;
    bool fresh = player->sampled != player->past.step;
    bool filmed = film_runs(&player->recording.film);
    player->sampled = player->past.step;
    player_sample(player);
    player_paint(player, paper);
    Status status = view_show(player->view);
    if (!status && (fresh || filmed))
        status = recording_frame(&player->recording, &paper->canvas,
                                 player->past.step, frames_shown(player));
    return status;
}

/* A bar that fills, on a terminal. */
static void show_progress(const Player *player)
{
    char bar[BAR_LENGTH + 1] = {0};
    long steps = player->past.step, all = player->given[0].steps;
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
        bool done = player->past.machine[0].simulation.done;
        const Command *command = script_due(&player->script, player->past.step,
                                            !player->paused && !done);
        if (!command)
            break;
        status = player_obey(player, command);
        if (status == STATUS_INVALID_INPUT) {
            char line[128];
            command_format(command, line, sizeof line);
            one_line(line, line, sizeof line);
            one_line(player->message, player->message, sizeof player->message);
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
    Past *past = &player->past;
    Status status = STATUS_OK;
    int count = player->window && player->speed > 0 ? 1 << player->speed : 1;
    double begin = count > 1 ? clock_now() : 0;
    for (int i = 0; i < count && !status && (!player->paused || past->works);
         i++) {
        if (i > 0 &&
            (player_ended(player) || clock_now() - begin > BATCH_LIMIT))
            break;
        if (!past->works) {
            player->known = past->step < past_newest(past);
            status = player_go_on(player, THEN_NOTHING);
        } else {
            status = player_work(player);
        }
        if (past->works)
            break;
        if (player->by_run && !player->known)
            player_pause_if_due(player);
        if (!status)
            status = obey_script(player);
    }
    return status;
}

/* Simulated over real time, twice a second. */
static void measure_speed(Player *player)
{
    double now = clock_now(), time = player_time(player);
    double passed = now - player->clock_mark;
    if (passed < MEASURE_TIME)
        return;
    player->measured = (time - player->time_mark) / passed;
    player->clock_mark = now;
    player->time_mark = time;
}

Status player_start(Player *player)
{
    player->due = clock_now();
    return player_draw(player);
}

Status player_frame(Player *player)
{
    double period = 1 / fmin(FRAME_RATE, player_rate(player));
    Status status = obey_inputs(player);
    if (!status && !player->past.works)
        status = obey_script(player);
    double now = player->window ? clock_now() : 0; /* else nobody waits */
    if (player->sampled < 0) /* a new run: step 0 is a frame too */
        player->due = now + period;
    bool due = !player->window || now >= player->due - EARLY;
    bool first = player->sampled < 0 && player->view;
    bool works = player->past.works;
    bool goes = !player->paused && due && !first && !player_ended(player);
    if (!status && (works || goes)) {
        if (!works)
            player->due = fmax(player->due + period, now);
        status = step_frame(player);
        if (player->window)
            measure_speed(player);
    }
    if (!status && !player->quit && (player->changed || player->glide > 0))
        status = player_draw(player);
    return status;
}

int player_wait(const Player *player)
{
    if (!player->window || player->past.works ||
        (player->paused && !script_is_over(&player->script)))
        return 0;
    double wait = player->glide > 0 ? 1e3 / FRAME_RATE
                  : player->paused  ? IDLE_WAIT
                                    : 1e3 * (player->due - clock_now());
    return (int)fmax(fmin(ceil(wait), IDLE_WAIT), 0);
}

Status player_run(Player *player)
{
    Status status = player_start(player);
    while (!status && !player_ended(player)) {
        status = player_frame(player);
        if (!player->window)
            show_progress(player);
        else if (!status && !player_ended(player))
            view_wait(player->view, player_wait(player));
    }
    return status;
}

/* ---- beginning and end -------------------------------------------------- */

/* Of the window. */
static void player_title(const Player *player, char *title, size_t size)
{
    snprintf(title, size, "elasto: %s (press ? for the keys)",
             player->scene ? player->scene->name
                           : player->given[0].scene->name);
}

void player_set_title(Player *player)
{
    char title[128];
    player_title(player, title, sizeof title);
    if (player->view)
        view_set_title(player->view, title);
}

/* A window; or if there is no screen, a surface for the frames. */
static Status open_view(Player *player)
{
    Options *options = &player->given[0];
    char reason[256] = "", title[128], shown[256];
    Status status = STATUS_OK;
    player_title(player, title, sizeof title);
    if (!options->headless) {
        const int size[] = {(int)options->size[0], (int)options->size[1]};
        status = view_create_window(title, size, options->fullscreen,
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
    char why[640], shown[80];
    if (!name)
        return STATUS_OK;
    one_line(name, shown, sizeof shown);
    Status status = script_read(name, &player->script, why, sizeof why);
    if (status == STATUS_FILE_FAILED)
        snprintf(player->message, sizeof player->message, "--script: %s: %s",
                 shown, strerror(errno));
    if (status == STATUS_INVALID_INPUT)
        snprintf(player->message, sizeof player->message,
                 "--script: %s, %.600s", shown, why);
    return status == STATUS_FILE_FAILED ? STATUS_INVALID_INPUT : status;
}

bool player_explains(const Options *options)
{
    return options->page ? !options->page->plays : options->scene->explains;
}

Status player_create(const Options *options, int count, const char *line,
                     const volatile sig_atomic_t *stop, Player *player)
{
    *player = (Player){.given_count = count, .stop = stop};
    snprintf(player->line, sizeof player->line, "%s", line);
    memcpy(player->given, options, (size_t)count * sizeof *options);
    player->started = clock_now();
    player->speed = player_first_speed(options);
    player->lens = LENS_FITS;
    player->large = player->selected = -1;
    player_leave_rounds(player);
    Status status = read_script(player);
    if (!status)
        status = open_view(player);
    if (status)
        return status;
    player->attended = player->window || options->script || options->page;
    player->paused =
        options->paused || (player->window && !options->script &&
                            options->steps < 0 && player_explains(options));
    status = recording_open(&player->given[0], count, &player->recording);
    past_create(player->attended || player->view,
                player->attended && options->steps < 0, &player->past);
    player->scene = player->given[0].scene;
    if (!status)
        status = player_begin(player, player->given, count,
                              &(Command){.kind = COMMAND_RESTART});
    Command pause = {.kind = COMMAND_PAUSE}; /* scripts begin to run */
    if (!status && player->paused)
        status = script_add(&player->journal, 0, &pause);
    player->left = options->page;
    if (!status && options->page && player->window && !options->script)
        status = lesson_prepare(player);
    player->begun = !status;
    return status;
}

Status player_finish(Player *player)
{
    Status rest = STATUS_OK;
    if (player->past.branches > 0) {
        rest = player_write_rest(player);
        player_label_panes(player);
    }
    view_free(player->view);
    player->view = NULL;
    Status closed = recording_close(&player->recording);
    return rest ? rest : closed;
}

void player_free(Player *player)
{
    view_free(player->view);
    recording_close(&player->recording);
    past_free(&player->past);
    for (int p = 0; p < OPTIONS_MAX_PANES; p++) {
        free(player->side[p].ghost);
        free(player->side[p].from);
        player->side[p].ghost = player->side[p].from = NULL;
    }
    script_free(&player->script);
    script_free(&player->journal);
}
