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
#include <stdio.h>

#include "base/status.h"

enum { COMMAND_TEXT_SIZE = 64 };

/* What each does is in its row, and told by --help commands. */
typedef enum CommandKind {
    COMMAND_NONE,
#define ROW(kind, ...) COMMAND_##kind,
#include "play/command_rows.def"
#undef ROW
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
    AT_SHEET = 16, /* while the sheet of scenes is shown: no key of the run */
    AT_QUESTION = 32, /* a page waits for a guess */
    AT_PLAY = AT_RUN | AT_NUMBER | AT_LIST | AT_QUESTION,
    AT_ANY = AT_PLAY | AT_SHEET
} Keyboard;

enum {
    REPEATS = 1, /* while the key is held down */
    KEPT = 2,    /* belongs into the script of a session */
    SCREEN = 4,  /* concerns what is shown: obeyed while a step is computed;
                    all else ends that work first */
    LATEST = 8,  /* of several in one drag the last one does what all do */
    QUIET = 16   /* leaves the message of before */
};

typedef struct CommandRow {
    const char *word; /* in scripts; NULL: not there */
    const char *does; /* for whoever reads or writes one */
    unsigned flags;
    const char *keys; /* "Space", "Ctrl+R", several: "?|F1"; "*": any;
                         "letters": all that can be typed; NULL: none */
    /* What it does, for the list of keys; "": told with the row before it;
     * NULL: not in the list. */
    const char *label;
    /* What stands behind the word: "N X Y", a whole number from 0 and two more;
     * "OPTION VALUE"; or a name; NULL: nothing. */
    const char *takes;
    Keyboard keyboard; /* 0: AT_PLAY */
    const char *chip;  /* what it does now, for the chips: "play|pause" */
} CommandRow;

extern const CommandRow command_rows[COMMAND_KINDS]; /* of each kind */

/* What a key asks for; COMMAND_NONE: nothing.  Its text is the key.
 *   key      "N", "Shift+N", "Left", "+"
 *   repeats  the key is held down */
Command command_from_key(const char *key, bool repeats, Keyboard keyboard);

/* The text of --help commands. */
void commands_help(FILE *file);

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

/* ---- scripts ------------------------------------------------------------- */

/* Commands from a file, each with the step at which it is given: a line each,
 * the step, a space, the command; empty lines and what stands behind # are
 * skipped.
 *     0 set timestep 0.01
 *     40 grab 12
 * `40 & set stretch 1.2` is undone together with the line before it, as what
 * one drag does is.  The lines are obeyed in their order.  A line waits until
 * the run has reached its step; a run that is paused, or at its end, waits for
 * nothing. */
typedef struct ScriptLine {
    long step;
    Command command;
    int gesture; /* it was part of; 0: unknown */
} ScriptLine;

typedef struct Script {
    ScriptLine *line; /* [count] in their order */
    size_t count, size;
    size_t next; /* the line that is due next */
} Script;

/* Appends a line.  Returns OK, OUT_OF_MEMORY. */
Status script_add(Script *script, long step, const Command *command,
                  int gesture);

/* Reads the file of --script; NULL: there is none.
 *   script   out; free it in any case
 *   message  [size] out: what is wrong with the file or with which line
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
Status script_read(const char *name, Script *script, char *message,
                   size_t size);

/* Writes what script_read reads, behind a comment with the command line that
 * plays it.  Returns OK, OUT_OF_MEMORY, FILE_FAILED. */
Status script_write(const char *name, const char *line, const Script *script);

/* The next command if it is due, or NULL.
 *   waits  the run goes on by itself: later steps are waited for */
const Command *script_due(Script *script, long step, bool waits);

/* Whether every line was obeyed. */
bool script_is_over(const Script *script);

void script_free(Script *script);

#endif
