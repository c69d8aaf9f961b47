/* document.h - the frame as text, for a page that shows it beside the canvas.
 */
#ifndef ELASTO_DOCUMENT_H
#define ELASTO_DOCUMENT_H

#include "play/player.h"

/* Shows a card on a canvas of its own (window_web.c). */
void window_show_card(const Canvas *canvas, int card);

enum { DOCUMENT_SIZE = 48 << 10 };

/* Writes all texts of the last frame, with their numbers filled in; document.c
 * says which lines there are.
 *   text  [DOCUMENT_SIZE] out */
void document_write(const Player *player, char *text);

/* A colour for letters on white: darker where it would be too faint to read. */
unsigned document_colour(Colour colour);

/* What never changes: the pages of the lecture, the scenes, the keys.
 *   text  [DOCUMENT_SIZE] out */
void document_write_lists(char *text);

#endif
