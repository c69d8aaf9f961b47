/* pins.h - which nodes of the square never move: the text of --pin.
 */
#ifndef ELASTO_PINS_H
#define ELASTO_PINS_H

#include "model/square_mesh.h"

/* The words that --pin knows besides node numbers. */
#define PINS_WORDS "top-corners, top, bottom, left, right"

/* Reads node numbers and words, separated by commas.
 *   pinned  [nodes] in/out: 1 for each that is named; NULL: the text is only
 *           checked
 * Returns OK or INVALID_INPUT. */
Status pins_read(const char *text, const SquareMesh *shape,
                 unsigned char *pinned);

#endif
