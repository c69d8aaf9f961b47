/* player.h - simulations that are played: stepped, drawn, recorded, gone back
 * in, and ordered by keys, mouse and scripts.
 *
 *   keys, mouse, chips, scripts, pages  ->  Command      (hands.c, command.h)
 *   player_obey: the function of its kind                (obey.c)
 *   that function changes the past, or chooses the step to be shown
 *   player_work: past_iterate, until that step is shown  (steps.c)
 *
 * From a key to Newton's method: player_input, player_obey, player_work,
 * past_iterate, simulation_advance, time_integrator_advance, newton_minimise.
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

/* ---- what was asked for -------------------------------------------------- */

/* The command line, and how it is played. */
typedef struct Given {
    Options options[OPTIONS_MAX_PANES]; /* options of each pane */
    char *const *words; /* words of the command line, then NULL; NULL itself
                           where there is no command line */
    Script script;
    const volatile sig_atomic_t *stop; /* not 0 after a signal: the run ends */
    double started; /* s, time on the wall clock when the run began */
    bool
        attended; /* a window, a script or a page: the run may pause, go back */
    bool asks;    /* pages wait for a guess before they show the answer */
} Given;

/* ---- time ---------------------------------------------------------------- */

enum {
    SPEED_LEAST = -6, /* lowest speed: a frame lasts 64 times as long, about 1 s
                       */
    SPEED_MOST = 10   /* highest speed: 1024 steps a frame */
};

/* Whether steps are made.  From MODE_PAUSE on none is; MODE_END and MODE_REST
 * are pauses that nobody asked for. */
typedef enum Mode {
    MODE_RUN,
    MODE_PAUSE,
    MODE_END, /* the scene is over, or a step did not converge */
    MODE_REST /* the bodies are at rest, the forces in balance */
} Mode;

/* Action when the chosen step is shown. */
typedef enum AfterWork {
    AFTER_NOTHING,
    AFTER_ENTER,  /* show the first line of Algorithm 3 in it */
    AFTER_LEAVE,  /* show the last line */
    AFTER_PEAK,   /* show an explosion in it, if there was one */
    AFTER_COMPARE /* compare the outcomes before and after an edit */
} AfterWork;

/* The view of the present step in a pane. */
typedef struct Side {
    int place;             /* in the step's trace; -1: the whole step */
    double *ghost;         /* [2n] m, positions before an edit, or NULL */
    char ghost_label[256]; /* the edited setting, and the outcome before it */
} Side;

/* How steps follow each other. */
typedef struct Time {
    Mode mode;
    int fine; /* unit of "next": 0 a step, 1 an update, 2 a line */
    AfterWork after;
    TracePlace
        retaken; /* place before an edit made the step again; round -1: none */
    int speed;   /* s: 2^s steps a frame, or a frame lasts 2^-s times as long */
    double due;  /* s on the wall clock, time of the next step */
    double began; /* s on the wall clock, start of the present work; 0: none */
    bool warned;  /* the run has stopped at a step that did not converge */
    bool gained;  /* a rise of the total energy was reported */
} Time;

/* ---- commands ------------------------------------------------------------ */

enum { QUEUE_MOST = 16 };

/* Commands that wait until the present one is obeyed and no step is being made:
 * those that the present one consists of, and those of a mouse that moves while
 * a step is made. */
typedef struct Queue {
    Command command[QUEUE_MOST];
    int count;
    bool of_page;             /* the commands are those of a page that opens */
    const Control *pins;      /* pins to be set again after them, or NULL */
    bool plays;               /* the run goes on after them */
    char note[SENTENCE_SIZE]; /* message after them, or "" */
} Queue;

/* The order in which commands are obeyed and undone. */
typedef struct Orders {
    Queue queue;
    int gesture;         /* id of the present gesture: undone as a whole */
    int gestures;        /* number of gestures so far, the id of the newest */
    int held;            /* id of the last grab or push, for its drags */
    Script journal;      /* the commands so far, with undo and redo */
    CommandKind leaving; /* COMMAND_ESCAPE or COMMAND_QUIT, if a second one ends
                            the program */
    bool refused;        /* a line of the script was refused */
} Orders;

/* ---- tour ---------------------------------------------------------------- */

typedef struct Tour {
    const LecturePage *left;     /* page that was last open, or NULL */
    const LecturePage *revealed; /* page whose answer is shown, or NULL */
    char verdict[VALUE_SIZE];    /* on the guess at this page, or "" */
    int guesses, right;          /* numbers of guesses on all pages */
    bool opens;                  /* the commands of a page are obeyed */
} Tour;

/* ---- screen -------------------------------------------------------------- */

enum { LABEL_SIZE = 64 }; /* bytes */

/* Data of the last frame.  Pictures read the contents, which point to the
 * other fields; the mouse finds in it what was drawn. */
typedef struct Frame {
    FrameContent content;
    History history[LAYOUT_PANES];
    Trace trace[LAYOUT_PANES];
    char label[LAYOUT_PANES][LABEL_SIZE]; /* difference between the panes */
    char chip_key[LAYOUT_CHIPS][VALUE_SIZE];
    char chip_label[LAYOUT_CHIPS][VALUE_SIZE];
    CommandKind chip[LAYOUT_CHIPS]; /* command of each chip */
    int numbers;                    /* count of numbers in the row */
    const OptionRow *number[OPTIONS_MOST];
} Frame;

typedef struct Screen {
    bool draws;  /* frames are drawn: for a window, for files */
    bool window; /* a window is open; else frames go to files */
    Paper paper;
    int size[2];  /* pixels of the paper; 0: those of the window */
    bool changed; /* the frame must be drawn again */
    long sampled; /* step of the last frame that was drawn; -1: none */
    const struct Scene *scene; /* scene and page of that frame: new ones */
    const LecturePage *page;   /* reset the camera and the cards */
    Column column;
    struct Sheet *sheet; /* open sheet of scenes, or NULL */
    bool strain;         /* colours of springs are not those of the scene */
    bool bare, blank;    /* the picture alone; a black screen */
    unsigned closed;     /* bit c: card c was opened or closed by hand */
    int large;           /* index of the enlarged card; -1: none */
    View view;
    Frame frame;
} Screen;

/* ---- hands --------------------------------------------------------------- */

typedef struct Mouse {
    double x, y;      /* pixels */
    bool placed;      /* the position is known */
    CommandKind drag; /* command of its movement while a button is down */
    int index; /* index of the dragged node, point, number; -1: the stretch */
    double from[2];  /* pixels, start of the drag, or its last position */
    bool moved;      /* the mouse has moved farther than a click may */
    double grip[2];  /* m, from the mouse to the dragged point */
    bool pins;       /* the dragged node is pinned again when it is let go */
    bool turns;      /* the last input was the wheel's */
    int gesture;     /* id of the last key, click or turn of the wheel */
    Options options; /* values at the start of a drag of a number */
} Mouse;

typedef struct Hands {
    Mouse mouse;
    bool holds;           /* a node or an obstacle is grabbed */
    long pulled;          /* step at which node or obstacle last moved */
    const OptionRow *lit; /* selected number, or NULL */
    uint64_t added;       /* bit r: row r of the options was added to the row */
    bool typing;          /* a field is open: keys go into `typed` */
    char typed[28];       /* a value, an answer, a line of a list */
} Hands;

/* ---- all of it ----------------------------------------------------------- */

typedef struct Player {
    Given given;
    Past past;
    Side side[OPTIONS_MAX_PANES];
    int active; /* index of the pane whose numbers are shown */
    Recording recording;
    long written; /* last step in the tables; -1: none */
    long booked;  /* last step whose energies in the tables are up to date */
    Time time;
    Orders orders;
    Tour tour;
    Screen screen;
    Hands hands;
    bool quit;                /* the program is asked to end */
    char message[768];        /* why a command was refused, or "" */
    char note[SENTENCE_SIZE]; /* message below the picture, or "" */
    bool warning;             /* the note is a warning */
    bool explains; /* the mouse has moved since the note: a sentence about what
                      is under it may replace the note */
} Player;

/* Creates a player.  Without a screen, says so on standard error and writes 100
 * frames to the folder "frames".
 *   options  [count] in, of the panes
 *   words    in, command line with NULL at its end, or NULL; lives as long as
 *            the player
 *   stop     in, not 0 ends the run after the present step; lives as long
 *   player   out; must not be moved; free it in any case
 * Returns OK or a failure; player->message may say more of INVALID_INPUT. */
Status player_create(const Options *options, int count, char *const *words,
                     const volatile sig_atomic_t *stop, Player *player);

/* Makes the next step, known or new, and records it; in a window it may only
 * begin.  Returns OK also for a step that did not converge. */
Status player_step(Player *player);

/* Obeys a command and the commands that it consists of.  Returns OK,
 * INVALID_INPUT with the reason in player->message, or a failure. */
Status player_obey(Player *player, const Command *command);

/* Obeys an input as commands.  Returns as player_obey. */
Status player_input(Player *player, const Input *input);

/* Draws, shows and records a frame, if frames are drawn. */
Status player_draw(Player *player);

/* Runs until the window is closed, or to the end. */
Status player_run(Player *player);

/* The parts of player_run for a program that is called a frame at a time: reads
 * inputs, obeys the script, makes steps, draws a frame, as far as they are due;
 * time until something is due, ms; whether the run is over. */
Status player_frame(Player *player);
int player_wait(const Player *player);
bool player_ended(const Player *player);

/* Writes the label of a pane: "h 0.01 s, ended at step 3". */
void player_label(const Player *player, int pane, char label[LABEL_SIZE]);

/* Hash of the present state of all panes (state_hash). */
uint64_t player_hash(const Player *player);

/* Copies the present options of all panes.  Returns the number of panes. */
int player_options(const Player *player, Options options[OPTIONS_MAX_PANES]);

/* Finishes the files and closes the window; the summary can still be printed.
 *   status  end of the run; after a failure files stay NAME.part
 * Returns status, or OUT_OF_MEMORY, FILE_FAILED. */
Status player_finish(Player *player, Status status);
void player_free(Player *player);

/* ---- the program --------------------------------------------------------- */

/* The program from its command line to its exit code, on a computer and in a
 * page.  Failures are a line each on standard error. */

/* Exit codes. */
enum ExitCode {
    PROGRAM_PLAYS = -1, /* not yet */
    EXIT_FINE = 0,
    EXIT_FAILED = 1,     /* while running */
    EXIT_MISUSED = 2,    /* the command line, or a line of its script */
    EXIT_UNCONVERGED = 3 /* the run ended, but steps did not converge */
};

/* Returns the index, from i on, of the next word of the command line that
 * decides what is simulated, not how long it runs or what it writes; 0: no
 * more.  A loop is for (i = 0; (i = player_next_argument(player, i + 1));) */
int player_next_argument(const Player *player, int i);

/* Reads the command line, prints --help and the like, or creates the player.
 *   argv    in, NULL ends it; it must live as long as the player
 *   stop    in, must live as long; not 0 ends the run after the present step
 *   player  out, before its first frame; free it in any case
 * Returns PROGRAM_PLAYS, or the exit code where nothing is to be played. */
int program_begin(int argc, char **argv, const volatile sig_atomic_t *stop,
                  Player *player);

/* Finishes the files and prints the summary, or why the run failed.
 *   status  end of the run
 * Returns the exit code. */
int program_end(Player *player, Status status);

#endif
