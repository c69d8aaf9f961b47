/* command.h - everything that keys, mouse, wheel and scripts can ask for.
 *
 * One table: a word for scripts, the words behind it, the keys and where they
 * mean this, and what it does in a few words, for the list of keys and for the
 * chips.  What a script can say is what the window obeys, so that a session can
 * be written down and played again, with a window or without.
 */
#ifndef ELASTO_COMMAND_H
#define ELASTO_COMMAND_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum { COMMAND_TEXT_SIZE = 64 };

typedef enum CommandKind {
    COMMAND_NONE,
    COMMAND_REDRAW,       /* the window was uncovered or resized */
    COMMAND_QUIT,         /* ends the program */
    COMMAND_TOGGLE_PAUSE, /* runs, or stops */
    COMMAND_PLAY,
    COMMAND_PAUSE,
    COMMAND_NEXT,        /* one on: a step, an update or a line */
    COMMAND_BACK,        /* one back, the same */
    COMMAND_STEP,        /* a whole new step from here */
    COMMAND_FINER,       /* from steps to updates to lines to steps */
    COMMAND_HOME,        /* step 0 */
    COMMAND_END,         /* the newest step */
    COMMAND_GOTO,        /* number: the step */
    COMMAND_UNDO,        /* what was changed last is not */
    COMMAND_REDO,        /* or is again */
    COMMAND_RESTART,     /* begins again */
    COMMAND_FASTER,      /* twice as many steps a second */
    COMMAND_SLOWER,      /* half as many */
    COMMAND_FILTER,      /* projection off, or on again */
    COMMAND_SEARCH,      /* line search off, or on again */
    COMMAND_METHOD,      /* the next integrator */
    COMMAND_ADD_PANE,    /* the next integrator, beside this one */
    COMMAND_END_PANE,    /* the last pane goes */
    COMMAND_PANE,        /* number: the pane whose numbers are shown */
    COMMAND_SET,         /* number: an option; x: its value, or text */
    COMMAND_DEFAULT,     /* number: an option, back to its default */
    COMMAND_SELECT,      /* the next number of the row */
    COMMAND_RAISE,       /* the selected number, a step up */
    COMMAND_LOWER,       /* or down */
    COMMAND_SCENE,       /* text: name or number, 1 is the first */
    COMMAND_START,       /* x, y: where the scene begins, m */
    COMMAND_GRAB,        /* number: the node that the hand takes */
    COMMAND_DRAG,        /* x, y: where it pulls it, m */
    COMMAND_RELEASE,     /* the hand lets go */
    COMMAND_PIN,         /* number: the node that is pinned or set free */
    COMMAND_HANDLE,      /* number, x, y: a point of the scene moves there, m */
    COMMAND_FLIP,        /* number: a part of the scene is switched off or on */
    COMMAND_ZOOM,        /* number percent, x, y: the point that stays, m */
    COMMAND_PAN,         /* x, y: how far the picture moves, m */
    COMMAND_FIT,         /* all of it in the picture */
    COMMAND_COLOURS,     /* springs by their strain */
    COMMAND_BARE,        /* the picture alone */
    COMMAND_KEYS,        /* the list of keys */
    COMMAND_CARD,        /* number: the card that is closed or opened */
    COMMAND_ENLARGE,     /* number: the card that takes the column */
    COMMAND_PREDICT,     /* x, y: where the next step will lead, m */
    COMMAND_CELL,        /* number: the cell of the envelope that is shown */
    COMMAND_PAGE,        /* text: a page of the lecture, number or name */
    COMMAND_PAGE_ON,     /* the next one; outside of the lecture the first */
    COMMAND_PAGE_BACK,   /* the one before */
    COMMAND_PAGES,       /* the list of pages */
    COMMAND_CODE,        /* the text of the page's function */
    COMMAND_HASH,        /* the hash of the state, and how to get there */
    COMMAND_SHOT,        /* a picture */
    COMMAND_FILM,        /* begins a film, or ends it */
    COMMAND_FULL,        /* full screen and back */
    COMMAND_BLANK,       /* a black screen and back */
    COMMAND_ESCAPE,      /* closes what is open; twice ends the program */
    COMMAND_TYPE_NUMBER, /* text: a key that begins the selected number, */
    COMMAND_TYPE_PAGE,   /* or that of a page in their list, */
    COMMAND_TYPE,        /* text: any key while it is typed, but those */
    COMMAND_ENTER,       /* that take it, */
    COMMAND_CLOSE,       /* or leave it alone */
    COMMAND_KINDS
} CommandKind;

typedef struct Command {
    CommandKind kind;
    long number; /* of an option: its row */
    double x, y;
    char text[COMMAND_TEXT_SIZE]; /* of an option: a value that is not one
                                     number, or makes no sense; else "" */
    bool joins; /* undone together with the one before it: "& set ..." */
} Command;

/* Who listens to the keys; a row of the table says for whom its keys are. */
typedef enum Keyboard {
    AT_RUN = 1,    /* the run, */
    AT_NUMBER = 2, /* while a number is selected, */
    AT_LIST = 4,   /* or the list of pages is open; */
    AT_FIELD = 8,  /* what is typed: it takes every key */
    AT_PLAY = AT_RUN | AT_NUMBER | AT_LIST
} Keyboard;

enum {
    REPEATS = 1, /* while the key is held down */
    KEPT = 2,    /* belongs into the script of a session */
    SCREEN = 4   /* concerns what is shown: obeyed while a step is computed;
                    all else ends that work first */
};

/* What a command does.  Returns as player_obey. */
struct Player;
typedef Status Deed(struct Player *player, const Command *command);

typedef struct CommandRow {
    Deed *deed;       /* NULL: nothing but what every command does */
    const char *word; /* in scripts; NULL: not there */
    const char *keys; /* "Space", "Ctrl+R", several: "?|F1", "*": any; NULL */
    /* What it does, for the list of keys; "": told with the row before it;
     * NULL: not in the list. */
    const char *label;
    unsigned flags;
    /* What stands behind the word, a letter each: n a whole number from 0, x
     * and y, w a word, o the name of an option, v its value; NULL: nothing. */
    const char *takes;
    Keyboard keyboard; /* 0: AT_PLAY */
    const char *chip;  /* what it does now, for the chips: "play|pause" */
} CommandRow;

/* The row of a kind. */
const CommandRow *command_row(CommandKind kind);

/* What a key asks for; COMMAND_NONE: nothing.  Its text is the key.
 *   key      "N", "Shift+N", "Left", "+"
 *   repeats  the key is held down */
Command command_from_key(const char *key, bool repeats, Keyboard keyboard);

/* "goto 12" and the like.
 *   line     in, without the step
 *   command  out
 *   message  [size] out, what is wrong, after INVALID_INPUT
 * Returns OK or INVALID_INPUT. */
Status command_parse(const char *line, Command *command, char *message,
                     size_t size);

/* The line that command_parse reads; numbers have 17 digits.
 *   line  [size] out */
void command_format(const Command *command, char *line, size_t size);

#endif
