/* font.h - the letters of text.c, from which type.c sets lines. */
#ifndef ELASTO_FONT_H
#define ELASTO_FONT_H

#include "picture/text.h"

#define FONT_GUESSED 0.6 /* ems, width of a letter if there is no font */

/* A letter in one face and size. */
typedef struct Glyph {
    uint64_t key;  /* face, size and letter as one number; 0: a free slot */
    int left, top; /* pixels from the pen on the baseline to the mask */
    int advance;   /* pixels to the next letter */
    int width, height;
    uint8_t *mask; /* [height width] coverage; NULL: no pixel is covered */
} Glyph;

/* Finds or draws a letter; size in pixels.  Valid until the next call. */
const Glyph *font_get_glyph(Text *text, Face face, int size, uint32_t letter);

#endif
