/* past.h - the one past: all that was computed and done, of up to six runs side
 * by side.
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
 * one up; a change drops those above.
 *
 * An entry's state is what its step left behind; then comes its control, which
 * the next step is made with (simulation_use).  A branch begins with another
 * control, and the state is that of the branch below: where several branches
 * begin at one step only the last one's control counts.  A point that is
 * dragged is another state, which its branch keeps.
 *
 * To show a step, the machine of each pane takes the nearest state that is kept
 * of it or of a step before it, and makes the steps from there once more
 * (past_iterate).
 *
 * All panes have one time and one count of steps: a step is one of the pane
 * with the longest timestep, and as many of the others as fit into it.  A pane
 * that cannot make its part ends, and the others go on.
 */
#ifndef ELASTO_PAST_H
#define ELASTO_PAST_H

#include "play/command.h"
#include "play/rounds.h"
#include "run/control.h"

#define PAST_BYTES ((size_t)256 << 20) /* of states; they give way */

/* Beyond so many times its size in the first step nobody can see a state. */
#define PAST_EXPLODED 10

/* A state, and what plots show of it with the control that it had last
 * (show_sample). */
typedef struct State {
    size_t size; /* of all this, bytes */
    double time; /* s */
    int rows;
    Energy row[HISTORY_SERIES];
    unsigned char bytes[];
} State;

/* What is told of a step when its iterations are long forgotten. */
typedef struct Outcome {
    int updates;   /* Newton's, in all its substeps */
    Status status; /* the worst */
    double change; /* of E, J s^2 */
    double extent; /* m, the largest coordinate of run 0 */
} Outcome;

/* One step of one pane: the state after it, and how the next one is made. */
typedef struct Entry {
    const Control *control; /* from this step on; NULL: it is not made yet */
    State *state;           /* before that control; NULL: made again */
    int substeps; /* steps of its own in it: with a shorter h several; 0: its
                     scene is over; or the outcome says why it has ended, and
                     the state is the last one that can be seen */
    Outcome outcome;
} Entry;

typedef struct Branch {
    bool fresh; /* starts from options; else goes on from the one below */
    long first; /* step of its entry 0 */
    long count; /* entries; never 0 */
    long room;  /* for so many; behind the last is the one that is being made */
    int given;  /* entries whose controls came with it: 1, or 2 where it begins
                   before the step that was changed */
    long shown; /* the step that was shown when it was left */
    long stride; /* every so manyth state is kept, and that of entry 0: there is
                    one in a fresh branch, or if something was dragged */
    int panes;
    int source[OPTIONS_MAX_PANES]; /* the pane below that each goes on from */
    Entry *entry;                  /* [room][panes]; 0 behind the last */
    int gesture;  /* of the mouse; 0: none.  Changes of the same one change this
                     branch's end */
    Command edit; /* what began it */
} Branch;

/* A simulation that stands at an entry of the present branch. */
typedef struct Machine {
    Simulation simulation;
    const Control *start;   /* of its run's step 0; NULL: there is none */
    const Control *control; /* that it uses */
    bool stands;            /* else its state has to be loaded */
    long step;
    bool iterating;  /* a step of the simulation is begun */
    int substeps;    /* made of the step after it */
    long before;     /* the simulation's steps before the last of them */
    Outcome outcome; /* of the step that is made, or the last one */
    bool failed;     /* that one could not be made */
    Rounds rounds;
    bool known; /* rounds and records are of the step it stands at, or failed
                   after it */
    Records records; /* all that Newton told of that step, for the log */
} Machine;

/* How far the work has come. */
typedef enum Work {
    WORK_DONE,    /* the step that was aimed at is shown */
    WORK_LOADS,   /* machines take states that are kept */
    WORK_REPEATS, /* steps that are known are made once more */
    WORK_MAKES,   /* a new step is made: no pane has come to its end */
    WORK_MADE     /* at least one pane has made its part of a new step */
} Work;

typedef struct Past {
    Branch *branch;
    int branches, room; /* for so many */
    int now;            /* the present one; those above it were undone */
    long step;          /* shown, in all panes */
    Machine machine[OPTIONS_MAX_PANES];
    bool keeps;   /* somebody may go back, or looks at steps behind */
    bool goes_on; /* when one of several panes fails the others go on */
    long same;    /* Tables of later steps are out of date.  The player writes
                     them anew and sets LONG_MAX. */
    long booked;  /* The ledgers of later steps are out of date, alike: a number
                     that changes after a step changes the ledger of it. */
    size_t bytes, limit;
    int line; /* pane in which E along p is drawn: it is kept of the last update
                 of each step; -1: none */
    /* The work to show another step, a Newton iteration at a time. */
    Work work;
    long aim;      /* step that is to be shown */
    long from;     /* step that machines are brought to by WORK_LOADS */
    bool walks;    /* all rounds of the aim are kept, for a walk through it */
    double target; /* s, end of a new step */
    Status worst;  /* of the parts of a new step */
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

/* New runs from step 0, side by side.  Returns as simulation_create; what was
 * there before is shown then as soon as past_iterate has made it. */
Status past_begin(Past *past, const Options *options, int panes, int gesture,
                  const Command *edit);

/* Changes something from the step that is shown on; later steps that are known
 * stay in the branch below.
 *   edit     which the caller has checked: COMMAND_SET with a row of the
 *            options and its number x or its text; COMMAND_PIN with a node,
 *            x = 1 to pin it and 0 to set it free; COMMAND_GRAB with a node and
 *            where the hand is, m, and COMMAND_PUSH with an obstacle alike;
 *            COMMAND_DRAG, COMMAND_RELEASE;
 *            COMMAND_PLACE, COMMAND_OBSTACLE, COMMAND_HANDLE, COMMAND_FLIP;
 *            COMMAND_ADD_PANE: one more with the past of the last one;
 *            COMMAND_END_PANE: it goes
 *   from,to  in panes from ... to - 1
 *   again    it counts from the step before on: the one that is shown, not
 *            step 0, is made once more by past_iterate
 *   gesture  of the mouse: the same one changes its own branch's end; or 0
 * Returns OK, OUT_OF_MEMORY. */
Status past_edit(Past *past, const Command *edit, int from, int to, bool again,
                 int gesture);

/* Wants this step shown, 0 ... newest + 1; work that is under way is given up.
 *   again  it is made once more, also where that is long work, to know all of
 *          its rounds */
void past_aim(Past *past, long step, bool again);

/* A piece of the work: one Newton iteration, or the beginning of a step; of a
 * step without a minimisation all of it.  RUNNING: there is more.  OK, or an
 * unconverged status: the aim is shown, if it is a new step that any pane could
 * make.  A failure: the last whole step is shown. */
Status past_iterate(Past *past);

/* Iterates to the end of the work, and returns as past_iterate does there. */
Status past_finish(Past *past);

/* Makes the shown step once more if E along p is drawn at this place of its
 * rounds, or -1, but was not kept, unless a step has failed after it.
 * past_iterate follows. */
void past_complete(Past *past, int place);

/* One gesture down (-1) or up (1), where past_iterate leads.  Returns what was
 * undone or done again; NULL: nothing was. */
const Command *past_undo(Past *past, int way);

int past_panes(const Past *past);

/* The newest step that is known; one that is being made is not yet. */
long past_newest(const Past *past);

/* NULL: there is none. */
const Entry *past_entry(const Past *past, int pane, long step);

/* From the step that is shown on; at step 0 of the run. */
const Control *past_control(const Past *past, int pane);
const Control *past_start(const Past *past, int pane);

/* Whether no step has led to what is shown: it is a start, or something was
 * dragged there. */
bool past_is_start(const Past *past);

/* The last step that a pane could make, if it has ended before this one because
 * a step of it failed; else -1. */
long past_end_step(const Past *past, int pane, long step);

/* The last step up to this one whose state can still be seen: at most
 * PAST_EXPLODED times as large as after step 1. */
long past_last_seen(const Past *past, int pane, long step);

/* What plots show of a pane's steps.  history out */
void past_history(const Past *past, int pane, History *history);

#endif
