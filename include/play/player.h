/* player.h - simulations that are played: stepped, drawn, recorded, gone back
 * in, and told what to do by keys, mouse and scripts.
 */
#ifndef ELASTO_PLAYER_H
#define ELASTO_PLAYER_H

#include <signal.h>
#include <stdio.h>

#include "play/past.h"
#include "play/script.h"
#include "scenes/options.h"
#include "play/recording.h"
#include "play/view.h"

enum {
    SPEED_LEAST = -6, /* a frame every second */
    SPEED_MOST = 10   /* 1024 steps a frame */
};

/* What the left or the middle button drags. */
typedef enum Drag {
    DRAG_NONE,
    DRAG_NODE,
    DRAG_EDGE,   /* the stretch */
    DRAG_START,  /* where the scene begins */
    DRAG_HANDLE, /* index: a point of the scene */
    DRAG_NUMBER, /* index: in the row */
    DRAG_TIME,   /* the handle of the time line */
    DRAG_PICTURE /* the picture moves */
} Drag;

typedef struct Mouse {
    double x, y; /* pixels */
    bool inside;
    bool placed; /* where it rests at the start is known: now it can move */
    Drag drag;
    int index;
    double from[2], last[2]; /* pixels, where the drag began and has come */
    bool moved;              /* it is more than a click */
    bool turns;              /* the last input was the wheel's */
    Options options;         /* at its beginning */
} Mouse;

/* What is shown of one of the runs side by side. */
typedef struct Side {
    int place;     /* in its rounds; -1: after the step */
    double *ghost; /* [2n] m, the outcome with other settings, or NULL */
    char ghost_label[64];
    double *from;   /* [4n] m, where a glide begins, and where it is; NULL */
    char label[64]; /* what is different here */
    int rigid;      /* steps in which nothing has deformed, up to this one */
    int idle;       /* steps that needed no update, the same */
    bool over;      /* that it ended was told */
    bool retried;   /* it was tried to know its rounds */
} Side;

/* What is to be done as soon as the step that was asked for is shown. */
typedef enum Then {
    THEN_NOTHING,
    THEN_ENTER, /* its lines are walked through from the first one, */
    THEN_LEAVE, /* or from the last one back */
    THEN_PEAK,  /* it was taken by itself: an explosion in it is shown */
    THEN_TELL   /* it was taken again: both outcomes are told */
} Then;

/* Of a step that is taken again: what it was. */
typedef struct Retake {
    char had[160]; /* "no projection: E +206 in 12 updates" */
    char is[64];   /* what it is now: "projection clamp" */
    Command edit;  /* the change */
    bool alone;    /* two unlike outcomes may be put beside each other */
    double extent; /* m */
    int round;     /* the place in it; -1: none */
    Line line;
} Retake;

typedef struct Player {
    Options given[OPTIONS_MAX_PANES]; /* of the command line */
    int given_count;
    Past past;
    Side side[OPTIONS_MAX_PANES]; /* one for each of its panes */
    int active;                   /* the one whose numbers are shown */
    Then then;
    Retake retake;
    const struct Scene *scene; /* that is shown */
    Recording recording;
    long written;    /* the last step in its tables; -1: none */
    View *view;      /* NULL: nothing is drawn */
    bool window;     /* the view is a window: it takes keys */
    bool attended;   /* a window or a script: it may pause and go back */
    Script script;   /* of the command line */
    char line[1024]; /* the command line, without files and scripts */
    bool begun;      /* player_create worked */
    bool quit;       /* somebody asked for the end */
    bool changed;    /* the window must be drawn again */
    bool warned;     /* paused once because a step did not converge */
    bool holds;      /* the hand has not let go since it took a node */
    bool paused;
    bool halted;         /* by itself: at rest, at an end, after a failure */
    bool rests;          /* nothing moves any more, */
    bool balances;       /* and the forces are in balance */
    bool drifts;         /* it moves, and nothing deforms any more */
    bool leaving;        /* the last command was Escape, with nothing open */
    bool by_hand;        /* commands come from keys and mouse */
    bool by_run;         /* the step that is made was not asked for, */
    bool known;          /* and it is not new */
    int gesture;         /* so many keys, clicks, turns of the wheel */
    int grip;            /* the same of a script, < 0: of its present line, */
    int held;            /* of its last grab, which drags go on with, */
    int lines;           /* and the last one that was given */
    int noted;           /* gesture of the journal's last line; 0: no hand's */
    int within;          /* commands that are obeyed, one within the other */
    bool outermost_kept; /* the first of them is a line of the journal, */
    size_t before;       /* which had so many when it began */
    Script journal;      /* all that was done, undo and redo, too */
    int fine;            /* one on is: 0 a step, 1 an update, 2 a line */
    int speed;         /* s: 2^s steps a frame, or a frame 2^-s times as long */
    long sampled;      /* step of the last frame that was drawn; -1: none */
    bool refused;      /* a line of the script made no sense */
    char message[768]; /* why a command or the script cannot be obeyed, or "" */
    char note[SHOW_TEXT];              /* what a command just did, or "" */
    bool warning;                      /* and it is a bad thing */
    const volatile sig_atomic_t *stop; /* set by signals */
    double started;                    /* s, on the wall clock */
    double due;                        /* s, the next step */
    double began;                      /* s, work that is */
    bool under_way;                    /* and goes on in the next frame */
    double clock_mark, time_mark;      /* s, where the speed is measured from */
    double measured; /* simulated over real time; 0: unknown */

    /* What only the screen shows. */
    Lens lens;
    LectureColumn column;
    const LecturePage *left; /* the page that was last open, or NULL */
    bool strain, bare, help, blank;
    unsigned closed; /* cards that are not as the picture has them */
    int large, selected;
    double glide;   /* s, when the way to the next line began; 0: it is over */
    bool typing;    /* every key belongs into what is typed: */
    char typed[28]; /* for the selected number, or a page of the list */
    CommandKind chip[LAYOUT_CHIPS];        /* what the chips ask for */
    const OptionRow *number[OPTIONS_MOST]; /* what the row has */
    int numbers;
    Mouse mouse;
    Show show; /* of the last frame */
} Player;

/* Sets everything up.  Says on standard error if there is no screen, and then
 * asks for frames in the folder "frames" and 100 steps.
 *   options  [count] in, of the panes
 *   line     in, how the program was called, for messages
 *   stop     in, must live as long; not 0 ends the run after the present step
 *   player   out; must stay where it is; close it in any case
 * Returns OK, or why it failed; INVALID_INPUT: player->message may say more. */
Status player_create(const Options *options, int count, const char *line,
                     const volatile sig_atomic_t *stop, Player *player);

/* One step with its records.  OK also for a step that did not converge. */
Status player_step(Player *player);

/* Does what a command asks for.  Returns OK; INVALID_INPUT with the reason in
 * player->message where it makes no sense here; or a failure. */
Status player_obey(Player *player, const Command *command);

/* What happened at keyboard, mouse or window, as commands.  Returns as
 * player_obey. */
Status player_input(Player *player, const Input *input);

/* Draws, shows and records the state if there is a view. */
Status player_draw(Player *player);

/* Until the window is closed, or to the end. */
Status player_run(Player *player);

/* The same in its parts, for a program that is called a frame at a time, as a
 * page is: the first frame; inputs, script, steps and a frame, as far as they
 * are due; for how many milliseconds nothing is; whether it is over. */
Status player_start(Player *player);
Status player_frame(Player *player);
int player_wait(const Player *player);
bool player_ended(const Player *player);

/* Whether any step, or the scene as a whole, did not converge. */
bool player_unconverged(const Player *player);

/* The hash of the present state of all panes; see state_hash. */
uint64_t player_hash(const Player *player);

/* Finishes the files and frees all but the numbers that a summary needs.
 * Returns OK, OUT_OF_MEMORY or FILE_FAILED. */
Status player_finish(Player *player);
void player_free(Player *player);

/* What a run did, in a few lines at its end; the caller checks the stream. */
void summary_print(FILE *file, const Player *player);

/* Writes the lecture as an HTML file to options->handout; it appears when it is
 * whole.
 *   player   workspace; it must stay where it is
 *   stop     in, not 0 ends it after the present page: INTERRUPTED
 *   message  [size] out, what is wrong, where errno does not tell
 * Returns OK, OUT_OF_MEMORY, FILE_FAILED (errno), INTERRUPTED, or how a page
 * could not be drawn. */
Status handout_write(const Options *options, const volatile sig_atomic_t *stop,
                     Player *player, char *message, size_t size);

#endif
