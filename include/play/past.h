/* past.h - all steps and edits of up to OPTIONS_MAX_PANES panes side by side.
 *
 * A step is a pure function: state and control of entry k give the state of
 * entry k+1.  Therefore states can be dropped and made again with the same
 * bits; going back and forward, undo, panes and tables only read the past.
 *
 *   branch 0   0--1--2--3--4--5--6     started from options
 *   branch 1            3'-4'-5'       changed at 3 by a pin; 4 ... 6 stay
 *   branch 2               4"-5"       key P at 5': step 5 made again from 4'
 *
 * Branches are a stack.  Undo returns to the branch below, at the step where
 * the user left it; redo returns to the branch above; an edit drops the
 * branches above the present one.
 * An entry has the state after its step, and the control with which the next
 * step is made (control_apply).  A branch begins with a new control at a state
 * of the branch below.  Where several branches begin at one step, the control
 * of the topmost one counts.  A start, a dragged point, a placed node and a
 * flipped switch set a new state, which the branch stores.
 *
 * To show a step, each pane loads the nearest stored state up to that step, and
 * makes the steps from there once more (past_continue_work).  A short step of
 * Newton's method is made once more although its state is stored, to show its
 * iterates.  The panes share their time and count of steps.  In a step the pane
 * with the longest time step makes one time step, the other panes as many as
 * fit into it.  A pane that cannot make its part ends; the others go on. */
#pragma once

#include "play/command.h"
#include "play/step_trace.h"
#include "simulation/control.h"

/* Bytes for states and samples; beyond them every second state is dropped. */
#define PAST_BYTES ((size_t)256 << 20)

/* Largest max_coordinate of a drawn step, as a multiple of step 1's. */
#define PAST_EXPLODED 10

enum { ALL_PANES = -1 }; /* past_edit edits each pane */

/* A stored state, which entries of several branches can share. */
typedef struct SavedState {
    int ref_count;              /* number of entries that share the state */
    size_t size;                /* bytes of memory, with this struct */
    bool is_set_by_user;        /* set by the user, not made by a step */
    const UserControl *control; /* control under which the state was saved */
    unsigned char bytes[];      /* the state (state_save) */
} SavedState;

/* A point of the plots over time. */
typedef struct EnergySample {
    double time; /* s */
    int energy_count;
    Energy energy[MAX_HISTORY_SERIES]; /* [energy_count] */
} EnergySample;

/* The summary of a step, which outlives its iterations. */
typedef struct StepOutcome {
    int updates;          /* number of Newton's updates in all substeps */
    Status status;        /* last status other than OK in the substeps, or OK */
    double energy_change; /* change of the minimised E in the step, J s^2 */
    double max_coordinate; /* largest |coordinate| of a node in run 0, m */
} StepOutcome;

/* A step that a pane has made. */
typedef struct PastEntry {
    /* Control of the next step; NULL while a new step is being made. */
    const UserControl *next_control;
    SavedState *state;    /* state after the step; NULL: not stored */
    EnergySample *sample; /* energies under the entry's control, or NULL */
    /* Number of steps of the simulation in this step of the panes, 1 at step 0.
     * 0: the
     * scene is over, or the pane has ended with the failure in `outcome`. */
    int substep_count;
    StepOutcome outcome;
} PastEntry;

/* Entries of all panes from one step on. */
typedef struct Branch {
    bool begins_runs;  /* starts from options, not from the branch below */
    long first_step;   /* step of entry 0 */
    long entry_count;  /* number of entries, at least 1 */
    long capacity;     /* entries that memory is reserved for */
    int copied_count;  /* number of entries from the branch below, 0 ... 2 */
    long left_at_step; /* step that was shown when the user left the branch */
    long stride;       /* every stride-th entry stores its state */
    int panes;         /* number of panes */
    PastEntry *entry;  /* [capacity][panes]; entry[entry_count] is being made */
    int gesture_id;    /* id; a gesture is undone as a whole; 0: none */
    Command edit;      /* edit that began the branch */
} Branch;

/* The simulation of a pane, and its position in the present branch. */
typedef struct PastPane {
    Simulation simulation;
    const UserControl *start_control; /* control at step 0; NULL: no run */
    const UserControl *control;       /* control of the simulation */
    bool has_state;            /* the simulation has the state of `step` */
    long step;                 /* last step that the pane has finished */
    bool is_in_substep;        /* a step of the simulation has begun */
    int substep_count;         /* steps of the simulation since `step` */
    long steps_before_substep; /* steps of the simulation before this substep */
    StepOutcome outcome;       /* outcome of the present step, or of the last */
    bool has_failed;           /* the step after `step` could not be made */
    StepTrace trace;           /* iterates of the last step that was made */
    bool has_trace;            /* `trace` is of `step` or of the failed step */
    NewtonRecords newton_records; /* records of the last step, for the log */
} PastPane;

/* Stages of the work that leads to the step that is to be shown. */
typedef enum WorkStage {
    WORK_DONE,       /* no work is left: goal_step is shown */
    WORK_LOADING,    /* the panes load stored states */
    WORK_REPEATING,  /* known steps are made once more */
    WORK_MAKING,     /* a new step is made; no pane has finished its part */
    WORK_PARTLY_MADE /* a pane has finished its part of the new step */
} WorkStage;

typedef struct Past {
    Branch *branch; /* [branch_count] branches from the bottom of the stack */
    int branch_count, capacity; /* number of branches; room for branches */
    int branch_index; /* index of the present branch; higher ones are undone */
    long shown_step;  /* step that is shown in all panes */
    PastPane pane[OPTIONS_MAX_PANES];
    bool stores_states;    /* states are stored: the user may go back */
    bool panes_fail_alone; /* a pane that fails ends alone; the others go on */
    long written_step;     /* last step with valid rows in the tables, or -1 */
    long energies_step;    /* last step with valid energies in the tables */
    size_t used_bytes, max_bytes; /* memory of states and samples, limit */
    int line_energy_pane; /* pane in which E(x + alpha p) is drawn; -1: none */
    WorkStage work_stage; /* stage of the work that leads to `goal_step` */
    long goal_step;       /* step that is to be shown */
    long step_to_load;    /* step to which WORK_LOADING brings the panes */
    bool samples_line_energy; /* every iteration samples E(x + alpha p) */
    double step_end_time;     /* end of the new step, s */
    Status bad_status; /* last status other than OK in the new step, or OK */
} Past;

/* Whether work is left before goal_step is shown. */
static inline bool past_is_working(const Past *past)
{
    return past->work_stage != WORK_DONE;
}

/* Whether a new step is being made. */
static inline bool past_makes_step(const Past *past)
{
    return past->work_stage >= WORK_MAKING;
}

void past_create(bool stores_states, bool panes_fail_alone, Past *past);
void past_free(Past *past);

/* Begins new runs side by side at step 0.  Returns as simulation_create; if a
 * simulation could not be created, past_continue_work leads back to the step
 * that was shown. */
Status past_begin_runs(Past *past, const Options *options, int panes,
                       int gesture, const Command *edit);

/* Edits the shown step in a new branch; the branch below keeps the old steps.
 *   edit     in, checked by the caller: COMMAND_SET with a row of the options
 *            and its number x or its text; COMMAND_PIN with a node, x = 1 to
 *            pin it and 0 to free it; COMMAND_GRAB with a node, COMMAND_PUSH
 *            with an obstacle, each with the place of the hand, m;
 *            COMMAND_DRAG, COMMAND_RELEASE, COMMAND_PLACE, COMMAND_OBSTACLE,
 *            COMMAND_HANDLE, COMMAND_FLIP; COMMAND_ADD_PANE adds a pane with
 *            the past of the last one, COMMAND_END_PANE removes the last one
 *   pane     pane that is edited; ALL_PANES: each pane
 *   again    the branch begins one step earlier: past_set_goal then leads to
 *            the shown step, made once more with the edit
 *   gesture  id, or 0; edits of one gesture are undone together
 * Returns OK, OUT_OF_MEMORY. */
Status past_edit(Past *past, const Command *edit, int pane, bool again,
                 int gesture);

/* Sets goal_step, cut to 0 ... newest + 1; abandons the present work.
 *   again  the step is made once more, with samples of E in each iteration */
void past_set_goal(Past *past, long step, bool again);

/* Does a part of the work: makes a Newton iteration, or begins a step.  Returns
 * RUNNING while work is left, OK or an unconverged status when goal_step is
 * shown, or the status of a failure: the last whole step is shown then. */
Status past_continue_work(Past *past);

/* Repeats past_continue_work until it returns another status than RUNNING. */
Status past_finish_work(Past *past);

/* Undoes one gesture (-1) or redoes one (1); past_continue_work then shows the
 * step. Returns the edit that was undone or redone, or NULL. */
const Command *past_undo_or_redo(Past *past, int way);

int past_count_panes(const Past *past);

/* Returns the newest step; a step that is being made does not count. */
long past_find_newest(const Past *past);

/* Returns the entry of a step; NULL: the step is not made yet. */
const PastEntry *past_find_entry(const Past *past, int pane, long step);

/* Returns the control with which the step after the shown step is made. */
const UserControl *past_get_control(const Past *past, int pane);

/* Returns the control with which the run was started. */
const UserControl *past_get_start_control(const Past *past, int pane);

/* Returns the last step up to `step` that a pane has made: an earlier one if a
 * failure has ended the pane before. */
long past_find_made_step(const Past *past, int pane, long step);

/* Returns the last step up to `step` that can be drawn (PAST_EXPLODED). */
long past_find_drawable_step(const Past *past, int pane, long step);

/* Fills the energies over time that plots of a pane show. */
void past_fill_history(const Past *past, int pane, History *history);
