/* window_web.c - the window and films in a page: the paper's pixels go into its
 * canvas; mouse, touch and keys come from it into a line of inputs.
 * src/web/page.js has the object Page.
 */
#include <emscripten.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/recording.h"
#include "play/view.h"

/* ---- what the page does -------------------------------------------------- */

/* clang-format off */
EM_JS(void, window_size, (int *size), {
    HEAP32[size >> 2] = Page.width();
    HEAP32[(size >> 2) + 1] = Page.height();
});
EM_JS(double, window_letter, (void), { return Page.letter(); });
EM_JS(bool, window_has_document, (void), { return true; });
EM_JS(void, page_show, (const void *pixels, int width, int height, int card), {
    Page.show(HEAPU8, pixels, width, height, card);
});
/* clang-format on */

bool window_open(const char *title, const int size[2], bool full)
{
    (void)size;
    (void)full;
    (void)title;
    return true;
}

/* The title is that of the document. */
void window_set_title(const char *title)
{
    (void)title;
}

void window_close(void)
{
}

/* The browser's own keys fill the screen. */
void window_set_full(bool full)
{
    (void)full;
}

bool window_is_full(void)
{
    return false;
}

const char *window_failure(void)
{
    return "";
}

/* As a canvas wants them: red first, nothing shines through. */
static Status show(const Canvas *canvas, int card)
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
    page_show(rgba, canvas->width, canvas->height, card);
    return STATUS_OK;
}

Status window_show(const Canvas *canvas)
{
    return show(canvas, -1);
}

void window_show_card(const Canvas *canvas, int card)
{
    show(canvas, card);
}

/* ---- inputs -------------------------------------------------------------- */

enum { INPUTS = 256 };

/* The inputs that were not read yet; only the page's loop uses them. */
static Input inputs[INPUTS];
static int first_input, input_count;

/* Keeps only the last of several movements in a row. */
static void put_input(const Input *input)
{
    int last = (first_input + input_count - 1) % INPUTS;
    if (input_count > 0 && input->kind == INPUT_MOVE &&
        inputs[last].kind == INPUT_MOVE)
        inputs[last] = *input;
    else if (input_count < INPUTS)
        inputs[(first_input + input_count++) % INPUTS] = *input;
}

EMSCRIPTEN_KEEPALIVE void web_key(const char *key, int repeats)
{
    Input input = {.kind = INPUT_KEY, .repeats = repeats != 0};
    snprintf(input.key, sizeof input.key, "%s", key);
    put_input(&input);
}

/*   kind  of InputKind, any but keys */
EMSCRIPTEN_KEEPALIVE void web_mouse(int kind, double x, double y, int button,
                                    int clicks, double amount)
{
    const Input input = {(InputKind)kind, "", false, button,
                         clicks,          x,  y,     amount};
    put_input(&input);
}

Input window_input(void)
{
    Input input = {.kind = INPUT_NONE};
    if (input_count == 0)
        return input;
    input = inputs[first_input];
    first_input = (first_input + 1) % INPUTS;
    input_count--;
    return input;
}

/* Does not wait: the page does, and no input arrives while C runs. */
void window_wait(int milliseconds)
{
    (void)milliseconds;
}

/* ---- films --------------------------------------------------------------- */

Status film_open(const char *name, char *message, Film *film)
{
    *film = (Film){0};
    return output_report(message, name, STATUS_INVALID_INPUT,
                         "a page makes no films; the program does");
}

Status film_add(Film *film, const Canvas *canvas, int times)
{
    (void)film, (void)canvas, (void)times;
    return STATUS_OK;
}

Status film_close(Film *film, Keep keep)
{
    (void)film, (void)keep;
    return STATUS_OK;
}
