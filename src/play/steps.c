/* steps.c - steps of all panes, what is recorded of them, and going back. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "play/playing.h"
#include "scenes/scene.h"

/* s, of a frame in which steps are made; then inputs are looked at. */
static const double SLICE = 0.05;

/* ---- tables -------------------------------------------------------------- */

/* What Newton told of the step that the machines have just made, or could not
 * make. */
static Status record_updates(Player *player, long step)
{
    Recording *recording = &player->recording;
    Status status = STATUS_OK;
    for (int p = 0; p < past_panes(&player->past) && p < recording->panes;
         p++) {
        const Machine *machine = &player->past.machine[p];
        for (int i = 0; i < machine->records.count && !status; i++) {
            NewtonRecord row = machine->records.row[i];
            if (recording->panes > 1)
                row.step = step;
            status = recording_update(recording, &row, p + 1);
        }
    }
    return status;
}

/* The step that is shown, if it is the next one that is not written yet. */
static Status record_step(Player *player)
{
    const Simulation *simulation[OPTIONS_MAX_PANES];
    int panes = past_panes(&player->past);
    long step = player->past.step;
    if (step != player->written + 1)
        return STATUS_OK;
    player->written = step;
    for (int p = 0; p < panes; p++)
        simulation[p] = &player->past.machine[p].simulation;
    Status status = step > 0 ? record_updates(player, step) : STATUS_OK;
    return status
               ? status
               : recording_states(&player->recording, simulation, panes, step);
}

Status player_write_rest(Player *player)
{
    Past *past = &player->past;
    Status status = STATUS_OK;
    long shown = past->step;
    if (!past->keeps || past->branches == 0 ||
        (!player->recording.states.file && !player->recording.log.file))
        return STATUS_OK;
    while (player->written < past_newest(past) && !status && !*player->stop) {
        if (past->works || past->step > player->written + 1)
            past_aim(past, player->written > 0 ? player->written : 0, false);
        else
            past_aim(past, player->written + 1, false);
        do
            status = past_iterate(past);
        while (status == STATUS_RUNNING);
        if (!status || status_is_unconverged(status))
            status = record_step(player);
    }
    past_aim(past, shown, false);
    while (past_iterate(past) == STATUS_RUNNING)
        ;
    return status;
}

/* ---- beginning ----------------------------------------------------------- */

/* Another scene has a camera and cards of its own. */
static void enter_scene(Player *player)
{
    const Options *options = player_settings(player);
    if (options->scene == player->scene)
        return;
    player->scene = options->scene;
    player->speed = player_first_speed(options);
    player->lens = LENS_FITS;
    player->closed = 0;
    player->large = -1;
    player_deselect(player);
    player->show.hover = (Pick){.kind = PICK_NONE};
    player->mouse.drag = DRAG_NONE;
    player_set_title(player);
}

void player_leave_step(Player *player)
{
    player->changed = true;
    player->rests = false;
    player_leave_rounds(player);
    for (int p = 0; p < OPTIONS_MAX_PANES; p++) {
        free(player->side[p].ghost);
        player->side[p].ghost = NULL;
        player->side[p].retried = false;
    }
}

Status player_begin(Player *player, const Options *options, int count,
                    const Command *edit)
{
    Past *past = &player->past;
    bool again = past->branches > 0;
    Status status =
        past_begin(past, options, count, player_gesture(player), edit);
    if (status && again) { /* what was there before is shown again */
        snprintf(player->message, sizeof player->message, "%s",
                 status_text(status));
        Status shown = player_work(player);
        return shown ? shown : STATUS_INVALID_INPUT;
    }
    if (status)
        return status;
    player_leave_step(player);
    player->sampled = player->written = -1;
    player->halted = player->warned = player->drifts = player->holds = false;
    player->active = 0;
    for (int p = 0; p < count; p++)
        player->side[p].rigid = player->side[p].idle = 0;
    if (again)
        status = recording_restart(&player->recording, options);
    enter_scene(player);
    player_reset_speed(player);
    return status ? status : record_step(player);
}

Status player_fork(Player *player, long step)
{
    Past *past = &player->past;
    const Options *start = &past_start(past, 0)->options;
    player->changed = true;
    if (player->active >= past_panes(past))
        player->active = past_panes(past) - 1;
    enter_scene(player);
    if (player->written <= step)
        return STATUS_OK;
    player->written = step;
    return step < 0 ? recording_restart(&player->recording, start)
                    : recording_cut(&player->recording, step);
}

/* ---- what happens as a step is shown ------------------------------------- */

void player_sample(Player *player)
{
    Past *past = &player->past;
    for (int p = 0; p < past_panes(past); p++) {
        Curves *curves = past_curves(past, p);
        if (!curves || curves->sampled >= past->step || past->works)
            continue;
        curves->sampled = past->step;
        if (past_ended(past, p) < 0)
            show_sample(&past->machine[p].simulation, &curves->history);
    }
}

/* A failure beyond all numbers: what is shown then is the last state that can
 * be seen, at most ten times as large as the first. */
static Status show_last_good(Player *player)
{
    Past *past = &player->past;
    long failed = past->step + 1, step = past_last_seen(past, 0, past->step, 0);
    if (step == past->step)
        return STATUS_OK;
    Status status = player_show(player, step, false, THEN_NOTHING);
    player_note(player,
                "step %ld ends beyond all numbers; shown is step %ld, the last "
                "below ten times the size",
                failed, step);
    player->warning = true;
    return status;
}

/* Of several side by side: those whose step could not be made have ended. */
static void tell_ended(Player *player)
{
    for (int p = 0; p < past_panes(&player->past); p++) {
        Side *side = &player->side[p];
        long last = past_ended(&player->past, p);
        bool over = last >= 0;
        if (over && !side->over) {
            player_note(player,
                        "pane %d ended at step %ld, beyond all numbers: its "
                        "last state below ten times the size is shown",
                        p + 1, last);
            player->warning = true;
        }
        side->over = over;
    }
}

/* A failed step is shown, and somebody may go on from it. */
static Status show_failure(Player *player, Status status)
{
    Past *past = &player->past;
    if (past->step == player->written) { /* its iterations are told */
        Status recorded = record_updates(player, past->step + 1);
        if (recorded)
            return recorded;
    }
    player->sampled = -1; /* draw the last frame again, and why it ends */
    player->changed = true;
    if (!player->attended || player->given[0].steps >= 0 ||
        status == STATUS_OUT_OF_MEMORY)
        return status;
    player->paused = true;
    player->then = THEN_NOTHING;
    if (!player->by_run || status != STATUS_NOT_FINITE)
        return STATUS_OK;
    return show_last_good(player);
}

/* The work has come to its end. */
static Status step_shown(Player *player, Status status, long before)
{
    Past *past = &player->past;
    Then then = player->then;
    bool failed = status && !status_is_unconverged(status);
    player->changed = true;
    if (past_panes(past) > 1)
        tell_ended(player);
    if (failed && (past_panes(past) == 1 || past->step == before))
        return show_failure(player, status);
    if (past->step != before && player->attended)
        player_sample(player);
    status = record_step(player);
    player->then = THEN_NOTHING;
    return status ? status : player_wish(player, then);
}

Status player_work(Player *player)
{
    Past *past = &player->past;
    double begin = clock_now();
    if (!player->under_way)
        player->began = begin;
    player->under_way = true;
    while (past->works && !player->quit) {
        long before = past->step;
        Status status = past_iterate(past);
        if (!past->works || (status && status != STATUS_RUNNING)) {
            status = step_shown(player, status, before);
            if (status)
                return status;
        }
        if (*player->stop)
            player->quit = true;
        if (player->window && clock_now() - begin > SLICE)
            break;
    }
    player->changed = true;
    player->under_way = past->works;
    return STATUS_OK;
}

Status player_show(Player *player, long step, bool again, Then then)
{
    player_leave_step(player);
    player->holds = player->drifts = player->by_run = false;
    player->paused = true;
    if (!player->past.keeps)
        return STATUS_OK;
    long newest = past_newest(&player->past);
    past_aim(&player->past, step < newest ? step : newest, again);
    player->then = then;
    return player_work(player);
}

/* A node that was held when this step was shown, long ago. */
static Status let_go(Player *player)
{
    Command release = {.kind = COMMAND_RELEASE};
    if (past_control(&player->past, 0)->hand < 0 || player->holds)
        return STATUS_OK;
    player_next_gesture(player, COMMAND_NONE);
    return player_change_all(player, &release); /* as a script does by itself */
}

Status player_go_on(Player *player, Then then)
{
    Past *past = &player->past;
    Status status = past->step < past_newest(past) ? STATUS_OK : let_go(player);
    if (status)
        return status;
    player_leave_step(player);
    player->by_run = !player->paused;
    past_aim(past, past->step + 1, false);
    player->then = then;
    return player_work(player);
}

Status player_step(Player *player)
{
    return player_go_on(player, THEN_NOTHING);
}

/* ---- pauses -------------------------------------------------------------- */

/* Whether nothing moved in this step: no update was made, and nothing is
 * held. */
static bool is_idle(const Machine *machine)
{
    const Simulation *simulation = &machine->simulation;
    const TimeIntegrator *run = &simulation->run[0];
    if (!(simulation->scene->needs & NEEDS_TIME) || !run->newton ||
        simulation->runs > 1 || machine->control->hand >= 0 ||
        machine->outcome.updates > 0 || simulation->steps == 0)
        return false;
    for (int i = 0; i < 2 * simulation->system.nodes; i++)
        if (fabs(run->v[i]) > simulation->options.tolerance)
            return false;
    return true;
}

/* Whether nothing moves any more: in balance, or, so says the second of two
 * steps from the same place, because the tolerance lets the forces pass. */
static bool is_at_rest(const Machine *machine, Side *side, bool *balances)
{
    side->idle = is_idle(machine) ? side->idle + 1 : 0;
    if (side->idle == 0)
        return false;
    bool rests = simulation_rests(&machine->simulation);
    *balances = *balances && rests;
    return rests || side->idle > 1;
}

/* Whether it moves on for ever as it is: nothing acts on it, and nothing has
 * deformed for some steps, so that this is no turning point. */
static bool drifts(const Machine *machine, Side *side)
{
    enum { STEPS = 8 };
    const Simulation *simulation = &machine->simulation;
    double centre, turn;
    const unsigned body = NEEDS_MESH | NEEDS_TIME;
    if ((simulation->scene->needs & body) != body ||
        !simulation_is_handled(simulation) || simulation->runs > 1 ||
        machine->control->hand >= 0 || !simulation_is_free(simulation) ||
        !(simulation_deforming(simulation, &centre, &turn) <=
          simulation->options.tolerance))
        side->rigid = 0;
    else
        side->rigid++;
    return side->rigid >= STEPS;
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
    for (int p = 0; p < past_panes(&player->past); p++) {
        Pane pane = {.simulation = &player->past.machine[p].simulation};
        folded += pane_folded(&pane);
    }
    player_note(player,
                folded ? "at rest, with folded cells: springs alone do "
                         "not mind, --cells on forbids it; pull a node, or "
                         "R begins again"
                       : "at rest: nothing moves any more; pull a node, "
                         "change a number, or R begins again");
}

void player_pause_if_due(Player *player)
{
    bool ended = true, rests = true, trouble = false, drifting = true;
    bool balances = true;
    int going = 0, panes = past_panes(&player->past);
    if (player->given[0].steps >= 0 || !player->attended)
        return;
    for (int p = 0; p < panes; p++) {
        const Machine *machine = &player->past.machine[p];
        Side *side = &player->side[p];
        if (past_ended(&player->past, p) >= 0)
            continue;
        going++;
        ended = ended && (machine->simulation.done || machine->failed);
        rests = is_at_rest(machine, side, &balances) && rests;
        drifting = drifts(machine, side) && drifting;
        trouble = trouble || machine->outcome.status;
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
    if (trouble && !player->warned && panes == 1) {
        player->warned = true;
        player->halted = player->halted || !player->paused;
        player->paused = true;
    }
}
