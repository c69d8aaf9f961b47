/* view.h - where frames are shown: the window, or a surface that nobody sees.
 *
 * Both work alike: draw on view_paper, then view_show.
 */
#ifndef ELASTO_VIEW_H
#define ELASTO_VIEW_H

#include <stdbool.h>
#include <stddef.h>

#include "picture/paper.h"

typedef struct View View;

/* What happened at keyboard, mouse or window. */
typedef enum InputKind {
    INPUT_NONE,
    INPUT_KEY,     /* key */
    INPUT_CLOSE,   /* somebody asks for the end */
    INPUT_REDRAW,  /* the window was uncovered or resized */
    INPUT_MOVE,    /* x, y */
    INPUT_PRESS,   /* button, x, y, clicks */
    INPUT_RELEASE, /* button, x, y */
    INPUT_WHEEL,   /* x, y, amount: > 0 away from the hand */
    INPUT_LEAVE    /* the mouse is elsewhere */
} InputKind;

enum { BUTTON_LEFT = 1, BUTTON_MIDDLE = 2, BUTTON_RIGHT = 3 };

typedef struct Input {
    InputKind kind;
    char key[32]; /* "N", "Shift+N", "Ctrl+R", "Tab+M", "Left", "+" */
    bool repeats; /* the key is held down */
    int button, clicks;
    double x, y; /* pixels of the paper */
    double amount;
} Input;

/* The window; there is one at a time.
 *   size    [2] in, its pixels; 0: 1280 x 800, or what fits on the screen
 *   full    it fills the screen
 *   view    out; free it with view_free; NULL after a failure
 *   reason  [length] out, one line, why there is no window
 * Returns OK, OUT_OF_MEMORY, SCREEN_FAILED. */
Status view_create_window(const char *title, const int size[2], bool full,
                          View **view, char *reason, size_t length);

/* From now on `lost` is called when the server of a window is gone; it must not
 * return. */
void view_when_lost(void (*lost)(void));

/* Ends every wait for a server that does not answer, as if it were gone; while
 * a window is opened the program ends, for nothing was begun.  For handlers of
 * signals. */
void view_let_go(void);

/* A surface in memory; needs no screen.  Returns OK, OUT_OF_MEMORY. */
Status view_create_surface(int width, int height, View **view);

/* Accepts NULL. */
void view_free(View *view);

void view_set_title(View *view, const char *title);

/* Pixels that a letter needs there, so that it can be read. */
double view_letter(const View *view);

/* The paper, in the size that the view has now; NULL: not enough memory. */
Paper *view_paper(View *view);

/* Why the last SCREEN_FAILED, in one line; empty where nobody knows.  reason
 * [size] out */
void view_failure(char *reason, size_t size);

/* Shows what is on the paper.  Returns OK, OUT_OF_MEMORY, SCREEN_FAILED. */
Status view_show(View *view);

/* Full screen, or a window again; whether it is. */
void view_set_full(View *view, bool full);
bool view_is_full(const View *view);

/* The next input that waits, or INPUT_NONE.  Of several movements in a row only
 * the last is told. */
Input view_input(View *view);

/* Waits for an input, at most this long. */
void view_wait(View *view, int milliseconds);

#endif
