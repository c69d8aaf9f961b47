/* command_line.h - reads command lines and options, and writes --help. */
#pragma once

#include <stdio.h>

#include "simulation/message.h"
#include "simulation/options.h"

/* Reads a command line into options, whose texts point into argv.  Lists of
 * values make several panes: "--timestep 0.004,0.04 --projection clamp,none"
 * makes four.  options->panes is the number of panes.
 *   pane     number of the pane, from 0
 *   options  out
 *   message  out, after INVALID_INPUT a line with the option, its value
 *            and its range; 512 bytes are enough
 * Returns OK or INVALID_INPUT. */
Status options_parse(int argc, char **argv, int pane, Options *options,
                     Message message);

/* Reads a line like "drop --segments 8", which names no files and no nodes. */
Status options_parse_line(const char *line, Options *options, Message message);

/* Sets options to the defaults, changed by the command line of the page.
 * Returns OK or INVALID_INPUT.  A test checks that all pages return OK. */
Status lecture_make_options(const struct LecturePage *page, Options *options,
                            Message message);

/* Sets an option that has a value.  An option that the scene cannot use, or
 * that does not fit the others, is refused with a message.
 *   text   in, value as on the command line; "": take `value`
 *   value  number, or index of a name; NaN is refused like an empty text */
Status options_set(Options *options, const OptionRow *row, const char *text,
                   double value, Message message);

/* Writes the text of --help, 80 columns wide. */
void options_print_help(FILE *help);
