/* window.h - the window of SDL or of a web page: pictures out, inputs in. */
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
    INPUT_RELEASE, /* a button is released, or the focus lost: button, x, y */
    INPUT_WHEEL,   /* the wheel turns: wheel_notches, x, y */
    INPUT_LEAVE    /* the mouse has left the window */
} InputKind;

enum { BUTTON_LEFT = 1, BUTTON_MIDDLE = 2, BUTTON_RIGHT = 3 };

/* An event that keyboard, mouse or window sends. */
typedef struct Input {
    InputKind kind;
    char key[32];       /* "N", "Shift+N", "Ctrl+R", "Tab+M", "Left", "+" */
    bool is_repeat;     /* repeats a key that is held down */
    int button, clicks; /* button: BUTTON_...; clicks 2: a double click */
    double x, y; /* place of the mouse, pixels of the picture in the window */
    double wheel_notches; /* notches of the wheel; > 0: away from the user */
} Input;

/* Functions of the program's window. */
typedef struct Window {
    /* Opens the window.  Returns false after a failure (get_failure_reason).
     *   size  [2] in, points of the screen; 0: 1280 x 800, or what fits on the
     * screen full  the window fills the screen */
    bool (*open)(const int size[2], bool full);
    void (*close)(void);

    /* Finds the size of a paper that fills the window, pixels. */
    void (*find_size)(int size[2]);

    /* Returns the size of letters that are easy to read, pixels. */
    double (*find_font_size)(void);

    /* Whether the web page shows texts, numbers, switches and cards as elements
     * beside the window's canvas.  NULL: the window is not in a web page. */
    bool (*has_document)(void);

    void (*set_title)(const char *title);

    /* Returns why `open` or `show` failed.  NULL: `open` never fails. */
    const char *(*get_failure_reason)(void);

    /* Shows the paper's canvas.  Returns OK, OUT_OF_MEMORY, SCREEN_FAILED. */
    Status (*show)(const Canvas *canvas);

    void (*set_full_screen)(bool full);
    bool (*is_full_screen)(void);

    /* Returns the next input, or INPUT_NONE; skips movements but the last. */
    Input (*read_input)(void);

    /* Waits for an input, at most for this time.  NULL: page.js waits. */
    void (*wait_for_input)(int milliseconds);
} Window;

extern const Window window_sdl; /* on a computer */
extern const Window window_web; /* in a web page */
