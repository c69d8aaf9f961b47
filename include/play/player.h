/* player.h - simulations that are played: stepped, drawn, recorded, gone back
 * in, and told what to do by keys, mouse and scripts.
 *
 *   keys, mouse, chips, scripts, pages  ->  Command      (hands.c, command.h)
 *   player_obey: the deed of its kind                    (obey.c)
 *   the deed changes the past, or says which step is to be shown
 *   player_work: past_iterate, until that step is shown  (steps.c)
 *
 * From a key to Newton's method: player_input, player_obey (after the deed),
 * player_work, past_iterate, simulation_advance, time_integrator_advance,
 * newton_minimise.
 */
#ifndef ELASTO_PLAYER_H
#define ELASTO_PLAYER_H

#include <signal.h>
#include <stdio.h>

#include "play/past.h"
#include "play/command.h"
#include "run/options.h"
#include "play/recording.h"
#include "play/view.h"

enum {
    SPEED_LEAST = -6, /* a frame every second */
    SPEED_MOST = 10   /* 1024 steps a frame */
};

/* What time does.  From MODE_PAUSE on it stands still; from MODE_END on nobody
 * has asked for that. */
typedef enum Mode {
    MODE_RUN,
    MODE_PAUSE,
    MODE_END, /* the scene is over, or a step did not converge */
    MODE_REST /* nothing moves, and the forces are in balance */
} Mode;

/* What is to be done as soon as the step that was asked for is shown. */
typedef enum Then {
    THEN_NOTHING,
    THEN_ENTER, /* its lines are walked through from the first one, */
    THEN_LEAVE, /* or from the last one back */
    THEN_PEAK,  /* it was taken by itself: an explosion in it is shown */
    THEN_TELL   /* it was taken again: both outcomes are told */
} Then;

typedef struct Mouse {
    double x, y; /* pixels */
    bool placed; /* where it rests at the start is known: now it can move */
    CommandKind drag; /* what its movement asks for, while a button is down: */
    int index; /* of a node, a point, a number of the row; -1: the stretch */
    double from[2];  /* pixels, where the drag began, or has come */
    bool moved;      /* it is more than a click */
    double grip[2];  /* m, from the mouse to the point that it moves */
    bool pins;       /* the node is pinned again when it is let go */
    bool turns;      /* the last input was the wheel's */
    int gesture;     /* the last key, click or turn of the wheel */
    Options options; /* at its beginning */
} Mouse;

/* What is shown of one of the runs side by side. */
typedef struct Side {
    int place;     /* in the rounds of the step; -1: it shows all of it */
    double *ghost; /* [2n] m, the outcome with other settings, or NULL */
    char ghost_label[256]; /* which one, and what it was */
} Side;

enum { LABEL_SIZE = 64 }; /* bytes */

/* Contents of the last frame: pictures read the Show, which points to the rest;
 * the mouse finds in it what was drawn. */
typedef struct Frame {
    Show show;
    History history[LAYOUT_PANES];
    Trace trace[LAYOUT_PANES];
    char label[LAYOUT_PANES][LABEL_SIZE]; /* what is different in a pane */
    char chip_key[LAYOUT_CHIPS][SHOW_VALUE];
    char chip_label[LAYOUT_CHIPS][SHOW_VALUE];
    CommandKind chip[LAYOUT_CHIPS]; /* what the chips ask for */
    int numbers;                    /* in the row */
    const OptionRow *number[OPTIONS_MOST];
} Frame;

enum { QUEUE_MOST = 16 };

/* Commands that wait until the present one is obeyed and no step is under way:
 * those that it is made of, and those of a mouse that moves meanwhile. */
typedef struct Queue {
    Command command[QUEUE_MOST];
    int count;
    bool of_page;        /* a page's own, as it opens */
    const Control *pins; /* before a restart, to be set after the page's
                            commands; or NULL */
    bool plays;          /* the run goes on after them */
    char note[SHOW_TEXT];
} Queue;

typedef struct Player {
    Options given[OPTIONS_MAX_PANES]; /* of the command line */
    char *const *words; /* of the command line, not owned; NULL ends them, or
                           there are none */
    Script script;      /* of the command line */
    bool draws;         /* frames, on this paper */
    Paper paper;
    int size[2];   /* its pixels; 0: those of the window */
    bool window;   /* it is a window's, which takes keys */
    bool attended; /* a window or a script: it may pause and go back */
    bool quit;     /* somebody asked for the end */
    bool refused;  /* a line of the script made no sense */
    const volatile sig_atomic_t *stop; /* set by signals */
    double started;                    /* s, on the wall clock */

    Past past;
    Side side[OPTIONS_MAX_PANES]; /* one for each of its panes */
    int active;                   /* the one whose numbers are shown */
    const struct Scene *scene;    /* that is shown, and the page */
    const LecturePage *page;
    Recording recording;
    long written; /* the last step in its tables; -1: none */
    long booked;  /* last step whose row of the ledger is up to date, at most
                     `written`; -1: none */
    Mode mode;
    int fine; /* one on is: 0 a step, 1 an update, 2 a line */
    Then then;
    Station
        retaken; /* the place in a step that is taken again; round -1: none */
    bool holds;  /* the hand has not let go since it took a node */
    long pulled; /* the step at which it went where it is */
    Queue queue;
    bool warned; /* it has stopped because a step did not converge */
    bool gained; /* whether a rise of the total energy was reported */

    int gesture;    /* what is done now is undone at once: its number, */
    int gestures;   /* how many there were, */
    int held;       /* that of a script's last grab, which drags go on with */
    Script journal; /* all that was done, undo and redo, too */
    char message[768]; /* why a command or the script makes no sense, or "" */
    char note[SHOW_TEXT]; /* what a command just did, or "" */
    bool warning;         /* and it is a bad thing */
    bool explains;        /* the mouse has gone to something else since then */

    int speed;    /* s: 2^s steps a frame, or a frame 2^-s times as long */
    double due;   /* s, on the wall clock: the next step */
    double began; /* s, work that is under way; 0: none is */
    bool changed; /* the window must be drawn again */
    long sampled; /* step of the last frame that was drawn; -1: none */

    /* What only the screen shows. */
    Column column;
    struct Sheet *sheet;      /* of scenes; NULL: it is closed */
    const LecturePage *left;  /* the page that was last open, or NULL */
    const LecturePage *told;  /* the page whose answer is shown, or NULL */
    char verdict[SHOW_VALUE]; /* on the guess at this page, or "" */
    int guesses, right;       /* numbers and clicks of all pages */
    bool opens;               /* a page: its own lines are obeyed */
    bool asks;                /* pages wait for a guess before they tell */
    bool strain, bare, blank;
    unsigned closed;      /* cards that are not as the picture has them */
    int large;            /* the enlarged card, */
    const OptionRow *lit; /* and the number that is lit; NULL: none */
    uint64_t added; /* bit r: row r of the options is in the row of numbers */
    bool typing;    /* every key belongs into what is typed: */
    char typed[28]; /* for the selected number, or a page of the list */
    CommandKind leaving; /* Escape or Q, which once more ends the program */
    Mouse mouse;
    View view;
    Frame frame;
} Player;

/* Sets everything up.  Says on standard error if there is no screen, and then
 * asks for frames in the folder "frames" and 100 steps.
 *   options  [count] in, of the panes
 *   words    in, how the program was called: its name, words, NULL; or NULL.
 *            They must live as long as the player
 *   stop     in, must live as long; not 0 ends the run after the present step
 *   player   out; must stay where it is; close it in any case
 * Returns OK, or why it failed; INVALID_INPUT: player->message may say more. */
Status player_create(const Options *options, int count, char *const *words,
                     const volatile sig_atomic_t *stop, Player *player);

/* The next step, known or new, with its records; in a window it may only begin.
 * OK also for a step that did not converge. */
Status player_step(Player *player);

/* Does what a command asks for.  Returns OK; INVALID_INPUT with the reason in
 * player->message where it makes no sense here; or a failure. */
Status player_obey(Player *player, const Command *command);

/* What happened at keyboard, mouse or window, as commands.  Returns as
 * player_obey. */
Status player_input(Player *player, const Input *input);

/* Draws, shows and records the state, if anything is drawn. */
Status player_draw(Player *player);

/* Until the window is closed, or to the end. */
Status player_run(Player *player);

/* The same in its parts, for a program that is called a frame at a time, as a
 * page is: inputs, script, steps and a frame, as far as they are due; for how
 * many milliseconds nothing is; whether it is over. */
Status player_frame(Player *player);
int player_wait(const Player *player);
bool player_ended(const Player *player);

/* What is different in a pane: "h 0.01 s, ended at step 3". */
void player_label(const Player *player, int pane, char label[LABEL_SIZE]);

/* The hash of the present state of all panes; see state_hash. */
uint64_t player_hash(const Player *player);

/* The present options of all panes.  Returns how many. */
int player_options(const Player *player, Options options[OPTIONS_MAX_PANES]);

/* Finishes the files and frees all but the numbers that the summary needs.
 *   status  how the run ended; a failure leaves its files as NAME.part
 * Returns it, or what failed then: OUT_OF_MEMORY, FILE_FAILED. */
Status player_finish(Player *player, Status status);
void player_free(Player *player);

/* ---- the program --------------------------------------------------------- */

/* From its command line to its exit code, wherever it runs.  What is wrong it
 * says in one line on standard error. */

/* How the program ends. */
enum ExitCode {
    PROGRAM_PLAYS = -1, /* not yet */
    EXIT_FINE = 0,
    EXIT_FAILED = 1,     /* while running */
    EXIT_MISUSED = 2,    /* the command line, or a line of its script */
    EXIT_UNCONVERGED = 3 /* the run ended, but steps did not converge */
};

/* The place of the word from i on that decides what is simulated, not how long
 * it runs and what it leaves behind.  0: there is none.  A loop over all of
 * them is for (i = 0; (i = player_next_word(player, i + 1));) */
int player_next_word(const Player *player, int i);

/* Does what a command line asks for, until it is to be played.
 *   argv    in, NULL ends it; it must live as long as the player
 *   stop    in, must live as long; not 0 ends the run after the present step
 *   player  out, before its first frame; free it in any case
 * Returns PROGRAM_PLAYS, or the exit code where nothing is to be played. */
int program_begin(int argc, char **argv, const volatile sig_atomic_t *stop,
                  Player *player);

/* Finishes the files and prints the summary, or why the run failed.
 *   status  how it ended
 * Returns the exit code. */
int program_end(Player *player, Status status);

#endif
