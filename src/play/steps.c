/* steps.c - goes through time by steps, updates or lines, and undoes edits. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/playing.h"

/* ---- tables -------------------------------------------------------------- */

/* Writes the iterations of the last step, also of a failed one, to the log. */
static Status record_iterations(Player *player, long step)
{
    Recording *recording = &player->recording;
    Status status = STATUS_OK;
    for (int p = 0;
         p < past_count_panes(&player->past) && p < recording->pane_count;
         p++) {
        const PastPane *pane = &player->past.pane[p];
        if (pane->newton_records.is_incomplete)
            status = STATUS_OUT_OF_MEMORY;
        for (int i = 0; i < pane->newton_records.count && !status; i++) {
            NewtonRecord row = pane->newton_records.record[i];
            if (recording->pane_count > 1)
                row.step_number = step;
            status = recording_write_iteration(recording, &row, p + 1);
        }
    }
    return status;
}

/* Writes the shown step to the tables, but only its energies if the tables have
 * its states already.  Does nothing unless the step is the next one to write
 * and all panes have the records of the step. */
static Status record_step(Player *player)
{
    Past *past = &player->past;
    const Simulation *simulation[OPTIONS_MAX_PANES];
    int panes = past_count_panes(past);
    long step = past->shown_step;
    bool due = step == past->energies_step + 1,
         again = step <= past->written_step;
    for (int p = 0; p < panes; p++) {
        const PastPane *pane = &past->pane[p];
        simulation[p] = &pane->simulation;
        due = due && (pane->has_trace || !past->stores_states || step == 0 ||
                      past_find_entry(past, p, step)->substep_count == 0);
    }
    if (!due)
        return STATUS_OK;
    Status status =
        step > 0 && !again ? record_iterations(player, step) : STATUS_OK;
    past->energies_step = step;
    if (!again)
        past->written_step = step;
    return status ? status
                  : recording_write_states(&player->recording, again,
                                           simulation, panes, step);
}

Status player_write_missing_rows(Player *player)
{
    Past *past = &player->past;
    Status status = STATUS_OK;
    long shown = past->shown_step;
    bool failed = false, again = true;
    for (int p = 0; p < past_count_panes(past); p++)
        failed = failed || past->pane[p].has_failed;
    if (failed && shown == past->written_step)
        status = record_iterations(player, shown + 1);
    if (!past->stores_states || !player->recording.has_tables)
        return status;
    while (past->energies_step < past_find_newest(past) && !status &&
           !*player->setup.stop_signal) {
        long next = past->energies_step + 1;
        past_set_goal(past, next, again);
        status = past_finish_work(past);
        if (!status_is_failure(status))
            status = record_step(player);
        again = past->energies_step < next;
    }
    past_set_goal(past, shown, false);
    past_finish_work(past);
    return status;
}

/* ---- beginning ----------------------------------------------------------- */

/* Leaves the lines of Algorithm 3.  The panes show the end of the step. */
static void show_step_end(Player *player)
{
    for (int p = 0; p < OPTIONS_MAX_PANES; p++)
        player->view_of_pane[p].trace_index = -1;
}

void player_reset_view(Player *player)
{
    player->screen.must_redraw = true;
    if (player->play.mode > MODE_END)
        player->play.mode = MODE_END;
    show_step_end(player);
    for (int p = 0; p < OPTIONS_MAX_PANES; p++) {
        free(player->view_of_pane[p].ghost_x);
        player->view_of_pane[p].ghost_x = NULL;
    }
}

static void drop_held_node_and_queue(Player *player)
{
    player->input.is_holding = false;
    player->commands.queue.count = 0;
}

/* Resets camera and cards for another scene or page. */
static void reset_screen_for_scene(Player *player)
{
    const Options *options = player_get_active_options(player);
    char title[128];
    player->screen.scene = options->scene;
    player->screen.page = options->page;
    player->play.log_speed = player_find_start_speed(player, options);
    player->screen.view.lens = LENS_FITS;
    player->screen.toggled_cards = 0;
    player->screen.enlarged_card = -1;
    player_deselect(player);
    player->screen.view.hovered_part = (Pick){.kind = PICK_NONE};
    player->input.mouse.drag_command = COMMAND_NONE;
    snprintf(title, sizeof title, "elasto: %s (press ? for the keys)",
             options->scene->name);
    if (player->screen.window)
        player->screen.window->set_title(title);
}

/* Adapts the player to an edit of the past: frame, active pane, scene. */
static void update_player_after_edit(Player *player)
{
    const Past *past = &player->past;
    player->screen.must_redraw = true;
    if (player_is_stopped(player))
        player->screen.drawn_step = -1;
    if (player->active_pane >= past_count_panes(past))
        player->active_pane = past_count_panes(past) - 1;
    const Options *now = player_get_active_options(player);
    if (now->scene != player->screen.scene || now->page != player->screen.page)
        reset_screen_for_scene(player);
}

Status player_begin_runs(Player *player, const Options *options, int count,
                         const Command *edit)
{
    Past *past = &player->past;
    bool again = past->branch_count > 0;
    Status status = past_begin_runs(past, options, count,
                                    player->commands.gesture_id, edit);
    if (status)
        return again ? player_refuse(player, "%s", status_text(status))
                     : status;
    player_reset_view(player);
    player->play.mode = player_is_stopped(player) ? MODE_PAUSE : MODE_RUN;
    player->screen.drawn_step = -1;
    player->play.has_stopped_unconverged = player->play.has_reported_gain =
        false;
    drop_held_node_and_queue(player);
    update_player_after_edit(player);
    return record_step(player);
}

Status player_edit_step(Player *player, const Command *change, int pane,
                        bool again)
{
    if (player->play.mode == MODE_REST)
        player->play.mode = MODE_RUN; /* bodies may move again */
    Status status = past_edit(&player->past, change, pane, again,
                              player->commands.gesture_id);
    if (!status)
        update_player_after_edit(player);
    return status || again ? status : record_step(player);
}

/* ---- where a run stops by itself ----------------------------------------- */

/* Reports that the run is at rest, possibly with folded cells of the mesh. */
static void report_at_rest(Player *player)
{
    const Past *past = &player->past;
    int folded = 0;
    for (int p = 0; p < past_count_panes(past); p++) {
        Pane pane = {.simulation = &past->pane[p].simulation};
        if (past_find_made_step(past, p, past->shown_step) == past->shown_step)
            folded += pane_count_folded_cells(&pane);
    }
    player_notify(player,
                  folded ? "at rest, with folded cells: springs alone do "
                           "not mind, cells on (A) forbids it; %s"
                           "or R begins again"
                         : "at rest; %schange a number, or R begins again",
                  simulation_is_draggable(player_get_simulation(player))
                      ? "pull a node, "
                      : "");
}

/* Reports, except on pages, the first step that gains energy without work. */
static void report_energy_gain(Player *player)
{
    const Past *past = &player->past;
    if (player->setup.options[0].steps >= 0 || !player->setup.is_attended ||
        player_get_active_options(player)->page)
        return;
    for (int p = 0;
         p < past_count_panes(past) && !player->play.has_reported_gain; p++) {
        const Simulation *simulation = &past->pane[p].simulation;
        for (int r = 0; r < simulation->runs && !player->play.has_reported_gain;
             r++) {
            player->play.has_reported_gain =
                simulation->ledger[r].gain_steps > 0;
            if (player->play.has_reported_gain)
                player_notify(player,
                              "step %ld: the total energy has risen by %.3g J "
                              "without work; a long step of backward Euler can "
                              "do that",
                              past->shown_step,
                              simulation->ledger[r].gained_energy);
        }
    }
}

/* Stops the run if all panes have ended, a step did not converge for the first
 * time, all bodies are at rest, or an unchanged page pauses at this step. */
static void stop_run_if_over(Player *player)
{
    const Past *past = &player->past;
    bool ended = true, rests = true, bad = false;
    int going = 0;
    const Options *options = player_get_active_options(player);
    if (player->setup.options[0].steps >= 0 || !player->setup.is_attended ||
        (options->next_action == NEXT_ADDS_SPRING && /* springs left to add */
         past->shown_step < player_get_simulation(player)->system.springs))
        return;
    for (int p = 0; p < past_count_panes(past); p++) {
        const PastPane *pane = &past->pane[p];
        const Simulation *simulation = &pane->simulation;
        if (past_find_made_step(past, p, past->shown_step) < past->shown_step)
            continue;
        going++;
        ended = ended && (simulation->is_over || pane->has_failed);
        rests = rests && (simulation->scene->traits & HAS_TIME) &&
                simulation->runs == 1 && !control_is_holding(pane->control) &&
                simulation_is_at_rest(simulation);
        bad = past_count_panes(past) == 1 && pane->outcome.status;
    }
    if (rests && going > 0)
        player->play.mode = MODE_REST;
    else if (ended || (bad && !player->play.has_stopped_unconverged))
        player->play.mode = MODE_END;
    if (ended) /* the sentence above the picture says how the run ended */
        player->note[0] = '\0';
    player->play.has_stopped_unconverged =
        player->play.has_stopped_unconverged || bad;
    if (past->shown_step == options->pause_step && past->shown_step > 0 &&
        options->page == player->tour.revealed_page &&
        !player_has_changed_page(player))
        player->play.mode = MODE_PAUSE;
    if (player->play.mode == MODE_REST)
        report_at_rest(player);
}

/* ---- inside a step ------------------------------------------------------- */

/* Shows a line of Algorithm 3 in each pane whose step has iterations: the first
 * line, the last line, or, if E exploded, the update at which E was highest. */
static void begin_algorithm_walk(Player *player, ActionAfterWork after)
{
    for (int p = 0; p < past_count_panes(&player->past); p++) {
        const StepTrace *trace = &player->past.pane[p].trace;
        NewtonTrace shown;
        double far = 0;
        int place = trace->position_count <= 2       ? -1 /* no iteration */
                    : after == AFTER_SHOW_FIRST_LINE ? 0
                    : after == AFTER_SHOW_LAST_LINE
                        ? trace->position_count - 1
                        : step_trace_find_peak(trace);
        if (place < 0)
            continue;
        player->play.mode = MODE_PAUSE;
        player->view_of_pane[p].trace_index = place;
        const double *x = step_trace_read_position(trace, place, &shown);
        if (after != AFTER_SHOW_STEP_END)
            continue;
        for (int i = 0; x && i < trace->x_length; i++)
            far = fmax(far, fabs(x[i]));
        player_notify(
            player, "update %d of %d: nodes are %.4g m away; N goes on",
            trace->position[place].iterate + 1, trace->records.count, far);
        player->is_warning = true;
    }
}

/* Walks on (1) or back (-1) by a line or update.  Returns whether a pane
 * moved. */
static bool walk_algorithm_lines(Player *player, int way)
{
    bool moved = false;
    for (int p = 0; p < past_count_panes(&player->past); p++) {
        const StepTrace *trace = &player->past.pane[p].trace;
        int *place = &player->view_of_pane[p].trace_index;
        if (*place < 0)
            continue;
        int next = step_trace_walk(trace, player->play.walk_unit, *place, way);
        moved = moved || next != *place;
        *place = next;
    }
    return moved;
}

/* ---- the step once more, with an edit ------------------------------------ */

/* Describes a step: "projection none: E(x) rises by 206 J s² in 12 updates". */
static void describe_outcome(const Player *player, const OptionRow *row,
                             char *text, size_t size)
{
    const StepOutcome *outcome = &player_get_active_pane(player)->outcome;
    bool curve = player->screen.scene->picture == PICTURE_CURVE;
    char value[VALUE_SIZE], change[64] = "stays";
    player_format_value(row, player_get_active_options(player),
                        player_get_simulation(player), value, sizeof value);
    if (outcome->energy_change != 0)
        snprintf(change, sizeof change, "%s by %.3g%s",
                 outcome->energy_change > 0 ? "rises" : "falls",
                 fabs(outcome->energy_change), curve ? "" : " J s\u00b2");
    snprintf(text, size, "%s %s: no update", row->label, value);
    if (outcome->updates > 0)
        snprintf(text, size, "%s %s: %s %s in %d update%s", row->label, value,
                 curve ? "f(x)" : "E(x)", change, outcome->updates,
                 outcome->updates == 1 ? "" : "s");
    if (outcome->status)
        append(text, size, ", %s", status_text(outcome->status));
}

/* Reports how the step ended before and after the edit, and shows the line of
 * Algorithm 3 that was shown before the edit. */
static void compare_outcomes(Player *player)
{
    const Past *past = &player->past;
    const StepTrace *trace = &player_get_active_pane(player)->trace;
    const WalkPosition *at = &player->play.wanted_position;
    char has[256];
    if (at->iterate >= 0 && trace->position_count > 2) {
        player->play.mode = MODE_PAUSE;
        player->view_of_pane[player->active_pane].trace_index =
            step_trace_find_position(trace, at->iterate, at->at_line);
    }
    describe_outcome(player,
                     &option_rows[past->branch[past->branch_index].edit.number],
                     has, sizeof has);
    player_notify(player, "%s; %s",
                  player->view_of_pane[player->active_pane].ghost_label, has);
}

Status player_repeat_step(Player *player, const Command *change, int pane)
{
    Past *past = &player->past;
    PaneView *view = &player->view_of_pane[player->active_pane];
    const OptionRow *row = &option_rows[change->number];
    const PastPane *active = player_get_active_pane(player);
    const Simulation *simulation = &active->simulation;
    size_t bytes = 2 * (size_t)simulation->system.nodes * sizeof(double);
    bool failed = active->has_failed;
    long step = past->shown_step + failed;
    player->play.wanted_position = (WalkPosition){.iterate = -1};
    if (view->trace_index >= 0 && player->play.walk_unit != UNIT_STEP)
        player->play.wanted_position =
            active->trace.position[view->trace_index];
    player_reset_view(player);
    describe_outcome(player, row, view->ghost_label, sizeof view->ghost_label);
    if (row->effect == EFFECT_REPEATED_STEP && !failed &&
        !simulation->scene->step)
        view->ghost_x = malloc(bytes);
    if (view->ghost_x)
        memcpy(view->ghost_x, simulation->run[0].x, bytes);
    Status status = player_edit_step(player, change, pane, !failed);
    if (status)
        return status;
    player->screen.drawn_step = -1;
    past_set_goal(past, step, player->play.wanted_position.iterate >= 0);
    player->play.after_work = AFTER_COMPARE_OUTCOMES;
    return STATUS_OK;
}

/* ---- work ---------------------------------------------------------------- */

Status player_finish_work(Player *player, Status status, long before, bool made)
{
    const Past *past = &player->past;
    ActionAfterWork after = player->play.after_work;
    bool runs = made && after == AFTER_NOTHING && !player_is_stopped(player);
    player->play.after_work = AFTER_NOTHING;
    player->screen.must_redraw = true;
    if (status_is_failure(status) && past->shown_step == before) {
        long seen = past_find_drawable_step(past, 0, before);
        bool lost = runs && status == STATUS_NOT_FINITE;
        player->screen.drawn_step = -1;
        status = player_pause_after_failure(player, status);
        if (status || !lost || seen == before)
            return status;
        player_notify(
            player,
            "step %ld ends beyond all numbers; shown is step %ld, the "
            "last below ten times the size",
            before + 1, seen);
        player->is_warning = true;
        return player_seek(player, seen, AFTER_NOTHING);
    }
    status = record_step(player);
    if (!status && runs)
        report_energy_gain(player);
    if (!status && runs)
        stop_run_if_over(player);
    else if (!status && after == AFTER_COMPARE_OUTCOMES)
        compare_outcomes(player);
    else if (!status && after != AFTER_NOTHING)
        begin_algorithm_walk(player, after);
    return status;
}

/* Releases what the hand held in an old step, if the user holds nothing now.
 * The release is a gesture of its own. */
static Status release_unused_hand(Player *player)
{
    const Command release = {.kind = COMMAND_RELEASE};
    int gesture = player->commands.gesture_id;
    if (!control_is_holding(past_get_control(&player->past, 0)) ||
        player->input.is_holding)
        return STATUS_OK;
    player->commands.gesture_id = ++player->commands.gesture_count;
    Status status = player_edit_step(player, &release, ALL_PANES, false);
    player->commands.gesture_id = gesture;
    return status;
}

Status player_seek(Player *player, long step, ActionAfterWork after)
{
    Past *past = &player->past;
    bool known = step <= past_find_newest(past);
    Status status = known ? STATUS_OK : record_step(player);
    if (known)
        drop_held_node_and_queue(player);
    if (!status && !known)
        status = release_unused_hand(player);
    if (status)
        return status;
    player_reset_view(player);
    past_set_goal(past, step,
                  after == AFTER_SHOW_FIRST_LINE ||
                      after == AFTER_SHOW_LAST_LINE);
    player->play.after_work = after;
    return STATUS_OK;
}

/* ---- commands ------------------------------------------------------------ */

Status obey_pause(Player *player, const Command *command)
{
    bool runs = command->kind == COMMAND_PLAY;
    player->play.mode = runs ? MODE_RUN : MODE_PAUSE;
    if (runs)
        show_step_end(player);
    return STATUS_OK;
}

Status obey_go_forward(Player *player, const Command *command)
{
    ActionAfterWork after = command->kind == COMMAND_STEP ? AFTER_NOTHING
                            : player->play.walk_unit != UNIT_STEP
                                ? AFTER_SHOW_FIRST_LINE
                                : AFTER_SHOW_STEP_END;
    player_pause(player);
    if (after == AFTER_SHOW_FIRST_LINE && walk_algorithm_lines(player, 1))
        return STATUS_OK;
    if (after == AFTER_SHOW_STEP_END &&
        player->view_of_pane[player->active_pane].trace_index >= 0) {
        show_step_end(player);
        return STATUS_OK;
    }
    return player_seek(player, player->past.shown_step + 1, after);
}

static bool panes_use_newton(const Player *player)
{
    bool any = false;
    for (int p = 0; p < past_count_panes(&player->past); p++)
        any = any ||
              simulation_has_newton_updates(&player->past.pane[p].simulation);
    return any;
}

/* Goes back by a step, an update or a line.  From the first line of a step,
 * goes to the end of the step before.  At the end of a step without a trace the
 * step is made once more, and its last line is shown. */
Status obey_go_back(Player *player, const Command *command)
{
    long step = player->past.shown_step;
    player_pause(player);
    if (step == 0)
        player_notify(player, "this is step 0: nothing was before it");
    if (player->play.walk_unit == UNIT_STEP || !panes_use_newton(player))
        return player_seek(player, step - 1, AFTER_NOTHING);
    if (player->view_of_pane[player->active_pane].trace_index < 0 && step > 0) {
        if (!player_get_active_pane(player)->has_trace)
            return player_seek(player, step, AFTER_SHOW_LAST_LINE);
        begin_algorithm_walk(player, AFTER_SHOW_LAST_LINE);
    }
    if (player->view_of_pane[player->active_pane].trace_index >= 0 &&
        walk_algorithm_lines(player, -1))
        return STATUS_OK;
    return player_seek(player, step - 1, AFTER_SHOW_LAST_LINE);
}

Status obey_change_walk_unit(Player *player, const Command *command)
{
    static const char *const paces[] = {
        "whole steps", "updates of Newton's method", "lines of Algorithm 3"};
    if (player_get_active_options(player)->next_action ==
            NEXT_SHORTENS_SPRING ||
        (!panes_use_newton(player) && player->play.walk_unit == UNIT_STEP))
        return player_refuse(player, "a step here has no finer ones");
    player->play.walk_unit = (player->play.walk_unit + 1) % UNITS;
    player_pause(player);
    if (player->play.walk_unit == UNIT_STEP)
        show_step_end(player);
    player_notify(player, "N and \u2190 go by %s",
                  paces[player->play.walk_unit]);
    return STATUS_OK;
}

Status obey_go_to_step(Player *player, const Command *command)
{
    long step =
        command->kind == COMMAND_HOME ? 0 : past_find_newest(&player->past);
    if (command->kind == COMMAND_GOTO && command->number < step)
        step = command->number;
    player_pause(player);
    return player_seek(player, step, AFTER_NOTHING);
}

/* Describes what an edit has done to the scene: "ball moved", "stretch 1.2". */
static void describe_edit(const Player *player, const Command *edit, char *line,
                          size_t size)
{
    Options edited = *player_get_active_options(player);
    const OptionRow *row = &option_rows[edit->number];
    CommandKind kind = edit->kind;
    char value[COMMAND_TEXT_SIZE];
    if (kind == COMMAND_SET) {
        edited.number[row->slot] = edit->x;
        option_write_short_value(row, &edited, value, sizeof value);
        snprintf(line, size, "%s %s", row->name,
                 edit->text[0] ? edit->text : value);
    } else if (kind == COMMAND_OBSTACLE || kind == COMMAND_PUSH)
        snprintf(line, size, "%s %s",
                 edit->number < edited.grounds ? "ground" : "ball",
                 kind == COMMAND_PUSH ? "pushed" : "moved");
    else if (kind == COMMAND_GRAB || kind == COMMAND_PLACE)
        snprintf(line, size, "node %ld %s", edit->number,
                 kind == COMMAND_GRAB ? "pulled" : "placed");
    else if (kind == COMMAND_PIN)
        snprintf(line, size, "node %ld %s", edit->number,
                 edit->x != 0 ? "pinned" : "freed");
    else
        snprintf(line, size, "%s%s%s", command_rows[kind].name,
                 edit->text[0] ? " " : "", edit->text);
}

Status obey_undo(Player *player, const Command *command)
{
    char line[2 * COMMAND_TEXT_SIZE];
    int way = command->kind == COMMAND_UNDO ? -1 : 1;
    const Command *made = past_undo_or_redo(&player->past, way);
    if (!made)
        return player_refuse(player, way < 0 ? "nothing is to be undone"
                                             : "nothing was undone");
    const Command edit = *made;
    player->play.mode = MODE_PAUSE;
    drop_held_node_and_queue(player);
    player->input.mouse.input_gesture_id = ++player->commands.gesture_count;
    update_player_after_edit(player);
    player_reset_view(player);
    describe_edit(player, &edit, line, sizeof line);
    player_notify(player, "%s: %s", way < 0 ? "undone" : "done again", line);
    return STATUS_OK;
}
