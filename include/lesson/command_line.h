/* command_line.h - reads command lines and single options, and
 * writes --help.
 */
#ifndef ELASTO_COMMAND_LINE_H
#define ELASTO_COMMAND_LINE_H

#include <stdio.h>

#include "run/message.h"
#include "run/options.h"

/* Reads a command line into options, whose texts point into argv.  Lists of
 * values make several panes: "--timestep 0.004,0.04 --projection clamp,none" is
 * four.  options->panes is their number; each pane has its own options.
 *   pane     number of the pane, from 0
 *   options  out
 *   message  out, after INVALID_INPUT a line with the option, its value
 *            and its range; 512 bytes are enough
 * Returns OK or INVALID_INPUT. */
Status options_parse(int argc, char **argv, int pane, Options *options,
                     Message message);

/* Reads a line such as "drop --segments 8", without files and pins. */
Status options_of_line(const char *line, Options *options, Message message);

/* Sets an option, named without dashes, to a value as on the command line.
 * Options that the scene cannot use are refused, with a message as above. */
Status options_set(Options *options, const char *name, const char *value,
                   Message message);

/* Sets an option that has one number, or one name by its index, with the same
 * checks as options_set.  NaN is refused as an empty text would be. */
Status options_put(Options *options, const OptionRow *row, double value,
                   Message message);

/* Writes the text of --help, 80 columns wide. */
void options_help(FILE *help);

#endif
