/* paper.h - what a picture is drawn on: a canvas, and a font that fits it.
 *
 * Sizes of everything but the square itself are in units: the smaller side of
 * the picture has PAPER_UNITS of them, so that any size looks the same.  A
 * line of text over it holds PAPER_LETTERS letters.
 */
#ifndef ELASTO_PAPER_H
#define ELASTO_PAPER_H

#include "picture/font.h"

enum { PAPER_UNITS = 450, PAPER_LETTERS = 62 };

typedef struct Paper {
    Canvas canvas;
    Font font;
    double unit; /* pixels */
} Paper;

/* From metres, y up, to pixels, y down. */
typedef struct Mapping {
    double scale;  /* pixels a metre */
    double x0, y0; /* pixels, where the origin is */
} Mapping;

/* White paper of this size in pixels; free it also after a failure.
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
Status paper_create(int width, int height, Paper *paper);
void paper_free(Paper *paper);

/* Units to whole pixels. */
int paper_pixels(const Paper *paper, double units);

/* Whether it is large enough for text that can be read. */
bool paper_shows_text(const Paper *paper);

/* Origin in the middle; `size` metres fill this part of the smaller side. */
Mapping paper_mapping(const Paper *paper, double size, double part);

/* A line between two points in metres, at least a pixel wide.
 *   a, b   [2] m, in
 *   width  units */
void paper_line(Paper *paper, const Mapping *mapping, const double *a,
                const double *b, double width, Colour colour);

/* A disc around a point in metres.  a [2] m, in; radius in units. */
void paper_disc(Paper *paper, const Mapping *mapping, const double *a,
                double radius, Colour colour);

/* Translucent white, to put text on. */
void paper_panel(Paper *paper, Box box);

/* One line of text; y is its upper edge.  The bold one has thicker strokes. */
void paper_text(Paper *paper, int x, int y, Align align, Colour colour,
                const char *text);
void paper_bold_text(Paper *paper, int x, int y, Align align, Colour colour,
                     const char *text);

#endif
