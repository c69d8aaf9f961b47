/* view.h - the window: that of window_sdl.c on a computer, of window_web.c in a
 * page.
 */
#ifndef ELASTO_VIEW_H
#define ELASTO_VIEW_H

#include <stdbool.h>

#include "picture/paper.h"

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

/* There is one at a time; false: window_failure tells why there is none.
 *   size  [2] in, its pixels; 0: 1280 x 800, or what fits on the screen
 *   full  it fills the screen
 * window_close: in any case; a second time it does nothing. */
bool window_open(const char *title, const int size[2], bool full);
void window_close(void);

/* size  [2] out, pixels of a paper that fills it */
void window_size(int size[2]);

/* Pixels that a letter needs there, so that it can be read. */
double window_letter(void);

/* Whether a page shows texts, numbers, keys and cards beside the paper. */
bool window_has_document(void);

void window_set_title(const char *title);

/* Why the last SCREEN_FAILED; "" where nobody knows. */
const char *window_failure(void);

/* Returns OK, OUT_OF_MEMORY, SCREEN_FAILED. */
Status window_show(const Canvas *canvas);

/* Full screen, or a window again; whether it is. */
void window_set_full(bool full);
bool window_is_full(void);

/* The next input that waits, or INPUT_NONE.  Of several movements in a row only
 * the last is told. */
Input window_input(void);

/* Waits for an input, at most this long. */
void window_wait(int milliseconds);

#endif
