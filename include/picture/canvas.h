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

enum {
    CANVAS_MAX_SIZE = 16384, /* pixels a side */
    CANVAS_MAX_WIDTH = 4096  /* pixels, of a line */
};

typedef struct Canvas {
    int width, height; /* pixels */
    uint32_t *pixels;  /* [width height] row by row, no gaps */
} Canvas;

/* A rectangle in pixels. */
typedef struct Box {
    int x, y, width, height;
} Box;

/* White.  width, height 1 ... CANVAS_MAX_SIZE; canvas out.
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
Status canvas_create(int width, int height, Canvas *canvas);

/* Accepts NULL and a zeroed struct. */
void canvas_free(Canvas *canvas);

/* Sets every pixel. */
void canvas_clear(Canvas *canvas, Colour colour);

/* Filled rectangle with corner (x, y), whole pixels. */
void canvas_rectangle(Canvas *canvas, int x, int y, int width, int height,
                      Colour colour);

/* Line of this width in pixels; the ends are cut off straight. */
void canvas_line(Canvas *canvas, double x0, double y0, double x1, double y1,
                 double width, Colour colour);

/* Filled disc. */
void canvas_disc(Canvas *canvas, double x, double y, double radius,
                 Colour colour);

/* A stencil: mask [width height] holds coverages 0 ... 255. */
void canvas_stencil(Canvas *canvas, int x, int y, int width, int height,
                    const uint8_t *mask, Colour colour);

#endif
