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

/* The step of the newest entry, one that is being made included. */
static long newest_entry(const Past *past)
{
    const Branch *branch = &past->branch[past->now];
    return branch->first + branch->count - 1;
}

long past_newest(const Past *past)
{
    return newest_entry(past) - past->making;
}

/* The entry of a step as a branch sees it: its own, or one below.
 *   branch, pane  in and out, whose it is */
static Entry *entry_below(const Past *past, long step, int *branch, int *pane)
{
    const Branch *at = &past->branch[*branch];
    while (step < at->first && !at->fresh) {
        *pane = at->source[*pane];
        at = &past->branch[--*branch];
    }
    long i = step - at->first;
    return i < 0 || i >= at->count ? NULL : &at->entry[i * at->panes + *pane];
}

/* As the present one does. */
static Entry *find_entry(const Past *past, long step, int *branch, int *pane)
{
    *branch = past->now;
    return entry_below(past, step, branch, pane);
}

static Entry *entry_of(const Past *past, int pane, long step)
{
    int branch;
    return find_entry(past, step, &branch, &pane);
}

const Entry *past_entry(const Past *past, int pane, long step)
{
    return entry_of(past, pane, step);
}

const Control *past_control(const Past *past, int pane)
{
    return entry_of(past, pane, past->step)->control;
}

const Control *past_start(const Past *past, int pane)
{
    const Branch *at = &past->branch[past->now];
    for (; !at->fresh; at--)
        pane = at->source[pane];
    return at->entry[pane].control;
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

Curves *past_curves(const Past *past, int pane)
{
    return (Curves *)&past->machine[pane].curves;
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

/* Lets go of the newest entries of the present branch. */
static void drop_newest(Past *past)
{
    Branch *branch = &past->branch[past->now];
    branch->count--;
    for (int p = 0; p < branch->panes; p++)
        drop_entry(past, &branch->entry[branch->count * branch->panes + p]);
}

/* One more entry a pane.  Where nobody goes back the last two are enough. */
static Status add_entries(Past *past, Branch *branch)
{
    size_t row = (size_t)branch->panes * sizeof(Entry);
    if (!past->keeps && branch->count == 2) {
        for (int p = 0; p < branch->panes; p++)
            drop_entry(past, &branch->entry[p]);
        memmove(branch->entry, branch->entry + branch->panes, row);
        branch->first++;
        branch->count--;
    }
    if (branch->count == branch->room) {
        long room = branch->room ? 2 * branch->room : 4;
        Entry *entry = realloc(branch->entry, (size_t)room * row);
        if (!entry)
            return STATUS_OUT_OF_MEMORY;
        branch->entry = entry;
        branch->room = room;
    }
    memset(branch->entry + branch->count * branch->panes, 0, row);
    branch->count++;
    return STATUS_OK;
}

/* Every second kept state of the branch with the finest ones goes; at last that
 * of its first entry, too, if there is a branch below.  The branch that is
 * shown comes last. */
static bool thin_states(Past *past)
{
    Branch *finest = NULL;
    for (int b = 0; b < past->branches; b++) {
        Branch *branch = &past->branch[b];
        bool finer = !finest || branch->stride < finest->stride ||
                     (branch->stride == finest->stride && b != past->now);
        if (branch->stride < branch->count + !branch->fresh && finer)
            finest = branch;
    }
    if (!finest)
        return false;
    finest->stride *= 2;
    bool all = !finest->fresh && finest->stride > finest->count;
    for (long i = 0; i < finest->count * finest->panes; i++)
        if ((all || i / finest->panes % finest->stride) &&
            !finest->entry[i].placed)
            drop_state(past, &finest->entry[i]);
    return true;
}

/* The machine's state for the entry where it stands, if that one keeps it.
 * Memory that is not there makes the past coarser; it is no failure but for the
 * first one. */
static Status keep_state(Past *past, int pane)
{
    Machine *machine = &past->machine[pane];
    Branch *branch = &past->branch[machine->branch];
    long i = machine->step - branch->first;
    Entry *entry = &branch->entry[i * branch->panes + machine->pane];
    size_t size = past->keeps ? state_bytes(&machine->simulation) : 0;
    drop_state(past, entry);
    if (size == 0)
        return STATUS_OK;
    while (past->bytes + size > past->limit && thin_states(past))
        continue;
    if ((i % branch->stride || branch->stride > branch->count) &&
        !entry->placed)
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

/* ---- branches ------------------------------------------------------------ */

static void drop_branch(Past *past, Branch *branch)
{
    for (long i = 0; i < branch->count * branch->panes; i++)
        drop_entry(past, &branch->entry[i]);
    for (int p = 0; p < OPTIONS_MAX_PANES; p++) {
        control_drop(branch->then[p]);
        free(branch->curves[p]);
    }
    free(branch->entry);
    *branch = (Branch){0};
}

/* Branches from this one on go. */
static void drop_branches(Past *past, int from)
{
    while (past->branches > from)
        drop_branch(past, &past->branch[--past->branches]);
}

/* No machine stands anywhere any more. */
static void lose_machines(Past *past)
{
    for (int p = 0; p < OPTIONS_MAX_PANES; p++)
        past->machine[p].step = -1;
}

/* Room for one more branch, in the place of those that were undone. */
static Status make_room(Past *past)
{
    drop_branches(past, past->now + 1);
    if (past->branches < past->room)
        return STATUS_OK;
    int room = past->room ? 2 * past->room : 16;
    Branch *grown = realloc(past->branch, (size_t)room * sizeof *grown);
    if (!grown)
        return STATUS_OUT_OF_MEMORY;
    past->branch = grown;
    past->room = room;
    return STATUS_OK;
}

/* The present branch is left, and can be come back to; the curves of those that
 * were left long ago are no longer known then. */
static void leave_branch(Past *past)
{
    enum { LONG_AGO = 16 }; /* branches */
    Branch *branch = &past->branch[past->now];
    branch->left = past->step;
    for (int p = 0; past->now >= LONG_AGO && p < OPTIONS_MAX_PANES; p++) {
        free(branch[-LONG_AGO].curves[p]);
        branch[-LONG_AGO].curves[p] = NULL;
    }
    for (int p = 0; p < branch->panes; p++) {
        if (!branch->curves[p])
            branch->curves[p] = malloc(sizeof *branch->curves[p]);
        if (branch->curves[p])
            *branch->curves[p] = past->machine[p].curves;
    }
}

static void clear_curves(Curves *curves)
{
    history_clear(&curves->history);
    curves->sampled = -1;
}

/* Curves forget what came after this step. */
static void cut_curves(Curves *curves, long step, double time)
{
    if (curves->sampled <= step)
        return;
    history_cut(&curves->history, time);
    curves->sampled = step;
}

/* A branch on top of the present one, with one entry.  NULL: no memory. */
static Branch *push_branch(Past *past, bool fresh, long first, int panes,
                           const Command *edit, int gesture)
{
    Branch *branch = &past->branch[past->branches];
    *branch = (Branch){.fresh = fresh,
                       .first = first,
                       .stride = 1,
                       .panes = panes,
                       .gesture = gesture,
                       .edit = *edit};
    if (add_entries(past, branch)) {
        free(branch->entry);
        return NULL;
    }
    if (past->branches > 0)
        leave_branch(past);
    past->runs += fresh;
    branch->run = fresh ? past->runs : past->branch[past->now].run;
    int below = past->branches > 0 ? past->branch[past->now].panes : 0;
    for (int p = 0; p < panes; p++) {
        branch->source[p] = p < below ? p : below - 1;
        if (p >= below && !fresh)
            past->machine[p].curves = past->machine[below - 1].curves;
    }
    for (int p = 0; p < panes && !fresh; p++) {
        const Entry *entry = past_entry(past, branch->source[p], first);
        branch->entry[p].control = control_keep(entry->control);
        branch->entry[p].substeps = entry->substeps;
        branch->entry[p].outcome = entry->outcome;
        cut_curves(&past->machine[p].curves, first, entry->outcome.time);
    }
    past->now = past->branches++;
    past->step = past->aim = first;
    return branch;
}

/* ---- machines ------------------------------------------------------------ */

double machine_time(const Machine *machine)
{
    return simulation_time(&machine->simulation);
}

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
    if (!machine->stepping)
        return true;
    machine->outcome.updates += record->iteration >= 0;
    if (machine->simulation.scene->step) /* an update is a step */
        machine->outcome.change = record->change;
    const Newton *newton = listened_to(&machine->simulation);
    if (newton && machine->rounds.step > 0)
        rounds_add(&machine->rounds, newton, record);
    Records *records = &machine->records;
    if (records->count == records->room) {
        int room = records->room ? 2 * records->room : 64;
        NewtonRecord *grown =
            realloc(records->row, (size_t)room * sizeof *grown);
        if (!grown)
            return true;
        records->row = grown;
        records->room = room;
    }
    records->row[records->count++] = *record;
    return true;
}

static void free_simulation(Machine *machine)
{
    simulation_free(&machine->simulation);
    control_drop(machine->control);
    machine->control = NULL;
    machine->run = 0;
    machine->step = -1;
    machine->stepping = machine->failed = machine->known = false;
    machine->substeps = 0;
    machine->records.count = 0;
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
    machine->run = past->branch[past->now].run;
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
    find_entry(past, step, &machine->branch, &pane);
    machine->pane = pane;
}

static bool stands(const Past *past, int pane, long step)
{
    const Machine *machine = &past->machine[pane];
    int branch;
    return machine->step == step &&
           machine->run == past->branch[past->now].run &&
           find_entry(past, step, &branch, &pane) &&
           machine->branch == branch && machine->pane == pane;
}

/* The entry whose state leads to this step: its own, or where a branch begins
 * that of the branch below; NULL: none is kept. */
static const Entry *kept_entry(const Past *past, int pane, long step)
{
    int b;
    const Entry *entry = find_entry(past, step, &b, &pane);
    while (entry && !entry->state && !past->branch[b].fresh &&
           step == past->branch[b].first) {
        pane = past->branch[b--].source[pane];
        entry = entry_below(past, step, &b, &pane);
    }
    return entry && entry->state ? entry : NULL;
}

/* The machine to where it can make its way to this step from. */
static Status load(Past *past, int pane, long goal)
{
    Machine *machine = &past->machine[pane];
    const Entry *kept = kept_entry(past, pane, goal);
    long from = goal;
    while (!kept && from > 0)
        kept = kept_entry(past, pane, --from);
    bool near = machine->step >= from || machine->step >= goal - 1;
    if (near && machine->step <= goal && stands(past, pane, machine->step))
        return STATUS_OK;
    if (!kept)
        return STATUS_OUT_OF_MEMORY;
    Status status = STATUS_OK;
    if (machine->run != past->branch[past->now].run)
        status = make_simulation(past, pane, &past_start(past, pane)->options);
    if (!status)
        status = use_control(machine, kept->control);
    if (status)
        return status;
    state_restore(kept->state->bytes, &machine->simulation);
    machine->known = machine->failed = false;
    machine->outcome = kept->outcome;
    machine->substeps = 0;
    stand(past, pane, from);
    return use_control(machine, past_entry(past, pane, from)->control);
}

/* ---- steps --------------------------------------------------------------- */

/* Where the pane with the longest timestep will be, s. */
static double next_time(const Past *past)
{
    double pace = -1, time = 0;
    for (int p = 0; p < past_panes(past); p++) {
        const Machine *machine = &past->machine[p];
        if (has_failed(past_entry(past, p, machine->step)) ||
            machine_pace(machine) <= pace)
            continue;
        pace = machine_pace(machine);
        time = machine_time(machine);
    }
    return time + pace;
}

/* What is told of the step that was made. */
static void sum_up(Machine *machine, Status status)
{
    const Simulation *simulation = &machine->simulation;
    Outcome *outcome = &machine->outcome;
    outcome->status = status ? status : outcome->status;
    outcome->time = machine_time(machine);
    outcome->extent = 0;
    for (int i = 0; i < 2 * simulation->system.nodes; i++)
        outcome->extent = fmax(outcome->extent, fabs(simulation->run[0].x[i]));
    for (int r = 0; r < simulation->runs && !simulation->scene->step; r++)
        if (simulation->run[r].newton)
            outcome->change += simulation->run[r].newton->change;
}

/* The machine has come to the entry behind the one where it stood. */
static Status arrive(Past *past)
{
    int pane = past->pane;
    Machine *machine = &past->machine[pane];
    const Entry *from = past_entry(past, pane, machine->step);
    Entry *to = entry_of(past, pane, machine->step + 1);
    Branch *branch = &past->branch[past->now];
    bool fresh = !to->control;
    if (fresh) {
        const Control *then = branch->then[pane];
        bool second = machine->step == branch->first && then;
        to->control = control_keep(second ? then : from->control);
        to->substeps = machine->substeps;
        to->outcome = machine->outcome;
    }
    past->moved = past->moved || machine->substeps > 0;
    machine->substeps = 0;
    stand(past, pane, machine->step + 1);
    Status status = use_control(machine, to->control);
    if (!status && fresh)
        status = keep_state(past, pane);
    else if (!status && to->placed)
        state_restore(to->state->bytes, &machine->simulation);
    return status ? status : STATUS_RUNNING;
}

/* The pane that failed beside others goes back to its last state that can be
 * seen; from there on it stands still. */
static void end_pane(Past *past, int pane, Status status)
{
    Branch *branch = &past->branch[past->now];
    Machine *machine = &past->machine[pane];
    long last = past_last_seen(past, pane, machine->step, branch->first);
    const Entry *good = past_entry(past, pane, last);
    cut_curves(&machine->curves, last, good->outcome.time);
    for (long step = last + 1; step <= newest_entry(past); step++) {
        Entry *entry = entry_of(past, pane, step);
        int updates = entry->outcome.updates;
        drop_entry(past, entry);
        *entry = (Entry){.control = control_keep(good->control),
                         .outcome = good->outcome};
        entry->outcome.updates = updates;
        entry->outcome.status = status;
    }
    machine->step = -1;
    machine->substeps = 0;
    /* What an explosion has made of the energies would flatten those of
     * others. */
    History *history = &machine->curves.history;
    while (history->count > 1 && history->value[0][history->count - 1] >
                                     PAST_EXPLODED * fabs(history->value[0][0]))
        history_cut(history, history->time[history->count - 2]);
}

/* Work that is under way ends; the last whole step stays, but machines that
 * have left it stand at none. */
static void stop_work(Past *past)
{
    if (!past->works)
        return;
    for (int p = 0; p < past_panes(past); p++) {
        Machine *machine = &past->machine[p];
        if (machine->stepping || machine->substeps > 0)
            machine->step = -1;
        machine->stepping = false;
        machine->substeps = 0;
    }
    if (past->making) {
        drop_newest(past);
        for (int p = 0; p < past_panes(past); p++)
            if (past->machine[p].step > newest_entry(past))
                past->machine[p].step = -1;
    }
    past->making = past->works = past->again = false;
}

/* Whether it is the computer that cannot go on. */
static bool lacks(Status status)
{
    return status == STATUS_OUT_OF_MEMORY || status == STATUS_TOO_LARGE;
}

/* A step could not be made. */
static Status fail(Past *past, Status status)
{
    Machine *machine = &past->machine[past->pane];
    if (past->making && past->goes_on && past_panes(past) > 1 &&
        !lacks(status)) {
        end_pane(past, past->pane, status);
        past->moved = true;
        past->worst = status;
        return STATUS_RUNNING;
    }
    stop_work(past);
    if (!lacks(status) && machine->run) {
        machine->failed = machine->known = true;
        machine->outcome.status = status;
    }
    if (past->keeps) /* some of its runs may have made the step */
        machine->step = -1;
    past->aim = past->step;
    return status;
}

/* A step of the simulation goes on, or is over. */
static Status stepped(Past *past, Status status)
{
    int pane = past->pane;
    Machine *machine = &past->machine[pane];
    const Simulation *simulation = &machine->simulation;
    const Entry *to = past_entry(past, pane, machine->step + 1);
    if (status == STATUS_RUNNING)
        return status;
    machine->stepping = false;
    if (past->keeps && rounds_end(&machine->rounds, &simulation->options))
        return fail(past, STATUS_OUT_OF_MEMORY);
    bool moved = simulation->steps > machine->before;
    sum_up(machine, status);
    if (status && !moved && (lacks(status) || !simulation->done))
        return fail(past, status);
    machine->known = past->keeps;
    machine->substeps += moved;
    if (past->making && status)
        past->worst = status;
    bool more = to->control
                    ? machine->substeps < to->substeps
                    : moved && (simulation->scene->needs & NEEDS_TIME) &&
                          machine_time(machine) + 0.5 * machine_pace(machine) <
                              past->target;
    return more ? STATUS_RUNNING : arrive(past);
}

/* One step of the simulation begins, where the pane makes any. */
static Status begin_step(Past *past)
{
    int pane = past->pane;
    Machine *machine = &past->machine[pane];
    const Entry *from = past_entry(past, pane, machine->step);
    const Entry *to = past_entry(past, pane, machine->step + 1);
    if (machine->substeps == 0) {
        machine->outcome = (Outcome){.time = machine_time(machine)};
        machine->records.count = 0;
        machine->failed = machine->known = false;
    }
    if (to->control ? to->substeps == 0 : has_failed(from)) {
        machine->outcome = to->control ? to->outcome : from->outcome;
        machine->outcome.updates = 0;
        return arrive(past);
    }
    if (past->keeps && rounds_begin(&machine->rounds, &machine->simulation))
        return fail(past, STATUS_OUT_OF_MEMORY);
    machine->before = machine->simulation.steps;
    machine->stepping = true;
    return stepped(past, simulation_begin(&machine->simulation));
}

/* All panes have come as far as they know the way: the aim is reached, or a new
 * step begins. */
static Status end_turn(Past *past)
{
    long newest = newest_entry(past);
    if (!past->making && past->aim > newest) {
        past->target = next_time(past);
        past->pane = 0;
        past->making = true;
        past->moved = false;
        past->worst = STATUS_OK;
        if (add_entries(past, &past->branch[past->now])) {
            past->making = false;
            return fail(past, STATUS_OUT_OF_MEMORY);
        }
        return STATUS_RUNNING;
    }
    Status worst = past->making ? past->worst : STATUS_OK;
    if (past->making && !past->moved) { /* all scenes are at their end */
        drop_newest(past);
        for (int p = 0; p < past_panes(past); p++)
            stand(past, p, newest - 1);
        past->aim = newest - 1;
    }
    past->making = past->works = past->again = false;
    past->step = past->aim;
    return worst;
}

Status past_iterate(Past *past)
{
    if (!past->works)
        return STATUS_OK;
    Machine *machine = &past->machine[past->pane];
    if (machine->stepping) {
        const Newton *newton = listened_to(&machine->simulation);
        if (newton && past->keeps)
            rounds_look(&machine->rounds, newton);
        return stepped(past, simulation_iterate(&machine->simulation));
    }
    /* Nothing is being computed.  The panes come to the goal one after the
     * other: from the nearest state that is kept, and by steps that are made
     * once more from there.  `making`: the goal's entry is new and has no
     * state yet.  `again`: two steps are made whatever is kept, for the rounds
     * of the last one and of the one before. */
    long newest = newest_entry(past);
    long goal = past->aim < newest ? past->aim : newest;
    long from = past->again ? (goal > 2 ? goal - 2 : 0) : goal;
    for (; past->pane < past_panes(past); past->pane++) {
        machine = &past->machine[past->pane];
        bool under_way =
            machine->substeps > 0 || (past->again && machine->step >= from &&
                                      stands(past, past->pane, machine->step));
        Status status = under_way || (past->making && machine->step == goal)
                            ? STATUS_OK
                            : load(past, past->pane, from);
        if (status)
            return fail(past, status);
        if (machine->step < goal)
            return begin_step(past);
    }
    return end_turn(past);
}

void past_aim(Past *past, long step, bool again)
{
    stop_work(past);
    long most = newest_entry(past) + 1;
    past->aim = step < 0 ? 0 : step > most ? most : step;
    past->works = true;
    past->pane = 0;
    past->again = again && past->aim > 0 && past->aim < most;
    for (int p = 0; p < past_panes(past) && past->again; p++) {
        rounds_clear(&past->machine[p].rounds);
        past->machine[p].step = -1;
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
    Status status = STATUS_RUNNING;
    stop_work(past);
    for (int p = 0; p < past_panes(past); p++)
        past->works = past->works || !stands(past, p, past->step);
    past->pane = 0;
    past->aim = past->step;
    while (past->works && status == STATUS_RUNNING)
        status = past_iterate(past);
    return status == STATUS_RUNNING ? STATUS_OK : status;
}

/* The branch that could not begin goes. */
static void pop_branch(Past *past)
{
    past->now--;
    drop_branches(past, past->now + 1);
    lose_machines(past);
    if (past->now < 0)
        return;
    past->step = past->branch[past->now].left;
    past->works = false;
    past_aim(past, past->step, false);
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
    entry->control = control;
    entry->substeps = 1;
    machine->control = control_keep(control);
    machine->outcome = (Outcome){.status = machine->simulation.status};
    clear_curves(&machine->curves);
    rounds_clear(&machine->rounds);
    machine->rounds.step = 0;
    stand(past, pane, 0);
    return keep_state(past, pane);
}

Status past_begin(Past *past, const Options *options, int panes, int gesture,
                  const Command *edit)
{
    Options
        own[OPTIONS_MAX_PANES]; /* they may be those of a branch that goes */
    memcpy(own, options, (size_t)panes * sizeof *own);
    if (past->branches > 0) {
        stop_work(past);
        const Branch *now = &past->branch[past->now];
        if (gesture && now->gesture == gesture && now->fresh && past->now > 0) {
            pop_branch(past);
            past->works = false;
        }
    }
    Branch *branch = make_room(past)
                         ? NULL
                         : push_branch(past, true, 0, panes, edit, gesture);
    if (!branch)
        return STATUS_OUT_OF_MEMORY;
    Status status = STATUS_OK;
    for (int p = 0; p < panes && !status; p++)
        status = begin_pane(past, p, &own[p]);
    if (status)
        pop_branch(past);
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

/* The control after a change. */
static Status change_control(const Control *from, const Command *edit,
                             const Control **to)
{
    Control *control = control_copy(from);
    if (!control)
        return STATUS_OUT_OF_MEMORY;
    *to = control;
    if (edit->kind == COMMAND_SET)
        control->options.number[option_rows[edit->number].slot] = edit->x;
    if (edit->kind == COMMAND_PIN)
        control_pin(control, (int)edit->number, edit->x != 0);
    if (edit->kind == COMMAND_GRAB)
        control->hand = (int)edit->number;
    if (edit->kind == COMMAND_GRAB || edit->kind == COMMAND_DRAG) {
        control->at[0] = edit->x;
        control->at[1] = edit->y;
    }
    if (edit->kind == COMMAND_RELEASE)
        control->hand = -1;
    return STATUS_OK;
}

/* An entry whose machine stands at it is changed; edit NULL: only its control
 * is another one. */
static Status change_entry(Past *past, int pane, const Control *to,
                           const Command *edit)
{
    Machine *machine = &past->machine[pane];
    Entry *entry = entry_of(past, pane, past->step);
    bool drags = edit && edit->kind == COMMAND_HANDLE;
    bool flips = edit && edit->kind == COMMAND_FLIP;
    double time = entry->outcome.time;
    control_drop(entry->control);
    entry->control = control_keep(to);
    stand(past, pane, past->step);
    Status status = use_control(machine, to);
    entry->placed = entry->placed || drags || flips;
    entry->substeps += entry->substeps == 0; /* it may go on again */
    if (status)
        return status;
    if (drags)
        exhibit_drag(&machine->simulation, (int)edit->number, edit->x, edit->y);
    if (flips)
        exhibit_flip(&machine->simulation, (int)edit->number);
    if (edit) /* the state that it was is no longer drawn */
        cut_curves(&machine->curves, past->step - 1,
                   nextafter(time, -INFINITY));
    return keep_state(past, pane);
}

/* The controls of all panes at a step after a change in some of them. */
static Status change_controls(const Past *past, long step, const Command *edit,
                              int from, int to, const Control *control[])
{
    Status status = STATUS_OK;
    for (int p = 0; p < past_panes(past) && !status; p++) {
        const Control *now = past_entry(past, p, step)->control;
        if (p >= from && p < to)
            status = change_control(now, edit, &control[p]);
        else
            control[p] = control_keep(now);
    }
    return status;
}

/* The change with these controls; then: those of the step that is made again,
 * or NULL. */
static Status make_edit(Past *past, const Command *edit, int from, int to,
                        int gesture, const Control *const control[],
                        const Control *const then[])
{
    int panes = past_panes(past);
    const Branch *now = &past->branch[past->now];
    bool joins = gesture && now->gesture == gesture && !then &&
                 past->step == newest_entry(past);
    if (!joins) {
        Branch *branch = make_room(past)
                             ? NULL
                             : push_branch(past, false, past->step - !!then,
                                           panes, edit, gesture);
        if (!branch)
            return STATUS_OUT_OF_MEMORY;
        for (int p = 0; p < panes && then; p++) {
            branch->then[p] = control_keep(then[p]);
            control_drop(branch->entry[p].control);
            branch->entry[p].control = control_keep(control[p]);
        }
    }
    Status status = STATUS_OK;
    for (int p = 0; p < panes && !then && !status; p++) {
        bool own = p >= from && p < to;
        if (own || !joins)
            status = change_entry(past, p, control[p], own ? edit : NULL);
    }
    return status;
}

Status past_edit(Past *past, const Command *edit, int from, int to, bool again,
                 int gesture, char *message, size_t size)
{
    const Control *control[OPTIONS_MAX_PANES] = {NULL},
                  *then[OPTIONS_MAX_PANES] = {NULL};
    Status status = settle(past);
    for (int p = from; p < to && !status; p++)
        status = check_edit(&past->machine[p].simulation, edit, message, size);
    if (!status)
        status =
            change_controls(past, past->step - again, edit, from, to, control);
    if (!status && again)
        status = change_controls(past, past->step, edit, from, to, then);
    if (!status)
        status = make_edit(past, edit, from, to, gesture, control,
                           again ? then : NULL);
    for (int p = 0; p < OPTIONS_MAX_PANES; p++) {
        control_drop(control[p]);
        control_drop(then[p]);
    }
    return status;
}

Status past_set_panes(Past *past, int panes, int gesture, const Command *edit)
{
    Status status = settle(past);
    if (!status)
        status = make_room(past);
    if (!status && !push_branch(past, false, past->step, panes, edit, gesture))
        status = STATUS_OUT_OF_MEMORY;
    if (!status)
        past_aim(past, past->step, false);
    return status;
}

/* Whether the branch above it is of the same gesture. */
static bool is_continued(const Past *past, int branch)
{
    int gesture = past->branch[branch].gesture;
    return gesture && gesture == past->branch[branch + 1].gesture;
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
    int top = way < 0 ? from : to, low = way < 0 ? to : from;
    bool same = past->branch[from].run == past->branch[to].run;
    *fork = same ? LONG_MAX : -1;
    for (int b = low + 1; b <= top; b++)
        if (past->branch[b].first < *fork)
            *fork = past->branch[b].first;
    stop_work(past);
    leave_branch(past);
    past->now = to;
    Branch *branch = &past->branch[to];
    for (int p = 0; p < branch->panes; p++) {
        clear_curves(&past->machine[p].curves);
        if (branch->curves[p])
            past->machine[p].curves = *branch->curves[p];
    }
    past->step = branch->left;
    past_aim(past, branch->left, false);
    return &past->branch[top].edit;
}

void past_create(bool keeps, bool goes_on, Past *past)
{
    *past = (Past){
        .now = -1, .keeps = keeps, .goes_on = goes_on, .limit = PAST_BYTES};
    lose_machines(past);
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
