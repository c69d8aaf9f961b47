/* command.h - the commands of keys, mouse, wheel and scripts.
 *
 * The table command_rows has a row for each command.  The window obeys the same
 * commands as a script: a session can be saved as a script and played again. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "simulation/message.h"

enum { COMMAND_TEXT_SIZE = 64 };

/* Each command is explained in command_rows.def, and by --help commands if it
 * has a name. */
typedef enum CommandKind {
    COMMAND_NONE,
#define ROW(kind, ...) COMMAND_##kind,
#include "play/command_rows.def"
#undef ROW
    COMMAND_KIND_COUNT
} CommandKind;

typedef struct Command {
    CommandKind kind;
    long number; /* index of a node, card, obstacle, row of options, ... */
    double x, y; /* position, m; x also the value of an option */
    char text[COMMAND_TEXT_SIZE]; /* name or value that is no number, or "" */
    bool joins_gesture; /* is undone with Commands.gesture_id; "&" in scripts */
} Command;

/* The part of the window that gets the keys; a row can name several. */
typedef enum KeyScope {
    SCOPE_RUN = 1,       /* no number, list, field, sheet, question is open */
    SCOPE_NUMBER = 2,    /* a number is selected */
    SCOPE_LIST = 4,      /* the list of pages or of numbers is open */
    SCOPE_FIELD = 8,     /* a text is typed: the field takes every key */
    SCOPE_SHEET = 16,    /* the sheet of scenes is open */
    SCOPE_QUESTION = 32, /* a page waits for a guess */
    SCOPE_PLAY = SCOPE_RUN | SCOPE_NUMBER | SCOPE_LIST | SCOPE_QUESTION,
    SCOPE_ANY = SCOPE_PLAY | SCOPE_SHEET /* any part but a field of text */
} KeyScope;

enum {
    REPEATS = 1,       /* is repeated while the key is held down */
    IN_SCRIPT = 2,     /* is written into the script of a session */
    KEEPS_STEP = 4,    /* does not abandon a step that is being made */
    REPLACES_SAME = 8, /* in a gesture, replaces the last command of its kind */
    KEEPS_NOTE = 16    /* does not clear Player.note */
};

typedef struct CommandRow {
    const char *name;  /* name in scripts; NULL: none */
    const char *help;  /* explanation for --help commands */
    unsigned flags;    /* bits REPEATS, IN_SCRIPT, ... */
    const char *keys;  /* "Space", "Ctrl+R"; several: "?|F1"; "*": any key;
                          "letters": keys that type text; NULL: none */
    const char *label; /* text in the list of keys; "": the keys are listed with
                          those of the row before; NULL: not listed */
    const char *args;  /* arguments: "N X Y", a whole number from 0 and two
                          numbers; "OPTION VALUE"; a name; NULL: none */
    KeyScope key_scope;      /* parts in which the keys work; 0: SCOPE_PLAY */
    const char *chip_labels; /* labels of its chip, by state: "pause|play" */
} CommandRow;

extern const CommandRow command_rows[COMMAND_KIND_COUNT];

/* Returns the command of a key such as "Shift+N", with the key as its text, or
 * COMMAND_NONE.
 *   repeats  in, the key is held down */
Command command_from_key(const char *key, bool repeats, KeyScope scope);

/* Prints the text of --help commands. */
void commands_print_help(FILE *file);

/* Reads a line such as "goto 12".  Returns OK, INVALID_INPUT with a message. */
Status command_parse(const char *line, Command *command, Message message);

/* Writes the line that command_parse reads, its numbers with 17 digits.
 *   line  [size] out */
void command_format(const Command *command, char *line, size_t size);

/* Whether a command replaces `before`, as each new place of a drag does. */
bool command_replaces(const Command *command, const Command *before);

/* ---- scripts ------------------------------------------------------------- */

/* A line of a script: the step at which the command is obeyed, a space, the
 * command.  Empty lines and comments after # are skipped.
 *     0 set timestep 0.01
 *     40 grab 12
 *     40 & drag 0.5 0.5
 * A command with & is undone together with the command of the line before.  A
 * line waits for its step, unless the run is paused or at its end. */
typedef struct ScriptLine {
    long due_step; /* step at which the line is obeyed */
    Command command;
    int gesture_id; /* id of the command's gesture; 0: not known */
} ScriptLine;

typedef struct Script {
    ScriptLine *line;       /* [lines] */
    size_t lines, capacity; /* number of lines; room for lines */
    size_t next_line;       /* index of the next line to be obeyed */
} Script;

/* Appends a line.  A command of the same gesture that the new one replaces
 * (command_replaces) is overwritten.  Returns OK, OUT_OF_MEMORY. */
Status script_add(Script *script, long step, const Command *command,
                  int gesture);

/* Reads a script.
 *   name     in, name of a file; NULL: the script is empty
 *   script   out; free it in any case
 *   message  out, reason of INVALID_INPUT
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
Status script_read(const char *name, Script *script, Message message);

/* Writes a script, below a comment with the command line that plays it.
 * Returns OK, FILE_FAILED. */
Status script_write(const char *name, const char *line, const Script *script);

/* Returns the command of the next line if it is due, or NULL.
 *   waits  in, lines of later steps are not due; false: every line is due */
const Command *script_take_due_command(Script *script, long step, bool waits);

bool script_is_over(const Script *script);

void script_free(Script *script);
