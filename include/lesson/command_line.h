/* command_line.h - the command line: reads values and lines into options, and
 * writes --help.
 */
#ifndef ELASTO_COMMAND_LINE_H
#define ELASTO_COMMAND_LINE_H

#include <stdio.h>

#include "run/options.h"

/* A single number as somebody types it, "1/60", "0,02", "4 ms", "clamp".
 *   value  out
 * Returns whether it can be read and is in the row's range. */
bool option_read(const OptionRow *row, const char *text, double *value);

/* argv into options, whose texts point into argv.  Where values of scene and
 * method are lists, "--timestep 0.004,0.04 --projection clamp,none" are four panes:
 * options->panes says so, and each has options of its own.
 *   pane     whose options, from 0
 *   options  out
 *   message  [size] out, one line without newline after INVALID_INPUT: the
 *            option, its value and its range stand in it, whole if 512 bytes
 *            are there
 * Returns OK or INVALID_INPUT.  Prints nothing. */
Status options_parse(int argc, char **argv, int pane, Options *options,
                     char *message, size_t size);

/* The same of one line, "drop --segments 8", that has no texts: no files, no
 * pins. */
Status options_of_line(const char *line, Options *options, char *message,
                       size_t size);

/* One option, by its name without dashes, of options that have a scene already:
 * what this scene cannot make use of is refused, as above. */
Status options_set(Options *options, const char *name, const char *value,
                   char *message, size_t size);

/* The same of a number, for a row with a single one; of a name its place.  NaN,
 * which a field gives that is empty, is refused as an empty text is. */
Status options_put(Options *options, const OptionRow *row, double value,
                   char *message, size_t size);

/* Writes the text of --help, 80 columns wide. */
void options_help(FILE *help);

#endif
