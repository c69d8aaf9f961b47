/* view.h - shows the window, by SDL or in a web page, and reads its inputs. */
#pragma once

#include <stdbool.h>

#include "picture/paper.h"

/* Kinds of events, and the fields of Input that each has. */
typedef enum InputKind {
    INPUT_NONE,
    INPUT_KEY,     /* a key is down: key, is_repeat */
    INPUT_CLOSE,   /* the user closes the window */
    INPUT_REDRAW,  /* the window was uncovered or resized */
    INPUT_MOVE,    /* the mouse moves: x, y */
    INPUT_PRESS,   /* a button is pressed: button, clicks, x, y */
    INPUT_RELEASE, /* a button is released: button, x, y */
    INPUT_WHEEL,   /* turned: wheel_notches, x, y */
    INPUT_LEAVE    /* the mouse has left the window */
} InputKind;

enum { BUTTON_LEFT = 1, BUTTON_MIDDLE = 2, BUTTON_RIGHT = 3 };

/* An event that keyboard, mouse or window sends. */
typedef struct Input {
    InputKind kind;
    char key[32];   /* "N", "Shift+N", "Ctrl+R", "Tab+M", "Left", "+" */
    bool is_repeat; /* the key is held down */
    int button, clicks;
    double x, y; /* place of the mouse, pixels of the picture in the window */
    double wheel_notches; /* notches of the wheel; > 0: away from the user */
} Input;

/* Opens the only window.  Returns false after a failure (window_failure).
 *   size  [2] in, pixels; 0: 1280 x 800, or what fits on the screen
 *   full  the window fills the screen */
bool window_open(const int size[2], bool full);
void window_close(void);

/* Finds the size of a paper that fills the window, pixels. */
void window_find_size(int size[2]);

/* Returns the size of letters that are easy to read in the window, pixels. */
double window_find_font_size(void);

/* Whether the window is a canvas in a web page. */
bool window_is_in_page(void);

/* Whether the page has texts, numbers, switches and cards beside the canvas. */
bool window_has_document(void);

void window_set_title(const char *title);

/* Returns the reason of the last failure, or "". */
const char *window_failure(void);

/* Shows the paper's canvas.  Returns OK, OUT_OF_MEMORY, SCREEN_FAILED. */
Status window_show(const Canvas *canvas);

/* Switches to the full screen or back. */
void window_set_full(bool full);
bool window_is_full_screen(void);

/* Returns the next input, or INPUT_NONE; skips movements but the last one. */
Input window_read_input(void);

/* Waits for an input, at most for this time. */
void window_wait_for_input(int milliseconds);
