/* steps.c - steps of all lanes, what is recorded of them, and going back. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "play/playing.h"
#include "scenes/scene.h"

/* The Newton object whose iterations are kept for the cards: that of the first
 * run that has one, while it is this run's turn; else NULL. */
static const Newton *listened_to(const Simulation *simulation)
{
    for (int r = 0; r < simulation->runs; r++)
        if (simulation->run[r].newton)
            return r == simulation->stepping ? simulation->run[r].newton : NULL;
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
         view_quit_waits(player->view, player->selected < 0 && !player->typing,
                         player_escape_ends(player))))
        player->quit = true;
    if (lane->track.keeps && newton && lane->track.simulation.scene &&
        !lane->track.simulation.scene->step)
        tape_add(&lane->tape, newton, record);
    if (!lane->track.repeating) {
        NewtonRecord row = *record;
        if (player->recording.panes > 1)
            row.step = player->step + 1;
        if (lane->number < player->recording.panes)
            player->recorded =
                recording_update(&player->recording, &row, lane->number + 1);
    }
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

Status player_begin(Player *player, const Options *options, int count)
{
    player->sampled = -1;
    player->halted = false;
    player->warned = player->rests = player->drifts = player->holds = false;
    player->changed = true;
    player->recorded = STATUS_OK;
    player->step = player->newest = 0;
    player->active = 0;
    player->lanes = 0;
    /* pictures show the steps behind them: residuals, the time line */
    bool keeps = player->attended || player->view;
    for (int i = 0; i < count; i++) {
        Status status = lane_create(player, i, &options[i], keeps, player_watch,
                                    &player->lane[i]);
        player->lanes++;
        if (status)
            return status;
    }
    player_reset_speed(player);
    for (int i = 0; i < count && !player->given[0].quiet; i++)
        player->start[i] =
            simulation_energies(&player->lane[i].track.simulation, 0);
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
        player->from_map = false;
        player->speed = player_first_speed(&copy[0]);
        player->lens = LENS_FITS;
        player->closed = 0;
        player->large = -1;
        player_deselect(player);
        player->show.hover = (Pick){.kind = PICK_NONE};
        player->mouse.drag = DRAG_NONE;
    }
    return status ? status : player_begin(player, copy, count);
}

void player_leave_tapes(Player *player)
{
    for (int i = 0; i < player->lanes; i++)
        player->lane[i].place = -1;
}

/* What goes whenever another step is shown. */
static void leave_step(Player *player)
{
    player->changed = true;
    player->rests = false;
    player_leave_tapes(player);
    for (int i = 0; i < player->lanes; i++)
        lane_drop_ghost(&player->lane[i]);
}

static long clamp_step(const Player *player, long step)
{
    return step < 0 ? 0 : step > player->newest ? player->newest : step;
}

/* Another step is to be shown, and the run waits there. */
static void wait_elsewhere(Player *player)
{
    leave_step(player);
    player->holds = player->drifts = false;
    player->paused = true;
}

/* All lanes at this step, as lane_show or lane_retape shows it. */
static Status go_to_step(Player *player, long step,
                         Status (*show)(Lane *lane, long step))
{
    Status status = STATUS_OK;
    for (int i = 0; i < player->lanes && !status; i++)
        status = show(&player->lane[i], step);
    player->step = step;
    return status == STATUS_INTERRUPTED ? STATUS_OK : status;
}

Status player_show(Player *player, long step)
{
    wait_elsewhere(player);
    if (!player->attended)
        return STATUS_OK;
    return go_to_step(player, clamp_step(player, step), lane_show);
}

Status player_retape(Player *player, long step)
{
    if (step < 1 || step > player->newest)
        return player_show(player, step);
    wait_elsewhere(player);
    return go_to_step(player, step, lane_retape);
}

Status player_go_on(Player *player)
{
    if (!player->attended || player->step >= player->newest)
        return player_step(player);
    leave_step(player);
    player->holds = player->drifts = false;
    return go_to_step(player, player->step + 1, lane_repeat);
}

void player_tell_forgotten(Player *player)
{
    long first = player->forgotten[0], last = player->forgotten[1];
    size_t used = strlen(player->note);
    player->forgotten[1] = 0;
    if (last < 1 || used >= sizeof player->note)
        return;
    if (first == last)
        snprintf(player->note + used, sizeof player->note - used,
                 "%sstep %ld is forgotten", used ? "; " : "", first);
    else
        snprintf(player->note + used, sizeof player->note - used,
                 "%ssteps %ld ... %ld are forgotten", used ? "; " : "", first,
                 last);
}

Status player_forget_later(Player *player)
{
    if (!player->attended || player->step >= player->newest)
        return STATUS_OK;
    player->forgotten[0] = player->step + 1;
    player->forgotten[1] = player->newest;
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
        if (!lane->failed && !lane->ended && lane_pace(lane) > pace) {
            pace = lane_pace(lane);
            time = lane_time(lane);
        }
    }
    return time + pace;
}

/* Whether nothing moved in this step: no update was made, and nothing is
 * held. */
static bool is_idle(const Lane *lane)
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

/* Whether nothing moves any more: in balance, or, so says the second of two
 * steps from the same place, because the tolerance lets the forces pass. */
static bool is_at_rest(Lane *lane, bool *balances)
{
    lane->idle = is_idle(lane) ? lane->idle + 1 : 0;
    if (lane->idle == 0)
        return false;
    bool rests = simulation_rests(&lane->track.simulation);
    *balances = *balances && rests;
    return rests || lane->idle > 1;
}

/* Whether it moves on for ever as it is: nothing acts on it, and nothing has
 * deformed for some steps, so that this is no turning point. */
static bool drifts(Lane *lane)
{
    enum { STEPS = 8 };
    const Simulation *simulation = &lane->track.simulation;
    double centre, turn;
    const unsigned body = NEEDS_MESH | NEEDS_TIME;
    if ((simulation->scene->needs & body) != body ||
        state_size(simulation) == 0 || simulation->runs > 1 ||
        lane->track.settings.held || !simulation_is_free(simulation) ||
        !(simulation_deforming(simulation, &centre, &turn) <=
          simulation->options.tolerance))
        lane->rigid = 0;
    else
        lane->rigid++;
    return lane->rigid >= STEPS;
}

/* Says so once. */
static void tell_drift(Player *player, bool drifting)
{
    double centre, turn;
    const Simulation *simulation = player_simulation(player);
    if (drifting && !player->drifts) {
        simulation_deforming(simulation, &centre, &turn);
        bool turns =
            fabs(turn) * simulation->mesh.side > simulation->options.tolerance;
        player_note(player,
                    "nothing deforms any more: free as it is, it drifts on at "
                    "%.2g m/s%s; pull a node, pin one, or R begins again",
                    centre, turns ? " and turns" : "");
    }
    player->drifts = drifting;
}

/* What stands still although forces are left, or may be. */
static void tell_tolerance(Player *player)
{
    const Simulation *simulation = player_simulation(player);
    double tolerance = simulation->options.tolerance, needed;
    double h = simulation->options.timestep;
    if (simulation_is_loose(simulation, &needed))
        player_note(
            player,
            "within the tolerance, perhaps not at rest: bodies may hang "
            "or freeze unless \u03b5 is at most %.3g m/s",
            needed);
    else
        player_note(player,
                    "within the tolerance, not at rest: \u03b5 = %.3g m/s lets "
                    "%.3g m pass in each step of %.4g s; a smaller one goes on",
                    tolerance, tolerance * h, h);
}

/* Says so, and why cells may stay folded. */
static void tell_rest(Player *player)
{
    int folded = 0;
    for (int i = 0; i < player->lanes; i++) {
        Pane pane = {.simulation = &player->lane[i].track.simulation};
        folded += pane_folded(&pane);
    }
    player_note(player,
                folded ? "at rest, with folded cells: springs alone do "
                         "not mind, --cells on forbids it; pull a node, or "
                         "R begins again"
                       : "at rest: nothing moves any more; pull a node, "
                         "change a number, or R begins again");
}

/* Of the statuses of several lanes the one that ends most. */
static Status worse(Status one, Status other)
{
    bool first = one && !status_is_unconverged(one);
    return first || !other ? one : other;
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
    return player_change_all(player, &release); /* as a script does by itself */
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

void player_sample(Player *player)
{
    for (int i = 0; i < player->lanes; i++) {
        Lane *lane = &player->lane[i];
        if (lane->sampled >= player->step)
            continue;
        lane->sampled = player->step;
        if (!lane_is_over(lane, player->step))
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
    player_tell_forgotten(player);
    leave_step(player);
    status = advance_lanes(player);
    if (player->recorded)
        return player->recorded;
    if (player->step != before) {
        if (player->attended)
            player_sample(player);
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

void player_pause_if_due(Player *player)
{
    bool ended = true, rests = true, trouble = false, drifting = true;
    bool balances = true;
    int going = 0;
    if (player->given[0].steps >= 0 || !player->attended)
        return;
    for (int i = 0; i < player->lanes; i++) {
        Lane *lane = &player->lane[i];
        if (lane_is_over(lane, player->step))
            continue;
        going++;
        ended = ended && (lane->track.simulation.done || lane->failed);
        rests = is_at_rest(lane, &balances) && rests;
        drifting = drifts(lane) && drifting;
        trouble = trouble || lane->outcome;
    }
    rests = rests && going > 0;
    if (rests && !player->rests && balances)
        tell_rest(player);
    else if (rests && !player->rests)
        tell_tolerance(player);
    tell_drift(player, drifting && !rests && going > 0);
    player->rests = rests;
    player->balances = balances;
    player->halted = !player->paused && (ended || rests);
    player->paused = player->paused || player->halted;
    if (trouble && !player->warned && player->lanes == 1) {
        player->warned = true;
        player->halted = player->halted || !player->paused;
        player->paused = true;
    }
}
