/* pins.h - which nodes of the square never move: the text of --pin.
 */
#ifndef ELASTO_PINS_H
#define ELASTO_PINS_H

#include "base/status.h"

/* The words that --pin knows besides node numbers. */
#define PINS_WORDS "top-corners, top, bottom, left, right"

/* Reads node numbers and words, separated by commas.
 *   columns, rows  in, of cells; nodes are numbered column by column
 *   pinned  [(columns+1) (rows+1)] in/out: 1 for each that is named; NULL: the
 *           text is only checked
 * Returns OK or INVALID_INPUT. */
Status pins_read(const char *text, int columns, int rows,
                 unsigned char *pinned);

#endif
