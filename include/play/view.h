/* view.h - the window: window_sdl.c makes it on a computer, window_web.c in a
 * page.
 */
#ifndef ELASTO_VIEW_H
#define ELASTO_VIEW_H

#include <stdbool.h>

#include "picture/paper.h"

/* An event of keyboard, mouse or window. */
typedef enum InputKind {
    INPUT_NONE,
    INPUT_KEY,     /* key */
    INPUT_CLOSE,   /* the window is to be closed */
    INPUT_REDRAW,  /* the window was uncovered or resized */
    INPUT_MOVE,    /* x, y */
    INPUT_PRESS,   /* button, x, y, clicks */
    INPUT_RELEASE, /* button, x, y */
    INPUT_WHEEL,   /* x, y, amount: > 0 away from the hand */
    INPUT_LEAVE    /* the mouse has left the window */
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

/* Opens the only window.  Returns false if it cannot, window_failure says why.
 *   size  [2] in, pixels; 0: 1280 x 800, or what fits on the screen
 *   full  the window fills the screen */
bool window_open(const char *title, const int size[2], bool full);
void window_close(void);

/* size  [2] out, pixels of a paper that fills it */
void window_size(int size[2]);

/* Size of a letter that can be read there, pixels. */
double window_letter(void);

/* Whether a page shows texts, numbers, keys and cards beside the paper. */
bool window_has_document(void);

void window_set_title(const char *title);

/* Reason of the last SCREEN_FAILED, or "". */
const char *window_failure(void);

/* Returns OK, OUT_OF_MEMORY, SCREEN_FAILED. */
Status window_show(const Canvas *canvas);

/* Switches to the full screen or back; whether the window is full. */
void window_set_full(bool full);
bool window_is_full(void);

/* Returns the next input, or INPUT_NONE.  Several movements in a row are one.
 */
Input window_input(void);

/* Waits for an input, up to a time. */
void window_wait(int milliseconds);

#endif
