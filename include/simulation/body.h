/* body.h - makes the mesh, start, obstacles and terms that options describe. */
#pragma once

#include "model/contact.h"
#include "simulation/simulation.h"

/* Returns the mesh of the options; a beam has fewer rows than columns. */
SquareMesh body_make_mesh(const Options *options);

/* Reads node numbers and PINS_WORDS, separated by commas; "top:2" is the top of
 * the second body.
 *   pinned  [nodes] in/out: 1 for each node that is named; NULL: the text is
 *           only checked
 * Returns the part of the text that names no node; NULL: there is none. */
const char *pins_parse(const char *text, const SquareMesh *shape,
                       unsigned char *pinned);

/* Returns the table of PINS_WORDS. */
NameTable pins_get_words(void);

/* Returns the height (m) that a scene adds to a run's body and grounds. */
double body_find_added_height(const Options *options, int run);

/* Gives gravity, terms and springs of a run the numbers of the present options.
 * Returns OK, OUT_OF_MEMORY. */
Status body_apply_options(Simulation *simulation, int run);

/* Creates the mesh, and for each run of the scene the system with all its terms
 * and the start.  The centre of a scene's ball is the last node.
 * Returns OK, INVALID_INPUT, TOO_LARGE, OUT_OF_MEMORY. */
Status create_square_scene(Simulation *simulation);

/* Checks that the integrator works with all terms of the body.  Most terms need
 * backward Euler.  Returns OK, or INVALID_INPUT with a message. */
Status body_check_method(const Options *options, Message message);

/* Checks that the body can start: obstacles have possible numbers, no body
 * overlaps an obstacle or another body, no cell is turned over.
 * Returns OK, INVALID_INPUT with a message, OUT_OF_MEMORY. */
Status body_check_start(const Options *options, Message message);

/* Reads positions and velocities of a run from options->state, a table that
 * --states wrote, or which of its springs are broken and have yielded from
 * options->state_springs, a table of --springs.  Columns are found by name.  A
 * table with several panes gives its first pane.
 *   nodes    nodes of each run; the rows of run r follow those of run r - 1
 *   x, v     [2 nodes] out, m, m/s
 *   system   in/out, with all its terms
 * Returns OK, OUT_OF_MEMORY, or INVALID_INPUT if the file has no such step, a
 * line that cannot be read, or another number of nodes, springs or runs. */
Status start_table_read(const Options *options, int run, int nodes, double *x,
                        double *v, Message message);
Status start_table_read_springs(const Options *options, int run, System *system,
                                Message message);
