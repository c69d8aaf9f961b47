#include "play/lane.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene.h"

/* Room for this step of the player. */
static Status make_room(Lane *lane, long step)
{
    if (!lane->track.keeps || step < lane->room)
        return STATUS_OK;
    long room = lane->room ? 2 * lane->room : 256;
    long *at = realloc(lane->at, (size_t)room * sizeof *at);
    if (at)
        lane->at = at;
    StepBar *bar = realloc(lane->bar, (size_t)room * sizeof *bar);
    if (bar)
        lane->bar = bar;
    if (!at || !bar)
        return STATUS_OUT_OF_MEMORY;
    lane->room = room;
    return STATUS_OK;
}

Status lane_create(struct Player *player, int number, const Options *options,
                   bool keeps, NewtonObserver observer, Lane *lane)
{
    *lane =
        (Lane){.player = player, .number = number, .sampled = -1, .place = -1};
    Status status = track_create(options, keeps, observer, lane, &lane->track);
    if (!status)
        status = make_room(lane, 0);
    if (!status && keeps)
        lane->at[0] = 0;
    lane->outcome = lane->track.simulation.status;
    history_clear(&lane->history);
    trail_clear(&lane->trail);
    return status;
}

void lane_free(Lane *lane)
{
    track_free(&lane->track);
    tape_free(&lane->tape);
    free(lane->ghost);
    free(lane->from);
    free(lane->at);
    free(lane->bar);
    *lane = (Lane){0};
}

double lane_time(const Lane *lane)
{
    return simulation_time(&lane->track.simulation);
}

double lane_pace(const Lane *lane)
{
    const Simulation *simulation = &lane->track.simulation;
    return simulation->scene->needs & NEEDS_TIME ? simulation->options.timestep
                                                 : 1;
}

/* One step of the track, taped. */
static Status make_step(Lane *lane, StepBar *bar)
{
    Track *track = &lane->track;
    long before = track_step_shown(track);
    Status status = STATUS_OK;
    if (track->keeps)
        status = tape_begin(&lane->tape, &track->simulation);
    if (status)
        return status;
    lane->taped = track->keeps;
    status = track_step(track);
    if (track->keeps && tape_end(&lane->tape, &track->simulation.options))
        return STATUS_OUT_OF_MEMORY;
    bool moved = track_step_shown(track) > before;
    bar->updates += track->now.updates;
    bar->unconverged = bar->unconverged || status_is_unconverged(status);
    lane->failed = status && !moved && status != STATUS_INTERRUPTED;
    lane->outcome = status;
    return status;
}

Status lane_advance(Lane *lane, double target, long step)
{
    Track *track = &lane->track;
    bool time = track->simulation.scene->needs & NEEDS_TIME;
    StepBar bar = {0};
    Status worst = make_room(lane, step);
    if (worst)
        return worst;
    if (lane->ended) {
        lane->at[step] = lane->at[step - 1];
        lane->bar[step - 1] = bar;
        return STATUS_OK;
    }
    lane->outcome = STATUS_OK;
    lane->place = -1;
    bool again = true;
    while (again) {
        long before = track_step_shown(track);
        Status status = make_step(lane, &bar);
        worst = status ? status : worst;
        again = time && track_step_shown(track) > before &&
                lane_time(lane) + 0.5 * lane_pace(lane) < target;
    }
    lane->outcome = worst;
    if (track->keeps) {
        lane->at[step] = track_step_shown(track);
        lane->bar[step - 1] = bar;
    }
    return worst;
}

Status lane_show(Lane *lane, long step)
{
    lane->failed = lane->taped = lane->retried = false;
    lane->place = -1;
    lane->rigid = lane->idle = 0;
    Status status = track_show(&lane->track, lane->at[step]);
    if (lane->track.keeps && step > 0 && lane->at[step] > 0 && !status)
        lane->outcome = track_row(&lane->track, lane->at[step])->status;
    else
        lane->outcome = lane->track.simulation.status;
    return status;
}

long lane_last_good(const Lane *lane)
{
    enum { TIMES = 10 };
    const Track *track = &lane->track;
    long step = track_step_shown(track);
    if (step < 1)
        return 0;
    double limit = TIMES * fmax(track_row(track, 1)->extent, 1e-300);
    while (step > 0 && !(track_row(track, step)->extent <= limit))
        step--;
    return step;
}

/* What an explosion has made of the energies would flatten those of others. */
static void cut_explosion(History *history)
{
    enum { TIMES = 10 };
    while (history->count > 1 && history->value[0][history->count - 1] >
                                     TIMES * fabs(history->value[0][0]))
        history_cut(history, history->time[history->count - 2]);
}

Status lane_end(Lane *lane, long step)
{
    Track *track = &lane->track;
    Status outcome = lane->outcome;
    lane->ended = lane->last = step;
    if (!track->keeps)
        return STATUS_OK;
    while (lane->last > 0 && lane->at[lane->last] == lane->at[lane->last - 1])
        lane->last--;
    if (state_size(&track->simulation) == 0)
        return STATUS_OK;
    long good = lane_last_good(lane);
    for (long i = 0; i <= step; i++)
        if (lane->at[i] > good)
            lane->at[i] = good;
    Status status = track_show(track, good);
    if (status)
        return status;
    track_forget(track);
    history_cut(&lane->history, lane_time(lane));
    cut_explosion(&lane->history);
    lane->failed = lane->taped = lane->retried = false;
    lane->place = -1;
    lane->outcome = outcome;
    return STATUS_OK;
}

bool lane_is_over(const Lane *lane, long step)
{
    return lane->ended > 0 && step >= lane->ended;
}

/* The next known step once more, taped. */
static Status repeat_step(Lane *lane)
{
    Track *track = &lane->track;
    Status status = tape_begin(&lane->tape, &track->simulation);
    if (status)
        return status;
    track->repeating = true;
    status = track_repeat(track);
    track->repeating = false;
    Status taped = tape_end(&lane->tape, &track->simulation.options);
    return status ? status : taped;
}

Status lane_repeat(Lane *lane, long step)
{
    Track *track = &lane->track;
    Status status = STATUS_OK;
    lane->place = -1;
    while (!status && track_step_shown(track) < lane->at[step]) {
        status = repeat_step(lane);
        lane->taped = true;
        lane->failed = false;
        lane->outcome = track_row(track, track_step_shown(track))->status;
    }
    return status;
}

/* The step before it is made again, too: its residuals are shown in grey. */
Status lane_retape(Lane *lane, long step)
{
    long last = lane->at[step];
    if (last == 0 || last == lane->at[step - 1])
        return lane_show(lane, step);
    tape_clear(&lane->tape);
    Status status = track_show(&lane->track, last > 1 ? last - 2 : 0);
    return status ? status : lane_repeat(lane, step);
}

void lane_forget(Lane *lane, long step)
{
    track_forget(&lane->track);
    if (lane->ended > step)
        lane->ended = 0;
    if (lane->sampled > step) {
        history_cut(&lane->history, lane_time(lane));
        trail_cut(&lane->trail,
                  (int)fmin((double)(lane->sampled - step), TRAIL_POINTS));
        lane->sampled = step;
    }
}

void lane_sample_again(Lane *lane, long step)
{
    if (lane->sampled < step)
        return;
    history_cut(&lane->history, nextafter(lane_time(lane), -INFINITY));
    trail_cut(&lane->trail, 1);
    show_sample(&lane->track.simulation, &lane->history, &lane->trail);
}

Status lane_clone(const Lane *lane, int number, NewtonObserver observer,
                  Lane *clone)
{
    const Track *from = &lane->track;
    Status status = lane_create(lane->player, number, &from->options,
                                from->keeps, observer, clone);
    Track *to = &clone->track;
    to->repeating = true;
    if (!status)
        status = track_follow(from, to);
    to->repeating = false;
    if (!status)
        status = make_room(clone, lane->room - 1);
    if (status)
        return status;
    memcpy(clone->at, lane->at, (size_t)lane->room * sizeof *clone->at);
    memcpy(clone->bar, lane->bar, (size_t)lane->room * sizeof *clone->bar);
    clone->history = lane->history;
    clone->trail = lane->trail;
    clone->sampled = lane->sampled;
    clone->outcome = lane->outcome;
    clone->ended = lane->ended;
    clone->last = lane->last;
    return STATUS_OK;
}

Status lane_keep_ghost(Lane *lane, const char *label)
{
    const Simulation *simulation = &lane->track.simulation;
    size_t bytes = 2 * (size_t)simulation->system.nodes * sizeof(double);
    double *ghost = realloc(lane->ghost, bytes);
    if (!ghost)
        return STATUS_OUT_OF_MEMORY;
    lane->ghost = ghost;
    memcpy(ghost, simulation->run[0].x, bytes);
    snprintf(lane->ghost_label, sizeof lane->ghost_label, "%s", label);
    return STATUS_OK;
}

void lane_drop_ghost(Lane *lane)
{
    free(lane->ghost);
    lane->ghost = NULL;
}

bool lane_walks(const Lane *lane)
{
    return lane->taped && lane->tape.places > 2;
}

/* The sum of the changes may be off by some units in the last place of the
 * highest E; only whether it is a tenth of that is asked. */
int lane_peak(const Lane *lane, double *rise)
{
    enum { FAR = 10 };
    const Tape *tape = &lane->tape;
    double sum = 0;
    int round = -1;
    *rise = 0;
    for (int i = 0; lane_walks(lane) && i < tape->count; i++) {
        sum += tape->record[i].change;
        if (sum > *rise) {
            *rise = sum;
            round = i;
        }
    }
    if (round < 0 || !(*rise > FAR * fabs(sum)))
        return -1;
    for (int i = 0; i < tape->places; i++)
        if (tape->place[i].round == round && tape->place[i].line == LINE_UPDATE)
            return i;
    return -1;
}

/* The largest size of a number in an array. */
static double largest(const double *x, int size)
{
    double extent = 0;
    for (int i = 0; x && i < size; i++)
        extent = fmax(extent, fabs(x[i]));
    return extent;
}

double lane_extent(const Lane *lane)
{
    const Simulation *simulation = &lane->track.simulation;
    const Tape *tape = &lane->tape;
    double extent = largest(simulation->run[0].x, 2 * simulation->system.nodes);
    for (int i = 0; lane->taped && i <= tape->count && i < tape->room; i++)
        extent = fmax(extent, largest(tape->round[i].x, tape->size));
    return extent;
}
