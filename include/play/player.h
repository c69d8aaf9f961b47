/* player.h - a simulation that is played: stepped, drawn, recorded.
 */
#ifndef ELASTO_PLAYER_H
#define ELASTO_PLAYER_H

#include <signal.h>

#include "picture/hud.h"
#include "play/recording.h"
#include "play/view.h"

typedef struct Player {
    Options options; /* of the scene that runs */
    Options given;   /* of the command line, for its own scene */
    Simulation simulation;
    Recording recording;
    Hud hud;
    View *view;      /* NULL: nothing is drawn */
    bool window;     /* the view is a window: it takes keys */
    bool quit;       /* somebody asked for the end */
    bool changed;    /* the window must be drawn again */
    bool warned;     /* paused once because a step did not converge */
    int speed;       /* s: 2^s steps a frame, or a frame 2^-s times as long */
    long sampled;    /* step of the last frame that was drawn; -1: none */
    Status recorded; /* how the last record of the log was written */
    const volatile sig_atomic_t *stop; /* set by signals */
    double started;                    /* s, on the wall clock */
    double clock_mark, time_mark;      /* s, where the speed is measured from */
    Energies start; /* of run 0, when a summary will want them */
} Player;

/* Sets everything up.  Says on standard error if there is no screen, and then
 * asks for frames in the folder "frames" and 100 steps.
 *   stop    in, must live as long; not 0 ends the run after the present step
 *   player  out; must stay where it is; close it in any case
 * Returns OK, or why it failed. */
Status player_create(const Options *options, const volatile sig_atomic_t *stop,
                     Player *player);

/* One step with its records.  OK also for a step that did not converge. */
Status player_step(Player *player);

/* Draws, shows and records the state if there is a view. */
Status player_draw(Player *player);

/* To the end, without a window; or as long as the window is open. */
Status player_run(Player *player);
Status player_run_window(Player *player);

/* Whether there is nothing left to do. */
bool player_ended(const Player *player);

/* Whether any step, or the scene as a whole, did not converge. */
bool player_unconverged(const Player *player);

/* Seconds since an arbitrary moment. */
double player_clock(void);

/* Finishes the files and frees all but the numbers that a summary needs.
 * Returns OK, OUT_OF_MEMORY or FILE_FAILED. */
Status player_finish(Player *player);
void player_free(Player *player);

#endif
