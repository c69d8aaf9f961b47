/* player.h - the application: plays simulations by commands of keys, mouse and
 * scripts, draws and records them, and goes back to earlier steps.
 *
 *   keys, mouse, chips, scripts, pages -> Command    (input.c, command.h)
 *   player_obey: calls the command's function        (obey.c)
 *   that function: edits the past, or chooses the step to be shown
 *   do_work: past_continue_work until that step is shown   (obey.c)
 *
 * From key to Newton: player_obey_input, player_obey, do_work,
 * past_continue_work, pane_iterate, simulation_advance,
 * time_integrator_continue, newton_minimise.  In a window do_work returns after
 * SLICE; the next frames go on with the work (player_make_frame,
 * make_due_steps, player_make_step). */
#pragma once

#include <signal.h>

#include "play/past.h"
#include "play/command.h"
#include "simulation/options.h"
#include "play/recording.h"
#include "play/window.h"

/* Command line and script of the program, and what follows from them. */
typedef struct PlayerSetup {
    Options options[OPTIONS_MAX_PANES]; /* options of each pane */
    char *const *arguments; /* command line, ended by NULL; or NULL */
    Script script;
    const volatile sig_atomic_t *stop_signal; /* not 0: the run ends */
    double start_time; /* time on the wall clock when the run began, s */
    bool is_attended;  /* a window, script or page can control the run */
    bool asks_guess;   /* pages hide the answer until the user guesses */
} PlayerSetup;

enum {
    MIN_LOG_SPEED = -6, /* lowest speed: a step every 64 frames, about 1 s */
    MAX_LOG_SPEED = 10  /* highest speed: 1024 steps a frame */
};

/* Whether steps are made by themselves, and why not. */
typedef enum PlayMode {
    MODE_RUN,
    MODE_PAUSE, /* paused by the user or a page, or after a failure */
    MODE_END,   /* the scene is over, or a step did not converge */
    MODE_REST   /* the bodies are at rest, the forces in balance */
} PlayMode;

/* Action after the work that leads to a step. */
typedef enum ActionAfterWork {
    AFTER_NOTHING,
    AFTER_SHOW_FIRST_LINE, /* show the step's first line of Algorithm 3 */
    AFTER_SHOW_LAST_LINE,  /* show the step's last line of Algorithm 3 */
    AFTER_SHOW_STEP_END,   /* show the step's end; if E exploded, its peak */
    AFTER_COMPARE_OUTCOMES /* compare the outcomes before and after an edit */
} ActionAfterWork;

/* How a pane shows the present step. */
typedef struct PaneView {
    int trace_index; /* index in StepTrace.position; -1: end of the step */
    double *ghost_x; /* [2n] m, positions before an edit, or NULL */
    char ghost_label[256]; /* setting and outcome of the step before an edit */
} PaneView;

/* How steps follow each other. */
typedef struct Playback {
    PlayMode mode;
    TimeUnit walk_unit; /* unit of "next" and "back" */
    ActionAfterWork after_work;
    WalkPosition wanted_position; /* shown after an edit; iterate < 0: none */
    int log_speed;                /* 2^log_speed steps a frame */
    double due_time;        /* time of the next step on the wall clock, s */
    double work_start_time; /* start of the work on the wall clock, s; 0: no
                               work */
    bool has_stopped_unconverged; /* the run was stopped where a step did not
                                     converge */
    bool has_reported_gain;       /* a rise of the total energy was reported */
} Playback;

enum { MAX_QUEUED_COMMANDS = 16 };

/* Commands that wait for the end of the present command and of a step being
 * made: commands that a command has added, and drags during a step. */
typedef struct CommandQueue {
    Command command[MAX_QUEUED_COMMANDS];
    int count;               /* number of commands */
    bool is_from_page;       /* the commands belong to a page */
    const UserControl *pins; /* pins to set after the last command, or NULL */
    char end_note[SENTENCE_SIZE]; /* message when the queue is empty, or "" */
} CommandQueue;

/* Queue, journal and gestures.  Undo takes back all commands of a gesture. */
typedef struct Commands {
    CommandQueue queue;
    int gesture_id;      /* id of the present gesture, which is undone as one */
    int gesture_count;   /* number of gestures so far, the id of the newest */
    int drag_gesture_id; /* gesture of the last grab or push */
    Script journal;      /* commands of the session, with undo and redo */
    CommandKind quit_command; /* command that ends the program if repeated */
    bool has_refused_line;    /* a line of the script was refused */
} Commands;

/* The guided tour, page by page. */
typedef struct Tour {
    const LecturePage *tour_page;     /* page that was last open, or NULL */
    const LecturePage *revealed_page; /* page whose answer is shown, or NULL */
    char asked_question[ANSWER_SIZE]; /* question of revealed_page */
    char verdict[VALUE_SIZE]; /* verdict on the guess at the page, or "" */
    int guess_count, right_guess_count; /* numbers of guesses and right ones */
    bool is_page_running;               /* a page's commands are running */
    Options page_options[OPTIONS_MAX_DRAWN_PANES]; /* options of each pane */
} Tour;

enum { LABEL_SIZE = 64 }; /* bytes */

/* Contents of the last frame; `content` points to the other fields. */
typedef struct WindowFrame {
    FrameContent content;
    History history[LAYOUT_MAX_PANES];
    NewtonTrace trace[LAYOUT_MAX_PANES];
    char pane_label[LAYOUT_MAX_PANES][LABEL_SIZE]; /* how each pane differs */
    CommandKind chip_command[LAYOUT_MAX_CHIPS];    /* command of each chip */
    int option_count; /* number of options in the row */
    const OptionRow *option[OPTIONS_MAX_ROWS];
} WindowFrame;

/* How the window or the frames show the past. */
typedef struct Screen {
    bool draws_frames;    /* frames are drawn, for a window or for files */
    const Window *window; /* the open window, or NULL */
    Paper paper;
    int paper_size[2]; /* pixels of the paper; 0: the size of the window */
    bool must_redraw;  /* the frame must be drawn again */
    long drawn_step;   /* step of the last frame; -1: out of date */
    const struct Scene *scene; /* scene that camera and cards are set for */
    const LecturePage *page;   /* page that camera and cards are set for */
    ColumnContent column;
    struct Sheet *sheet;     /* open sheet of scenes, or NULL */
    bool has_toggled_strain; /* strain colours differ from the scene's choice */
    bool is_bare;            /* the picture is shown without texts and cards */
    bool is_black;           /* a black screen is shown */
    unsigned toggled_cards; /* bit c: card c was opened or closed by the user */
    int enlarged_card;      /* index of the enlarged card; -1: none */
    FrameView view;
    WindowFrame frame;
} Screen;

/* The mouse and what it drags. */
typedef struct Mouse {
    double x, y;              /* pixels */
    bool has_position;        /* x and y are known */
    CommandKind drag_command; /* kind of drag; COMMAND_NONE: no drag */
    int dragged_index;     /* index of the dragged part; -1: none, or an edge */
    double drag_start[2];  /* pixels, mouse at start of drag or at last pan */
    bool has_moved;        /* the mouse has moved farther than a click may */
    double grip_offset[2]; /* from the mouse to the dragged obstacle, m */
    bool repins_node;      /* the dragged node is pinned again after the drag */
    bool was_wheel_turn;   /* the last input was a turn of the wheel */
    int input_gesture_id;  /* gesture id of the last key, click or wheel turn */
    Options drag_options;  /* options at the start of a drag of a number */
} Mouse;

/* Objects that the user holds or has selected, and the typed text. */
typedef struct InputState {
    Mouse mouse;         /* mouse and its drag */
    bool is_holding;     /* a node or an obstacle is held */
    long last_pull_step; /* step at which the hand last moved what it holds */
    const OptionRow *selected_option; /* option with the selected number */
    uint64_t added_option_rows;       /* bit r: the user added option r */
    bool is_typing;      /* a field is open: keys go into `typed` */
    char typed_text[28]; /* typed value, answer, or number of a list's line */
} InputState;

typedef struct Player {
    PlayerSetup setup;
    Past past;
    PaneView view_of_pane[OPTIONS_MAX_PANES];
    int active_pane; /* index of the active pane, whose numbers are shown */
    Recording recording;
    Playback play;
    Commands commands;
    Tour tour;
    Screen screen;
    InputState input;
    bool is_quitting;         /* the program is asked to end */
    char message[768];        /* why a command was refused, or "" */
    char note[SENTENCE_SIZE]; /* message in the title bar, or "" */
    bool is_warning;          /* the note is a warning */
    bool explains_hover; /* a sentence about the part under the mouse replaces
                            the note: the mouse has moved since the note */
} Player;

/* Creates a player, which without a screen writes 100 frames to "frames".
 *   options  [options->panes] in, options of each pane
 *   words    in, command line, ended by NULL, or NULL; outlives the player
 *   window   in, NULL only with --headless
 *   stop     in, not 0 ends the run after this iteration; outlives the player
 *   player   out; must not be moved; free it in any case
 * Returns OK or a failure; player->message may explain INVALID_INPUT. */
Status player_create(const Options *options, char *const *words,
                     const Window *window, const volatile sig_atomic_t *stop,
                     Player *player);

/* Continues the work that leads to the step to be shown, or begins the work for
 * the next step; then records the step and obeys the queue.  With a window, a
 * call can leave work undone.  Returns OK also after an unconverged step. */
Status player_make_step(Player *player);

/* Obeys a command, then the commands in the queue.  Returns OK, INVALID_INPUT
 * with the reason in player->message, or a failure. */
Status player_obey(Player *player, const Command *command);

/* Obeys an input as commands.  Returns as player_obey. */
Status player_obey_input(Player *player, const Input *input);

/* Draws, shows and records a frame, if the player draws. */
Status player_draw(Player *player);

/* Makes frames until the window is closed or the run is over. */
Status player_run(Player *player);

/* Makes a frame: reads inputs, obeys the script, makes due steps and draws. */
Status player_make_frame(Player *player);

/* Whether nothing happens before the next input. */
bool player_is_idle(const Player *player);

/* Returns the time until the next frame is due, ms. */
int player_find_wait_time(const Player *player);

/* Whether the run is over. */
bool player_has_ended(const Player *player);

/* Describes how a pane differs: "h 0.01 s, ended at step 3".  A value that all
 * panes but one share is left out, unless the label would be empty. */
void player_write_label(const Player *player, int pane, char label[LABEL_SIZE]);

/* Returns the hash of the present states of all panes (state_hash). */
uint64_t player_compute_hash(const Player *player);

/* Copies the present options of all panes.  Returns the number of panes. */
int player_copy_options(const Player *player,
                        Options options[OPTIONS_MAX_PANES]);

/* Finishes the files and closes the window; the past can still be read.
 *   status  in, last status of the run; after a failure files stay NAME.part
 * Returns `status` unless it is OK; else OK, OUT_OF_MEMORY or FILE_FAILED. */
Status player_close_files(Player *player, Status status);
void player_free(Player *player);

/* ---- the program --------------------------------------------------------- */

enum ExitCode {
    EXIT_NONE = -1, /* no exit: the run begins */
    EXIT_FINE = 0,
    EXIT_FAILED = 1,     /* the run failed */
    EXIT_MISUSED = 2,    /* the command line or a line of the script is wrong */
    EXIT_UNCONVERGED = 3 /* the run ended, but steps did not converge */
};

/* Returns the index, from i on, of the next word of the command line that
 * decides what is simulated, not how long or with which files; 0: no such word.
 * The first call has i = 1, each further call the last index + 1. */
int player_find_first_scene_word(const Player *player, int i);

/* Reads the command line; prints --help, --version or a list, or creates the
 * player.  Prints a failure as one line on standard error.
 *   argv    in, ended by NULL; outlives the player
 *   stop    in, not 0 ends the run after this iteration; outlives the player
 *   player  out, before its first frame; free it in any case
 * Returns EXIT_NONE, or an exit code if there is no run. */
int program_begin(int argc, char **argv, const Window *window,
                  const volatile sig_atomic_t *stop, Player *player);

/* Finishes the files after the last status of a run, and prints the summary or
 * why the run failed.  Returns the exit code. */
int program_end(Player *player, Status status);
