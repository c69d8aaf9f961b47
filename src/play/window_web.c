/* window_web.c - the window in a web page, whose object Page is in src/web. */
#include <emscripten.h>
#include <stdio.h>
#include <stdlib.h>

#include "play/window.h"

/* clang-format off */
/* Empty functions: the browser closes, titles and enlarges its own window. */
EM_JS(bool, web_open, (const int *size, bool full), { return true; });
EM_JS(void, web_close, (void), {});
EM_JS(void, web_set_title, (const char *title), {});
EM_JS(void, web_set_full_screen, (bool full), {});
EM_JS(bool, web_is_full_screen, (void), { return false; });
EM_JS(void, web_find_size, (int *size), {
    HEAP32[size >> 2] = Page.width();
    HEAP32[(size >> 2) + 1] = Page.height();
});
EM_JS(double, web_find_font_size, (void), { return Page.letter(); });
EM_JS(bool, web_has_document, (void), { return Page.hasDocument(); });
EM_JS(void, web_paint, (const void *pixels, int width, int height, int card), {
    Page.show(HEAPU8, pixels, width, height, card);
});
/* clang-format on */

/* Converts the pixels to bytes red, green, blue, alpha for the page. */
Status web_show_card(const Canvas *canvas, int card)
{
    static uint32_t *rgba; /* [room] */
    static size_t room;
    size_t pixels = (size_t)canvas->width * (size_t)canvas->height;
    if (room < pixels) {
        free(rgba);
        rgba = malloc(pixels * sizeof *rgba);
        room = rgba ? pixels : 0;
    }
    if (!rgba)
        return STATUS_OUT_OF_MEMORY;
    for (size_t i = 0; i < pixels; i++) {
        uint32_t p = canvas->pixels[i];
        rgba[i] =
            0xff000000 | (p & 0xff00) | (p & 0xff) << 16 | (p >> 16 & 0xff);
    }
    web_paint(rgba, canvas->width, canvas->height, card);
    return STATUS_OK;
}

static Status web_show_frame(const Canvas *canvas)
{
    return web_show_card(canvas, -1);
}

enum { INPUT_QUEUE_SIZE = 256 };

/* Queue of the inputs that are not yet read. */
static Input inputs[INPUT_QUEUE_SIZE];
static int first_input, input_count;

/* Appends an input; a mouse movement replaces the movement just before it. */
static void queue_input(const Input *input)
{
    int last = (first_input + input_count - 1) % INPUT_QUEUE_SIZE;
    if (input_count > 0 && input->kind == INPUT_MOVE &&
        inputs[last].kind == INPUT_MOVE)
        inputs[last] = *input;
    else if (input_count < INPUT_QUEUE_SIZE)
        inputs[(first_input + input_count++) % INPUT_QUEUE_SIZE] = *input;
}

EMSCRIPTEN_KEEPALIVE void web_queue_key(const char *key, int repeats)
{
    Input input = {.kind = INPUT_KEY, .is_repeat = repeats != 0};
    snprintf(input.key, sizeof input.key, "%s", key);
    queue_input(&input);
}

/* Queues an input of any InputKind but INPUT_KEY. */
EMSCRIPTEN_KEEPALIVE void web_queue_mouse(int kind, double x, double y,
                                          int button, int clicks, double amount)
{
    const Input input = {(InputKind)kind, "", false, button,
                         clicks,          x,  y,     amount};
    queue_input(&input);
}

static Input web_read_input(void)
{
    Input input = {.kind = INPUT_NONE};
    if (input_count == 0)
        return input;
    input = inputs[first_input];
    first_input = (first_input + 1) % INPUT_QUEUE_SIZE;
    input_count--;
    return input;
}

const Window window_web = {
    .open = web_open,
    .close = web_close,
    .find_size = web_find_size,
    .find_font_size = web_find_font_size,
    .has_document = web_has_document,
    .set_title = web_set_title,
    .show = web_show_frame,
    .set_full_screen = web_set_full_screen,
    .is_full_screen = web_is_full_screen,
    .read_input = web_read_input,
};
