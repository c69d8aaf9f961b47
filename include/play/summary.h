/* summary.h - what a run did, in a few lines at its end.
 */
#ifndef ELASTO_SUMMARY_H
#define ELASTO_SUMMARY_H

#include <stdio.h>

#include "play/player.h"

/* Writes the lines; the caller checks the stream. */
void summary_print(FILE *file, const Player *player);

#endif
