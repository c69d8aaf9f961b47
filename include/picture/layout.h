/* layout.h - where everything in the window is.
 *
 * The layout is a function of the window's size and of what is open, never of
 * the numbers that are shown, so that the zones do not move.  layout_create
 * (frame_content.h) fills it.
 *
 *     +------------------------------------------------------+
 *     | strip: topic, sentence                  method, state |
 *     +----------------------------------+-------------------+
 *     | stage: one to six panes          | column: cards, or |
 *     |                                  | one page (help,   |
 *     |                                  | code)             |
 *     +----------------------------------+-------------------+
 *     | settings                                             |
 *     | time line                                            |
 *     | chips                                                |
 *     +------------------------------------------------------+
 *
 * A small window leaves zones out: first the column, then the settings, then
 * the chips.  In a bare window the stage is alone.  Pixels are those of the
 * canvas, y down.
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
    LAYOUT_ROWS = 128 /* rows of a list */
};

/* A box without width is not drawn. */
typedef struct Layout {
    int width, height; /* pixels of the window */
    double em;         /* pixels, size of the texts */
    Box strip, stage, column, settings_row, time_line, chip_row;
    int panes, cards, settings, chips;
    bool page;              /* help or code is in the column instead of cards */
    Box pane[LAYOUT_PANES]; /* inside the stage */
    Box card[LAYOUT_CARDS]; /* inside the column, or on the stage */
    Box setting[LAYOUT_SETTINGS];
    Box chip[LAYOUT_CHIPS]; /* a chip that does not fit has no width */
    int chips_left_out;     /* chips that do not fit, all before the last one */
    Box bars;               /* the bars of the steps, inside the time line */
    int cells;
    Box cell[LAYOUT_CELLS]; /* a square with a line below it for its name; the
                               group's heading is above its first cell */
} Layout;

typedef enum Zone {
    ZONE_NONE,
    ZONE_STRIP,
    ZONE_STAGE,      /* a stage; Hit.index: its pane */
    ZONE_CARD,       /* a card; Hit.index: its number */
    ZONE_CARD_CLOSE, /* the cross of a card; Hit.index: the card's number */
    ZONE_PAGE,       /* help or code */
    ZONE_PAGE_CLOSE, /* the cross of that page */
    ZONE_SETTING,    /* index: the setting */
    ZONE_TIME,
    ZONE_CHIP, /* index: the chip */
    ZONE_CELL  /* index: the cell of the sheet */
} Zone;

typedef struct Hit {
    Zone zone;
    int index;
    double at[2]; /* pixels, position of the mouse */
} Hit;

/* Finds the topmost part of the window at this pixel. */
Hit layout_hit(const Layout *layout, double x, double y);

/* Box of the cross that closes a card; card -1: the page in the column. */
Box layout_close_box(const Layout *layout, int card);

/* ---- stage and world ---------------------------------------------------- */

/* Maps the world to pixels: pixel = origin + (scale[0] x, -scale[1] y). */
typedef struct Camera {
    double scale[2];  /* pixels a metre, > 0 */
    double origin[2]; /* pixels, image of the point (0, 0) */
} Camera;

/* Zoom and pan by the user, relative to the view that fits the scene. */
typedef struct Lens {
    double zoom;   /* magnification; 1 fits the scene */
    double pan[2]; /* shift of the middle, as a part of the width and height of
                      the view that fits */
} Lens;

extern const Lens LENS_FITS;

/* Makes the camera that shows bounds [4] (left, bottom, right, top; m) in the
 * middle of the box, with the user's zoom and pan.
 *   stretched  x and y have different scales, so that the bounds fill the box
 */
Camera camera_create(Box box, const double bounds[4], bool stretched,
                     const Lens *lens);
static inline void camera_pixel(const Camera *camera, const double world[2],
                                double pixel[2])
{
    pixel[0] = camera->origin[0] + camera->scale[0] * world[0];
    pixel[1] = camera->origin[1] - camera->scale[1] * world[1];
}
void camera_world(const Camera *camera, double x, double y, double world[2]);

/* Zooms by a factor around pixel (x, y).  The zoom stays in 1e-3 ... 1e6. */
void lens_zoom(Lens *lens, Box box, double x, double y, double factor);

/* Pans by (dx, dy) pixels. */
void lens_move(Lens *lens, Box box, double dx, double dy);

#endif
