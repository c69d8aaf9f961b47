/* past.h - the past: all steps and edits of up to six runs side by side.
 *
 * A step is a pure function: the state of entry k+1 is made of the state and
 * the control of entry k.  So states may be thrown away and made again with the
 * same bits, and all else is reading: back, forward, undo, panes, the walk
 * inside a step, tables.
 *
 *   branch 0   0--1--2--3--4--5--6     started from options (fresh)
 *   branch 1            3'-4'-5'       changed at 3: a pin; 4 ... 6 stay
 *   branch 2               4"-5"       P at 5': step 5 again, made from 4'
 *
 * Branches are a stack.  Undo goes one down, to where that one was left; redo
 * one up; an edit drops those above.
 *
 * An entry's state is what its step left behind; then comes its control, which
 * the next step is made with (control_apply).  A branch begins with another
 * control, and the state is that of the branch below: where several branches
 * begin at one step only the last one's control counts.  A dragged point makes
 * another state, which its branch keeps.
 *
 * To show a step, the machine of each pane takes the nearest state that is kept
 * of that step or one before, and makes the steps from there once more
 * (past_iterate).
 *
 * All panes have one time and one count of steps: a step is one of the pane
 * with the longest timestep, and as many of the others as fit into it.  A pane
 * that cannot make its part ends, and the others go on.
 */
#ifndef ELASTO_PAST_H
#define ELASTO_PAST_H

#include "play/command.h"
#include "play/step_trace.h"
#include "run/control.h"

/* Memory for states, bytes; beyond it states are dropped. */
#define PAST_BYTES ((size_t)256 << 20)

/* Size of a state, relative to that after step 1, beyond which a picture shows
 * nothing of it. */
#define PAST_EXPLODED 10

/* A state, and the samples of it that plots show (picture_sample). */
typedef struct State {
    size_t size; /* bytes, with this struct */
    double time; /* s */
    int rows;
    Energy row[HISTORY_SERIES];
    unsigned char bytes[];
} State;

/* The summary of a step, which is kept without its iterations. */
typedef struct Outcome {
    int updates;   /* number of Newton's updates in all substeps */
    Status status; /* the worst of the substeps */
    double change; /* change of E, J s^2 */
    double extent; /* m, largest coordinate of run 0 */
} Outcome;

/* A step of a pane has the state after it and the control of the next step. */
typedef struct Entry {
    const Control *control; /* NULL: the step is not made yet */
    State *state;           /* before that control; NULL: not kept */
    int substeps;           /* steps of the pane in it.  0: the scene is over;
                               or the outcome says why the pane has ended, and the
                               state is the last one that can be seen */
    Outcome outcome;
} Entry;

typedef struct Branch {
    bool fresh;  /* starts from options, not from the branch below */
    long first;  /* step of its entry 0 */
    long count;  /* entries, at least 1 */
    long room;   /* entries that memory is reserved for; the one behind the last
                    is being made */
    int given;   /* entries whose controls came with the branch: 1, or 2 if it
                    begins before the step that was edited */
    long shown;  /* step that was shown when the branch was left */
    long stride; /* each stride-th state is kept.  Entry 0 has a state of its
                    own in a fresh branch and after a drag */
    int panes;
    int source[OPTIONS_MAX_PANES]; /* pane of the branch below it continues */
    Entry *entry;                  /* [room][panes]; 0 behind the last */
    int gesture;  /* id; edits of one gesture share a branch; 0: none */
    Command edit; /* edit that began the branch */
} Branch;

/* A simulation, which has the state of an entry of the present branch. */
typedef struct Machine {
    Simulation simulation;
    const Control *start;   /* at step 0 of its run, or NULL */
    const Control *control; /* in use */
    bool has_state;         /* the simulation has the state of `step` */
    long step;
    bool iterating;  /* a step of the simulation has begun */
    int substeps;    /* steps of the simulation since `step` */
    long before;     /* steps of the simulation before the present substep */
    Outcome outcome; /* outcome of the step in progress, else of the last step
                      */
    bool failed;     /* the step after `step` could not be made */
    StepTrace trace;
    bool known;      /* trace and records are those of `step`, or of the step
                        that failed after it */
    Records records; /* Newton's records of that step, for the log */
} Machine;

/* How far the work has come that leads to another step. */
typedef enum Work {
    WORK_DONE,    /* the step that was aimed at is shown */
    WORK_LOADS,   /* machines take states that were kept */
    WORK_REPEATS, /* known steps are made once more */
    WORK_MAKES,   /* a new step is made; no pane has finished its part */
    WORK_MADE     /* a pane has finished its part of a new step */
} Work;

typedef struct Past {
    Branch *branch;
    int branches, room; /* number of branches; memory is reserved for room */
    int now;            /* index of the present branch; others above: undone */
    long step;          /* shown, in all panes */
    Machine machine[OPTIONS_MAX_PANES];
    bool keeps;   /* states are kept: the user may go back */
    bool goes_on; /* when one of several panes fails the others go on */
    long same;    /* last step whose rows in tables are valid; the player writes
                     later ones again and sets LONG_MAX */
    long booked;  /* last step whose row of energies is valid; an edit after a
                     step  changes its row, too */
    size_t bytes, limit; /* memory of states; most of it */
    int line; /* pane in which E along p is drawn and is kept; -1: none */
    /* The work to show another step, a Newton iteration at a time. */
    Work work;
    long aim;      /* step that is to be shown */
    long from;     /* step that machines are brought to by WORK_LOADS */
    bool walks;    /* each round of the aim is sampled, for a walk through it */
    double target; /* s, end of the new step */
    Status worst;  /* worst outcome of the panes in the new step */
} Past;

static inline bool past_works(const Past *past)
{
    return past->work != WORK_DONE;
}

/* Whether a new step is being made. */
static inline bool past_makes(const Past *past)
{
    return past->work >= WORK_MAKES;
}

void past_create(bool keeps, bool goes_on, Past *past);
void past_free(Past *past);

/* Starts new runs side by side at step 0.  Returns as simulation_create; after
 * a failure past_iterate leads back to the step that was shown. */
Status past_begin(Past *past, const Options *options, int panes, int gesture,
                  const Command *edit);

/* Edits the shown step; the later steps so far stay in the branch below.
 *   edit     checked by the caller: COMMAND_SET with a row of the options and
 *            its number x or its text; COMMAND_PIN with a node, x = 1 to pin it
 *            and 0 to free it; COMMAND_GRAB with a node and the place of the
 *            hand, m, COMMAND_PUSH with an obstacle likewise; COMMAND_DRAG,
 *            COMMAND_RELEASE, COMMAND_PLACE, COMMAND_OBSTACLE, COMMAND_HANDLE,
 *            COMMAND_FLIP; COMMAND_ADD_PANE adds a pane with the past of the
 *            last one, COMMAND_END_PANE removes the last one
 *   from,to  panes from ... to - 1 are edited
 *   again    the edit counts from the step before on: past_iterate makes the
 *            shown step, not step 0, once more with it
 *   gesture  id of the mouse gesture; edits of one gesture share a branch; or 0
 * Returns OK, OUT_OF_MEMORY. */
Status past_edit(Past *past, const Command *edit, int from, int to, bool again,
                 int gesture);

/* Chooses the step to be shown, 0 ... newest + 1; abandons the present work.
 *   again  the step is made once more, however long that takes, and each of its
 *          rounds is sampled */
void past_aim(Past *past, long step, bool again);

/* Does a piece of the work: one Newton iteration, or the beginning of a step.
 * Returns RUNNING while there is more to do; OK, or an unconverged status, when
 * the aim is shown; else a failure: the last whole step is shown. */
Status past_iterate(Past *past);

/* Repeats past_iterate until it does not return RUNNING; returns its last
 * status. */
Status past_finish(Past *past);

/* Makes the shown step once more if E along p is drawn at this place of its
 * trace (-1: after it) but was not kept, unless a later step has failed.
 * past_iterate follows. */
void past_complete(Past *past, int place);

/* Undoes one gesture (-1) or redoes it (1); past_iterate follows.  Returns the
 * edit that was undone or redone, or NULL. */
const Command *past_undo(Past *past, int way);

int past_panes(const Past *past);

/* The newest step; the step that is being made does not count. */
long past_newest(const Past *past);

/* NULL: the step is not made yet. */
const Entry *past_entry(const Past *past, int pane, long step);

/* The control after the shown step; that at step 0 of the run. */
const Control *past_control(const Past *past, int pane);
const Control *past_start(const Past *past, int pane);

/* Whether the shown state is a start or was dragged, not made by a step. */
bool past_is_state_set(const Past *past);

/* The last step that a pane has made, if a failure has ended it before `step`;
 * else -1. */
long past_end_step(const Past *past, int pane, long step);

/* The last step up to this one whose state can be seen: at most PAST_EXPLODED
 * times as large as after step 1. */
long past_last_seen(const Past *past, int pane, long step);

/* Fills the energies over time that plots show of a pane. */
void past_history(const Past *past, int pane, History *history);

#endif
