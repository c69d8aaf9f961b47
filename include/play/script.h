/* script.h - commands from a file, each with the step at which it is given.
 *
 * One command a line: the step, a space, the command; empty lines and what
 * stands behind # are skipped.
 *     0 pause
 *     0 set timestep 0.01
 *     0 play
 *     40 grab 12
 * `40 & set stretch 1.2` is undone together with the line before it, as what
 * one drag does is.  The lines are obeyed in their order.  A line waits until
 * the run has reached its step; a run that is paused, or at its end, waits for
 * nothing.
 */
#ifndef ELASTO_SCRIPT_H
#define ELASTO_SCRIPT_H

#include "play/command.h"

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
Status script_add(Script *script, long step, const Command *command);

/* Reads the file of --script; NULL: there is none.
 *   script   out; free it in any case
 *   message  [size] out: what is wrong with the file or with which line
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
Status script_read(const char *name, Script *script, char *message,
                   size_t size);

/* Writes what script_read reads.  Returns OK, OUT_OF_MEMORY, FILE_FAILED. */
Status script_write(const char *name, const Script *script);

/* The next command if it is due, or NULL.
 *   waits  the run goes on by itself: later steps are waited for */
const Command *script_due(Script *script, long step, bool waits);

/* Whether every line was obeyed. */
bool script_is_over(const Script *script);

void script_free(Script *script);

#endif
