#include "play/track.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/pull_energy.h"
#include "scenes/scene.h"

long track_step_shown(const Track *track)
{
    return track->simulation.steps;
}

const StepRow *track_row(const Track *track, long step)
{
    return &track->row[step - 1];
}

/* Sums up the step for its row. */
static bool watch(void *user, const NewtonRecord *record)
{
    Track *track = user;
    track->now.updates += record->iteration >= 0;
    track->now.change = record->change; /* where an update is a step */
    track->now.residual = record->residual;
    if (!track->observer)
        return true;
    return track->observer(track->user, record);
}

/* ---- kept states -------------------------------------------------------- */

size_t track_bytes(const Track *track)
{
    return track->used + (size_t)track->kept_size * sizeof *track->kept +
           (size_t)track->newest * TRACK_STEP_BYTES +
           track->changes.count * sizeof *track->changes.line;
}

/* Lets go of kept states from this index on. */
static void drop_states(Track *track, long from)
{
    while (track->kept_count > from) {
        KeptState *last = &track->kept[--track->kept_count];
        free(last->bytes);
        track->used -= last->size;
    }
}

/* Every second state goes. */
static void thin_states(Track *track)
{
    for (long i = 0; i < track->kept_count; i++) {
        if (i % 2 == 1) {
            free(track->kept[i].bytes);
            track->used -= track->kept[i].size;
        } else {
            track->kept[i / 2] = track->kept[i];
        }
    }
    track->kept_count = (track->kept_count + 1) / 2;
    track->stride *= 2;
}

/* Room for one more pointer. */
static bool make_room(Track *track)
{
    if (track->kept_count < track->kept_size)
        return true;
    long size = track->kept_size ? 2 * track->kept_size : 64;
    KeptState *kept = realloc(track->kept, (size_t)size * sizeof *kept);
    if (!kept)
        return false;
    track->kept = kept;
    track->kept_size = size;
    return true;
}

/* The present state, if its step is one of those that are kept.  Memory that
 * is not there makes the past coarser; it is no failure. */
static void keep_state(Track *track)
{
    size_t size = track->keeps ? state_size(&track->simulation) : 0;
    long step = track_step_shown(track);
    if (size == 0)
        return;
    while (track->kept_count > 1 && track_bytes(track) + size > track->limit)
        thin_states(track);
    if (step % track->stride != 0 || step / track->stride != track->kept_count)
        return;
    void *bytes = make_room(track) ? malloc(size) : NULL;
    if (!bytes) {
        if (track->kept_count > 1)
            thin_states(track);
        return;
    }
    state_save(&track->simulation, STATE_ALL, bytes);
    track->kept[track->kept_count++] = (KeptState){bytes, size};
    track->used += size;
}

/* ---- changes ------------------------------------------------------------ */

/* Where `node` stands among the pins, or would. */
static int pin_place(const Settings *settings, int node)
{
    int at = 0;
    while (at < settings->pins && settings->pin[at] < node)
        at++;
    return at;
}

/* One pin more or less. */
static Status settings_pin(Settings *settings, int node, bool pinned)
{
    int at = pin_place(settings, node);
    bool there = at < settings->pins && settings->pin[at] == node;
    if (there == pinned)
        return STATUS_OK;
    if (!pinned) {
        settings->pins--;
        memmove(settings->pin + at, settings->pin + at + 1,
                (size_t)(settings->pins - at) * sizeof *settings->pin);
        return STATUS_OK;
    }
    int *pin = realloc(settings->pin,
                       (size_t)(settings->pins + 1) * sizeof *settings->pin);
    if (!pin)
        return STATUS_OUT_OF_MEMORY;
    settings->pin = pin;
    memmove(pin + at + 1, pin + at,
            (size_t)(settings->pins - at) * sizeof *pin);
    pin[at] = node;
    settings->pins++;
    return STATUS_OK;
}

/* All of them, pins too.  Returns OK, OUT_OF_MEMORY. */
static Status settings_copy(const Settings *from, Settings *to)
{
    int *pin = to->pin;
    if (from->pins > 0) {
        pin = realloc(pin, (size_t)from->pins * sizeof *pin);
        if (!pin)
            return STATUS_OUT_OF_MEMORY;
        memcpy(pin, from->pin, (size_t)from->pins * sizeof *pin);
    }
    *to = *from;
    to->pin = pin;
    return STATUS_OK;
}

/* The pins that a new simulation has. */
static Status find_pins(const Simulation *simulation, Settings *settings)
{
    Status status = STATUS_OK;
    for (int i = 0; i < simulation->system.nodes && !status; i++)
        if (simulation_is_pinned(simulation, i))
            status = settings_pin(settings, i, true);
    return status;
}

/* "NAME VALUE" into its two words. */
static void split(const char *text, char name[COMMAND_TEXT_SIZE],
                  char value[COMMAND_TEXT_SIZE])
{
    size_t length = strcspn(text, " ");
    snprintf(name, COMMAND_TEXT_SIZE, "%.*s", (int)length, text);
    snprintf(value, COMMAND_TEXT_SIZE, "%s",
             text[length] ? text + length + 1 : "");
}

/* The settings after a change. */
static Status settings_change(Settings *settings, const Command *change,
                              char *message, size_t size)
{
    char name[COMMAND_TEXT_SIZE], value[COMMAND_TEXT_SIZE];
    if (change->kind == COMMAND_PIN)
        return settings_pin(settings, (int)change->number, change->x != 0);
    if (change->kind != COMMAND_SET) {
        if (change->kind == COMMAND_GRAB)
            settings->node = (int)change->number;
        settings->held = change->kind != COMMAND_RELEASE;
        settings->at[0] = change->x;
        settings->at[1] = change->y;
        return STATUS_OK;
    }
    split(change->text, name, value);
    return options_set(&settings->options, name, value, message, size);
}

/* Whether the simulation must be made anew for these options. */
static bool needs_rebuilding(const Options *now, const Options *wanted)
{
    return now->integrator != wanted->integrator ||
           now->stiffness != wanted->stiffness;
}

/* Options, as far as they differ. */
static Status use_options(Track *track)
{
    Simulation *simulation = &track->simulation;
    const Options *now = &simulation->options;
    const Options *wanted = &track->settings.options;
    Status status = STATUS_OK;
    if (needs_rebuilding(now, wanted))
        return simulation_change(simulation, wanted);
    if (now->timestep != wanted->timestep)
        simulation_set_timestep(simulation, wanted->timestep);
    if (now->tolerance != wanted->tolerance)
        simulation_set_tolerance(simulation, wanted->tolerance);
    if (now->solver != wanted->solver)
        simulation_set_solver(simulation, wanted->solver);
    if (now->filter != wanted->filter)
        simulation_set_filter(simulation, wanted->filter);
    if (now->line_search != wanted->line_search)
        simulation_set_line_search(simulation, wanted->line_search);
    if (now->friction != wanted->friction)
        status = simulation_set_friction(simulation, wanted->friction);
    if (!status && now->damping != wanted->damping)
        status = simulation_set_damping(simulation, wanted->damping);
    return status;
}

/* Pins and the hand, as far as they differ. */
static Status use_hands(Track *track)
{
    Simulation *simulation = &track->simulation;
    const Settings *settings = &track->settings;
    Status status = STATUS_OK;
    for (int i = 0, at = 0; i < simulation->system.nodes && !status; i++) {
        bool pinned = at < settings->pins && settings->pin[at] == i;
        at += pinned;
        if (simulation_is_pinned(simulation, i) != pinned)
            status = simulation_pin(simulation, i, pinned);
    }
    const Pull *hand = hand_energy_of(&simulation->system);
    if (!settings->held) {
        simulation_release(simulation);
        return status;
    }
    bool same = hand && hand->node == settings->node &&
                hand->target[0] == settings->at[0] &&
                hand->target[1] == settings->at[1];
    if (!status && !same)
        status = simulation_grab(simulation, settings->node, settings->at[0],
                                 settings->at[1]);
    return status;
}

/* Makes the simulation one with the present settings. */
static Status use_settings(Track *track)
{
    Status status = use_options(track);
    return status ? status : use_hands(track);
}

/* One change of what is there now. */
static Status apply_change(Track *track, const Command *change, char *message,
                           size_t size)
{
    Simulation *simulation = &track->simulation;
    int number = (int)change->number;
    if (change->kind == COMMAND_HANDLE) {
        exhibit_drag(simulation, number, change->x, change->y);
        return STATUS_OK;
    }
    if (change->kind == COMMAND_FLIP) {
        exhibit_flip(simulation, number);
        return STATUS_OK;
    }
    Status status = settings_change(&track->settings, change, message, size);
    return status ? status : use_settings(track);
}

/* ---- going back --------------------------------------------------------- */

/* The last kept step from which `step` can be reached. */
static long nearest_kept(const Track *track, long step)
{
    long newest = (track->kept_count - 1) * track->stride;
    return (step < newest ? step : newest) / track->stride * track->stride;
}

/* Settings as they were when the state of this step was kept: all changes made
 * at earlier steps.  next out: the first change after them. */
static Status settings_at(Track *track, long step, size_t *next)
{
    char message[256];
    const Script *changes = &track->changes;
    Status status = settings_copy(&track->start, &track->settings);
    for (*next = 0; *next < changes->count && !status; (*next)++) {
        if (changes->line[*next].step >= step)
            break;
        status =
            settings_change(&track->settings, &changes->line[*next].command,
                            message, sizeof message);
    }
    return status;
}

/* The state of a kept step, or of step 0 where none are kept. */
static Status restore(Track *track, long step, size_t *next)
{
    Simulation *simulation = &track->simulation;
    Status status = settings_at(track, step, next);
    if (status)
        return status;
    if (state_size(simulation) == 0 || track->kept_count == 0) {
        NewtonObserver observer = simulation->observer;
        void *user = simulation->user;
        NewtonCounters counted = simulation_counters(simulation);
        simulation_free(simulation);
        status = simulation_create(&track->options, observer, user, simulation);
        simulation->counted = counted;
        return status;
    }
    status = use_settings(track);
    if (!status)
        state_restore(track->kept[step / track->stride].bytes, STATE_ALL,
                      simulation);
    return status;
}

/* All changes of the step that is shown. */
static Status repeat_changes(Track *track, size_t *next)
{
    char message[256];
    const Script *changes = &track->changes;
    Status status = STATUS_OK;
    while (*next < changes->count && !status &&
           changes->line[*next].step == track_step_shown(track)) {
        status = apply_change(track, &changes->line[*next].command, message,
                              sizeof message);
        (*next)++;
    }
    return status;
}

/* Step by step from the kept one. */
static Status repeat_steps(Track *track, long step, size_t next)
{
    Status status = repeat_changes(track, &next);
    while (!status && track_step_shown(track) < step) {
        long before = track_step_shown(track);
        status = simulation_step(&track->simulation);
        if (status_is_unconverged(status) ||
            track_step_shown(track) == before + 1)
            status = STATUS_OK;
        if (!status && track_step_shown(track) == before)
            break; /* the scene is at its end */
        if (!status)
            status = repeat_changes(track, &next);
    }
    return status;
}

Status track_show(Track *track, long step)
{
    size_t next = 0;
    long from = 0;
    step = step < 0 ? 0 : step > track->newest ? track->newest : step;
    if (state_size(&track->simulation) > 0 && track->kept_count > 0)
        from = nearest_kept(track, step);
    track->repeating = true;
    Status status = restore(track, from, &next);
    if (!status)
        status = repeat_steps(track, step, next);
    track->repeating = false;
    return status;
}

Status track_repeat(Track *track)
{
    const Script *changes = &track->changes;
    size_t next = 0;
    long step = track_step_shown(track);
    if (step >= track->newest)
        return STATUS_OK;
    while (next < changes->count && changes->line[next].step <= step)
        next++; /* those of this step were made when it was shown */
    return repeat_steps(track, step + 1, next);
}

Status track_follow(const Track *from, Track *to)
{
    const Script *changes = &from->changes;
    long end = track_step_shown(from);
    char message[256];
    size_t next = 0;
    Status status = STATUS_OK;
    to->limit = from->limit;
    while (!status) {
        long step = track_step_shown(to);
        for (; next < changes->count && changes->line[next].step == step &&
               !status;
             next++)
            status = track_change(to, &changes->line[next].command, message,
                                  sizeof message);
        if (status || step >= end)
            break;
        status = track_step(to);
        if (track_step_shown(to) > step)
            status = STATUS_OK;
    }
    return status;
}

void track_forget(Track *track)
{
    long step = track_step_shown(track);
    Script *changes = &track->changes;
    if (step >= track->newest)
        return;
    track->newest = step;
    drop_states(track, step / track->stride + 1);
    while (changes->count > 0 && changes->line[changes->count - 1].step > step)
        changes->count--;
}

/* ---- going on ----------------------------------------------------------- */

/* What a step in time did to E, in all runs. */
static void sum_up(Track *track)
{
    const Simulation *simulation = &track->simulation;
    if (simulation->scene->step)
        return;
    track->now.change = 0;
    for (int i = 0; i < simulation->runs; i++)
        if (simulation->run[i].newton)
            track->now.change += simulation->run[i].newton->change;
}

/* The row of the step that was just made. */
static Status add_row(Track *track, Status status)
{
    if (track->newest == track->row_size) {
        long size = track->row_size ? 2 * track->row_size : 256;
        StepRow *row = realloc(track->row, (size_t)size * sizeof *row);
        if (!row)
            return STATUS_OUT_OF_MEMORY;
        track->row = row;
        track->row_size = size;
    }
    const Simulation *simulation = &track->simulation;
    for (int i = 0; i < 2 * simulation->system.nodes; i++)
        track->now.extent =
            fmax(track->now.extent, fabs(simulation->run[0].x[i]));
    track->now.status = status;
    track->row[track->newest++] = track->now;
    return STATUS_OK;
}

Status track_step(Track *track)
{
    long before = track_step_shown(track);
    track_forget(track);
    track->now = (StepRow){0};
    Status status = simulation_step(&track->simulation);
    sum_up(track);
    if (track_step_shown(track) == before)
        return status;
    if (!track->keeps)
        track->newest = track_step_shown(track);
    else if (add_row(track, status))
        return STATUS_OUT_OF_MEMORY;
    keep_state(track);
    return status;
}

/* Whether a change makes sense here; message [size] out: why not. */
static Status check_change(const Track *track, const Command *change,
                           char *message, size_t size)
{
    const Simulation *simulation = &track->simulation;
    double at[SCENE_MAX_HANDLES][2];
    Switch part[SCENE_MAX_SWITCHES];
    Settings trial = track->settings;
    long limit = LONG_MAX;
    const char *what = change->kind == COMMAND_HANDLE ? "point to drag"
                       : change->kind == COMMAND_FLIP ? "switch"
                                                      : "node";
    message[0] = '\0';
    if (change->kind == COMMAND_SET)
        return settings_change(&trial, change, message, size);
    if (change->kind == COMMAND_HANDLE)
        limit = exhibit_handles(simulation, at);
    if (change->kind == COMMAND_FLIP)
        limit = exhibit_switches(simulation, part);
    if (change->kind == COMMAND_PIN || change->kind == COMMAND_GRAB)
        limit = simulation->system.nodes;
    if (change->number >= 0 && change->number < limit)
        return STATUS_OK;
    if (limit > 0)
        snprintf(message, size, "there is no %s %ld, they are 0 ... %ld", what,
                 change->number, limit - 1);
    else
        snprintf(message, size, "there is no %s here", what);
    return STATUS_INVALID_INPUT;
}

Status track_change(Track *track, const Command *change, char *message,
                    size_t size)
{
    Status status = check_change(track, change, message, size);
    if (status)
        return status;
    track_forget(track);
    status = script_add(&track->changes, track_step_shown(track), change);
    return status ? status : apply_change(track, change, message, size);
}

Status track_create(const Options *options, bool keeps, NewtonObserver observer,
                    void *user, Track *track)
{
    *track = (Track){.options = *options,
                     .start = {.options = *options},
                     .keeps = keeps,
                     .limit = TRACK_BYTES,
                     .stride = 1,
                     .observer = observer,
                     .user = user};
    Status status =
        simulation_create(options, watch, track, &track->simulation);
    if (!status)
        status = find_pins(&track->simulation, &track->start);
    if (!status)
        status = settings_copy(&track->start, &track->settings);
    if (!status)
        keep_state(track);
    return status;
}

void track_free(Track *track)
{
    for (long i = 0; i < track->kept_count; i++)
        free(track->kept[i].bytes);
    free(track->kept);
    free(track->row);
    free(track->settings.pin);
    free(track->start.pin);
    script_free(&track->changes);
    simulation_free(&track->simulation);
    *track = (Track){0};
}
