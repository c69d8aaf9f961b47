/* rest.c - whether a run has come to its end by itself, and what is said then.
 */
#include <math.h>

#include "picture/picture.h"
#include "play/playing.h"
#include "scenes/scene.h"

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
void player_judge(Player *player)
{
    enum { DRIFTS = 8 };
    const Past *past = &player->past;
    bool ended = true, idle = true, balance = true, rigid = true, bad = false;
    int going = 0;
    if (player->given[0].steps >= 0 || !player->attended)
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
    const LecturePage *page = player_settings(player)->page;
    if (page && page->law && page == player->told &&
        past->step == page->picture) /* what the page is about */
        player->mode = MODE_PAUSE;
}
