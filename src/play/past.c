#include "play/past.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene.h"

/* ---- entries ------------------------------------------------------------- */

int past_panes(const Past *past)
{
    return past->branches > 0 ? past->branch[past->now].panes : 0;
}

long past_newest(const Past *past)
{
    const Branch *branch = &past->branch[past->now];
    return branch->first + branch->count - 1;
}

/* The entry of a step as branch b sees it: its own, or one below; behind the
 * last, the one that is being made. */
static Entry *entry_in(const Past *past, int b, int pane, long step)
{
    const Branch *branch = &past->branch[b];
    while (step < branch->first && !branch->fresh) {
        pane = branch->source[pane];
        branch = &past->branch[--b];
    }
    long i = step - branch->first;
    return i < 0 || i >= branch->room
               ? NULL
               : &branch->entry[i * branch->panes + pane];
}

static Entry *entry_of(const Past *past, int pane, long step)
{
    return entry_in(past, past->now, pane, step);
}

const Entry *past_entry(const Past *past, int pane, long step)
{
    return step > past_newest(past) ? NULL : entry_of(past, pane, step);
}

const Control *past_control(const Past *past, int pane)
{
    return entry_of(past, pane, past->step)->control;
}

/* The pane with which this one's run began; the branch where it did, out. */
static int first_pane(const Past *past, int pane, const Branch **branch)
{
    for (*branch = &past->branch[past->now]; !(*branch)->fresh; --*branch)
        pane = (*branch)->source[pane];
    return pane;
}

const Control *past_start(const Past *past, int pane)
{
    const Branch *branch;
    pane = first_pane(past, pane, &branch);
    return branch->entry[pane].control;
}

/* Whether the pane can make no more steps from here. */
static bool has_failed(const Entry *entry)
{
    Status status = entry->outcome.status;
    return entry->substeps == 0 && status && !status_is_unconverged(status);
}

long past_ended(const Past *past, int pane)
{
    long last = past->step;
    while (last > 0 && has_failed(past_entry(past, pane, last)))
        last--;
    return last < past->step ? last : -1;
}

long past_last_seen(const Past *past, int pane, long step, long from)
{
    const Entry *first = past_entry(past, pane, from > 0 ? from : 1);
    if (!first)
        return step;
    double most = PAST_EXPLODED * fmax(first->outcome.extent, 1e-300);
    while (step > from &&
           !(past_entry(past, pane, step)->outcome.extent <= most))
        step--;
    return step;
}

static void drop_state(Past *past, Entry *entry)
{
    if (entry->state)
        past->bytes -= entry->state->size;
    free(entry->state);
    entry->state = NULL;
}

static void drop_entry(Past *past, Entry *entry)
{
    control_drop(entry->control);
    drop_state(past, entry);
    *entry = (Entry){0};
}

/* Room for one more entry a pane.  Where nobody goes back the last two are
 * enough. */
static Status make_room(Past *past, Branch *branch)
{
    size_t row = (size_t)branch->panes * sizeof(Entry);
    if (!past->keeps && branch->count == 2) {
        for (int p = 0; p < branch->panes; p++)
            drop_entry(past, &branch->entry[p]);
        memmove(branch->entry, branch->entry + branch->panes, row);
        memset(branch->entry + branch->panes, 0, row);
        branch->first++;
        branch->count--;
    }
    if (branch->count < branch->room)
        return STATUS_OK;
    long room = branch->room ? 2 * branch->room : 4;
    Entry *entry = realloc(branch->entry, (size_t)room * row);
    if (!entry)
        return STATUS_OUT_OF_MEMORY;
    memset((char *)entry + (size_t)branch->room * row, 0,
           (size_t)(room - branch->room) * row);
    branch->entry = entry;
    branch->room = room;
    return STATUS_OK;
}

/* ---- branches ------------------------------------------------------------ */

/* A copy of these, or empty ones; NULL: no memory. */
static Curves *copy_curves(const Curves *from)
{
    Curves *curves = malloc(sizeof *curves);
    if (curves && from)
        *curves = *from;
    if (!curves || from)
        return curves;
    history_clear(&curves->history);
    curves->sampled = -1;
    return curves;
}

/* Curves forget what came after this step. */
static void cut_curves(Curves *curves, long step, double time)
{
    if (!curves || curves->sampled <= step)
        return;
    history_cut(&curves->history, time);
    curves->sampled = step;
}

Curves *past_curves(const Past *past, int pane)
{
    return past->branch[past->now].curves[pane];
}

/* Branches from this one on go. */
static void drop_branches(Past *past, int from)
{
    while (past->branches > from) {
        Branch *branch = &past->branch[--past->branches];
        for (long i = 0; i < branch->room * branch->panes; i++)
            drop_entry(past, &branch->entry[i]);
        for (int p = 0; p < OPTIONS_MAX_PANES; p++) {
            control_drop(branch->second[p]);
            free(branch->curves[p]);
        }
        free(branch->entry);
    }
}

/* Entry 0 of a pane of the topmost branch, and the curves up to it, as the
 * branch below has them. */
static void copy_entry(Past *past, Branch *branch, int pane)
{
    int below = branch[-1].panes, b = past->branches - 1;
    int source = pane < below ? pane : below - 1;
    const Entry *from = entry_in(past, b, source, branch->first);
    branch->source[pane] = source;
    branch->entry[pane] = (Entry){.number = ++past->numbers,
                                  .control = control_keep(from->control),
                                  .substeps = from->substeps,
                                  .outcome = from->outcome};
    branch->curves[pane] = copy_curves(branch[-1].curves[source]);
    cut_curves(branch->curves[pane], branch->first, from->outcome.time);
}

/* A branch on top of the present one, in the place of those that were undone,
 * with one entry.  NULL: no memory. */
static Branch *push_branch(Past *past, bool fresh, long first, int panes,
                           const Command *edit, int gesture)
{
    enum { LONG_AGO = 16 }; /* branches, whose curves are forgotten */
    drop_branches(past, past->now + 1);
    if (past->branches == past->room) {
        int room = past->room ? 2 * past->room : 16;
        Branch *grown = realloc(past->branch, (size_t)room * sizeof *grown);
        if (!grown)
            return NULL;
        past->branch = grown;
        past->room = room;
    }
    Branch *branch = &past->branch[past->branches];
    *branch = (Branch){.fresh = fresh,
                       .first = first,
                       .stride = 1,
                       .panes = panes,
                       .gesture = gesture,
                       .edit = *edit};
    if (make_room(past, branch))
        return NULL;
    branch->count = 1;
    branch->run = fresh ? ++past->numbers : branch[-1].run;
    for (int p = 0; p < panes; p++)
        if (fresh)
            branch->curves[p] = copy_curves(NULL);
        else
            copy_entry(past, branch, p);
    if (past->branches > 0)
        branch[-1].shown = past->step;
    for (int p = 0; past->branches >= LONG_AGO && p < OPTIONS_MAX_PANES; p++) {
        free(branch[-LONG_AGO].curves[p]);
        branch[-LONG_AGO].curves[p] = NULL;
    }
    past->now = past->branches++;
    past->step = past->aim = first;
    return branch;
}

/* ---- states -------------------------------------------------------------- */

/* Every second kept state of the branch with the finest ones goes; at last that
 * of its first entry, too, if there is a branch below.  Of equals the branch
 * that is shown comes last. */
static bool thin_states(Past *past)
{
    Branch *finest = NULL;
    for (int b = 0; b < past->branches; b++) {
        Branch *branch = &past->branch[b];
        bool finer = !finest || branch->stride < finest->stride ||
                     (branch->stride == finest->stride && b != past->now);
        if (branch->stride <= branch->count + !branch->fresh && finer)
            finest = branch;
    }
    if (!finest)
        return false;
    finest->stride *= 2;
    bool all = !finest->fresh && finest->stride > finest->count;
    for (long i = 0; i < finest->room * finest->panes; i++)
        if ((all || i / finest->panes % finest->stride) &&
            !finest->entry[i].placed)
            drop_state(past, &finest->entry[i]);
    return true;
}

/* The machine's state for the entry of the present branch where it stands, if
 * that one keeps it.  Memory that is not there makes the past coarser; it is a
 * failure only for the first one and for a placed one. */
static Status keep_state(Past *past, int pane)
{
    const Machine *machine = &past->machine[pane];
    const Branch *branch = &past->branch[past->now];
    Entry *entry = entry_of(past, pane, machine->step);
    long i = machine->step - branch->first;
    size_t size = past->keeps ? state_bytes(&machine->simulation) : 0;
    drop_state(past, entry);
    if (size == 0)
        return STATUS_OK;
    while (past->bytes + size > past->limit && thin_states(past))
        continue;
    bool due = i % branch->stride == 0 &&
               (branch->fresh || i > 0 || branch->stride <= branch->count);
    if (!due && !entry->placed)
        return STATUS_OK;
    entry->state = malloc(sizeof *entry->state + size);
    if (!entry->state)
        return (i > 0 || !branch->fresh) && !entry->placed
                   ? STATUS_OK
                   : STATUS_OUT_OF_MEMORY;
    entry->state->size = size;
    past->bytes += size;
    state_save(&machine->simulation, entry->state->bytes);
    return STATUS_OK;
}

/* ---- machines ------------------------------------------------------------ */

double machine_pace(const Machine *machine)
{
    const Simulation *simulation = &machine->simulation;
    return simulation->scene->needs & NEEDS_TIME ? simulation->options.timestep
                                                 : 1;
}

/* The Newton object whose rounds are kept: that of the first run that has one,
 * while it is this run's turn; else NULL. */
static const Newton *listened_to(const Simulation *simulation)
{
    for (int r = 0; r < simulation->runs && !simulation->scene->step; r++)
        if (simulation->run[r].newton)
            return r == simulation->stepping ? simulation->run[r].newton : NULL;
    return NULL;
}

/* What Newton tells of an iteration. */
static bool watch(void *user, const NewtonRecord *record)
{
    Machine *machine = user;
    if (!machine->iterating)
        return true;
    machine->outcome.updates += record->iteration >= 0;
    if (machine->simulation.scene->step) /* an update is a step */
        machine->outcome.change = record->change;
    const Newton *newton = listened_to(&machine->simulation);
    if (newton && machine->rounds.step > 0)
        rounds_add(&machine->rounds, newton, record);
    Records *records = &machine->records;
    if (records_fit(records, records->count + 1))
        records->row[records->count++] = *record;
    else
        records->lost = true;
    return true;
}

static void free_simulation(Machine *machine)
{
    simulation_free(&machine->simulation);
    control_drop(machine->control);
    machine->control = NULL;
    machine->run = machine->entry = 0;
    machine->iterating = machine->failed = machine->known = false;
    machine->substeps = 0;
    machine->records.count = 0;
    machine->records.lost = false;
}

/* A simulation of the present run, at its step 0. */
static Status make_simulation(Past *past, int pane, const Options *options)
{
    Machine *machine = &past->machine[pane];
    free_simulation(machine);
    Status status =
        simulation_create(options, watch, machine, &machine->simulation);
    if (status)
        return status;
    const Branch *branch;
    machine->run = past->branch[past->now].run;
    machine->first_pane = first_pane(past, pane, &branch);
    if (machine->simulation.scene->needs & NEEDS_TIME)
        machine->start = simulation_energies(&machine->simulation, 0).total;
    return STATUS_OK;
}

static Status use_control(Machine *machine, const Control *control)
{
    if (machine->control == control)
        return STATUS_OK;
    Status status = simulation_use(&machine->simulation, control);
    control_keep(control);
    control_drop(machine->control);
    machine->control = control;
    if (status)
        free_simulation(machine);
    return status;
}

/* The machine stands at this step of the present branch. */
static void stand(Past *past, int pane, long step)
{
    Machine *machine = &past->machine[pane];
    machine->step = step;
    machine->entry = entry_of(past, pane, step)->number;
}

static bool stands(const Past *past, int pane)
{
    const Machine *machine = &past->machine[pane];
    const Entry *entry = entry_of(past, pane, machine->step);
    return machine->entry && entry && entry->number == machine->entry;
}

/* Whether this entry's state is kept as branch b sees it, or leads from a kept
 * one below by the changes with which branches begin. */
static bool is_kept(const Past *past, int b, int pane, long step)
{
    const Branch *branch = &past->branch[b];
    const Entry *entry = entry_in(past, b, pane, step);
    return entry &&
           (entry->state || (step <= branch->first && !branch->fresh &&
                             is_kept(past, b - 1, branch->source[pane], step)));
}

/* The machine takes the state that this entry keeps, as branch b sees it; else
 * that of the branch below, if it begins here, or its own of this step; and the
 * entry's control.  So several changes at one step are made one after the
 * other. */
static Status take_entry(Past *past, Machine *machine, int b, int pane,
                         long step)
{
    const Branch *branch = &past->branch[b];
    const Entry *entry = entry_in(past, b, pane, step);
    bool begins = step <= branch->first && !branch->fresh;
    Status status = STATUS_OK;
    if (begins && !entry->state)
        status = take_entry(past, machine, b - 1, branch->source[pane], step);
    if (!status)
        status = use_control(machine, entry->control);
    if (!status && entry->state)
        state_restore(entry->state->bytes, &machine->simulation);
    return status;
}

/* Loads a state from which the machine can make the steps up to this one. */
static Status load(Past *past, int pane, long goal)
{
    Machine *machine = &past->machine[pane];
    long from = goal;
    while (from > 0 && !is_kept(past, past->now, pane, from))
        from--;
    bool near = machine->step >= from || machine->step >= goal - 1;
    if (near && machine->step <= goal && stands(past, pane))
        return STATUS_OK;
    if (!is_kept(past, past->now, pane, from))
        return STATUS_OUT_OF_MEMORY;
    Status status = STATUS_OK;
    const Branch *branch;
    if (machine->run != past->branch[past->now].run ||
        machine->first_pane != first_pane(past, pane, &branch))
        status = make_simulation(past, pane, &past_start(past, pane)->options);
    if (!status)
        status = take_entry(past, machine, past->now, pane, from);
    if (status)
        return status;
    machine->known = machine->failed = false;
    machine->outcome = entry_of(past, pane, from)->outcome;
    machine->substeps = 0;
    stand(past, pane, from);
    return STATUS_OK;
}

/* ---- steps --------------------------------------------------------------- */

/* Work that is under way ends; the last whole step stays, but machines that
 * have left it stand at none. */
static void stop_work(Past *past)
{
    if (!past->works)
        return;
    for (int p = 0; p < past_panes(past); p++) {
        Machine *machine = &past->machine[p];
        if (machine->iterating || machine->substeps > 0)
            machine->entry = 0;
        machine->iterating = false;
        machine->substeps = 0;
        if (past->making)
            drop_entry(past, entry_of(past, p, past->aim));
    }
    past->making = past->works = false;
}

/* Whether it is the computer that cannot go on. */
static bool lacks(Status status)
{
    return status == STATUS_OUT_OF_MEMORY || status == STATUS_TOO_LARGE;
}

/* The pane that failed beside others goes back to its last state that can be
 * seen; from there on it stands still. */
static Status end_pane(Past *past, int pane, Status status)
{
    Machine *machine = &past->machine[pane];
    long first = past->branch[past->now].first;
    long last = past_last_seen(past, pane, machine->step, first);
    const Entry *good = past_entry(past, pane, last);
    for (long step = last + 1; step <= past->aim; step++) {
        Entry *entry = entry_of(past, pane, step);
        int updates = entry->outcome.updates;
        drop_entry(past, entry);
        *entry = (Entry){.number = ++past->numbers,
                         .control = control_keep(good->control),
                         .outcome = good->outcome};
        entry->outcome.updates = updates;
        entry->outcome.status = status;
    }
    machine->entry = 0;
    machine->substeps = 0;
    past->made = true;
    past->worst = status;
    Curves *curves = past_curves(past, pane);
    cut_curves(curves, last, good->outcome.time);
    /* What an explosion has made of the energies would flatten those of
     * others. */
    History *history = curves ? &curves->history : NULL;
    while (history && history->count > 1 &&
           history->value[0][history->count - 1] >
               PAST_EXPLODED * fabs(history->value[0][0]))
        history_cut(history, history->time[history->count - 2]);
    return load(past, pane, past_newest(past));
}

/* A step could not be made. */
static Status fail(Past *past, int pane, Status status)
{
    Machine *machine = &past->machine[pane];
    if (past->making && past->goes_on && past_panes(past) > 1 &&
        !lacks(status)) {
        status = end_pane(past, pane, status);
        return status ? fail(past, pane, status) : STATUS_RUNNING;
    }
    stop_work(past);
    if (!lacks(status) && machine->run) {
        machine->failed = machine->known = true;
        machine->outcome.status = status;
    }
    if (past->keeps) /* some of its runs may have made the step */
        machine->entry = 0;
    past->aim = past->step;
    return status;
}

/* The machine has come to the entry behind the one where it stood. */
static Status arrive(Past *past, int pane)
{
    Machine *machine = &past->machine[pane];
    const Branch *branch = &past->branch[past->now];
    const Entry *from = entry_of(past, pane, machine->step);
    Entry *to = entry_of(past, pane, machine->step + 1);
    bool known = to->control != NULL;
    Status status = STATUS_OK;
    if (!known) {
        bool second = machine->step == branch->first && branch->second[pane];
        to->control =
            control_keep(second ? branch->second[pane] : from->control);
        to->number = ++past->numbers;
        to->substeps = machine->substeps;
        to->outcome = machine->outcome;
    }
    past->made = past->made || machine->substeps > 0;
    machine->substeps = 0;
    stand(past, pane, machine->step + 1);
    if (known && to->control != machine->control)
        status = take_entry(past, machine, past->now, pane, machine->step);
    if (!known)
        status = use_control(machine, to->control);
    if (!known && !status)
        status = keep_state(past, pane);
    return status ? fail(past, pane, status) : STATUS_RUNNING;
}

/* What is told of the step that was made. */
static void sum_up(Machine *machine, Status status)
{
    const Simulation *simulation = &machine->simulation;
    Outcome *outcome = &machine->outcome;
    outcome->status = status ? status : outcome->status;
    outcome->time = simulation_time(simulation);
    outcome->extent = 0;
    for (int i = 0; i < 2 * simulation->system.nodes; i++)
        outcome->extent = fmax(outcome->extent, fabs(simulation->run[0].x[i]));
    for (int r = 0; r < simulation->runs && !simulation->scene->step; r++)
        if (simulation->run[r].newton)
            outcome->change += simulation->run[r].newton->change;
}

/* A step of the simulation goes on, or is over. */
static Status go_on(Past *past, int pane, Status status)
{
    Machine *machine = &past->machine[pane];
    const Simulation *simulation = &machine->simulation;
    const Entry *to = entry_of(past, pane, machine->step + 1);
    if (status == STATUS_RUNNING)
        return status;
    machine->iterating = false;
    if (past->keeps)
        rounds_end(&machine->rounds, &simulation->options);
    bool moved = simulation->steps > machine->before;
    sum_up(machine, status);
    if (status && !moved && (lacks(status) || !simulation->done))
        return fail(past, pane, status);
    machine->known = past->keeps;
    machine->substeps += moved;
    if (past->making && status)
        past->worst = status;
    double middle = simulation_time(simulation) + 0.5 * machine_pace(machine);
    bool more = to->control ? machine->substeps < to->substeps
                            : moved && middle < past->target &&
                                  (simulation->scene->needs & NEEDS_TIME);
    return more ? STATUS_RUNNING : arrive(past, pane);
}

/* One step of the simulation begins, where the pane makes any. */
static Status begin_step(Past *past, int pane)
{
    Machine *machine = &past->machine[pane];
    const Entry *from = entry_of(past, pane, machine->step);
    const Entry *to = entry_of(past, pane, machine->step + 1);
    if (machine->substeps == 0) {
        machine->outcome =
            (Outcome){.time = simulation_time(&machine->simulation)};
        machine->records.count = 0;
        machine->records.lost = false;
        machine->failed = machine->known = false;
    }
    if (to->control ? to->substeps == 0 : has_failed(from)) {
        machine->outcome = to->control ? to->outcome : from->outcome;
        machine->outcome.updates = 0;
        return arrive(past, pane);
    }
    if (past->keeps)
        rounds_begin(&machine->rounds, &machine->simulation);
    machine->before = machine->simulation.steps;
    machine->iterating = true;
    return go_on(past, pane, simulation_begin(&machine->simulation));
}

static Status iterate(Past *past, int pane)
{
    Machine *machine = &past->machine[pane];
    const Newton *newton = listened_to(&machine->simulation);
    if (newton && past->keeps)
        rounds_look(&machine->rounds, newton);
    return go_on(past, pane, simulation_iterate(&machine->simulation));
}

/* ---- work ---------------------------------------------------------------- */

/* Where the pane with the longest timestep will be, s. */
static double next_time(const Past *past)
{
    double pace = -1, time = 0;
    for (int p = 0; p < past_panes(past); p++) {
        const Machine *machine = &past->machine[p];
        if (has_failed(entry_of(past, p, machine->step)) ||
            machine_pace(machine) <= pace)
            continue;
        pace = machine_pace(machine);
        time = simulation_time(&machine->simulation);
    }
    return time + pace;
}

/* All panes are at the newest step; another one begins. */
static Status begin_making(Past *past)
{
    past->target = next_time(past);
    past->made = false;
    past->worst = STATUS_OK;
    if (make_room(past, &past->branch[past->now]))
        return fail(past, 0, STATUS_OUT_OF_MEMORY);
    past->making = true;
    return STATUS_RUNNING;
}

/* All panes have come to the aim; none has, where every scene is at its end. */
static Status end_work(Past *past)
{
    Status worst = past->making ? past->worst : STATUS_OK;
    long newest = past_newest(past);
    if (past->making && past->made) {
        past->branch[past->now].count++;
    } else if (past->making) {
        for (int p = 0; p < past_panes(past); p++) {
            drop_entry(past, entry_of(past, p, past->aim));
            stand(past, p, newest);
        }
        past->aim = newest;
    }
    past->making = past->works = false;
    past->step = past->aim;
    return worst;
}

Status past_iterate(Past *past)
{
    if (!past->works)
        return STATUS_OK;
    int panes = past_panes(past), pane = 0;
    for (; past->from >= 0 && pane < panes; pane++) {
        Status status = load(past, pane, past->from);
        if (status)
            return fail(past, pane, status);
    }
    past->from = -1;
    /* One pane after the other makes its way to what is known, and then each
     * its part of a new step. */
    long newest = past_newest(past);
    long goal = past->making || past->aim < newest ? past->aim : newest;
    for (pane = 0; pane < panes; pane++)
        if (past->machine[pane].iterating)
            return iterate(past, pane);
        else if (past->machine[pane].step < goal)
            return begin_step(past, pane);
    return goal < past->aim ? begin_making(past) : end_work(past);
}

void past_aim(Past *past, long step, bool again)
{
    stop_work(past);
    long newest = past_newest(past);
    past->aim = step < 0 ? 0 : step > newest ? newest + 1 : step;
    past->from = past->aim < newest ? past->aim : newest;
    past->works = true;
    if (!again || past->aim == 0 || past->aim > newest)
        return;
    past->from = past->aim > 2 ? past->aim - 2 : 0;
    for (int p = 0; p < past_panes(past); p++) {
        rounds_clear(&past->machine[p].rounds);
        past->machine[p].entry = 0;
    }
}

void past_drop(Past *past)
{
    if (past->works)
        past_aim(past, past->step, false);
}

/* ---- what is done -------------------------------------------------------- */

/* All machines stand at the step that is shown. */
static Status settle(Past *past)
{
    Status status;
    past_aim(past, past->step, false);
    do
        status = past_iterate(past);
    while (status == STATUS_RUNNING);
    return status;
}

/* The branch that could not begin goes, or the one that begins anew. */
static void pop_branch(Past *past)
{
    past->works = false;
    past->now--;
    drop_branches(past, past->now + 1);
    if (past->now >= 0)
        past->step = past->branch[past->now].shown;
}

/* A simulation at step 0, and its entry. */
static Status begin_pane(Past *past, int pane, const Options *options)
{
    Machine *machine = &past->machine[pane];
    Entry *entry = &past->branch[past->now].entry[pane];
    Status status = make_simulation(past, pane, options);
    Control *control = status ? NULL : control_of(&machine->simulation);
    if (!control)
        return status ? status : STATUS_OUT_OF_MEMORY;
    control->options = *options;
    *entry =
        (Entry){.number = ++past->numbers, .control = control, .substeps = 1};
    machine->control = control_keep(control);
    machine->outcome = (Outcome){.status = machine->simulation.status};
    rounds_clear(&machine->rounds);
    machine->rounds.step = 0;
    stand(past, pane, 0);
    return keep_state(past, pane);
}

Status past_begin(Past *past, const Options *options, int panes, int gesture,
                  const Command *edit)
{
    Options own[OPTIONS_MAX_PANES];
    memcpy(own, options, (size_t)panes * sizeof *own); /* their branch may go */
    stop_work(past);
    const Branch *now = past->now > 0 ? &past->branch[past->now] : NULL;
    if (now && gesture && now->gesture == gesture && now->fresh)
        pop_branch(past);
    if (!push_branch(past, true, 0, panes, edit, gesture))
        return STATUS_OUT_OF_MEMORY;
    Status status = STATUS_OK;
    for (int p = 0; p < panes && !status; p++)
        status = begin_pane(past, p, &own[p]);
    if (!status)
        return status;
    pop_branch(past);
    if (past->now >= 0)
        past_aim(past, past->step, false);
    return status;
}

/* Whether a change makes sense here; message [size] out: why not. */
static Status check_edit(const Simulation *simulation, const Command *edit,
                         char *message, size_t size)
{
    double at[SCENE_MAX_HANDLES][2];
    Switch part[SCENE_MAX_SWITCHES];
    const char *what = "node";
    long limit = LONG_MAX;
    message[0] = '\0';
    if (edit->kind == COMMAND_HANDLE) {
        what = "point to drag";
        limit = exhibit_handles(simulation, at);
    } else if (edit->kind == COMMAND_FLIP) {
        what = "switch";
        limit = exhibit_switches(simulation, part);
    } else if (edit->kind == COMMAND_PIN || edit->kind == COMMAND_GRAB) {
        limit = simulation->system.nodes;
    }
    if (edit->number >= 0 && edit->number < limit)
        return STATUS_OK;
    if (limit > 0)
        snprintf(message, size, "there is no %s %ld, they are 0 ... %ld", what,
                 edit->number, limit - 1);
    else
        snprintf(message, size, "there is no %s here", what);
    return STATUS_INVALID_INPUT;
}

/* The control after a change, for one user more.  NULL: no memory. */
static const Control *changed(const Control *from, const Command *edit)
{
    Control *control = control_copy(from);
    if (!control)
        return NULL;
    if (edit->kind == COMMAND_SET)
        control->options.number[option_rows[edit->number].slot] = edit->x;
    if (edit->kind == COMMAND_PIN)
        control_pin(control, (int)edit->number, edit->x != 0);
    if (edit->kind == COMMAND_GRAB)
        control->hand = (int)edit->number;
    if (edit->kind == COMMAND_RELEASE)
        control->hand = -1;
    if (edit->kind == COMMAND_GRAB || edit->kind == COMMAND_DRAG) {
        control->at[0] = edit->x;
        control->at[1] = edit->y;
    }
    return control;
}

/* A change of the newest entry, where the machine of its pane stands; NULL: of
 * other panes' alone.
 *   joins  it is not the first of this branch */
static Status change_entry(Past *past, int pane, const Command *edit,
                           bool joins)
{
    Machine *machine = &past->machine[pane];
    int panes = past_panes(past);
    Entry *entry = entry_of(past, pane, past->step);
    bool changed_before = joins && (past->branch[past->now].count == 1 ||
                                    entry->control != entry[-panes].control);
    const Control *control =
        edit ? changed(entry->control, edit) : control_keep(entry->control);
    if (!control)
        return STATUS_OUT_OF_MEMORY;
    control_drop(entry->control);
    entry->control = control;
    entry->substeps += entry->substeps == 0; /* it may go on again */
    stand(past, pane, past->step);
    Status status = use_control(machine, control);
    if (edit) /* the state that it was is no longer drawn */
        cut_curves(past_curves(past, pane), past->step - 1,
                   nextafter(entry->outcome.time, -INFINITY));
    if (edit && !status) {
        bool drags = edit->kind == COMMAND_HANDLE;
        bool flips = edit->kind == COMMAND_FLIP;
        bool pulls = edit->kind == COMMAND_GRAB || edit->kind == COMMAND_DRAG ||
                     edit->kind == COMMAND_RELEASE;
        entry->placed =
            entry->placed || drags || flips || (changed_before && !pulls);
        if (drags)
            exhibit_drag(&machine->simulation, (int)edit->number, edit->x,
                         edit->y);
        if (flips)
            exhibit_flip(&machine->simulation, (int)edit->number);
    }
    return status ? status : keep_state(past, pane);
}

/* Entry 0 of a new branch, and what the entry behind it is to have: both as
 * they were, with a change or without. */
static Status change_both(Past *past, int pane, const Command *edit)
{
    Branch *branch = &past->branch[past->now];
    Entry *entry = &branch->entry[pane];
    const Control *old = entry->control;
    const Control *later =
        entry_in(past, past->now - 1, branch->source[pane], branch->first + 1)
            ->control;
    branch->second[pane] = edit ? changed(later, edit) : control_keep(later);
    entry->control = edit ? changed(old, edit) : control_keep(old);
    bool lacking = !entry->control || !branch->second[pane];
    if (!entry->control)
        entry->control = control_keep(old);
    control_drop(old);
    return lacking ? STATUS_OUT_OF_MEMORY : STATUS_OK;
}

Status past_edit(Past *past, const Command *edit, int from, int to, bool again,
                 int gesture, char *message, size_t size)
{
    int panes = past_panes(past);
    const Branch *now = &past->branch[past->now];
    Status status = settle(past);
    for (int p = from; p < to && !status; p++)
        status = check_edit(&past->machine[p].simulation, edit, message, size);
    if (status)
        return status;
    bool joins = gesture && now->gesture == gesture && !again &&
                 past->step == past_newest(past);
    if (joins) /* those that were undone went on from what it was */
        drop_branches(past, past->now + 1);
    else if (!push_branch(past, false, past->step - again, panes, edit,
                          gesture))
        return STATUS_OUT_OF_MEMORY;
    for (int p = 0; p < panes && !status; p++) {
        const Command *own = p >= from && p < to ? edit : NULL;
        if (again)
            status = change_both(past, p, own);
        else if (own || !joins)
            status = change_entry(past, p, own, joins);
    }
    return status;
}

Status past_set_panes(Past *past, int panes, int gesture, const Command *edit)
{
    Status status = settle(past);
    if (!status && !push_branch(past, false, past->step, panes, edit, gesture))
        status = STATUS_OUT_OF_MEMORY;
    if (!status)
        past_aim(past, past->step, false);
    return status;
}

/* Whether the branch above it is of the same gesture. */
static bool is_continued(const Past *past, int b)
{
    int gesture = past->branch[b].gesture;
    return gesture && gesture == past->branch[b + 1].gesture;
}

const Command *past_undo(Past *past, int way, long *fork)
{
    int from = past->now, to = from + way;
    if (to < 0 || to >= past->branches)
        return NULL;
    while (way < 0 && to > 0 && is_continued(past, to))
        to--;
    while (way > 0 && to + 1 < past->branches && is_continued(past, to))
        to++;
    int low = way < 0 ? to : from, high = way < 0 ? from : to;
    *fork = LONG_MAX;
    for (int b = low + 1; b <= high; b++) {
        long first = past->branch[b].fresh ? -1 : past->branch[b].first;
        *fork = first < *fork ? first : *fork;
    }
    stop_work(past);
    past->branch[from].shown = past->step;
    past->now = to;
    Branch *branch = &past->branch[to];
    for (int p = 0; p < branch->panes; p++)
        if (!branch->curves[p])
            branch->curves[p] = copy_curves(NULL);
    past->step = branch->shown;
    past_aim(past, branch->shown, false);
    return &past->branch[high].edit;
}

void past_create(bool keeps, bool goes_on, Past *past)
{
    *past = (Past){
        .now = -1, .keeps = keeps, .goes_on = goes_on, .limit = PAST_BYTES};
}

void past_free(Past *past)
{
    drop_branches(past, 0);
    free(past->branch);
    past->branch = NULL;
    past->room = 0;
    for (int p = 0; p < OPTIONS_MAX_PANES; p++) {
        free_simulation(&past->machine[p]);
        rounds_free(&past->machine[p].rounds);
        free(past->machine[p].records.row);
        past->machine[p].records = (Records){0};
    }
    past->now = -1;
}
