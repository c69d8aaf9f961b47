/* track.h - a simulation with its past: every step can be shown again.
 *
 * Kept are the states of all steps, or when they have used up their memory of
 * every 2nd, 4th, ... one; and all changes, such as another timestep or a
 * pinned node, with the step at which they were made.  A state that is not kept
 * is computed again from the nearest one before it, with the same changes: the
 * bits are the same.  A step or a change after going back forgets what came
 * after that place.
 */
#ifndef ELASTO_TRACK_H
#define ELASTO_TRACK_H

#include "play/script.h"
#include "scenes/state.h"

/* Bytes that the past of one track may take: states give way, and what is told
 * of every step stays. */
#define TRACK_BYTES ((size_t)256 << 20)

/* What is told of a step when it is long over. */
typedef struct StepRow {
    int updates;     /* of Newton, in all runs */
    Status status;   /* how the step ended */
    double change;   /* E at the end - E at the start, J s^2 */
    double residual; /* m/s, at the end */
    double extent;   /* m, the largest coordinate of run 0 after it */
} StepRow;

/* Bytes of a step that are never given back: its row, and the lane's bar and
 * number. */
#define TRACK_STEP_BYTES (sizeof(StepRow) + 2 * sizeof(long))

/* What can be changed while a run goes on, as it is now. */
typedef struct Settings {
    Options options;
    int *pin; /* [pins] nodes that are pinned, ascending */
    int pins;
    bool held;    /* a hand holds a node */
    int node;     /* that one, */
    double at[2]; /* m, and where the hand is */
} Settings;

/* A kept state. */
typedef struct KeptState {
    void *bytes;
    size_t size;
} KeptState;

typedef struct Track {
    Simulation simulation;
    Options options;   /* at step 0 */
    Settings start;    /* there: the same options, and its pins */
    Settings settings; /* now */
    bool keeps;        /* states are kept: somebody may go back */
    size_t limit;      /* of track_bytes */

    KeptState *kept; /* [kept_count] states of step 0, stride, 2 stride, ... */
    long kept_count, kept_size;
    long stride;
    size_t used; /* bytes of these */

    StepRow *row; /* [newest] steps 1, 2, ... */
    long newest, row_size;
    Script changes; /* with the step they were made at */

    bool repeating; /* steps are being made again: the observer looks at it */
    StepRow now;    /* of the step that is being made */
    NewtonObserver observer;
    void *user; /* its first argument */
} Track;

/* Sets up options->scene.  track out: stays where it is; free it in any case.
 *   keeps           states are kept
 *   observer, user  told of each Newton iteration, or NULL
 * Returns as simulation_create. */
Status track_create(const Options *options, bool keeps, NewtonObserver observer,
                    void *user, Track *track);
void track_free(Track *track);

/* One step from the state that is shown; forgets what came after it.  Returns
 * as simulation_step. */
Status track_step(Track *track);

/* Shows this step, 0 ... newest; other numbers are brought into that range.
 * Returns OK, or a failure, INTERRUPTED too: then another step is shown. */
Status track_show(Track *track, long step);

/* Makes the next known step again, from the state that is shown.  Returns as
 * track_show; another step is shown then. */
Status track_repeat(Track *track);

/* Lets a new track make the same changes and steps as another one has made, up
 * to the step which that shows.  Returns as track_show. */
Status track_follow(const Track *from, Track *to);

/* Changes something from here on; forgets what came after.
 *   change   COMMAND_SET with "NAME VALUE"; COMMAND_PIN with a node, x = 1 to
 *            pin it and 0 to set it free; COMMAND_GRAB with a node and where
 *            the hand is, m; COMMAND_DRAG; COMMAND_RELEASE
 *   message  [size] out, why not, after INVALID_INPUT
 * Returns OK, INVALID_INPUT, or a failure. */
Status track_change(Track *track, const Command *change, char *message,
                    size_t size);

/* Forgets what came after the step that is shown. */
void track_forget(Track *track);

/* Bytes of all that is kept: states, rows, changes. */
size_t track_bytes(const Track *track);

/* The step that is shown. */
long track_step_shown(const Track *track);

/* What happened in a step, 1 ... newest. */
const StepRow *track_row(const Track *track, long step);

#endif
