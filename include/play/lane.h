/* lane.h - one of up to six runs side by side: a track, and what is shown of
 * it.
 *
 * All lanes have one time and one count of steps: a step of the player is one
 * step of the lane with the longest timestep, and as many of the others as fit
 * into it.
 */
#ifndef ELASTO_LANE_H
#define ELASTO_LANE_H

#include "play/tape.h"
#include "play/track.h"

struct Player;

typedef struct Lane {
    struct Player *player; /* whose it is */
    int number;            /* 0 ... */
    Track track;
    Tape tape;       /* of the last step that was made */
    bool taped;      /* it is that of the step shown */
    bool retried;    /* or it was tried to make it that */
    int place;       /* shown of the tape; -1: the state after the step */
    History history; /* of energies or radii */
    Trail trail;
    long sampled;  /* player's step up to which these know of it */
    double *ghost; /* [2n] m, the outcome with other settings, or NULL */
    char ghost_label[64];
    double *from;   /* [4n] m, where a glide begins, and where it is; NULL */
    char label[64]; /* what is different here */
    long *at;       /* [room] the track's step for each of the player's */
    StepBar *bar;   /* [room] */
    long room;
    int rigid;      /* steps in which nothing has deformed, up to this one */
    int idle;       /* steps that needed no update, the same */
    bool failed;    /* its last step could not be made */
    long ended;     /* a step could not be made beside others: from this step of
                       the player on it makes none; 0: it goes on */
    long last;      /* the player's step that was its last one then */
    Status outcome; /* of the last step, or of the one shown */
} Lane;

/* Sets up a run.  lane out: stays where it is.
 *   keeps  states are kept, and steps taped
 * Returns as simulation_create. */
Status lane_create(struct Player *player, int number, const Options *options,
                   bool keeps, NewtonObserver observer, Lane *lane);
void lane_free(Lane *lane);

/* The same run with the same past in another lane, up to the step that is
 * shown.  Returns as simulation_create. */
Status lane_clone(const Lane *lane, int number, NewtonObserver observer,
                  Lane *clone);

/* s, and s of one step; 0 and 1 in scenes without time. */
double lane_time(const Lane *lane);
double lane_pace(const Lane *lane);

/* Steps until the time is `target`; step is the player's number of it.  Returns
 * as simulation_step, the worst of them. */
Status lane_advance(Lane *lane, double target, long step);

/* Shows the player's step.  Returns as track_show. */
Status lane_show(Lane *lane, long step);

/* The last of the track's steps that is at most ten times as large as the first
 * one. */
long lane_last_good(const Lane *lane);

/* After a step that could not be made beside others: it takes no more, and goes
 * back to its last state below ten times the size; what came after that is
 * forgotten, so that pictures and plots keep their scale.  step is the player's
 * number of it.  Returns as track_show. */
Status lane_end(Lane *lane, long step);

/* Whether what it shows at the player's step is that end. */
bool lane_is_over(const Lane *lane, long step);

/* From the step before it to the player's step, by making it again: the tape
 * knows it then.  Returns as track_show. */
Status lane_repeat(Lane *lane, long step);

/* The same as lane_show, by making the step again, so that the tape knows it.
 */
Status lane_retape(Lane *lane, long step);

/* Forgets what came after the player's step that is shown. */
void lane_forget(Lane *lane, long step);

/* The state of the present step was changed: what histories keep of it is taken
 * again. */
void lane_sample_again(Lane *lane, long step);

/* Keeps positions as a ghost.  Returns OK, OUT_OF_MEMORY. */
Status lane_keep_ghost(Lane *lane, const char *label);
void lane_drop_ghost(Lane *lane);

/* Whether there is more to walk through than the start and the end. */
bool lane_walks(const Lane *lane);

/* The place in the tape where E was highest, if the step has raised it by far
 * more than it has changed it in the end: an explosion that is over.  rise out:
 * J s^2.  Returns -1 where there was none. */
int lane_peak(const Lane *lane, double *rise);

/* The largest coordinate of run 0, m, in the whole step as far as the tape
 * knows it. */
double lane_extent(const Lane *lane);

#endif
