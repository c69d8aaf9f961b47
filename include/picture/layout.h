/* layout.h - places of all parts of the window.
 *
 * The layout depends on the window's size and on the open parts, but not on the
 * numbers that are shown, so that the zones stand still.  layout_create
 * (frame_content.h) makes it.
 *
 *     +------------------------------------------------------+
 *     | title bar: topic, sentence              method, state |
 *     +----------------------------------+-------------------+
 *     | stage: one to six panes          | column: cards, or |
 *     |                                  | code, or a list   |
 *     +----------------------------------+-------------------+
 *     | settings                                             |
 *     | time line                                            |
 *     | chips                                                |
 *     +------------------------------------------------------+
 *
 * A small window leaves zones out: first the column, then the settings, then
 * the chips.  In a bare window the stage is alone.  Pixels are those of the
 * canvas, y down. */
#pragma once

#include "picture/canvas.h"

enum {
    LAYOUT_MAX_PANES = 6,
    LAYOUT_MAX_CARDS = 14,
    LAYOUT_MAX_SETTINGS = 16,
    LAYOUT_MAX_CHIPS = 16,
    LAYOUT_MAX_CELLS = 32,
    LAYOUT_MAX_ROWS = 128 /* most rows of a list */
};

/* The boxes of all parts.  A box without width is not drawn. */
typedef struct Layout {
    int width, height; /* pixels of the window */
    double em;         /* pixels of an em, the size of plain text */
    Box title_bar, stage, column, settings_row, time_line, chip_row;
    int pane_count, card_count, setting_count,
        chip_count; /* numbers of boxes */
    bool has_list;  /* the column shows code or a list, not cards */
    Box pane[LAYOUT_MAX_PANES];
    Box card[LAYOUT_MAX_CARDS]; /* the cards; a main card is on the stage */
    Box setting[LAYOUT_MAX_SETTINGS];
    Box chip[LAYOUT_MAX_CHIPS]; /* a chip that does not fit has no width */
    int omitted_chips;          /* number of chips that do not fit */
    Box step_bars;              /* bars of the steps, inside the time line */
    int cell_count;             /* number of cells of the overview */
    Box cell[LAYOUT_MAX_CELLS]; /* scene's square and name, no heading */
} Layout;

typedef enum WindowZone {
    ZONE_NONE,
    ZONE_TITLE_BAR,
    ZONE_STAGE,      /* index: number of the pane */
    ZONE_CARD,       /* index: number of the card */
    ZONE_CARD_CLOSE, /* the cross that closes a card; index: its number */
    ZONE_LIST,       /* the column with code or a list */
    ZONE_LIST_CLOSE, /* the cross that closes code or list */
    ZONE_SETTING,    /* index: number of the setting */
    ZONE_TIME_LINE,
    ZONE_CHIP, /* index: number of the chip */
    ZONE_CELL  /* index: number of the cell of the overview */
} WindowZone;

typedef struct WindowHit {
    WindowZone zone;
    int index;       /* number of the pane, card, ... in the zone */
    double pixel[2]; /* pixels, position of the mouse */
} WindowHit;

/* Finds the topmost part of the window at this pixel. */
WindowHit layout_find_hit(const Layout *layout, double x, double y);

/* Returns the box of the cross that closes a card; -1: the code or list. */
Box layout_cross_box(const Layout *layout, int card);

/* ---- stage and world (camera.c) ----------------------------------------- */

/* Maps the world to pixels: pixel = origin + (scale[0] x, -scale[1] y). */
typedef struct Camera {
    double scale[2];  /* pixels per metre along x and y, > 0 */
    double origin[2]; /* pixels, image of the point (0, 0) */
} Camera;

/* The user's zoom and pan, relative to the view that fits the scene. */
typedef struct Lens {
    double zoom;   /* magnification; 0 means 1 */
    double pan[2]; /* shift in widths and heights of the box at zoom 1 */
    bool shows_all_obstacles; /* the view widens to every obstacle, however far
                                 away */
} Lens;

extern const Lens LENS_FITS;

/* Makes the camera that shows the bounds in the middle of the box, with the
 * user's zoom and pan.
 *   bounds     [4] m: left, bottom, right, top
 *   stretched  x and y have scales of their own: the bounds fill the box */
Camera camera_create(Box box, const double bounds[4], bool stretched,
                     const Lens *lens);
static inline void camera_to_pixel(const Camera *camera, const double world[2],
                                   double pixel[2])
{
    pixel[0] = camera->origin[0] + camera->scale[0] * world[0];
    pixel[1] = camera->origin[1] - camera->scale[1] * world[1];
}
void camera_to_world(const Camera *camera, double x, double y, double world[2]);

/* Zooms by a factor around pixel (x, y).  The zoom stays in 1e-3 ... 1e6. */
void lens_zoom(Lens *lens, Box box, double x, double y, double factor);

/* Pans by (dx, dy) pixels. */
void lens_pan(Lens *lens, Box box, double dx, double dy);
