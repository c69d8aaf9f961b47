/* view.h - where frames are shown: a window, or a surface that nobody sees.
 *
 * Both work alike: draw on view_paper, then view_show.  SDL's types stay
 * inside view.c; its renderer only carries the finished picture to the screen,
 * so the picture is the same on all of them.
 */
#ifndef ELASTO_VIEW_H
#define ELASTO_VIEW_H

#include <stddef.h>

#include "picture/paper.h"

typedef struct View View;

/* What a key or the window system asks for. */
typedef enum CommandKind {
    COMMAND_NONE,
    COMMAND_QUIT,
    COMMAND_REDRAW, /* the window was uncovered or resized */
    COMMAND_PAUSE,
    COMMAND_STEP,
    COMMAND_RESTART,
    COMMAND_FASTER,
    COMMAND_SLOWER,
    COMMAND_SCREENSHOT,
    COMMAND_COLOURS,
    COMMAND_TEXT,
    COMMAND_FILTER,
    COMMAND_LINE_SEARCH,
    COMMAND_KEYS,
    COMMAND_SCENE, /* number: 0 is the first */
    COMMAND_PICK,  /* x, y: pixels of the paper */
} CommandKind;

typedef struct Command {
    CommandKind kind;
    int number;
    double x, y;
} Command;

/* A window of about 900 x 900.
 *   view    out; free it with view_free; NULL after a failure
 *   reason  [size] out, one line, why there is no window
 * Returns OK, OUT_OF_MEMORY, SCREEN_FAILED. */
Status view_create_window(const char *title, View **view, char *reason,
                          size_t size);

/* A surface in memory with SDL's software renderer; needs no screen.
 * Returns OK, OUT_OF_MEMORY, SCREEN_FAILED. */
Status view_create_surface(int width, int height, View **view);

/* Accepts NULL. */
void view_free(View *view);

void view_set_title(View *view, const char *title);

/* The paper, in the size that the view has now; NULL: not enough memory. */
Paper *view_paper(View *view);

/* Why the last SCREEN_FAILED, in one line; empty where nobody knows.  reason
 * [size] out */
void view_failure(char *reason, size_t size);

/* Shows what is on the paper.  Returns OK or SCREEN_FAILED. */
Status view_show(View *view);

/* The next command that waits, or COMMAND_NONE. */
Command view_command(View *view);

/* Waits for a command, at most this long. */
void view_wait(View *view, int milliseconds);

/* During long computations: whether COMMAND_QUIT waits.  Uncovered windows get
 * the last frame again; commands stay in line. */
bool view_quit_waits(View *view);

/* Pixel of the surface as 0xAARRGGBB; 0 if the view is a window. */
Colour view_surface_pixel(const View *view, int x, int y);

#endif
