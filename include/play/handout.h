/* handout.h - the lecture as one HTML file for a course's page: words, pictures
 * and films of every page.
 *
 * The pictures are what the window shows, played without a screen; films are
 * animated PNGs.  Everything stands in the file itself: it has no scripts and
 * asks no network.
 */
#ifndef ELASTO_HANDOUT_H
#define ELASTO_HANDOUT_H

#include "play/player.h"

/* Writes it to options->handout; the file appears when it is whole.
 *   player   workspace; it must stay where it is
 *   stop     in, not 0 ends it after the present page: INTERRUPTED
 *   message  [size] out, what is wrong, where errno does not tell
 * Returns OK, OUT_OF_MEMORY, FILE_FAILED (errno), INTERRUPTED, or how a page
 * could not be drawn. */
Status handout_write(const Options *options, const volatile sig_atomic_t *stop,
                     Player *player, char *message, size_t size);

#endif
