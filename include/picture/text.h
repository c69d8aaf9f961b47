/* text.h - words and formulas: FreeType with DejaVu Sans.
 *
 * Letters are drawn once for each size and kept in a cache.  Texts are UTF-8.
 * A combining mark (U+0303) stands over the letter before it.  Markup:
 *     ^{...} _{...}            superscript, subscript
 *     frac{a over b}           fraction
 *     matrix{a & b; c & d}     matrix in brackets, row by row
 *     #p{...}                  text in the colour of this name (colour_map.h)
 *     {x} {xt} {p} {alpha}     letters of the slides in their colours (xt is x
 *                              with a tilde); in COLOUR_GREY they stay grey
 * Any other brace is an ordinary character. */
#pragma once

#include <stddef.h>

#include "picture/canvas.h"

typedef enum Face { FACE_REGULAR, FACE_BOLD, FACE_MONO, FACE_COUNT } Face;

/* A line of text begins at x, is centred at x, or ends at x. */
typedef enum Align { ALIGN_LEFT, ALIGN_CENTRE, ALIGN_RIGHT } Align;

typedef struct TextStyle {
    Face face;
    double size; /* pixels an em, 5 ... 400; other sizes draw nothing */
    Colour colour;
    bool is_plain;   /* has no markup; braces are ordinary characters */
    double min_size; /* pixels, least size in superscripts and fractions */
} TextStyle;

typedef struct Font Font;

/* Opens the fonts: $ELASTO_FONT (a .ttf file; empty: no font at all), then
 * DejaVu Sans from the usual folders.
 *   text  out; NULL: no font was found.  With NULL the functions below draw
 *         nothing and take letters to be 0.6 em wide.
 * Returns OK, OUT_OF_MEMORY. */
Status font_create(Font **text);
void font_free(Font *text);

/* Returns the distance between two lines of words, pixels. */
double text_line_height(double size);

/* Extent of a line of text, at least as high as a line of words */
typedef struct TextExtent {
    double width, ascent, descent; /* pixels; the width is a whole number */
} TextExtent;
TextExtent text_measure(Font *text, const TextStyle *style, const char *markup);

/* Counts the bytes of a text, fewer than `room`, that fit into this width.  The
 * text is cut at a blank outside of braces; at least one word fits.
 *   extent  out, extent of the part that fits */
size_t text_break_line(Font *text, const TextStyle *style, int width,
                       const char *markup, size_t room, TextExtent *extent);

/* Draws a line of words whose top is at y; fractions reach higher.  Returns the
 * line's width, pixels. */
int text_draw(Font *text, Canvas *canvas, const TextStyle *style, double x,
              double y, Align align, const char *markup);

/* Returns the colour with this name of `length` bytes ("warning", "p",
 * "elastic"); COLOUR_TEXT for an unknown name. */
Colour colour_find_by_name(const char *name, size_t length);

/* Whether this brace of a text belongs to the markup. */
bool text_is_markup_brace(const char *text, const char *brace);

/* ---- letters, from which type.c sets lines ------------------------------- */

#define FONT_GUESSED 0.6 /* ems, width of a letter if there is no font */

/* A letter in one face and size. */
typedef struct Glyph {
    uint64_t key;      /* face, size and letter as one number; 0: a free slot */
    int left, top;     /* pixels from the pen to the mask: right, down */
    int advance;       /* pixels to the next letter */
    int width, height; /* pixels of the mask */
    uint8_t *mask;     /* [height width] coverage; NULL: no pixel is covered */
} Glyph;

/* Finds or draws a letter, valid until the next call; size in pixels. */
const Glyph *font_get_glyph(Font *text, Face face, int size, uint32_t letter);
