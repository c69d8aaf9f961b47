/* text.h - words and formulas: FreeType with DejaVu Sans.
 *
 * Fonts are opened and letters drawn once for each size; after that a letter
 * costs as much as its pixels.  Texts are UTF-8.  Marks such as U+0303 stand
 * over the middle of the letter before them.  In markup
 *     ^{...} _{...}            are superscripts and subscripts,
 *     frac{a over b}           a fraction,
 *     matrix{a & b; c & d}     a matrix in brackets, row by row,
 *     #p{...}                  what has the colour of this name (colour_map.h),
 *     {x} {xt} {p} {alpha}     the slides' letters in theirs (xt: x with a
 *                              tilde); in COLOUR_GREY all stay grey;
 *     any other brace          is itself.
 */
#ifndef ELASTO_TEXT_H
#define ELASTO_TEXT_H

#include <stddef.h>

#include "picture/canvas.h"

typedef enum Face { FACE_REGULAR, FACE_BOLD, FACE_MONO, FACE_COUNT } Face;

/* Which point of the text the given x is. */
typedef enum Align { ALIGN_LEFT, ALIGN_CENTRE, ALIGN_RIGHT } Align;

typedef struct TextStyle {
    Face face;
    double size; /* pixels an em; below 5 nothing is drawn, at most 400 */
    Colour colour;
    bool plain;   /* no markup: every character is itself */
    double least; /* pixels, no script and no part of a fraction is smaller */
} TextStyle;

typedef struct Text Text;

/* Looks for the fonts: $ELASTO_FONT (a .ttf file; empty: no text at all), then
 * where systems keep DejaVu Sans.
 *   text  out; NULL if no font was found, which is no failure: every function
 *         here accepts NULL, draws nothing and measures as if the letters
 *         were 0.6 em wide
 * Returns OK, OUT_OF_MEMORY. */
Status text_create(Text **text);
void text_free(Text *text);

/* Pixels from the upper edge of a line of words to that of the next. */
double text_line(double size);

/* Pixels, the width whole; above and below of the baseline, no less than a line
 * of words. */
typedef struct TextExtent {
    double width, above, below;
} TextExtent;
TextExtent text_extent(Text *text, const TextStyle *style, const char *markup);

/* One line; y is the upper edge of its words, beyond which fractions and
 * matrices reach.  Returns the width. */
int text_draw(Text *text, Canvas *canvas, const TextStyle *style, double x,
              double y, Align align, const char *markup);

/* A colour by its name in texts, which has so many bytes: "warning", "p",
 * "elastic", ...; that of all text for any other. */
Colour colour_named(const char *name, size_t length);

/* Whether this brace of a text belongs to the markup. */
bool text_is_markup(const char *text, const char *brace);

#endif
