/* font.h - the letters in the window: printable ASCII, drawn in font.c as a
 * sheet of 5 x 9 dots a letter, and smoothed to any size.
 */
#ifndef ELASTO_FONT_H
#define ELASTO_FONT_H

#include "picture/text.h"

enum {
    FONT_COLUMNS = 6, /* width of a letter with the gap after it, dots */
    FONT_ROWS = 10,   /* distance of two lines, dots */
    FONT_GLYPHS = 96  /* ' ' ... '~' and a box for everything else */
};

typedef struct Font {
    int width, height; /* of a letter, pixels */
    uint8_t *mask;     /* [FONT_GLYPHS height width] coverage 0 ... 255 */
} Font;

/* Whether dot (column, row) of this character is set; outside: no. */
bool font_dot(unsigned char character, int column, int row);

/* Letters of this size.
 *   unit  pixels a dot, > 0 and at most 64
 *   font  out; free it with font_free, also after a failure
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
Status font_create(double unit, Font *font);

/* Accepts NULL and a zeroed struct. */
void font_free(Font *font);

/* Width of a text in pixels. */
int font_width(const Font *font, const char *text);

/* One line of text; y is its upper edge. */
void font_draw(const Font *font, Canvas *canvas, int x, int y, Align align,
               Colour colour, const char *text);

#endif
