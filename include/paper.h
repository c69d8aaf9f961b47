/* paper.h - what a picture is drawn on: a canvas, and a font that fits it.
 *
 * Sizes of everything but the square itself are in units: the smaller side of
 * the picture has PAPER_UNITS of them, so that any size looks the same.
 */
#ifndef ELASTO_PAPER_H
#define ELASTO_PAPER_H

#include "font.h"

enum { PAPER_UNITS = 450 };

typedef struct Paper {
    Canvas canvas;
    Font font;
    double unit; /* pixels */
} Paper;

/* A rectangle in pixels, y down. */
typedef struct Box {
    int x, y, width, height;
} Box;

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

/* Translucent white, to put text on. */
void paper_panel(Paper *paper, Box box);

/* One line of text; y is its upper edge. */
void paper_text(Paper *paper, int x, int y, Align align, Colour colour,
                const char *text);

#endif
