/* canvas.h - a picture in memory and anti-aliased shapes on it.
 *
 * Pixels are 0xAARRGGBB; the origin is the upper left corner, y points down,
 * and pixel (i, j) covers [i, i+1) x [j, j+1).  A shape adds its colour in
 * proportion to the part of the pixel that it covers.  Everything is clipped;
 * NaN and infinite coordinates draw nothing.
 */
#ifndef ELASTO_CANVAS_H
#define ELASTO_CANVAS_H

#include <stdint.h>

#include "base/status.h"

/* 0xAARRGGBB; A = 255 is opaque. */
typedef uint32_t Colour;

enum { CANVAS_MAX_SIZE = 16384 }; /* pixels a side */

/* A rectangle in pixels. */
typedef struct Box {
    int x, y, width, height;
} Box;

typedef struct Canvas {
    int width, height; /* pixels */
    Box clip;          /* inside the picture; nothing is drawn beyond it */
    uint32_t *pixels;  /* [width height] row by row, no gaps */
} Canvas;

/* The colour between two, `part` of the second, 0 ... 1; opaque. */
Colour canvas_mix(Colour one, Colour other, double part);

/* White.  width, height 1 ... CANVAS_MAX_SIZE; canvas out.
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
Status canvas_create(int width, int height, Canvas *canvas);

/* Accepts NULL and a zeroed struct. */
void canvas_free(Canvas *canvas);

/* Draws only inside this box from now on, as far as it lies in the picture.
 * Returns the clip of before, for the end. */
Box canvas_clip(Canvas *canvas, Box box);

/* Shortens the line x, y, x, y to the box and a margin around it (Liang and
 * Barsky 1984); false: nothing of it is there. */
bool box_cut(const Box *box, double margin, double line[4]);

/* Sets every pixel, whatever the clip is. */
void canvas_clear(Canvas *canvas, Colour colour);

/* Filled rectangle with corner (x, y), whole pixels. */
void canvas_rectangle(Canvas *canvas, int x, int y, int width, int height,
                      Colour colour);

/* Line of this width in pixels; the ends are cut off straight. */
void canvas_line(Canvas *canvas, double x0, double y0, double x1, double y1,
                 double width, Colour colour);

/* The same in dashes of `on` pixels with gaps of `off` pixels, both > 0.
 * phase  pixels of the pattern that lie before the line, in/out: a polyline
 *        of several calls has even dashes; NULL: begin with a dash */
void canvas_dashes(Canvas *canvas, double x0, double y0, double x1, double y1,
                   double width, double on, double off, double *phase,
                   Colour colour);

/* A line with a filled head of this length at (x1, y1); a line shorter than
 * the head has a smaller one. */
void canvas_arrow(Canvas *canvas, double x0, double y0, double x1, double y1,
                  double width, double head, Colour colour);

/* Filled triangle; corners [6]: x, y, x, y, x, y.  Without smooth edges those
 * that share an edge leave no seam. */
void canvas_triangle(Canvas *canvas, const double corners[6], bool smooth,
                     Colour colour);

/* A box with round corners, filled, and a border one pixel wide; border 0:
 * none. */
void canvas_card(Canvas *canvas, Box box, double radius, Colour fill,
                 Colour border);

/* A ring of this line width. */
void canvas_ring(Canvas *canvas, double x, double y, double radius,
                 double width, Colour colour);

/* Copies a picture onto this one, corner at (x, y). */
void canvas_copy(Canvas *canvas, const Canvas *from, int x, int y);

/* Filled disc. */
void canvas_disc(Canvas *canvas, double x, double y, double radius,
                 Colour colour);

/* A stencil: mask [width height] holds coverages 0 ... 255. */
void canvas_stencil(Canvas *canvas, int x, int y, int width, int height,
                    const uint8_t *mask, Colour colour);

#endif
