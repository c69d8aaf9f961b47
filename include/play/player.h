/* player.h - a simulation that is played: stepped, drawn, recorded, gone back
 * in, and told what to do by keys, mouse and scripts.
 */
#ifndef ELASTO_PLAYER_H
#define ELASTO_PLAYER_H

#include <signal.h>

#include "picture/hud.h"
#include "play/recording.h"
#include "play/track.h"
#include "play/view.h"

enum {
    SPEED_LEAST = -6, /* a frame every second */
    SPEED_MOST = 10   /* 1024 steps a frame */
};

typedef struct Player {
    Options given; /* of the command line, for its own scene */
    Track track;
    Recording recording;
    Hud hud;
    View *view;        /* NULL: nothing is drawn */
    bool window;       /* the view is a window: it takes keys */
    bool attended;     /* a window or a script: it may pause and go back */
    Script script;     /* of the command line */
    Script journal;    /* what was done so far, as a script */
    bool quit;         /* somebody asked for the end */
    bool changed;      /* the window must be drawn again */
    bool warned;       /* paused once because a step did not converge */
    bool holds;        /* the hand has not let go since it took a node */
    bool blank;        /* the screen is black */
    int speed;         /* s: 2^s steps a frame, or a frame 2^-s times as long */
    long sampled;      /* step of the last frame that was drawn; -1: none */
    Status recorded;   /* how the last record of the log was written */
    char message[256]; /* why the script cannot be obeyed, or "" */
    const volatile sig_atomic_t *stop; /* set by signals */
    double started;                    /* s, on the wall clock */
    double clock_mark, time_mark;      /* s, where the speed is measured from */
    Energies start; /* of run 0, when a summary will want them */
} Player;

/* Sets everything up.  Says on standard error if there is no screen, and then
 * asks for frames in the folder "frames" and 100 steps.
 *   stop    in, must live as long; not 0 ends the run after the present step
 *   player  out; must stay where it is; close it in any case
 * Returns OK, or why it failed; INVALID_INPUT: player->message may say more. */
Status player_create(const Options *options, const volatile sig_atomic_t *stop,
                     Player *player);

/* One step with its records.  OK also for a step that did not converge. */
Status player_step(Player *player);

/* Does what a command asks for.  Returns OK; INVALID_INPUT with the reason in
 * player->message where it makes no sense here; or a failure. */
Status player_obey(Player *player, const Command *command);

/* Draws, shows and records the state if there is a view. */
Status player_draw(Player *player);

/* Until the window is closed, or to the end. */
Status player_run(Player *player);

/* Whether there is nothing left to do. */
bool player_ended(const Player *player);

/* Whether any step, or the scene as a whole, did not converge. */
bool player_unconverged(const Player *player);

/* The hash of the present state; see state_hash. */
uint64_t player_hash(const Player *player);

/* Seconds since an arbitrary moment. */
double player_clock(void);

/* Finishes the files and frees all but the numbers that a summary needs.
 * Returns OK, OUT_OF_MEMORY or FILE_FAILED. */
Status player_finish(Player *player);
void player_free(Player *player);

#endif
