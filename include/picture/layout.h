/* layout.h - where everything in the window is: a function of its size alone
 * and of what is open, never of the numbers shown, so that zones stay put.
 * show_layout (show.h) fills it.
 *
 *     +------------------------------------------------------+
 *     | strip: topic, sentence                  method, state |
 *     +----------------------------------+-------------------+
 *     | stage: one to six panes          | column: cards, or |
 *     |                                  | one page (help,   |
 *     |                                  | code)             |
 *     +----------------------------------+-------------------+
 *     | row of settings                                      |
 *     | time line                                            |
 *     | last line: chips                                     |
 *     +------------------------------------------------------+
 *
 * Small windows fold: first the column goes, then the settings, then the last
 * line.  Bare: the stage fills the window and nothing else is there.  Pixels
 * are those of the canvas, y down.
 */
#ifndef ELASTO_LAYOUT_H
#define ELASTO_LAYOUT_H

#include "picture/canvas.h"

enum {
    LAYOUT_PANES = 6,
    LAYOUT_CARDS = 14,
    LAYOUT_SETTINGS = 16,
    LAYOUT_CHIPS = 16,
    LAYOUT_CELLS = 32,
    LAYOUT_ROWS = 128 /* of a list */
};

/* A box without width is not there. */
typedef struct Layout {
    int width, height; /* pixels of the whole */
    double em;         /* pixels, size of the texts */
    Box strip, stage, column, row, time, last;
    int panes, cards, settings, chips;
    bool page;              /* help or code is in the column, no cards */
    Box pane[LAYOUT_PANES]; /* inside the stage */
    Box card[LAYOUT_CARDS]; /* inside the column, or on the stage */
    Box setting[LAYOUT_SETTINGS];
    Box chip[LAYOUT_CHIPS]; /* without width: there is no room for it */
    int chips_left_out;     /* so many of them, all before the last one */
    Box bars;               /* inside time: where the bars of the steps are */
    int cells;
    Box cell[LAYOUT_CELLS]; /* a square, and below it a line for its name; above
                               the first of a group a line for the heading */
} Layout;

typedef enum Zone {
    ZONE_NONE,
    ZONE_STRIP,
    ZONE_STAGE,      /* index: the pane */
    ZONE_CARD,       /* index: the card */
    ZONE_CARD_CLOSE, /* index: the card; its cross was hit */
    ZONE_PAGE,       /* help or code */
    ZONE_PAGE_CLOSE, /* its cross */
    ZONE_SETTING,    /* index: the setting */
    ZONE_TIME,
    ZONE_CHIP, /* index: the chip */
    ZONE_CELL  /* index: the cell of the sheet */
} Zone;

typedef struct Hit {
    Zone zone;
    int index;
    double at[2]; /* pixels, where the mouse is */
} Hit;

/* What is at this pixel: of things above each other the upper one. */
Hit layout_hit(const Layout *layout, double x, double y);

/* The cross that closes a card, or -1: the page in their place. */
Box layout_close_box(const Layout *layout, int card);

/* ---- stage and world ---------------------------------------------------- */

/* From the world to pixels: pixel = origin + (scale[0] x, -scale[1] y). */
typedef struct Camera {
    double scale[2];  /* pixels a metre, > 0 */
    double origin[2]; /* pixels, where (0, 0) is */
} Camera;

/* What the user did with the camera; {1, {0, 0}} fits. */
typedef struct Lens {
    double zoom;   /* > 1: closer */
    double pan[2]; /* how far the middle was moved, in parts of the width and
                      height that fit */
} Lens;

extern const Lens LENS_FITS;

/* The camera that shows bounds [4] (left, bottom, right, top; m) in the middle
 * of the box, then looked at through the lens.
 *   stretched  x and y have scales of their own, and fill the box */
Camera camera_create(Box box, const double bounds[4], bool stretched,
                     const Lens *lens);
static inline void camera_pixel(const Camera *camera, const double world[2],
                                double pixel[2])
{
    pixel[0] = camera->origin[0] + camera->scale[0] * world[0];
    pixel[1] = camera->origin[1] - camera->scale[1] * world[1];
}
void camera_world(const Camera *camera, double x, double y, double world[2]);

/* Zooms by a factor so that the point under pixel (x, y) stays there; moves by
 * (dx, dy) pixels.  The zoom stays in 1e-3 ... 1e6. */
void lens_zoom(Lens *lens, Box box, double x, double y, double factor);
void lens_move(Lens *lens, Box box, double dx, double dy);

#endif
