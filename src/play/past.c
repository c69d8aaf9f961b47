/* past.c - stores the steps and edits of all panes, and goes back to them. */
#include "play/past.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lesson/command_line.h"
#include "picture/picture.h"

/* ---- reading ------------------------------------------------------------- */

static Branch *get_present_branch(const Past *past)
{
    return &past->branch[past->branch_index];
}

int past_count_panes(const Past *past)
{
    return past->branch_count > 0 ? get_present_branch(past)->panes : 0;
}

long past_find_newest(const Past *past)
{
    return get_present_branch(past)->first_step +
           get_present_branch(past)->entry_count - 1;
}

/* Returns which pane of the branch before, branch[-1], this pane continues.  A
 * pane that was added continues the last pane of that branch. */
static int find_pane_in_branch_below(const Branch *branch, int pane)
{
    int last = branch[-1].panes - 1;
    return pane < last ? pane : last;
}

/* Returns the entry of a step, from a branch below if the step is earlier.  The
 * step after the last one has the entry being made.  NULL: no entry. */
static PastEntry *find_branch_entry(const Branch *branch, int pane, long step)
{
    for (; step < branch->first_step && !branch->begins_runs; branch--)
        pane = find_pane_in_branch_below(branch, pane);
    long i = step - branch->first_step;
    return i < 0 || i >= branch->capacity
               ? NULL
               : &branch->entry[i * branch->panes + pane];
}

static PastEntry *find_entry(const Past *past, int pane, long step)
{
    return find_branch_entry(get_present_branch(past), pane, step);
}

const PastEntry *past_find_entry(const Past *past, int pane, long step)
{
    return step > past_find_newest(past) ? NULL : find_entry(past, pane, step);
}

const UserControl *past_get_control(const Past *past, int pane)
{
    return find_entry(past, pane, past->shown_step)->next_control;
}

const UserControl *past_get_start_control(const Past *past, int pane)
{
    const Branch *branch = get_present_branch(past);
    for (; !branch->begins_runs; branch--)
        pane = find_pane_in_branch_below(branch, pane);
    return branch->entry[pane].next_control;
}

/* Whether a failure has ended the pane before the step of this entry. */
static bool entry_is_after_failure(const PastEntry *entry)
{
    return entry->substep_count == 0 &&
           status_is_failure(entry->outcome.status);
}

long past_find_made_step(const Past *past, int pane, long step)
{
    while (step > 0 &&
           entry_is_after_failure(past_find_entry(past, pane, step)))
        step--;
    return step;
}

long past_find_drawable_step(const Past *past, int pane, long step)
{
    const PastEntry *first = past_find_entry(past, pane, 1);
    if (!first)
        return step;
    double most = PAST_EXPLODED * fmax(first->outcome.max_coordinate, 1e-300);
    while (step > 0 &&
           !(past_find_entry(past, pane, step)->outcome.max_coordinate <= most))
        step--;
    return step;
}

/* ---- entries and branches ------------------------------------------------ */

/* Drops the state of an entry, and its sample. */
static void drop_state(Past *past, PastEntry *entry)
{
    SavedState *state = entry->state;
    if (state && --state->ref_count == 0) {
        past->used_bytes -= state->size;
        control_release(state->control);
        free(state);
    }
    if (entry->sample)
        past->used_bytes -= sizeof *entry->sample;
    free(entry->sample);
    entry->state = NULL;
    entry->sample = NULL;
}

static void drop_entry(Past *past, PastEntry *entry)
{
    control_release(entry->next_control);
    drop_state(past, entry);
    *entry = (PastEntry){0};
}

/* Reserves each pane's next entry.  Unless states are stored, only two stay. */
static Status reserve_entry(Past *past, Branch *branch)
{
    size_t row = (size_t)branch->panes * sizeof(PastEntry);
    if (!past->stores_states && branch->entry_count == 2) {
        for (int p = 0; p < branch->panes; p++)
            drop_entry(past, &branch->entry[p]);
        memmove(branch->entry, branch->entry + branch->panes, row);
        memset(branch->entry + branch->panes, 0, row);
        branch->first_step++;
        branch->entry_count--;
    }
    if (branch->entry_count < branch->capacity)
        return STATUS_OK;
    long room = branch->capacity ? 2 * branch->capacity : 4;
    PastEntry *entry = realloc(branch->entry, (size_t)room * row);
    if (!entry)
        return STATUS_OUT_OF_MEMORY;
    memset((char *)entry + (size_t)branch->capacity * row, 0,
           (size_t)(room - branch->capacity) * row);
    branch->entry = entry;
    branch->capacity = room;
    return STATUS_OK;
}

static void drop_branches(Past *past, int from)
{
    while (past->branch_count > from) {
        Branch *branch = &past->branch[--past->branch_count];
        for (long i = 0; i < branch->capacity * branch->panes; i++)
            drop_entry(past, &branch->entry[i]);
        free(branch->entry);
    }
}

/* ---- states -------------------------------------------------------------- */

/* Whether an entry keeps its state when its pane leaves the step.  With a
 * stride above 1, entry 0 keeps only a state that the user set. */
static bool branch_keeps_state(const Branch *branch, const PastEntry *entry)
{
    long i = (entry - branch->entry) / branch->panes;
    return i % branch->stride == 0 &&
           (i > 0 || branch->stride == 1 || !entry->state ||
            entry->state->is_set_by_user);
}

/* Drops every second state of the branch with the smallest stride; the present
 * branch has its turn last.  Returns false if no state is left to drop. */
static bool drop_every_second_state(Past *past)
{
    Branch *finest = NULL;
    for (int b = 0; b < past->branch_count; b++) {
        Branch *branch = &past->branch[b];
        bool finer =
            !finest || branch->stride < finest->stride ||
            (branch->stride == finest->stride && b != past->branch_index);
        if (branch->stride <= branch->entry_count && finer)
            finest = branch;
    }
    if (!finest)
        return false;
    finest->stride *= 2;
    for (long i = 0; i < finest->capacity * finest->panes; i++)
        if (!branch_keeps_state(finest, &finest->entry[i]))
            drop_state(past, &finest->entry[i]);
    return true;
}

/* Samples at most HISTORY_MAX_POINTS steps of a run, among them the newest. */
void past_fill_history(const Past *past, int pane, History *history)
{
    long newest = past_find_newest(past), stride = 1;
    long last = past_find_made_step(past, pane, newest);
    while (newest / stride > HISTORY_MAX_POINTS - 2)
        stride *= 2;
    history->series_count = history->point_count = 0;
    for (long step = 0; step < last + stride; step += stride) {
        const EnergySample *sample =
            find_entry(past, pane, step < last ? step : last)->sample;
        if (sample)
            history_add_point(history, sample->time, sample->energy_count,
                              sample->energy);
    }
}

/* Stores a pane's state in an entry; drops other states if memory is short. */
static Status store_state(Past *past, int p, bool set, PastEntry *entry)
{
    const PastPane *pane = &past->pane[p];
    const Simulation *simulation = &pane->simulation;
    size_t size = sizeof *entry->state + state_save(simulation, NULL);
    /* Memory for the state and for the sample, which is made next. */
    size_t both = size + sizeof *entry->sample;
    drop_state(past, entry);
    while (past->used_bytes + both > past->max_bytes &&
           drop_every_second_state(past))
        continue;
    SavedState *state = malloc(size);
    if (!state)
        return STATUS_OUT_OF_MEMORY;
    *state = (SavedState){1, size, set, control_retain(pane->control)};
    state_save(simulation, state->bytes);
    past->used_bytes += size;
    entry->state = state;
    return STATUS_OK;
}

/* Leaves the present step of a pane.  Until now an edit could have needed the
 * state of the step; now the state is dropped unless its entry keeps it. */
static void pane_leave_step(Past *past, int p)
{
    PastPane *pane = &past->pane[p];
    const Branch *branch = get_present_branch(past);
    if (!pane->has_state)
        return;
    while (pane->step < branch->first_step && !branch->begins_runs)
        branch--;
    PastEntry *entry = find_entry(past, p, pane->step);
    if (!branch_keeps_state(branch, entry))
        drop_state(past, entry);
    pane->has_state = false;
}

static void leave_steps_of_panes(Past *past)
{
    for (int p = 0; p < past_count_panes(past); p++)
        pane_leave_step(past, p);
}

/* Puts a branch on top of the present one, and drops undone branches.  The
 * first wanted.copied_count entries are copies from the branch below; entry 0
 * shares its state with the copied entry.  Returns NULL without memory. */
static Branch *push_new_branch(Past *past, Branch wanted, const Command *edit)
{
    drop_branches(past, past->branch_index + 1);
    if (past->branch_count == past->capacity) {
        int room = past->capacity ? 2 * past->capacity : 16;
        Branch *grown = realloc(past->branch, (size_t)room * sizeof *grown);
        if (!grown)
            return NULL;
        past->branch = grown;
        past->capacity = room;
    }
    Branch *branch = &past->branch[past->branch_count];
    *branch = wanted;
    branch->stride = 1;
    branch->edit = *edit;
    if (reserve_entry(past, branch))
        return NULL;
    branch->entry_count = 1;
    for (int p = 0; p < past_count_panes(past); p++)
        if (branch->begins_runs || p >= branch->panes ||
            past->pane[p].step > branch->first_step)
            pane_leave_step(past, p);
    for (int p = 0; p < branch->panes && !branch->begins_runs; p++)
        for (int i = 0; i < branch->copied_count; i++) {
            PastEntry *to = &branch->entry[i * branch->panes + p];
            *to = *find_branch_entry(branch - 1,
                                     find_pane_in_branch_below(branch, p),
                                     branch->first_step + i);
            control_retain(to->next_control);
            to->sample = NULL;
            if (i > 0)
                to->state = NULL;
            if (to->state)
                to->state->ref_count++;
        }
    if (past->branch_count > 0)
        branch[-1].left_at_step = past->shown_step;
    past->branch_index = past->branch_count++;
    past->shown_step = past->goal_step = branch->first_step;
    return branch;
}

/* ---- panes --------------------------------------------------------------- */

/* Returns the time step of a pane, s; 1 in scenes without time. */
static double find_pane_timestep(const PastPane *pane)
{
    const Simulation *simulation = &pane->simulation;
    return simulation->scene->traits & HAS_TIME ? simulation->options.timestep
                                                : 1;
}

/* Returns the Newton object of the first run that has one, whose iterations are
 * traced; NULL while another run makes its step. */
static const Newton *find_newton_to_trace(const Simulation *simulation)
{
    for (int r = 0; r < simulation->runs && !simulation->scene->step; r++)
        if (simulation->run[r].newton)
            return r == simulation->current_run ? simulation->run[r].newton
                                                : NULL;
    return NULL;
}

/* Records a Newton iteration.  Returns false: Newton's loop pauses after each,
 * so that the window can read the mouse and the program its signals. */
static bool observe_newton(void *user, const NewtonRecord *record)
{
    PastPane *pane = user;
    if (!pane->is_in_substep)
        return false;
    pane->outcome.updates += record->alpha != 0;
    if (pane->simulation.scene->step) /* a scene whose step is one update */
        pane->outcome.energy_change = record->energy_change;
    const Newton *newton = find_newton_to_trace(&pane->simulation);
    if (newton && pane->trace.x_length > 0 && record->iteration >= 0)
        step_trace_add_iterate(&pane->trace, newton, record);
    NewtonRecords *records = &pane->newton_records;
    if (newton_records_reserve(records, records->count + 1))
        records->record[records->count++] = *record;
    else
        records->is_incomplete = true;
    return false;
}

/* Discards the records of the last step. */
static void pane_clear_records(PastPane *pane)
{
    pane->has_trace = pane->has_failed = false;
    pane->substep_count = 0;
    pane->trace.position_count = pane->newton_records.count = 0;
    pane->newton_records.is_incomplete = false;
}

static void pane_free(PastPane *pane)
{
    simulation_free(&pane->simulation);
    control_release(pane->control);
    control_release(pane->start_control);
    pane->control = pane->start_control = NULL;
    pane->has_state = pane->is_in_substep = false;
    pane_clear_records(pane);
}

static Status pane_create(PastPane *pane, const Options *options)
{
    pane_free(pane);
    return simulation_create(options, observe_newton, pane, &pane->simulation);
}

static Status pane_use_control(PastPane *pane, const UserControl *control)
{
    if (pane->control == control)
        return STATUS_OK;
    Status status = control_apply(&pane->simulation, control);
    control_retain(control);
    control_release(pane->control);
    pane->control = control;
    if (status)
        pane_free(pane);
    return status;
}

/* Notes that a pane has the state of a step, gives the pane the control of the
 * next step, and samples the energies if this control is new. */
static Status pane_set_step(Past *past, int p, long step)
{
    PastPane *pane = &past->pane[p];
    PastEntry *entry = find_entry(past, p, step);
    bool samples = past->stores_states &&
                   (!entry->sample || pane->control != entry->next_control);
    Status status = pane_use_control(pane, entry->next_control);
    pane->step = step;
    pane->has_state = !status;
    if (status || !samples)
        return status;
    if (!entry->sample) {
        entry->sample = malloc(sizeof *entry->sample);
        past->used_bytes += entry->sample ? sizeof *entry->sample : 0;
    }
    if (entry->sample) {
        const Picture *picture = picture_of_scene(pane->simulation.scene);
        entry->sample->time = simulation_get_time(&pane->simulation);
        entry->sample->energy_count = 0;
        if (picture->get_energies)
            entry->sample->energy_count =
                picture->get_energies(&pane->simulation, entry->sample->energy);
    }
    return STATUS_OK;
}

static Status pane_load_state(PastPane *pane, const SavedState *state)
{
    Status status = pane_use_control(pane, state->control);
    if (!status)
        state_restore(state->bytes, &pane->simulation);
    return status;
}

/* Brings a pane near the step `goal`, if need be to the last stored state
 * at or before it.  Without stored states the pane is at that step already. */
static Status pane_seek(Past *past, int p, long goal)
{
    PastPane *pane = &past->pane[p];
    const UserControl *start = past_get_start_control(past, p);
    long from = goal;
    while (past->stores_states && from > 0 && !find_entry(past, p, from)->state)
        from--;
    bool is_near = pane->has_state && pane->step <= goal &&
                   (pane->step >= from || pane->step >= goal - 1);
    if (is_near &&
        pane->control == find_entry(past, p, pane->step)->next_control)
        return pane_set_step(past, p, pane->step);
    const PastEntry *entry = find_entry(past, p, from);
    if (!entry->state)
        return STATUS_OUT_OF_MEMORY;
    Status status = STATUS_OK;
    if (!pane->has_state || pane->step != from) {
        pane_leave_step(past, p);
        pane_clear_records(pane);
        pane->outcome = entry->outcome;
    }
    if (pane->start_control != start) {
        status = pane_create(pane, &start->options);
        pane->start_control = status ? NULL : control_retain(start);
    }
    if (!status)
        status = pane_load_state(pane, entry->state);
    return status ? status : pane_set_step(past, p, from);
}

/* ---- steps --------------------------------------------------------------- */

/* Abandons the present work.  A pane that is in the middle of a step or ahead
 * of the newest whole step must load a stored state again (has_state). */
static void past_abandon_work(Past *past)
{
    if (past->work_stage == WORK_DONE)
        return;
    long new = past_find_newest(past) + 1;
    for (int p = 0; p < past_count_panes(past); p++) {
        PastPane *pane = &past->pane[p];
        if (pane->is_in_substep || pane->substep_count > 0 || pane->step >= new)
            pane->has_state = false;
        pane->is_in_substep = false;
        pane->substep_count = 0;
        if (!past_makes_step(past))
            continue;
        drop_state(past, find_entry(past, p, new));
        /* A copied entry keeps its control, to make the step again. */
        if (get_present_branch(past)->entry_count >=
            get_present_branch(past)->copied_count)
            drop_entry(past, find_entry(past, p, new));
    }
    past->work_stage = WORK_DONE;
}

static bool is_out_of_memory(Status status)
{
    return status == STATUS_OUT_OF_MEMORY || status == STATUS_TOO_LARGE;
}

static Status pane_finish_step(Past *past, int p);
static Status pane_iterate(Past *past, int p);

/* Ends a pane that has failed while other panes go on.  From now on the pane
 * shows its last state that a picture can show (PAST_EXPLODED). */
static Status end_pane_by_failure(Past *past, int p, Status why)
{
    PastPane *pane = &past->pane[p];
    long step = pane->step, last = past_find_drawable_step(past, p, step);
    pane_leave_step(past, p);
    Status status = pane_seek(past, p, last);
    while (pane->step < last && (!status || status == STATUS_RUNNING))
        status = pane_iterate(past, p);
    if (status && status != STATUS_RUNNING)
        return status;
    pane->step = step;
    pane->substep_count = 0;
    pane->outcome = past_find_entry(past, p, last)->outcome;
    pane->outcome.status = past->bad_status = why;
    if (past_makes_step(past))
        past->work_stage = WORK_PARTLY_MADE;
    return pane_finish_step(past, p);
}

/* Ends the work after a failure, or only this pane if other panes can go on. */
static Status pane_record_failure(Past *past, int p, Status status)
{
    PastPane *pane = &past->pane[p];
    if (past_makes_step(past) && past->panes_fail_alone &&
        past_count_panes(past) > 1 && !is_out_of_memory(status)) {
        status = end_pane_by_failure(past, p, status);
        if (status == STATUS_RUNNING)
            return status;
    }
    past_abandon_work(past);
    if (!is_out_of_memory(status) && pane->start_control) {
        pane->has_failed = pane->has_trace = true;
        pane->outcome.status = status;
    }
    /* Some panes may have made the next step, so the state is not of `step`. */
    pane->has_state = false;
    past->goal_step = past->shown_step;
    return status;
}

/* Moves a pane to the entry of the step that the pane has finished. */
static Status pane_finish_step(Past *past, int p)
{
    PastPane *pane = &past->pane[p];
    long step = pane->step + 1;
    PastEntry *to = find_entry(past, p, step);
    Status status = STATUS_OK;
    if (step > past_find_newest(past)) {
        if (!to->next_control)
            to->next_control =
                control_retain(find_entry(past, p, step - 1)->next_control);
        to->substep_count = pane->substep_count;
        to->outcome = pane->outcome;
    }
    if (past_makes_step(past) && pane->substep_count > 0)
        past->work_stage = WORK_PARTLY_MADE;
    pane->substep_count = 0;
    pane_leave_step(past, p);
    if (to->state && to->state->is_set_by_user)
        status = pane_load_state(pane, to->state);
    else if (past->stores_states && !to->state)
        store_state(past, p, false, to);
    if (!status)
        status = pane_set_step(past, p, step);
    return status ? pane_record_failure(past, p, status) : STATUS_RUNNING;
}

/* Acts on the status of an iteration: if it ended a step of the simulation,
 * stores the outcome, and finishes the pane's step after the last substep. */
static Status pane_end_iteration(Past *past, int p, Status status)
{
    PastPane *pane = &past->pane[p];
    const Simulation *simulation = &pane->simulation;
    StepOutcome *outcome = &pane->outcome;
    if (status == STATUS_RUNNING)
        return status;
    pane->is_in_substep = false;
    if (past->stores_states)
        step_trace_end(&pane->trace, &simulation->options);
    bool moved = simulation->steps > pane->steps_before_substep;
    outcome->status = status ? status : outcome->status;
    outcome->max_coordinate = 0;
    for (int i = 0; i < 2 * simulation->system.nodes; i++)
        outcome->max_coordinate =
            fmax(outcome->max_coordinate, fabs(simulation->run[0].x[i]));
    for (int r = 0; r < simulation->runs && !simulation->scene->step; r++)
        if (simulation->run[r].newton)
            outcome->energy_change +=
                simulation->run[r].newton->total_energy_change;
    if (status && !moved && (is_out_of_memory(status) || !simulation->is_over))
        return pane_record_failure(past, p, status);
    pane->has_trace = past->stores_states;
    pane->substep_count += moved;
    if (past_makes_step(past) && status)
        past->bad_status = status;
    double middle =
        simulation_get_time(simulation) + 0.5 * find_pane_timestep(pane);
    const PastEntry *to = past_find_entry(past, p, pane->step + 1);
    bool more = to ? pane->substep_count < to->substep_count
                   : moved && middle < past->step_end_time &&
                         (simulation->scene->traits & HAS_TIME);
    return more ? STATUS_RUNNING : pane_finish_step(past, p);
}

/* Makes the next iteration of a pane, or begins its next step. */
static Status pane_iterate(Past *past, int p)
{
    PastPane *pane = &past->pane[p];
    const PastEntry *from = past_find_entry(past, p, pane->step);
    const PastEntry *to = past_find_entry(past, p, pane->step + 1);
    if (pane->is_in_substep)
        return pane_end_iteration(past, p,
                                  simulation_advance(&pane->simulation));
    if (pane->substep_count == 0) {
        pane->outcome = (StepOutcome){0};
        pane_clear_records(pane);
    }
    if (entry_is_after_failure(from)) {
        pane->outcome = from->outcome;
        return pane_finish_step(past, p);
    }
    if (to && status_is_failure(to->outcome.status))
        return end_pane_by_failure(past, p, to->outcome.status);
    if (past->stores_states)
        step_trace_begin(&pane->trace, &pane->simulation,
                         past->samples_line_energy,
                         p == past->line_energy_pane);
    pane->steps_before_substep = pane->simulation.steps;
    pane->is_in_substep = true;
    return pane_end_iteration(past, p,
                              simulation_begin_step(&pane->simulation));
}

/* ---- work ---------------------------------------------------------------- */

/* Begins a new step in all panes, which ends after the longest time step. */
static Status begin_new_step(Past *past)
{
    double longest = -1;
    for (int p = 0; p < past_count_panes(past); p++) {
        const PastPane *pane = &past->pane[p];
        double pace = find_pane_timestep(pane);
        if (pace <= longest ||
            entry_is_after_failure(past_find_entry(past, p, pane->step)))
            continue;
        longest = pace;
        past->step_end_time = simulation_get_time(&pane->simulation) + pace;
    }
    past->bad_status = STATUS_OK;
    if (reserve_entry(past, get_present_branch(past)))
        return pane_record_failure(past, 0, STATUS_OUT_OF_MEMORY);
    past->work_stage = WORK_MAKING;
    return STATUS_RUNNING;
}

/* Ends the work when all panes are at `goal_step`.  If no pane could make a new
 * step, as its scene is over or it has failed, the newest step is shown. */
static Status show_goal_step(Past *past)
{
    Status status = past_makes_step(past) ? past->bad_status : STATUS_OK;
    if (past->work_stage == WORK_PARTLY_MADE) {
        get_present_branch(past)->entry_count++;
    } else if (past->work_stage == WORK_MAKING) {
        past->goal_step = past_find_newest(past);
        for (int p = 0; p < past_count_panes(past); p++)
            past->pane[p].step = past->goal_step;
        past_abandon_work(past);
    }
    past->work_stage = WORK_DONE;
    past->shown_step = past->goal_step;
    return status;
}

Status past_continue_work(Past *past)
{
    if (past->work_stage == WORK_DONE)
        return STATUS_OK;
    int panes = past_count_panes(past), pane = 0;
    for (; past->work_stage == WORK_LOADING && pane < panes; pane++) {
        Status status = pane_seek(past, pane, past->step_to_load);
        if (status)
            return pane_record_failure(past, pane, status);
    }
    if (past->work_stage == WORK_LOADING)
        past->work_stage = WORK_REPEATING;
    /* First each pane repeats steps up to newest, then each makes the next. */
    long newest = past_find_newest(past);
    long goal = past->goal_step,
         limit = past_makes_step(past) || goal < newest ? goal : newest;
    for (pane = 0; pane < panes; pane++)
        if (past->pane[pane].is_in_substep || past->pane[pane].step < limit)
            return pane_iterate(past, pane);
    return limit < goal ? begin_new_step(past) : show_goal_step(past);
}

Status past_finish_work(Past *past)
{
    Status status = STATUS_RUNNING;
    while (status == STATUS_RUNNING)
        status = past_continue_work(past);
    return status;
}

/* Whether the trace of `goal_step` is missing and is quick to make. */
static bool can_trace_goal(const Past *past)
{
    enum { MAX_TRACE_WORK = 400000 }; /* limit of nodes times updates */
    long work = 0;
    for (int p = 0; p < past_count_panes(past); p++) {
        const PastPane *pane = &past->pane[p];
        const Simulation *simulation = &pane->simulation;
        const PastEntry *entry = past_find_entry(past, p, past->goal_step);
        long behind = past->goal_step - pane->step;
        bool is_known = pane->has_state &&
                        (behind == 1 || (behind == 0 && pane->has_trace));
        if (!is_known && simulation->run[0].newton &&
            entry->substep_count > 0 && simulation_is_draggable(simulation))
            work += simulation->system.nodes * (1 + entry->outcome.updates);
    }
    return 0 < work && work < MAX_TRACE_WORK;
}

void past_set_goal(Past *past, long step, bool again)
{
    past_abandon_work(past);
    long newest = past_find_newest(past);
    past->goal_step = step < 0 ? 0 : step > newest ? newest + 1 : step;
    past->step_to_load = past->goal_step < newest ? past->goal_step : newest;
    past->work_stage = WORK_LOADING;
    past->samples_line_energy = again;
    if (past->goal_step == 0 || past->goal_step > newest ||
        !past->stores_states || !(again || can_trace_goal(past)))
        return;
    past->step_to_load = past->goal_step - 1;
    for (int p = 0; p < past_count_panes(past); p++)
        step_trace_clear(&past->pane[p].trace);
    leave_steps_of_panes(past);
}

/* ---- edits --------------------------------------------------------------- */

/* Marks rows of the tables as invalid: the rows of later steps, the energies of
 * this step and, if the state has changed, all rows of this step. */
static void invalidate_tables(Past *past, long step, bool changed)
{
    if (past->written_step > step - changed)
        past->written_step = step - changed;
    if (past->energies_step > step - 1)
        past->energies_step = step - 1;
}

/* Brings the simulations of all panes to the step that is shown. */
static Status finish_shown_step(Past *past)
{
    past_set_goal(past, past->shown_step, false);
    return past_finish_work(past);
}

Status past_begin_runs(Past *past, const Options *options, int panes,
                       int gesture, const Command *edit)
{
    const Branch wanted = {
        .begins_runs = true, .panes = panes, .gesture_id = gesture};
    Status status = STATUS_OK;
    past_abandon_work(past);
    leave_steps_of_panes(past);
    for (int p = 0; p < panes && !status; p++) {
        PastPane *pane = &past->pane[p];
        status = pane_create(pane, &options[p]);
        UserControl *control =
            status ? NULL : control_create(&pane->simulation);
        if (!control) {
            status = status ? status : STATUS_OUT_OF_MEMORY;
            break;
        }
        pane->start_control = control;
        pane->control = control_retain(control);
        pane->outcome = (StepOutcome){.status = pane->simulation.status};
        step_trace_clear(&pane->trace);
    }
    if (status && past->branch_index >= 0)
        past_set_goal(past, past->shown_step, false);
    if (status)
        return status;
    Branch *branch = push_new_branch(past, wanted, edit);
    if (!branch)
        return STATUS_OUT_OF_MEMORY;
    invalidate_tables(past, 0, true);
    for (int p = 0; p < panes && !status; p++) {
        PastEntry *entry = &branch->entry[p];
        entry->next_control = control_retain(past->pane[p].start_control);
        entry->substep_count = 1;
        if (past->stores_states)
            status = store_state(past, p, true, entry);
        if (!status)
            status = pane_set_step(past, p, 0);
    }
    return status;
}

/* Whether an edit sets a new state, which its branch stores. */
static bool edit_sets_state(const Command *edit)
{
    return edit->kind == COMMAND_HANDLE || edit->kind == COMMAND_FLIP ||
           edit->kind == COMMAND_PLACE;
}

/* Whether an edit changes the state of its step, as a pin stops its node. */
static bool edit_changes_state(const Command *edit)
{
    return edit_sets_state(edit) || edit->kind == COMMAND_PIN;
}

/* Returns the control after an edit, or NULL if memory is missing.
 *   simulation  in, at the step that is edited */
static const UserControl *make_edited_control(const UserControl *from,
                                              const Command *edit,
                                              const Simulation *simulation)
{
    char message[256];
    UserControl *control = control_copy(from);
    if (!control)
        return NULL;
    if (edit->kind == COMMAND_SET)
        options_set(&control->options, &option_rows[edit->number], edit->text,
                    edit->x, MESSAGE(message));
    if (edit->kind == COMMAND_OBSTACLE) {
        double *at =
            options_get_obstacle_point(&control->options, (int)edit->number);
        at[0] = edit->x;
        at[1] = edit->y;
    }
    if (edit->kind == COMMAND_PIN)
        control->is_pinned[edit->number] = edit->x != 0;
    bool takes = edit->kind == COMMAND_GRAB || edit->kind == COMMAND_PUSH;
    if ((takes || edit->kind == COMMAND_RELEASE) && from->held_obstacle >= 0)
        control_store_obstacle(control, from->held_obstacle, simulation);
    if (takes || edit->kind == COMMAND_RELEASE) {
        int number = (int)edit->number;
        control->held_node = edit->kind == COMMAND_GRAB ? number : -1;
        control->held_obstacle = edit->kind == COMMAND_PUSH ? number : -1;
    }
    if (takes || edit->kind == COMMAND_DRAG) {
        control->target[0] = edit->x;
        control->target[1] = edit->y;
    }
    return control;
}

static Status apply_pane_edit(Past *past, int pane, const Command *edit,
                              PastEntry *entry)
{
    Simulation *simulation = &past->pane[pane].simulation;
    if (!edit_sets_state(edit)) {
        const UserControl *control =
            make_edited_control(entry->next_control, edit, simulation);
        if (!control)
            return STATUS_OUT_OF_MEMORY;
        control_release(entry->next_control);
        entry->next_control = control;
        return STATUS_OK;
    }
    if (edit->kind == COMMAND_HANDLE)
        exhibit_drag_handle(simulation, (int)edit->number, edit->x, edit->y);
    else if (edit->kind == COMMAND_PLACE)
        simulation_move_node(simulation, (int)edit->number, edit->x, edit->y,
                             true);
    else if (edit->kind == COMMAND_FLIP)
        exhibit_flip_switch(simulation, (int)edit->number);
    Status status = store_state(past, pane, true, entry);
    return status ? status : pane_set_step(past, pane, past->shown_step);
}

Status past_edit(Past *past, const Command *edit, int pane, bool again,
                 int gesture)
{
    Status status = finish_shown_step(past);
    if (status)
        return status;
    Branch *branch = get_present_branch(past);
    const int panes = branch->panes + (edit->kind == COMMAND_ADD_PANE) -
                      (edit->kind == COMMAND_END_PANE);
    bool counts = panes != branch->panes; /* the edit adds or removes a pane */
    bool joins = gesture && branch->gesture_id == gesture &&
                 !branch->begins_runs && !counts && !again &&
                 past->shown_step == past_find_newest(past) &&
                 edit_sets_state(edit) == edit_sets_state(&branch->edit) &&
                 (!edit_sets_state(edit) || branch->entry_count == 1);
    const Branch wanted = {.first_step = past->shown_step - again,
                           .copied_count = 1 + again,
                           .panes = panes,
                           .gesture_id = gesture};
    if (joins) /* the edit joins the present branch; undone branches end */
        drop_branches(past, past->branch_index + 1);
    else
        branch = push_new_branch(past, wanted, edit);
    if (!branch)
        return STATUS_OUT_OF_MEMORY;
    if (edit->kind == branch->edit.kind)
        branch->edit = *edit; /* undo reports the last edit of the gesture */
    invalidate_tables(past, past->shown_step, edit_changes_state(edit));
    for (long i = branch->entry_count - 1; i < branch->entry_count + again; i++)
        for (int p = 0; p < panes && !counts && !status; p++)
            if (pane == ALL_PANES || pane == p)
                status = apply_pane_edit(past, p, edit,
                                         &branch->entry[i * panes + p]);
    return status || again ? status : finish_shown_step(past);
}

const Command *past_undo_or_redo(Past *past, int way)
{
    int from = past->branch_index, to = from + way;
    int last = way < 0 ? 0 : past->branch_count - 1;
    if (to < 0 || to >= past->branch_count)
        return NULL;
    while (to != last && past->branch[to].gesture_id &&
           past->branch[to].gesture_id == past->branch[to + 1].gesture_id)
        to += way;
    int low = way < 0 ? to : from, high = way < 0 ? from : to;
    for (int b = low + 1; b <= high; b++)
        invalidate_tables(past, past->branch[b].first_step,
                          past->branch[b].begins_runs ||
                              edit_changes_state(&past->branch[b].edit));
    past_abandon_work(past);
    leave_steps_of_panes(past);
    get_present_branch(past)->left_at_step = past->shown_step;
    past->branch_index = to;
    past->shown_step = get_present_branch(past)->left_at_step;
    past_set_goal(past, past->shown_step, false);
    return &past->branch[high].edit;
}

void past_create(bool stores_states, bool panes_fail_alone, Past *past)
{
    *past = (Past){.branch_index = -1,
                   .stores_states = stores_states,
                   .panes_fail_alone = panes_fail_alone,
                   .written_step = -1,
                   .energies_step = -1,
                   .max_bytes = PAST_BYTES,
                   .line_energy_pane = -1};
}

void past_free(Past *past)
{
    drop_branches(past, 0);
    free(past->branch);
    for (int p = 0; p < OPTIONS_MAX_PANES; p++) {
        pane_free(&past->pane[p]);
        step_trace_free(&past->pane[p].trace);
        free(past->pane[p].newton_records.record);
    }
    *past = (Past){.branch_index = -1};
}
