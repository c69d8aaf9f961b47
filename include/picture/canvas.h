/* canvas.h - a picture in memory and anti-aliased shapes on it.
 *
 * The origin is the upper left corner, y points down, and pixel (i, j) covers
 * [i, i+1) x [j, j+1).  A shape adds its colour in proportion to the part of
 * the pixel that it covers.  Everything is clipped; NaN and infinite
 * coordinates draw nothing.
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

/* A place without its fraction; very far ones, and NaN, as far as can be
 * calculated with. */
int pixel_at(double place);

/* Smaller by a margin on each side, but not below nothing. */
Box box_inset(Box box, int margin);
bool box_contains(Box box, double x, double y);

/* Takes a strip of so many pixels off one edge of `rest`. */
typedef enum Edge { EDGE_TOP, EDGE_BOTTOM, EDGE_LEFT, EDGE_RIGHT } Edge;
Box box_cut_off(Box *rest, Edge edge, int pixels);

/* What two boxes share, the first of them at corners >= 0. */
Box box_shared(Box a, Box b);

/* Shortens the line x, y, x, y to the box and a margin around it (Liang and
 * Barsky 1984); false: nothing of it is there. */
bool box_cut(const Box *box, double margin, double line[4]);

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
void canvas_free(Canvas *canvas);

/* Draws only inside this box from now on, as far as it lies in the picture.
 * Returns the clip of before, for the end. */
Box canvas_clip(Canvas *canvas, Box box);

/* Sets every pixel, whatever the clip is. */
void canvas_clear(Canvas *canvas, Colour colour);

void canvas_fill(Canvas *canvas, Box box, Colour colour);

/* Filled, with a border one pixel wide. */
void canvas_card(Canvas *canvas, Box box, Colour fill, Colour border);

/* Line of this width in pixels; the ends are cut off straight. */
void canvas_line(Canvas *canvas, double x0, double y0, double x1, double y1,
                 double width, Colour colour);

/* In dashes of 5 units with gaps of 4.
 * phase  pixels of the pattern that lie before the line, in/out: a polyline
 *        of several calls has even dashes; NULL: begin with a dash */
void canvas_dashes(Canvas *canvas, const double a[2], const double b[2],
                   double width, double unit, double *phase, Colour colour);

/* A line with a filled head of this length at (x1, y1); a line shorter than
 * the head has a smaller one. */
void canvas_arrow(Canvas *canvas, double x0, double y0, double x1, double y1,
                  double width, double head, Colour colour);

/* Filled; corners [6]: x, y, x, y, x, y.  Without smooth edges those that share
 * an edge leave no seam. */
void canvas_triangle(Canvas *canvas, const double corners[6], bool smooth,
                     Colour colour);

/* A ring of this line width. */
void canvas_ring(Canvas *canvas, double x, double y, double radius,
                 double width, Colour colour);
void canvas_disc(Canvas *canvas, double x, double y, double radius,
                 Colour colour);

/* A stencil: mask [width height] holds coverages 0 ... 255. */
void canvas_stencil(Canvas *canvas, int x, int y, int width, int height,
                    const uint8_t *mask, Colour colour);

#endif
