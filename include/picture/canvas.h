/* canvas.h - a picture in memory and anti-aliased shapes on it.
 *
 * The origin is the upper left corner, y points down, and pixel (i, j) covers
 * [i, i+1) x [j, j+1).  A shape adds its colour in proportion to the part of
 * the pixel that it covers.  NaN and infinite coordinates draw nothing. */
#pragma once

#include <stdint.h>

#include "base/status.h"

/* 0xAARRGGBB; A = 255 is opaque. */
typedef uint32_t Colour;

enum { CANVAS_MAX_SIZE = 16384 }; /* pixels a side */

/* A rectangle in pixels. */
typedef struct Box {
    int x, y, width, height; /* pixels, from the upper left corner */
} Box;

/* Rounds a coordinate towards 0 and clamps it to -2^29 ... 2^29 pixels; NaN
 * becomes -2^29. */
int pixel_from_coordinate(double place);

/* Returns the box without a margin on each side; sizes are at least 0. */
Box box_inset(Box box, int margin);
bool box_contains(Box box, double x, double y);

typedef enum BoxEdge { EDGE_TOP, EDGE_BOTTOM, EDGE_LEFT, EDGE_RIGHT } BoxEdge;
/* Cuts a strip, `pixels` wide, off one edge of `rest`. Returns the strip. */
Box box_cut_off(Box *rest, BoxEdge edge, int pixels);

/* Returns the intersection of two boxes; a.x and a.y must be >= 0. */
Box box_intersect(Box a, Box b);

/* Clips the line {x0, y0, x1, y1} to the box and a margin around it (Liang and
 * Barsky 1984).  Returns false if the line lies outside. */
bool box_clip_line(const Box *box, double margin, double line[4]);

typedef struct Canvas {
    int width, height; /* pixels */
    Box clip;          /* drawing changes only pixels in this box */
    uint32_t *pixels;  /* [height width] rows from top to bottom */
} Canvas;

/* Returns an opaque colour between `one` (part = 0) and `other` (part = 1). */
Colour colour_mix(Colour one, Colour other, double part);

/* Creates a white canvas of 1 ... CANVAS_MAX_SIZE pixels a side.  Returns OK,
 * INVALID_INPUT, OUT_OF_MEMORY. */
Status canvas_create(int width, int height, Canvas *canvas);
void canvas_free(Canvas *canvas);

/* Limits drawing to this box.  Returns the previous clip, to be restored. */
Box canvas_set_clip(Canvas *canvas, Box box);

/* Sets every pixel, also outside of the clip. */
void canvas_clear(Canvas *canvas, Colour colour);

void canvas_fill(Canvas *canvas, Box box, Colour colour);

/* A filled box with a border one pixel wide. */
void canvas_framed_box(Canvas *canvas, Box box, Colour fill, Colour border);

/* A line of this width in pixels, with straight ends. */
void canvas_line(Canvas *canvas, double x0, double y0, double x1, double y1,
                 double width, Colour colour);

/* A line of dashes of 5 units with gaps of 4 units.
 *   unit   length in pixels
 *   phase  in/out, length of the polyline before this segment, pixels, modulo
 *          9 units; NULL: the line begins with a dash */
void canvas_dashes(Canvas *canvas, const double a[2], const double b[2],
                   double width, double unit, double *phase, Colour colour);

/* A line with a filled head at (x1, y1), at most `head` pixels long. */
void canvas_arrow(Canvas *canvas, double x0, double y0, double x1, double y1,
                  double width, double head, Colour colour);

/* A filled triangle.
 *   c       corners x, y, x, y, x, y
 *   smooth  anti-aliases the edges; false: no seam between two triangles */
void canvas_triangle(Canvas *canvas, const double c[6], bool smooth,
                     Colour colour);

/* A circle, drawn as a line of this width. */
void canvas_ring(Canvas *canvas, double x, double y, double radius,
                 double width, Colour colour);
void canvas_disc(Canvas *canvas, double x, double y, double radius,
                 Colour colour);

/* Blends the colour into a rectangle with upper left corner (x, y).
 *   mask  [height width] in, coverage of each pixel, 0 ... 255 */
void canvas_fill_mask(Canvas *canvas, int x, int y, int width, int height,
                      const uint8_t *mask, Colour colour);
