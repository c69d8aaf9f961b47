/* program.h - the program from its command line to its exit code, wherever it
 * runs.  What is wrong it says in one line on standard error.
 */
#ifndef ELASTO_PROGRAM_H
#define ELASTO_PROGRAM_H

#include "play/player.h"

/* How the program ends. */
enum ExitCode {
    PROGRAM_PLAYS = -1, /* not yet */
    EXIT_FINE = 0,
    EXIT_FAILED = 1,     /* while running */
    EXIT_MISUSED = 2,    /* the command line, or a line of its script */
    EXIT_UNCONVERGED = 3 /* the run ended, but steps did not converge */
};

/* Does what a command line asks for, until it is to be played.
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
