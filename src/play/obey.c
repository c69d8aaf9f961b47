/* obey.c - what each command does. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "picture/draw.h"
#include "play/playing.h"
#include "play/png_file.h"
#include "picture/show.h"
#include "scenes/scene.h"

/* Says why a command makes no sense here. */
static Status refuse_command(Player *player, const char *why)
{
    snprintf(player->message, sizeof player->message, "%s", why);
    return STATUS_INVALID_INPUT;
}

/* The step on which commands act. */
static long step_shown(const Player *player)
{
    return track_step_shown(&player->track);
}

/* ---- running and going back --------------------------------------------- */

static Status set_paused(Player *player, bool paused)
{
    player->hud.paused = paused;
    player_reset_speed(player);
    return STATUS_OK;
}

/* One step on: the next one that is known, or a new one. */
static Status go_on(Player *player)
{
    player->hud.paused = true;
    if (step_shown(player) < player->track.newest)
        return player_show(player, step_shown(player) + 1);
    return player_step(player);
}

/* ---- changes ------------------------------------------------------------ */

/* Whether the step after the one that is shown was tried and failed. */
static bool has_failed(const Player *player)
{
    Status status = player->track.simulation.status;
    return status && !status_is_unconverged(status);
}

/* The change, and the present step once more with it. */
static Status change_and_retake(Player *player, const Command *change)
{
    Track *track = &player->track;
    long step = step_shown(player);
    bool again = step > 0 || has_failed(player);
    Status status = STATUS_OK;
    if (again)
        status = player_show(player, has_failed(player) ? step : step - 1);
    if (!status)
        status = track_change(track, change, player->message,
                              sizeof player->message);
    if (!status)
        status = recording_cut(&player->recording, step_shown(player));
    if (!status && again)
        status = player_step(player);
    player->sampled = -1;
    return status;
}

/* An option while the run goes on, or from the start where it cannot change
 * any more. */
static Status set_option(Player *player, const char *text)
{
    Track *track = &player->track;
    const Scene *scene = track->options.scene;
    Command change = {.kind = COMMAND_SET};
    char name[COMMAND_TEXT_SIZE], value[COMMAND_TEXT_SIZE];
    bool paused = player->hud.paused;
    size_t length = strcspn(text, " ");
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    snprintf(value, sizeof value, "%s", text[length] ? text + length + 1 : "");
    snprintf(change.text, sizeof change.text, "%s", text);
    Options options = track->settings.options;
    if (options_set(&options, name, value, player->message,
                    sizeof player->message))
        return STATUS_INVALID_INPUT;
    bool method =
        strcmp(name, "filter") == 0 || strcmp(name, "line-search") == 0;
    bool live = track_can_change(name) && track->simulation.runs == 1 &&
                (scene->needs & NEEDS_TIME || method);
    if (strcmp(name, "timestep") == 0 && scene->needs & NEEDS_TIME)
        live = true;
    Status status;
    if (method && live)
        status = change_and_retake(player, &change);
    else if (live)
        status = track_change(track, &change, player->message,
                              sizeof player->message);
    else
        status = player_restart(player, &options);
    player->hud.paused = paused;
    player_reset_speed(player);
    return status;
}

/* Off, or on again as the command line has it, if there is anything to
 * project. */
static Status switch_filter(Player *player)
{
    char text[COMMAND_TEXT_SIZE];
    Filter given = player->given.filter;
    Filter filter = player->track.settings.options.filter;
    if (!simulation_has_filter(&player->track.simulation))
        return refuse_command(player, "nothing to project here");
    if (filter != FILTER_NONE)
        filter = FILTER_NONE;
    else
        filter = given != FILTER_NONE ? given : FILTER_CLAMP;
    snprintf(text, sizeof text, "filter %s", filter_name(filter));
    Status status = set_option(player, text);
    if (!status)
        player_note(player, "projection: %s", filter_name(filter));
    return status;
}

/* The same, if there is a line to search. */
static Status switch_search(Player *player)
{
    char text[COMMAND_TEXT_SIZE];
    LineSearch given = player->given.line_search;
    LineSearch search = player->track.settings.options.line_search;
    if (!simulation_has_line_search(&player->track.simulation))
        return refuse_command(player, "no line search here");
    if (search != LINE_SEARCH_NONE)
        search = LINE_SEARCH_NONE;
    else
        search = given != LINE_SEARCH_NONE ? given : LINE_SEARCH_BACKTRACK;
    snprintf(text, sizeof text, "line-search %s", line_search_name(search));
    Status status = set_option(player, text);
    if (!status)
        player_note(player, "line search: %s", line_search_name(search));
    return status;
}

/* The next row of the table of integrators. */
static Status switch_integrator(Player *player)
{
    char text[COMMAND_TEXT_SIZE];
    const Simulation *simulation = &player->track.simulation;
    if (!(simulation->scene->needs & NEEDS_TIME))
        return refuse_command(player, "no time passes here");
    const IntegratorMethod *next = simulation->run[0].method + 1;
    if (simulation->runs > 1 || !next->name)
        next = &integrator_methods[0];
    snprintf(text, sizeof text, "integrator %s", next->name);
    Status status = set_option(player, text);
    if (!status)
        player_note(player, "method: %s", next->label);
    return status;
}

/* A change from here on, that makes no step again. */
static Status change_here(Player *player, const Command *change)
{
    Status status = track_change(&player->track, change, player->message,
                                 sizeof player->message);
    player->changed = true;
    player->sampled = -1;
    return status ? status
                  : recording_cut(&player->recording, step_shown(player));
}

/* Pins a node, or sets it free. */
static Status switch_pin(Player *player, long node)
{
    const Simulation *simulation = &player->track.simulation;
    if (!(simulation->scene->needs & NEEDS_MESH) || simulation->scene->step)
        return refuse_command(player, "only nodes of a square can be pinned");
    bool pinned = node < simulation->system.nodes &&
                  simulation_is_pinned(simulation, (int)node);
    Command change = {.kind = COMMAND_PIN, .number = node, .x = !pinned};
    Status status = change_here(player, &change);
    if (!status)
        player_note(player, "node %ld is %s", node, pinned ? "free" : "pinned");
    return status;
}

/* The hand takes a node where it is. */
static Status grab(Player *player, long node)
{
    const Simulation *simulation = &player->track.simulation;
    if (state_size(simulation) == 0)
        return refuse_command(player, "nothing to take hold of here");
    Command change = {.kind = COMMAND_GRAB, .number = node};
    if (node < simulation->system.nodes) {
        change.x = simulation->run[0].x[2 * node];
        change.y = simulation->run[0].x[2 * node + 1];
    }
    Status status = change_here(player, &change);
    player->holds = player->holds || !status;
    return status;
}

/* It pulls, or lets go. */
static Status pull(Player *player, const Command *command)
{
    if (!player->track.settings.held)
        return refuse_command(player, "the hand holds nothing");
    player->holds = command->kind == COMMAND_DRAG;
    return change_here(player, command);
}

/* ---- other scenes ------------------------------------------------------- */

/* The options of a scene: those of the command line if it was called for
 * there, else its defaults; files and ends are those of the command line. */
static Status find_options(Player *player, const char *name, Options *options)
{
    char program[] = "elasto", word[COMMAND_TEXT_SIZE];
    char *arguments[] = {program, word, NULL};
    const Options *given = &player->given;
    snprintf(word, sizeof word, "%s", name);
    if (options_parse(2, arguments, options, player->message,
                      sizeof player->message))
        return STATUS_INVALID_INPUT;
    if (options->scene == given->scene) {
        *options = *given;
        return STATUS_OK;
    }
    player_keep_files(player, options);
    options->speed = given->speed;
    return STATUS_OK;
}

/* Another scene, from its start; it keeps the pause, and one that explains
 * something begins with one. */
static Status switch_scene(Player *player, const char *name)
{
    char title[128];
    Options options;
    Status status = find_options(player, name, &options);
    if (status)
        return status;
    status = player_restart(player, &options);
    if (status)
        return status;
    if (options.scene->explains && !player->given.script)
        player->hud.paused = true;
    player_title(player, title, sizeof title);
    if (player->view)
        view_set_title(player->view, title);
    return STATUS_OK;
}

/* Another start, where the scene has one. */
static Status pick_start(Player *player, double x, double y)
{
    Options options = player->track.settings.options;
    if (!(options.scene->needs & NEEDS_START))
        return refuse_command(player, "this scene has no start to choose");
    options.start[0] = x;
    options.start[1] = y;
    return player_restart(player, &options);
}

/* ---- pictures, films, hashes -------------------------------------------- */

/* elasto_SCENE_000012.png, or the first of ..._2.png, ... that is free. */
static void free_name(const Player *player, const char *end, char *name,
                      size_t size)
{
    const char *scene = player->track.options.scene->name;
    long step = step_shown(player);
    snprintf(name, size, "elasto_%s_%06ld%s", scene, step, end);
    for (int i = 2; access(name, F_OK) == 0 && i < 10000; i++)
        snprintf(name, size, "elasto_%s_%06ld_%d%s", scene, step, i, end);
}

/* The frame as it is, in the present folder. */
static Status save_picture(Player *player)
{
    char name[HUD_NOTE_SIZE - 8];
    Paper *paper = player->view ? view_paper(player->view) : NULL;
    Paper own = {0};
    Status status = STATUS_OK;
    if (!paper) {
        status = paper_create(900, 900, &own);
        paper = &own;
    }
    free_name(player, ".png", name, sizeof name);
    player->hud.note[0] = '\0';
    if (!status) {
        draw_frame(paper, &player->track.simulation, &player->hud);
        status = png_file_write(name, &paper->canvas);
    }
    paper_free(&own);
    if (status)
        player_note(player, "not saved: %s",
                    status == STATUS_FILE_FAILED ? strerror(errno)
                                                 : status_text(status));
    else
        player_note(player, "saved %s", name);
    return STATUS_OK;
}

/* Begins a film of all drawn steps, or ends it. */
static Status switch_film(Player *player)
{
    static char name[HUD_NOTE_SIZE]; /* for the message at its end */
    Recording *recording = &player->recording;
    Status status;
    bool ends = film_runs(&recording->film);
    if (!player->view)
        return refuse_command(player, "nothing is drawn that could be filmed");
    if (ends) {
        status = recording_end_film(recording);
    } else {
        free_name(player, ".apng", name, sizeof name);
        status = recording_film(recording, name);
        player->sampled = -1; /* the present frame is the first */
    }
    if (status)
        player_note(player, "no film: %s", strerror(recording->reason));
    else
        player_note(player, ends ? "film ends: %s" : "filming %s", name);
    recording->reason = 0;
    return STATUS_OK;
}

/* The hash of the state; a session that was changed by hand leaves a script
 * that leads there again. */
static Status tell_hash(Player *player)
{
    player_note(player, "state %016llx at step %ld",
                (unsigned long long)player_hash(player), step_shown(player));
    return STATUS_OK;
}

/* ---- the table ---------------------------------------------------------- */

/* Twice or half as fast. */
static Status change_speed(Player *player, int change)
{
    int speed = player->speed + change;
    if (speed >= SPEED_LEAST && speed <= SPEED_MOST)
        player->speed = speed;
    player_reset_speed(player);
    return STATUS_OK;
}

/* Help or full screen end first, then the program. */
static Status leave(Player *player)
{
    if (player->hud.keys)
        player->hud.keys = false;
    else if (player->hud.column)
        player->hud.column = LECTURE_CARDS;
    else if (player->blank)
        player->blank = false;
    else if (player->view && view_is_full(player->view))
        view_set_full(player->view, false);
    else
        player->quit = true;
    return STATUS_OK;
}

/* What only the screen shows. */
static Status obey_on_screen(Player *player, CommandKind kind)
{
    Hud *hud = &player->hud;
    switch (kind) {
    case COMMAND_FASTER:
        return change_speed(player, 1);
    case COMMAND_SLOWER:
        return change_speed(player, -1);
    case COMMAND_COLOURS:
        hud->strain = !hud->strain;
        break;
    case COMMAND_BARE:
        hud->text = !hud->text;
        hud_sample(hud, &player->track.simulation);
        break;
    case COMMAND_KEYS:
        hud->keys = !hud->keys;
        break;
    case COMMAND_PAGES:
        hud->keys = false;
        hud->column =
            hud->column == LECTURE_PAGES ? LECTURE_CARDS : LECTURE_PAGES;
        break;
    case COMMAND_CODE:
        hud->keys = false;
        hud->column =
            hud->column == LECTURE_CODE ? LECTURE_CARDS : LECTURE_CODE;
        break;
    case COMMAND_BLANK:
        player->blank = !player->blank;
        break;
    case COMMAND_FULL:
        if (player->view)
            view_set_full(player->view, !view_is_full(player->view));
        break;
    case COMMAND_ESCAPE:
        return leave(player);
    case COMMAND_SHOT:
        return save_picture(player);
    case COMMAND_FILM:
        return switch_film(player);
    case COMMAND_HASH:
        return tell_hash(player);
    default:
        break;
    }
    return STATUS_OK;
}

/* What changes the run. */
static Status obey_in_time(Player *player, const Command *command)
{
    switch (command->kind) {
    case COMMAND_QUIT:
        player->quit = true;
        return STATUS_OK;
    case COMMAND_PLAY:
        return set_paused(player, false);
    case COMMAND_PAUSE:
        return set_paused(player, true);
    case COMMAND_NEXT:
        return go_on(player);
    case COMMAND_STEP:
        player->hud.paused = true;
        return player_step(player);
    case COMMAND_BACK:
        return player_show(player, step_shown(player) - 1);
    case COMMAND_HOME:
        return player_show(player, 0);
    case COMMAND_END:
        return player_show(player, player->track.newest);
    case COMMAND_GOTO:
        return player_show(player, command->number);
    case COMMAND_RESTART:
        return player_restart(player, &player->track.settings.options);
    case COMMAND_SCENE:
        return switch_scene(player, command->text);
    case COMMAND_START:
        return pick_start(player, command->x, command->y);
    case COMMAND_PAGE:
    case COMMAND_PAGE_ON:
    case COMMAND_PAGE_BACK:
        return lesson_turn(player, command);
    case COMMAND_FILTER:
        return switch_filter(player);
    case COMMAND_SEARCH:
        return switch_search(player);
    case COMMAND_METHOD:
        return switch_integrator(player);
    case COMMAND_SET:
        return set_option(player, command->text);
    case COMMAND_PIN:
        return switch_pin(player, command->number);
    case COMMAND_GRAB:
        return grab(player, command->number);
    case COMMAND_DRAG:
    case COMMAND_RELEASE:
        return pull(player, command);
    case COMMAND_HANDLE:
    case COMMAND_FLIP:
        return change_here(player, command);
    default:
        return obey_on_screen(player, command->kind);
    }
}

/* A switch becomes what it does now, so that a journal of it leads to the same
 * place whatever was before. */
static Command resolve(const Player *player, const Command *command)
{
    Command resolved = *command;
    if (command->kind == COMMAND_TOGGLE_PAUSE)
        resolved.kind = player->hud.paused ? COMMAND_PLAY : COMMAND_PAUSE;
    return resolved;
}

Status player_obey(Player *player, const Command *command)
{
    Command resolved = resolve(player, command);
    player->changed = true;
    player->message[0] = '\0';
    if (command->kind != COMMAND_REDRAW)
        player->hud.note[0] = '\0';
    if (command_row(resolved.kind)->kept &&
        script_add(&player->journal, step_shown(player), &resolved))
        return STATUS_OUT_OF_MEMORY;
    Status status = obey_in_time(player, &resolved);
    if (status && player->attended && player->given.steps < 0 &&
        status == player->track.simulation.status) {
        player->hud.paused = true; /* a step that failed is shown */
        return STATUS_OK;
    }
    return status;
}
