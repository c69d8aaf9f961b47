/* steps.c - the work until a step is shown, what is recorded of it, where the
 * past begins or forks, and where a run stops by itself.
 */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "picture/picture.h"
#include "play/playing.h"
#include "scenes/scene.h"

enum { SLOW_NODES = 50000 };

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
        if (machine->records.lost)
            status = STATUS_OUT_OF_MEMORY;
        for (int i = 0; i < machine->records.count && !status; i++) {
            NewtonRecord row = machine->records.row[i];
            if (recording->panes > 1)
                row.step = step;
            status = recording_update(recording, &row, p + 1);
        }
    }
    return status;
}

/* Whether all panes have the records of the step that is shown: they have made
 * it, and not found its state. */
static bool has_records(const Past *past)
{
    bool all = true;
    for (int p = 0; past->keeps && past->step > 0 && p < past_panes(past); p++)
        all = all && (past->machine[p].known ||
                      past_entry(past, p, past->step)->substeps == 0);
    return all;
}

/* The step that is shown, if it is the next one that is not written yet. */
static Status record_step(Player *player)
{
    const Simulation *simulation[OPTIONS_MAX_PANES];
    int panes = past_panes(&player->past);
    long step = player->past.step;
    if (step != player->written + 1 || !has_records(&player->past))
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
    bool failed = false, again = true;
    for (int p = 0; p < past_panes(past); p++)
        failed = failed || past->machine[p].failed;
    if (failed && shown == player->written) /* its iterations are told */
        status = record_updates(player, shown + 1);
    if (!past->keeps || !player->recording.tables)
        return status;
    while (player->written < past_newest(past) && !status && !*player->stop) {
        long next = player->written + 1;
        past_aim(past, next, again);
        status = past_finish(past);
        if (!status || status_is_unconverged(status))
            status = record_step(player);
        again = player->written < next;
    }
    past_aim(past, shown, false);
    past_finish(past);
    return status;
}

/* ---- beginning ----------------------------------------------------------- */

/* Another scene has a camera and cards of its own. */
static void enter_scene(Player *player)
{
    const Options *options = player_settings(player);
    char title[128];
    if (options->scene == player->scene)
        return;
    player->scene = options->scene;
    player->speed = player_first_speed(options);
    player->show.lens = LENS_FITS;
    player->closed = 0;
    player->large = -1;
    player_deselect(player);
    player->show.hover = (Pick){.kind = PICK_NONE};
    player->mouse.drag = COMMAND_NONE;
    snprintf(title, sizeof title, "elasto: %s (press ? for the keys)",
             options->scene->name);
    if (player->window)
        window_set_title(title);
}

void player_leave_step(Player *player)
{
    player->changed = true;
    if (player->mode == MODE_WALK)
        player->mode = MODE_PAUSE;
    if (player->mode > MODE_END)
        player->mode = MODE_END;
    for (int p = 0; p < OPTIONS_MAX_PANES; p++) {
        free(player->side[p].ghost);
        player->side[p].ghost = NULL;
    }
}

Status player_begin(Player *player, const Options *options, int count,
                    const Command *edit)
{
    Past *past = &player->past;
    bool again = past->branches > 0;
    Status status = past_begin(past, options, count, player->gesture, edit);
    if (status) /* what was there before is going to be shown again */
        return again ? player_refuse(player, status_text(status)) : status;
    player_leave_step(player);
    player->mode = player_stands(player) ? MODE_PAUSE : MODE_RUN;
    player->sampled = -1;
    player->warned = player->holds = false;
    status = player_follow(player);
    return status ? status : record_step(player);
}

Status player_follow(Player *player)
{
    Past *past = &player->past;
    long same = past->same;
    past->same = LONG_MAX;
    player->changed = true;
    player->still = player->rigid = 0;
    if (player->active >= past_panes(past))
        player->active = past_panes(past) - 1;
    enter_scene(player);
    if (player->written <= same)
        return STATUS_OK;
    player->written = same;
    return recording_cut(&player->recording, same);
}

/* ---- where it stops by itself -------------------------------------------- */

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

/* Whether nothing has deformed, and nothing acts on it: a free body. */
static bool is_rigid(const Machine *machine)
{
    const Simulation *simulation = &machine->simulation;
    const unsigned body = NEEDS_MESH | NEEDS_TIME;
    return (simulation->scene->needs & body) == body &&
           simulation_is_handled(simulation) && simulation->runs == 1 &&
           machine->control->hand < 0 && system_is_free(&simulation->system) &&
           !system_has_gravity(&simulation->system) &&
           simulation_deforming(simulation) <= simulation->options.tolerance;
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

/* Why cells may stay folded, too. */
static void tell_rest(Player *player)
{
    const Past *past = &player->past;
    int folded = 0;
    for (int p = 0; p < past_panes(past); p++) {
        Pane pane = {.simulation = &past->machine[p].simulation};
        if (past_ended(past, p, past->step) < 0)
            folded += pane_folded(&pane);
    }
    player_note(player,
                folded ? "at rest, with folded cells: springs alone do "
                         "not mind, --cells on forbids it; pull a node, or "
                         "R begins again"
                       : "at rest: nothing moves any more; pull a node, "
                         "change a number, or R begins again");
}

/* Nothing has moved for a step: it is in balance; or, so says a second step
 * from the same place, the tolerance lets the forces pass.  Steps that deform
 * nothing may be a turning point; many in a row are not. */
static void judge(Player *player)
{
    enum { DRIFTS = 8 };
    const Past *past = &player->past;
    bool ended = true, idle = true, balance = true, rigid = true, bad = false;
    int going = 0;
    const LecturePage *page = player_settings(player)->page;
    if (player->given[0].steps >= 0 || !player->attended ||
        (page && page->writes && /* its steps write, they move nothing */
         past->step < player_simulation(player)->system.springs))
        return;
    for (int p = 0; p < past_panes(past); p++) {
        const Machine *machine = &past->machine[p];
        if (past_ended(past, p, past->step) >= 0)
            continue;
        going++;
        ended = ended && (machine->simulation.done || machine->failed);
        idle = idle && is_idle(machine);
        balance = balance && idle && simulation_rests(&machine->simulation);
        rigid = rigid && is_rigid(machine);
        bad = bad || machine->outcome.status;
    }
    player->still = idle && going > 0 ? player->still + 1 : 0;
    player->rigid = rigid && going > 0 ? player->rigid + 1 : 0;
    Mode mode = player->rigid < DRIFTS ? MODE_RUN : MODE_DRIFT;
    if (ended || (bad && !player->warned && past_panes(past) == 1))
        mode = MODE_END;
    if (player->still > 0 && (balance || player->still > 1))
        mode = balance ? MODE_REST : MODE_HELD;
    player->warned = player->warned || (bad && past_panes(past) == 1);
    if (mode == MODE_REST)
        tell_rest(player);
    else if (mode == MODE_HELD)
        tell_tolerance(player);
    else if (mode == MODE_DRIFT && player->mode != MODE_DRIFT)
        player_note(player, "nothing deforms any more: free as it is, it "
                            "drifts on; pull a node, right click pins one, R "
                            "begins again");
    if (!player_stands(player))
        player->mode = mode;
    if (page && page->law && page == player->told &&
        past->step == page->picture) /* what the page is about */
        player->mode = MODE_PAUSE;
}

/* ---- what happens as a step is shown ------------------------------------- */

Status player_bear(Player *player, Status status)
{
    bool fatal = status == STATUS_OUT_OF_MEMORY ||
                 status == STATUS_INVALID_INPUT ||
                 status == STATUS_FILE_FAILED || status == STATUS_SCREEN_FAILED;
    if (!status || fatal || !player->attended || player->given[0].steps >= 0)
        return status;
    player_stop(player);
    return STATUS_OK;
}

/* The work has come to its end. */
static Status step_shown(Player *player, Status status, long before)
{
    const Past *past = &player->past;
    Then then = player->then;
    bool failed = status && !status_is_unconverged(status);
    player->then = THEN_NOTHING;
    player->changed = true;
    if (failed && past->step == before) { /* it tells why */
        long seen = past_last_seen(past, 0, before);
        bool lost = then == THEN_JUDGE && status == STATUS_NOT_FINITE;
        player->sampled = -1;
        status = player_bear(player, status);
        if (status || !lost || seen == before)
            return status;
        player_note(player,
                    "step %ld ends beyond all numbers; shown is step %ld, the "
                    "last below ten times the size",
                    before + 1, seen);
        player->warning = true;
        return player_show(player, seen, false, THEN_NOTHING);
    }
    status = record_step(player);
    if (!status && then == THEN_JUDGE)
        judge(player);
    else if (!status && then == THEN_TELL)
        player_tell_retake(player);
    else if (!status && then != THEN_NOTHING)
        player_enter(player, then);
    return status;
}

bool player_is_slow(const Player *player)
{
    const Simulation *simulation = player_simulation(player);
    return simulation->options.solver == SOLVER_NEWTON &&
           simulation->system.nodes > SLOW_NODES;
}

Status player_work(Player *player)
{
    Past *past = &player->past;
    double begin = clock_now();
    if (player->began == 0)
        player->began = begin;
    while (past->works && !player->quit) {
        long before = past->step;
        bool made = past->making;
        Status status = past_iterate(past);
        if (!past->works || (status && status != STATUS_RUNNING)) {
            status = step_shown(player, status, before);
            if (status)
                return status;
        }
        player->quit = player->quit || *player->stop;
        bool begins = past->making && !made && player_is_slow(player);
        if (player->window && (begins || clock_now() - begin > SLICE))
            break;
    }
    player->changed = true;
    if (!past->works)
        player->began = 0;
    return STATUS_OK;
}

Status player_show(Player *player, long step, bool again, Then then)
{
    player_leave_step(player);
    player->holds = false;
    player_stop(player);
    if (!player->past.keeps)
        return STATUS_OK;
    long newest = past_newest(&player->past);
    past_aim(&player->past, step < newest ? step : newest, again);
    player->then = then;
    return STATUS_OK;
}

/* A node that was held when this step was shown, long ago; it is undone by
 * itself. */
static Status let_go(Player *player)
{
    const Command release = {.kind = COMMAND_RELEASE};
    int gesture = player->gesture, panes = past_panes(&player->past);
    if (past_control(&player->past, 0)->hand < 0 || player->holds)
        return STATUS_OK;
    player->gesture = ++player->gestures;
    player->sampled = -1;
    Status status = player_change(player, &release, 0, panes, false);
    player->gesture = gesture;
    return status;
}

Status player_go_on(Player *player, Then then)
{
    Past *past = &player->past;
    bool fresh = past->step >= past_newest(past);
    Status status = record_step(player);
    if (!status && fresh)
        status = let_go(player); /* as a script does by itself */
    if (status)
        return status;
    player_leave_step(player);
    past_aim(past, past->step + 1, false);
    player->then = then == THEN_NOTHING && fresh && !player_stands(player)
                       ? THEN_JUDGE
                       : then;
    return STATUS_OK;
}

Status player_step(Player *player)
{
    Status status = player_go_on(player, THEN_NOTHING);
    return status ? status : player_work(player);
}
