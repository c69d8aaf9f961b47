/* document.h - writes the texts that the page shows beside its canvas. */
#pragma once

#include "play/player.h"

/* Shows the canvas of a card in the page; card -1 is the picture. */
Status web_show_card(const Canvas *canvas, int card);

enum { DOCUMENT_SIZE = 48 << 10 };

/* Writes the texts of the last frame; the head of document.c lists their kinds.
 *   text  [DOCUMENT_SIZE] out */
void document_write(const Player *player, char *text);

/* Returns the colour, darkened until its letters can be read on white. */
unsigned document_darken(Colour colour);

/* Writes a line for each page of the lecture, each scene and each key:
 *     pages ADDRESS TOPIC, scenes ADDRESS TEXT, keys KEY MEANING
 *   text  [DOCUMENT_SIZE] out */
void document_write_lists(char *text);
