/* font.h - the letters of text.c, which type.c sets. */
#ifndef ELASTO_FONT_H
#define ELASTO_FONT_H

#include "picture/text.h"

#define FONT_GUESSED 0.6 /* ems a letter is wide, without a font */

/* A letter, drawn once. */
typedef struct Glyph {
    uint64_t key;           /* 0: a free place */
    int left, top, advance; /* pixels, of the mask from pen and baseline */
    int width, height;
    uint8_t *mask; /* [height width] coverage, or NULL: nothing to draw */
} Glyph;

/* From the cache, or drawn; size in pixels.  It is valid until the next call.
 */
const Glyph *font_glyph(Text *text, Face face, int size, uint32_t letter);

#endif
