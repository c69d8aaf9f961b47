/* paper.h - what a frame is drawn on: a canvas and texts in a size that fits
 * it.
 *
 * Sizes are in ems, the size of plain texts; layout.h says how many pixels one
 * has.  A line is `unit` pixels wide, 1 where the em has 14 pixels.
 */
#ifndef ELASTO_PAPER_H
#define ELASTO_PAPER_H

#include "picture/text.h"

typedef struct Paper {
    Canvas canvas;
    Text *text;   /* NULL: no font, nothing is written */
    double em;    /* pixels */
    double unit;  /* pixels */
    double least; /* ems, no letter but scripts is smaller */
} Paper;

/* White paper of this size in pixels, ready for the em that its layout has;
 * free it also after a failure.
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
Status paper_create(int width, int height, Paper *paper);
void paper_free(Paper *paper);

/* Ems to whole pixels. */
int paper_pixels(const Paper *paper, double ems);

/* One line of markup, made as printf does; y is its upper edge.  Returns its
 * width in pixels. */
int paper_write(Paper *paper, Face face, double size, Colour colour, double x,
                double y, Align align, const char *format, ...);

/* Takes last words away, with an ellipsis in their place, until the rest is at
 * most so many pixels wide.
 *   words  [room] in/out, markup */
void paper_shorten(Paper *paper, Face face, double size, int width, char *words,
                   size_t room);

/* In the middle of a box's height; smaller, to 0.6 of the size, where it is
 * wider than the box. */
int paper_fit(Paper *paper, Face face, double size, Colour colour, Box box,
              Align align, const char *markup);

/* On a piece of thin white, so that it can be read on a picture. */
int paper_panel(Paper *paper, Face face, double size, Colour colour, double x,
                double y, Align align, const char *markup);

/* The width it would have. */
int paper_width(Paper *paper, Face face, double size, const char *markup);

/* In at most `lines` lines of the box's width, each as high as what stands in
 * it, broken at blanks outside of braces; the last one ends with an ellipsis if
 * there is more.  lines 0: nothing is drawn, as many as it takes.  Returns the
 * pixels it took, downwards. */
int paper_paragraph(Paper *paper, Face face, double size, Colour colour,
                    Box box, int lines, const char *markup);

#endif
