/* command.h - everything that keys, mouse, wheel and scripts can ask for.
 *
 * One table has a row for each command: its word and arguments in scripts, its
 * keys, and what it does.  The window obeys the same commands as a script, so a
 * session can be written down and played again.
 */
#ifndef ELASTO_COMMAND_H
#define ELASTO_COMMAND_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "run/message.h"

enum { COMMAND_TEXT_SIZE = 64 };

/* command_rows.def says what each command does, as does --help commands. */
typedef enum CommandKind {
    COMMAND_NONE,
#define ROW(kind, ...) COMMAND_##kind,
#include "play/command_rows.def"
#undef ROW
    COMMAND_KINDS
} CommandKind;

typedef struct Command {
    CommandKind kind;
    long number; /* index of a node, a card, ...; the row of an option */
    double x, y;
    char text[COMMAND_TEXT_SIZE]; /* a name; the value of an option unless x has
                                     it; else "" */
    bool joins; /* the command joins the gesture before it: "& set ..." */
} Command;

/* The parts of the window that keys can go to; a row says to which its keys
 * belong. */
typedef enum Keyboard {
    AT_RUN = 1,
    AT_NUMBER = 2,    /* a number is selected */
    AT_LIST = 4,      /* the list of pages or of numbers is open */
    AT_FIELD = 8,     /* a text is typed: the field takes every key */
    AT_SHEET = 16,    /* the sheet of scenes is open */
    AT_QUESTION = 32, /* a page waits for a guess */
    AT_PLAY = AT_RUN | AT_NUMBER | AT_LIST | AT_QUESTION,
    AT_ANY = AT_PLAY | AT_SHEET
} Keyboard;

enum {
    REPEATS = 1, /* is repeated while the key is held down */
    KEPT = 2,    /* is written into the script of a session */
    SCREEN = 4,  /* changes only the screen: obeyed while a step is made; other
                    commands abandon the step first */
    LATEST = 8,  /* replaces the same command before it in a drag */
    QUIET = 16   /* keeps the message below the picture */
};

typedef struct CommandRow {
    const char *word; /* in scripts, or NULL */
    const char *does; /* for --help commands */
    unsigned flags;
    const char *keys;  /* "Space", "Ctrl+R"; several: "?|F1"; "*": any;
                          "letters":  all that type text; or NULL */
    const char *label; /* for the list of keys; "": the keys belong to the row
                          before; NULL: not listed */
    const char *takes; /* arguments: "N X Y", a whole number from 0 and two more
                          numbers; "OPTION VALUE"; a name; or NULL */
    Keyboard keyboard; /* 0: AT_PLAY */
    const char *chip;  /* words for what it does now: "play|pause" */
} CommandRow;

extern const CommandRow command_rows[COMMAND_KINDS];

/* Returns the command of a key, with the key as its text, or COMMAND_NONE.
 *   key      in, "N", "Shift+N", "Left", "+"
 *   repeats  in, the key is held down */
Command command_from_key(const char *key, bool repeats, Keyboard keyboard);

/* Prints the text of --help commands. */
void commands_help(FILE *file);

/* Reads a line like "goto 12".
 *   line     in, without the step
 *   message  out, the reason of INVALID_INPUT
 * Returns OK or INVALID_INPUT. */
Status command_parse(const char *line, Command *command, Message message);

/* Writes the line that command_parse reads, numbers with 17 digits.
 *   line  [size] out */
void command_format(const Command *command, char *line, size_t size);

/* ---- scripts ------------------------------------------------------------- */

/* Commands from a file, a line each: the step at which the command is obeyed, a
 * space, the command.  Empty lines and comments after # are skipped.
 *     0 set timestep 0.01
 *     40 grab 12
 *     40 & drag 0.5 0.5
 * A command with & joins the gesture of the line before: both are undone as
 * one. Lines are obeyed in their order.  A line waits until the run has reached
 * its step, unless the run is paused or at its end. */
typedef struct ScriptLine {
    long step;
    Command command;
    int gesture; /* id; 0: not known */
} ScriptLine;

typedef struct Script {
    ScriptLine *line; /* [count] in their order */
    size_t count, size;
    size_t next; /* index of the next line */
} Script;

/* Appends a line.  Returns OK, OUT_OF_MEMORY. */
Status script_add(Script *script, long step, const Command *command,
                  int gesture);

/* Reads a script.
 *   name     in, NULL: the script is empty
 *   script   out; free it in any case
 *   message  out, the reason of INVALID_INPUT
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
Status script_read(const char *name, Script *script, Message message);

/* Writes a script after a comment with the command line that plays it.  Returns
 * OK, OUT_OF_MEMORY, FILE_FAILED. */
Status script_write(const char *name, const char *line, const Script *script);

/* Returns the next command if it is due, or NULL.
 *   waits  the run goes on: commands of later steps are not due */
const Command *script_due(Script *script, long step, bool waits);

/* Whether all lines were obeyed. */
bool script_is_over(const Script *script);

void script_free(Script *script);

#endif
