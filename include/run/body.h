/* body.h - the body that options describe: the square, or a beam of square
 * cells, where it begins, what it meets, and what becomes of its springs.
 */
#ifndef ELASTO_BODY_H
#define ELASTO_BODY_H

#include "model/contact.h"
#include "run/one_line.h"
#include "run/simulation.h"

/* The square, or of its rows the part that the scene has. */
SquareMesh body_shape(const Options *options);

/* The words that --pin knows besides node numbers. */
#define PINS_WORDS "top-corners, top, bottom, left, right, all"

/* Reads node numbers and words, separated by commas; "top:2" is the second
 * body's.
 *   pinned  [nodes] in/out: 1 for each that is named; NULL: the text is only
 *           checked
 * Returns OK or INVALID_INPUT. */
Status pins_read(const char *text, const SquareMesh *shape,
                 unsigned char *pinned);

/* Mesh and system of this run, with all terms of its options, and the run from
 * where they put it.  A ball that comes with the scene is the last node.
 * Returns OK, INVALID_INPUT, TOO_LARGE, OUT_OF_MEMORY. */
Status body_create(Simulation *simulation, int run);

/* Terms and springs of a run that goes on get the numbers of the simulation's
 * options.  Returns OK, TOO_LARGE, OUT_OF_MEMORY. */
Status body_follow(Simulation *simulation, int run);

/* The only run of a scene, which is this body. */
Status create_square(Simulation *simulation);

/* What the options ask for that only a step whose result is the minimiser
 * knows, in words; NULL: nothing. */
const char *body_needs_end_of_step(const Options *options);

/* Whether the body can begin where the options put it: obstacles make sense,
 * all gaps and cells are > 0.  Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
Status body_check(const Options *options, Refusal told);

/* A step of the table that --states wrote, for the nodes of one run; and of the
 * table that --springs wrote, for its springs: which are broken, what has
 * flowed.  Columns are found by their names, others may stand between them.
 *   step     below 0: the last one
 *   nodes    n of each run; those of run r follow those of run r - 1
 *   runs     of the scene
 *   x, v     [2n] out, m, m/s
 *   system   in/out, with all its terms
 * Returns OK; INVALID_INPUT: there is no such table or step, a line is no row
 * of it, or it has other nodes or springs or fewer runs, or more of them and no
 * panes.  (Of a table of several panes it takes the first.) */
Status start_table_read(const char *name, double step, int nodes, int run,
                        int runs, double *x, double *v, Refusal told);
Status start_springs_read(const Options *options, int run, int runs,
                          System *system, Refusal told);

#endif
