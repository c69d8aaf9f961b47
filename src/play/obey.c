/* obey.c - what each command does. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "model/hand_energy.h"
#include "picture/picture.h"
#include "play/playing.h"
#include "play/png_file.h"
#include "scenes/scene.h"

/* Says why a command makes no sense here. */
static Status refuse_command(Player *player, const char *why)
{
    snprintf(player->message, sizeof player->message, "%s", why);
    return STATUS_INVALID_INPUT;
}

/* The settings of the lane whose numbers are shown. */
static const Settings *settings_now(const Player *player)
{
    return &player->lane[player->active].track.settings;
}

/* ---- running and going back --------------------------------------------- */

static Status set_paused(Player *player, bool paused)
{
    player->paused = paused;
    player->rests = player->rests && paused;
    for (int i = 0; !paused && i < player->lanes; i++)
        player->lane[i].place = -1;
    player_reset_speed(player);
    return STATUS_OK;
}

/* The next step, known or new. */
static Status next_step(Player *player, bool walked)
{
    player->paused = true;
    if (player->step >= player->newest)
        return player_step(player);
    return walked ? player_retape(player, player->step + 1)
                  : player_show(player, player->step + 1);
}

/* All lanes that can be walked through, at their first or at their last
 * place. */
static void enter_tapes(Player *player, bool at_end)
{
    for (int i = 0; i < player->lanes; i++) {
        Lane *lane = &player->lane[i];
        if (lane_walks(lane))
            lane->place = at_end ? lane->tape.places - 1 : 0;
    }
}

/* A pace on in all lanes; false: each was at its end. */
static bool walk_on(Player *player)
{
    bool moved = false;
    for (int i = 0; i < player->lanes; i++) {
        Lane *lane = &player->lane[i];
        int last = lane->tape.places - 1;
        if (lane->place < 0 || lane->place >= last)
            continue;
        int next = tape_next(&lane->tape, player->fine, lane->place);
        lane->place = next < last ? next : last;
        moved = true;
    }
    return moved;
}

/* The same back; false: each was at its start. */
static bool walk_back(Player *player)
{
    bool moved = false;
    for (int i = 0; i < player->lanes; i++) {
        Lane *lane = &player->lane[i];
        if (lane->place <= 0)
            continue;
        int next = tape_back(&lane->tape, player->fine, lane->place);
        lane->place = next > 0 ? next : 0;
        moved = true;
    }
    return moved;
}

/* Where E has risen beyond all proportion within a step that was taken by
 * itself, that is what is shown. */
static void show_peaks(Player *player)
{
    for (int i = 0; i < player->lanes; i++) {
        Lane *lane = &player->lane[i];
        double rise;
        int peak = lane_peak(lane, &rise);
        if (peak < 0)
            continue;
        lane->place = peak;
        player_note(player,
                    "update %d of %d: E has risen by %.3g J s\u00b2, and nodes "
                    "are %.3g m away; N goes on",
                    lane->tape.place[peak].round + 1, lane->tape.count, rise,
                    lane_extent(lane));
        player->warning = true;
    }
}

/* One on: a step, an update or a line. */
static Status go_on(Player *player)
{
    bool peaked = player->fine == 0 && player_lane(player)->place >= 0;
    player->paused = true;
    if (player->fine > 0 && walk_on(player))
        return STATUS_OK;
    if (peaked) { /* from the height of an explosion to its end */
        for (int i = 0; i < player->lanes; i++)
            player->lane[i].place = -1;
        return STATUS_OK;
    }
    Status status = next_step(player, player->fine > 0);
    if (!status && player->fine > 0)
        enter_tapes(player, false);
    else if (!status)
        show_peaks(player);
    return status;
}

/* One back, the same; from the first line of a step to the end of the one
 * before. */
static Status go_back(Player *player)
{
    Lane *lane = player_lane(player);
    player->paused = true;
    if (player->fine == 0)
        return player_show(player, player->step - 1);
    if (lane->place < 0 && player->step > 0) {
        Status status =
            lane->taped ? STATUS_OK : player_retape(player, player->step);
        if (status || !lane_walks(lane))
            return status ? status : player_show(player, player->step - 1);
        enter_tapes(player, true);
    }
    if (lane->place < 0 || walk_back(player))
        return STATUS_OK;
    Status status = player_retape(player, player->step - 1);
    if (!status)
        enter_tapes(player, true);
    return status;
}

/* Steps, updates, lines, and steps again. */
static Status go_finer(Player *player)
{
    static const char *const text[] = {
        "N and \u2190 go by whole steps",
        "N and \u2190 go by updates of Newton's method",
        "N and \u2190 go by lines of Algorithm 3",
    };
    player->fine = (player->fine + 1) % 3;
    for (int i = 0; player->fine == 0 && i < player->lanes; i++)
        player->lane[i].place = -1;
    player->paused = true;
    player_note(player, "%s", text[player->fine]);
    return STATUS_OK;
}

/* ---- changes ------------------------------------------------------------ */

/* Which lanes a change of this option is for: the active one where they are
 * compared by it, else all.  from, to out: lanes from ... to - 1. */
static void find_lanes(const Player *player, const char *option, int *from,
                       int *to)
{
    bool one = option && player_compares(player, option);
    *from = one ? player->active : 0;
    *to = one ? player->active + 1 : player->lanes;
}

/* A change from here on, in these lanes; it makes no step again. */
static Status change_lanes(Player *player, const Command *change, int from,
                           int to)
{
    Status status = player_forget_later(player);
    player->changed = true;
    player->rests = false;
    for (int i = from; i < to && !status; i++)
        status = track_change(&player->lane[i].track, change, player->message,
                              sizeof player->message);
    return status;
}

static Status change_all(Player *player, const Command *change)
{
    player->sampled = -1;
    return change_lanes(player, change, 0, player->lanes);
}

/* The sum over its updates of what the step that was just taken did to E, and
 * how many they were. */
typedef struct Outcome {
    double change;
    int updates;
    Status status;
    double extent;
} Outcome;

static Outcome outcome_of(const Lane *lane)
{
    return (Outcome){lane->track.now.change, lane->track.now.updates,
                     lane->outcome, lane_extent(lane)};
}

/* "E +206 in 12 updates" */
static void tell_outcome(const Outcome *outcome, char *text, size_t size)
{
    snprintf(text, size, "E %+.3g in %d update%s%s%s", outcome->change,
             outcome->updates, outcome->updates == 1 ? "" : "s",
             outcome->status ? ", " : "",
             outcome->status ? status_text(outcome->status) : "");
}

/* What a value of a method is called in a sentence. */
static void method_words(const char *option, const char *value, char *text,
                         size_t size)
{
    bool filter = strcmp(option, "filter") == 0;
    if (strcmp(value, "none") == 0)
        snprintf(text, size, filter ? "no projection" : "full step");
    else
        snprintf(text, size, "%s %s", filter ? "projection" : "line search",
                 value);
}

/* The place in the tape that is the same line of the same round as before. */
static void find_place(Lane *lane, int round, Line line)
{
    const Tape *tape = &lane->tape;
    if (!lane_walks(lane))
        return;
    lane->place = tape->places - 1;
    for (int i = tape->places - 1; i >= 0; i--)
        if (tape->place[i].round == round && tape->place[i].line <= line) {
            lane->place = i;
            return;
        }
}

/* The change, and the present step once more with it, from its own start; what
 * was there before stays as a ghost, or beside it. */
static Status retake(Player *player, const Command *change, const char *option,
                     const char *value, const char *old, int from, int to)
{
    Lane *lane = &player->lane[player->active];
    bool failed = lane->failed, paused = player->paused;
    bool again = player->step > 0 || failed;
    long first = player->step - (failed ? 0 : 1);
    int round = -1;
    Line line = LINE_NONE;
    char was[64], is[64], had[160], has[160];
    if (lane->place >= 0 && player->fine > 0) {
        round = lane->tape.place[lane->place].round;
        line = lane->tape.place[lane->place].line;
    }
    if (!again)
        return change_lanes(player, change, from, to);
    Outcome before = outcome_of(lane);
    if (!failed && track_step_shown(&lane->track) > 0 &&
        state_size(&lane->track.simulation) > 0) {
        const StepRow *row =
            track_row(&lane->track, track_step_shown(&lane->track));
        before.change = row->change;
        before.updates = row->updates;
    }
    method_words(option, old, was, sizeof was);
    method_words(option, value, is, sizeof is);
    double *ghost = NULL;
    size_t bytes =
        2 * (size_t)lane->track.simulation.system.nodes * sizeof *ghost;
    if (!failed && state_size(&lane->track.simulation) > 0)
        ghost = malloc(bytes);
    if (ghost)
        memcpy(ghost, lane->track.simulation.run[0].x, bytes);
    Status status = player_show(player, first);
    if (!status)
        status = change_lanes(player, change, from, to);
    if (!status)
        status = player_step(player);
    player->paused = paused;
    player->sampled = -1;
    Outcome after = outcome_of(lane);
    if (ghost) {
        lane_drop_ghost(lane);
        lane->ghost = ghost;
        snprintf(lane->ghost_label, sizeof lane->ghost_label, "%s", was);
    }
    if (round >= 0)
        find_place(lane, round, line);
    tell_outcome(&before, had, sizeof had);
    tell_outcome(&after, has, sizeof has);
    player_note(player, "%s: %s; %s: %s", was, had, is, has);
    return status;
}

/* Whether two outcomes fit into one picture. */
static bool fits_one_picture(const Outcome *one, const Outcome *other)
{
    enum { TIMES = 5 };
    return one->extent <= TIMES * other->extent &&
           other->extent <= TIMES * one->extent;
}

/* Filter or line search, with the present step taken again.  Two outcomes that
 * no one picture can show are put beside each other. */
static Status set_method(Player *player, const Command *change,
                         const char *option, const char *value, const char *old,
                         int from, int to)
{
    enum { SOON = 64 }; /* steps that are made again without a wait */
    Lane *lane = &player->lane[player->active], *beside = &player->lane[1];
    Status status = STATUS_OK;
    bool alone = player->lanes == 1 && player->attended && player->step > 0 &&
                 player->step < SOON && !lane->failed &&
                 (lane->track.options.scene->needs & NEEDS_MESH) &&
                 state_size(&lane->track.simulation) > 0;
    Outcome before = outcome_of(lane);
    if (alone)
        status = lane_clone(lane, 1, player_watch, beside);
    if (alone && !status)
        status = lane_retape(beside, player->step);
    if (!status)
        status = retake(player, change, option, value, old, from, to);
    Outcome after = outcome_of(lane);
    if (!alone)
        return status;
    if (status || fits_one_picture(&before, &after)) {
        lane_free(beside);
        return status;
    }
    lane_drop_ghost(lane);
    player->lanes = 2;
    char note[sizeof player->note];
    memcpy(note, player->note, sizeof note);
    show_peaks(player);
    memcpy(player->note, note, sizeof note);
    return STATUS_OK;
}

/* Whether new runs with these options can begin; the message says why not. */
static Status try_options(Player *player, const Options *options, int count)
{
    Simulation *trial = calloc(1, sizeof *trial);
    Status status = trial ? STATUS_OK : STATUS_OUT_OF_MEMORY;
    for (int i = 0; i < count && !status; i++) {
        status = simulation_create(&options[i], NULL, NULL, trial);
        simulation_free(trial);
    }
    free(trial);
    return status ? refuse_command(player, status_text(status)) : STATUS_OK;
}

/* New runs with this option in these lanes. */
static Status restart_with(Player *player, const char *option,
                           const char *value, int from, int to)
{
    Options options[OPTIONS_MAX_PANES];
    for (int i = 0; i < player->lanes; i++) {
        options[i] = player->lane[i].track.settings.options;
        if (i >= from && i < to &&
            options_set(&options[i], option, value, player->message,
                        sizeof player->message))
            return STATUS_INVALID_INPUT;
    }
    int active = player->active;
    bool paused = player->paused;
    Status status = try_options(player, options, player->lanes);
    if (status)
        return status;
    status = player_restart(player, options, player->lanes);
    player->active = active;
    player->paused = paused;
    return status;
}

/* An option while the run goes on, or from the start where it cannot change
 * any more. */
static Status set_option(Player *player, const char *text)
{
    const Simulation *simulation = player_simulation(player);
    const Scene *scene = simulation->scene;
    Command change = {.kind = COMMAND_SET};
    char name[COMMAND_TEXT_SIZE], value[COMMAND_TEXT_SIZE];
    char old[COMMAND_TEXT_SIZE] = "";
    size_t length = strcspn(text, " ");
    int from, to;
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    snprintf(value, sizeof value, "%s", text[length] ? text + length + 1 : "");
    snprintf(change.text, sizeof change.text, "%s", text);
    Options options = settings_now(player)->options;
    if (options_set(&options, name, value, player->message,
                    sizeof player->message))
        return STATUS_INVALID_INPUT;
    if (strcmp(name, "integrator") == 0 &&
        integrator_method_refuses(options.integrator, &simulation->system))
        return refuse_command(player, "a term of this scene refuses it");
    find_lanes(player, name, &from, &to);
    const Number *number = number_find(name);
    if (number)
        number_value(number, &settings_now(player)->options, old);
    bool time = scene->needs & NEEDS_TIME;
    bool method =
        strcmp(name, "filter") == 0 || strcmp(name, "line-search") == 0;
    bool live = track_can_change(name) && (time || method) &&
                (simulation->runs == 1 || strcmp(name, "integrator") != 0);
    Status status;
    if (!live)
        status = restart_with(player, name, value, from, to);
    else if (method && strcmp(old, value) != 0)
        status = set_method(player, &change, name, value, old, from, to);
    else
        status = change_lanes(player, &change, from, to);
    player_reset_speed(player);
    return status;
}

/* What the journal keeps of it: the number and its new value. */
static Status obey_set(Player *player, const char *option, const char *value)
{
    Command command = {.kind = COMMAND_SET};
    snprintf(command.text, sizeof command.text, "%.20s %.40s", option, value);
    return player_obey(player, &command);
}

/* The selected number up or down. */
static Status pace_number(Player *player, int paces)
{
    char value[COMMAND_TEXT_SIZE];
    const Number *number[NUMBERS_MOST];
    const Options *options = &settings_now(player)->options;
    int count = numbers_of(options, number);
    if (count == 0)
        return refuse_command(player, "there is no number to change here");
    if (player->selected < 0 || player->selected >= count)
        player->selected = 0;
    number_paced(number[player->selected], options, paces, value);
    return obey_set(player, number[player->selected]->option, value);
}

/* The value that the scene has by itself, or that of the command line. */
static Status set_default(Player *player, const char *option)
{
    char value[COMMAND_TEXT_SIZE];
    const Number *number = number_find(option);
    Options options = player->given[0];
    if (!number)
        return refuse_command(player, "there is no such number");
    if (options.scene != player->lane[0].track.options.scene) {
        char program[] = "elasto", scene[COMMAND_TEXT_SIZE];
        char *arguments[] = {program, scene, NULL};
        snprintf(scene, sizeof scene, "%s",
                 player->lane[0].track.options.scene->name);
        if (options_parse(2, arguments, &options, player->message,
                          sizeof player->message))
            return STATUS_INVALID_INPUT;
    }
    number_value(number, &options, value);
    return obey_set(player, option, value);
}

/* The pane whose numbers are shown. */
static Status choose_pane(Player *player, long number)
{
    if (number >= player->lanes)
        return refuse_command(player, "there is no such pane");
    player->active = (int)number;
    return STATUS_OK;
}

/* Tab: the next number, and after the last one none. */
static Status select_number(Player *player)
{
    const Number *number[NUMBERS_MOST];
    int count = numbers_of(&settings_now(player)->options, number);
    player->selected = player->selected + 1 < count ? player->selected + 1 : -1;
    return STATUS_OK;
}

/* Off, or on again as the command line has it, if there is anything to
 * project. */
static Status switch_filter(Player *player)
{
    char text[COMMAND_TEXT_SIZE];
    Filter given = player->given[0].filter;
    Filter filter = settings_now(player)->options.filter;
    if (!simulation_has_filter(player_simulation(player)))
        return refuse_command(player, "nothing to project here");
    if (filter != FILTER_NONE)
        filter = FILTER_NONE;
    else
        filter = given != FILTER_NONE ? given : FILTER_CLAMP;
    snprintf(text, sizeof text, "filter %s", filter_name(filter));
    return set_option(player, text);
}

/* The same, if there is a line to search. */
static Status switch_search(Player *player)
{
    char text[COMMAND_TEXT_SIZE];
    LineSearch given = player->given[0].line_search;
    LineSearch search = settings_now(player)->options.line_search;
    if (!simulation_has_line_search(player_simulation(player)))
        return refuse_command(player, "no line search here");
    if (search != LINE_SEARCH_NONE)
        search = LINE_SEARCH_NONE;
    else
        search = given != LINE_SEARCH_NONE ? given : LINE_SEARCH_BACKTRACK;
    snprintf(text, sizeof text, "line-search %s", line_search_name(search));
    return set_option(player, text);
}

/* The next row of the table of integrators that all terms allow. */
static const IntegratorMethod *next_method(const Simulation *simulation)
{
    const IntegratorMethod *next = simulation->run[0].method;
    if (simulation->runs > 1)
        return &integrator_methods[0];
    do {
        next = next[1].name ? next + 1 : &integrator_methods[0];
    } while (next != simulation->run[0].method &&
             integrator_method_refuses(next, &simulation->system));
    return next;
}

static Status switch_integrator(Player *player)
{
    char text[COMMAND_TEXT_SIZE];
    const Simulation *simulation = player_simulation(player);
    if (!(simulation->scene->needs & NEEDS_TIME))
        return refuse_command(player, "no time passes here");
    const IntegratorMethod *next = next_method(simulation);
    snprintf(text, sizeof text, "integrator %s", next->name);
    Status status = set_option(player, text);
    if (!status)
        player_note(player, "method: %s", next->label);
    return status;
}

/* The same run with the next method beside the last one. */
static Status add_pane(Player *player)
{
    const Lane *last = &player->lane[player->lanes - 1];
    const Simulation *simulation = &last->track.simulation;
    Command change = {.kind = COMMAND_SET};
    const IntegratorMethod *next = next_method(simulation);
    if (player->lanes == OPTIONS_MAX_PANES)
        return refuse_command(player, "six are side by side: no room for more");
    if (!(simulation->scene->needs & NEEDS_TIME) || simulation->runs > 1 ||
        !player->attended || next == simulation->run[0].method)
        return refuse_command(player, "nothing to be put beside it here");
    snprintf(change.text, sizeof change.text, "integrator %s", next->name);
    Status status = player_forget_later(player);
    Lane *lane = &player->lane[player->lanes];
    if (!status)
        status = lane_clone(last, player->lanes, player_watch, lane);
    if (status) {
        lane_free(lane);
        return status;
    }
    player->active = player->lanes++;
    player_note(player, "beside it: %s", next->label);
    return track_change(&lane->track, &change, player->message,
                        sizeof player->message);
}

/* The last pane goes. */
static Status end_pane(Player *player)
{
    if (player->lanes < 2)
        return refuse_command(player, "there is only one");
    lane_free(&player->lane[--player->lanes]);
    if (player->active >= player->lanes)
        player->active = player->lanes - 1;
    return STATUS_OK;
}

/* ---- hands -------------------------------------------------------------- */

/* Pins a node, or sets it free. */
static Status switch_pin(Player *player, long node)
{
    const Simulation *simulation = player_simulation(player);
    if (!(simulation->scene->needs & NEEDS_MESH) || simulation->scene->step)
        return refuse_command(player, "only nodes of a square can be pinned");
    bool pinned = node < simulation->system.nodes &&
                  simulation_is_pinned(simulation, (int)node);
    Command change = {.kind = COMMAND_PIN, .number = node, .x = !pinned};
    Status status = change_all(player, &change);
    if (!status)
        player_note(player, "node %ld is %s", node, pinned ? "free" : "pinned");
    return status;
}

/* The hand takes a node where it is. */
static Status grab(Player *player, long node)
{
    const Simulation *simulation = player_simulation(player);
    if (state_size(simulation) == 0)
        return refuse_command(player, "nothing to take hold of here");
    Command change = {.kind = COMMAND_GRAB, .number = node};
    if (node < simulation->system.nodes) {
        change.x = simulation->run[0].x[2 * node];
        change.y = simulation->run[0].x[2 * node + 1];
    }
    Status status = change_all(player, &change);
    player->holds = player->holds || !status;
    return status;
}

/* It pulls, or lets go. */
static Status pull(Player *player, const Command *command)
{
    if (!settings_now(player)->held)
        return refuse_command(player, "the hand holds nothing");
    player->holds = command->kind == COMMAND_DRAG;
    return change_all(player, command);
}

/* ---- other scenes ------------------------------------------------------- */

/* The options of a scene: those of the command line if it was called for
 * there, else its defaults; files and ends are those of the command line. */
static Status find_options(Player *player, const char *name, Options *options,
                           int *count)
{
    char program[] = "elasto", word[COMMAND_TEXT_SIZE];
    char *arguments[] = {program, word, NULL};
    const Options *given = &player->given[0];
    snprintf(word, sizeof word, "%s", name);
    if (options_parse(2, arguments, options, player->message,
                      sizeof player->message))
        return STATUS_INVALID_INPUT;
    *count = 1;
    if (options->scene == given->scene) {
        *count = player->given_count;
        memcpy(options, given, (size_t)*count * sizeof *given);
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
    Options options[OPTIONS_MAX_PANES];
    int count;
    Status status = find_options(player, name, options, &count);
    if (!status)
        status = player_restart(player, options, count);
    if (status)
        return status;
    if (options->scene->explains && !player->given[0].script)
        player->paused = true;
    player_title(player, title, sizeof title);
    if (player->view)
        view_set_title(player->view, title);
    return STATUS_OK;
}

/* Another start, where the scene has one. */
static Status pick_start(Player *player, double x, double y)
{
    Options options[OPTIONS_MAX_PANES];
    const Scene *scene = player->lane[0].track.options.scene;
    if (!(scene->needs & NEEDS_START))
        return refuse_command(player, "this scene has no start to choose");
    for (int i = 0; i < player->lanes; i++) {
        options[i] = player->lane[i].track.settings.options;
        options[i].start[0] = x;
        options[i].start[1] = y;
    }
    player->paused = true;
    Status status = try_options(player, options, player->lanes);
    return status ? status : player_restart(player, options, player->lanes);
}

/* From step 0 with the present numbers. */
static Status begin_again(Player *player)
{
    Options options[OPTIONS_MAX_PANES];
    for (int i = 0; i < player->lanes; i++)
        options[i] = player->lane[i].track.settings.options;
    return player_restart(player, options, player->lanes);
}

/* ---- pictures, films, hashes -------------------------------------------- */

/* elasto_SCENE_000012.png, or the first of ..._2.png, ... that is free. */
static void free_name(const Player *player, const char *end, char *name,
                      size_t size)
{
    const char *scene = player->lane[0].track.options.scene->name;
    snprintf(name, size, "elasto_%s_%06ld%s", scene, player->step, end);
    for (int i = 2; access(name, F_OK) == 0 && i < 100000; i++)
        snprintf(name, size, "elasto_%s_%06ld_%d%s", scene, player->step, i,
                 end);
}

/* The frame as it is, in the present folder. */
static Status save_picture(Player *player)
{
    enum { WIDTH = 1280, HEIGHT = 800 };
    char name[80];
    Paper *paper = player->view ? view_paper(player->view) : NULL;
    Paper own = {0};
    Status status = STATUS_OK;
    if (!paper) {
        status = paper_create(WIDTH, HEIGHT, &own);
        paper = &own;
    }
    free_name(player, ".png", name, sizeof name);
    player->note[0] = '\0';
    if (!status) {
        player_paint(player, paper);
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

/* Begins a film of all that is drawn, or ends it. */
static Status switch_film(Player *player)
{
    static char name[80]; /* for the message at its end */
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
    recording->message[0] = '\0';
    return STATUS_OK;
}

/* The hash of the state; where commands have led here they are written down as
 * a script, which leads here again. */
static Status tell_hash(Player *player)
{
    char name[80];
    unsigned long long hash = player_hash(player);
    const char *scene = player->lane[0].track.options.scene->name;
    if (player->journal.count == 0) {
        player_note(player, "state %016llx: %.80s --steps %ld", hash,
                    player->line, player->step);
        return STATUS_OK;
    }
    free_name(player, ".script", name, sizeof name);
    Status status = script_write(name, &player->journal);
    if (status)
        player_note(player, "state %016llx of %s, step %ld; no script: %s",
                    hash, scene, player->step,
                    status == STATUS_FILE_FAILED ? strerror(errno)
                                                 : status_text(status));
    else
        player_note(player, "state %016llx at step %ld: %.60s --script %s",
                    hash, player->step, player->line, name);
    return STATUS_OK;
}

/* ---- the screen --------------------------------------------------------- */

/* Twice or half as fast. */
static Status change_speed(Player *player, int change)
{
    int speed = player->speed + change;
    if (speed >= SPEED_LEAST && speed <= SPEED_MOST)
        player->speed = speed;
    player_reset_speed(player);
    return STATUS_OK;
}

/* Help, a black screen or full screen end first, then the program. */
static Status leave(Player *player)
{
    if (player->help)
        player->help = false;
    else if (player->column)
        player->column = LECTURE_CARDS;
    else if (player->blank)
        player->blank = false;
    else if (player->view && view_is_full(player->view))
        view_set_full(player->view, false);
    else
        player->quit = true;
    return STATUS_OK;
}

/* Zooms at a point in metres, or moves the picture by some of them. */
static Status move_camera(Player *player, const Command *command)
{
    const Paper *paper = player->view ? view_paper(player->view) : NULL;
    if (!paper)
        return STATUS_OK;
    player_fill(player);
    Layout layout =
        show_layout(&player->show, paper->canvas.width, paper->canvas.height);
    Camera camera = show_camera(&player->show, &layout, player->active);
    double at[2] = {command->x, command->y}, pixel[2];
    camera_pixel(&camera, at, pixel);
    if (command->kind == COMMAND_ZOOM)
        show_zoom(&player->show, &layout, pixel[0], pixel[1],
                  fmin(fmax((double)command->number, 1), 1e6) / 100);
    else
        show_move(&player->show, &layout, player->active,
                  camera.scale[0] * command->x, -camera.scale[1] * command->y);
    player->lens = player->show.lens;
    return STATUS_OK;
}

/* A card is closed or opened; enlarged or as the others. */
static Status switch_card(Player *player, const Command *command)
{
    int cards = picture_cards(picture_of(player->lane[0].track.options.scene));
    int card = (int)fmin((double)command->number, 1e6);
    if (card >= cards)
        return refuse_command(player, "there is no such card");
    if (command->kind == COMMAND_CARD)
        player->closed ^= 1u << card;
    else
        player->large = player->large == card ? -1 : card;
    return STATUS_OK;
}

/* The list of pages, or a page's code, or the cards again. */
static Status switch_column(Player *player, CommandKind kind)
{
    LectureColumn column = kind == COMMAND_PAGES ? LECTURE_PAGES : LECTURE_CODE;
    player->help = false;
    player->column = player->column == column ? LECTURE_CARDS : column;
    return STATUS_OK;
}

/* What only the screen shows. */
static Status obey_on_screen(Player *player, const Command *command)
{
    switch (command->kind) {
    case COMMAND_FASTER:
        return change_speed(player, 1);
    case COMMAND_SLOWER:
        return change_speed(player, -1);
    case COMMAND_COLOURS:
        player->strain = !player->strain;
        break;
    case COMMAND_BARE:
        player->bare = !player->bare;
        break;
    case COMMAND_KEYS:
        player->help = !player->help;
        break;
    case COMMAND_PAGES:
    case COMMAND_CODE:
        return switch_column(player, command->kind);
    case COMMAND_BLANK:
        player->blank = !player->blank;
        break;
    case COMMAND_FULL:
        if (player->view)
            view_set_full(player->view, !view_is_full(player->view));
        break;
    case COMMAND_FIT:
        player->lens = LENS_FITS;
        break;
    case COMMAND_ZOOM:
    case COMMAND_PAN:
        return move_camera(player, command);
    case COMMAND_CARD:
    case COMMAND_ENLARGE:
        return switch_card(player, command);
    case COMMAND_SELECT:
        return select_number(player);
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

/* ---- the table ---------------------------------------------------------- */

/* What changes the settings of the run. */
static Status obey_change(Player *player, const Command *command)
{
    switch (command->kind) {
    case COMMAND_FILTER:
        return switch_filter(player);
    case COMMAND_SEARCH:
        return switch_search(player);
    case COMMAND_METHOD:
        return switch_integrator(player);
    case COMMAND_ADD_PANE:
        return add_pane(player);
    case COMMAND_END_PANE:
        return end_pane(player);
    case COMMAND_PANE:
        return choose_pane(player, command->number);
    case COMMAND_SET:
        return set_option(player, command->text);
    case COMMAND_DEFAULT:
        return set_default(player, command->text);
    case COMMAND_RAISE:
        return pace_number(player, 1);
    case COMMAND_LOWER:
        return pace_number(player, -1);
    case COMMAND_PIN:
        return switch_pin(player, command->number);
    case COMMAND_GRAB:
        return grab(player, command->number);
    case COMMAND_DRAG:
    case COMMAND_RELEASE:
        return pull(player, command);
    case COMMAND_HANDLE:
    case COMMAND_FLIP:
        return change_all(player, command);
    default:
        return obey_on_screen(player, command);
    }
}

/* What goes through time. */
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
        player->paused = true;
        return player_step(player);
    case COMMAND_BACK:
        return go_back(player);
    case COMMAND_FINER:
        return go_finer(player);
    case COMMAND_HOME:
        return player_show(player, 0);
    case COMMAND_END:
        return player_show(player, player->newest);
    case COMMAND_GOTO:
        return player_show(player, command->number);
    case COMMAND_RESTART:
        return begin_again(player);
    case COMMAND_SCENE:
        return switch_scene(player, command->text);
    case COMMAND_START:
        return pick_start(player, command->x, command->y);
    case COMMAND_PREDICT:
        return lesson_predict(player, command->x, command->y);
    case COMMAND_CELL:
        return lesson_visit(player, command->number);
    case COMMAND_PAGE:
    case COMMAND_PAGE_ON:
    case COMMAND_PAGE_BACK:
        return lesson_turn(player, command);
    default:
        return obey_change(player, command);
    }
}

/* A switch becomes what it does now, so that a journal of it leads to the same
 * place whatever was before. */
static Command resolve(const Player *player, const Command *command)
{
    Command resolved = *command;
    if (command->kind == COMMAND_TOGGLE_PAUSE)
        resolved.kind = player->paused ? COMMAND_PLAY : COMMAND_PAUSE;
    return resolved;
}

/* Whether the message of before may stay. */
static bool keeps_note(CommandKind kind)
{
    return kind == COMMAND_REDRAW || kind == COMMAND_DRAG ||
           kind == COMMAND_PLAY || kind == COMMAND_RELEASE;
}

Status player_obey(Player *player, const Command *command)
{
    Command resolved = resolve(player, command);
    player->changed = true;
    player->message[0] = '\0';
    if (!keeps_note(resolved.kind))
        player->note[0] = '\0';
    if (command_row(resolved.kind)->kept &&
        script_add(&player->journal, player->step, &resolved))
        return STATUS_OUT_OF_MEMORY;
    Status status = obey_in_time(player, &resolved);
    bool fatal = status == STATUS_OUT_OF_MEMORY ||
                 status == STATUS_INVALID_INPUT ||
                 status == STATUS_FILE_FAILED || status == STATUS_SCREEN_FAILED;
    if (status && !fatal && player->attended && player->given[0].steps < 0) {
        player->paused = true; /* a step that failed is shown */
        return STATUS_OK;
    }
    return status;
}
