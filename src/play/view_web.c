/* view_web.c - view.h in a page: the paper's pixels go into its canvas, mouse,
 * touch and keys come from it into a line of inputs.  src/web/page.js has the
 * object Page.
 */
#include "play/view.h"

#include <emscripten.h>
#include <stdio.h>
#include <stdlib.h>

enum { INPUTS = 256 };

struct View {
    Paper paper;
    bool window;
    int width, height; /* of a surface */
    uint32_t *rgba;    /* [of the paper] as a canvas wants them */
    size_t room;
};

/* What the page has told and nobody has read; its loop is the only caller. */
static Input inputs[INPUTS];
static int first_input, input_count;

/* ---- what the page does ------------------------------------------------- */

/* clang-format off */
EM_JS(int, page_width, (void), { return Page.width(); });
EM_JS(int, page_height, (void), { return Page.height(); });
EM_JS(double, page_letter, (void), { return 9.5 * devicePixelRatio; });
EM_JS(void, page_title, (const char *title), {
    Page.title(UTF8ToString(title));
});
EM_JS(void, page_full, (int full), { Page.full(full); });
EM_JS(int, page_is_full, (void), {
    return document.fullscreenElement ? 1 : 0;
});
EM_JS(void, page_show, (const uint32_t *pixels, int width, int height), {
    Page.show(HEAPU8, pixels, width, height);
});
/* clang-format on */

/* ---- what the page tells ------------------------------------------------ */

/* Of several movements in a row only the last is kept. */
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
    Input input = {.kind = (InputKind)kind,
                   .button = button,
                   .clicks = clicks,
                   .x = x,
                   .y = y,
                   .amount = amount};
    put_input(&input);
}

/* ---- view.h ------------------------------------------------------------- */

Status view_create_window(const char *title, const int size[2], bool full,
                          View **view, char *reason, size_t length)
{
    (void)size;
    (void)full;
    if (length > 0)
        reason[0] = '\0';
    Status status = view_create_surface(0, 0, view);
    if (!status) {
        (*view)->window = true;
        page_title(title);
    }
    return status;
}

Status view_create_surface(int width, int height, View **view)
{
    *view = calloc(1, sizeof **view);
    if (!*view)
        return STATUS_OUT_OF_MEMORY;
    (*view)->width = width;
    (*view)->height = height;
    return STATUS_OK;
}

void view_free(View *view)
{
    if (!view)
        return;
    paper_free(&view->paper);
    free(view->rgba);
    free(view);
}

void view_set_title(View *view, const char *title)
{
    if (view->window)
        page_title(title);
}

double view_letter(const View *view)
{
    return view->window ? page_letter() : 0;
}

Paper *view_paper(View *view)
{
    const Canvas *canvas = &view->paper.canvas;
    int width = view->window ? page_width() : view->width;
    int height = view->window ? page_height() : view->height;
    if (canvas->pixels && canvas->width == width && canvas->height == height)
        return &view->paper;
    paper_free(&view->paper);
    if (paper_create(width, height, &view->paper)) {
        paper_free(&view->paper);
        return NULL;
    }
    return &view->paper;
}

void view_failure(char *reason, size_t size)
{
    if (size > 0)
        reason[0] = '\0';
}

Status view_show(View *view)
{
    const Canvas *canvas = &view->paper.canvas;
    size_t pixels = (size_t)canvas->width * (size_t)canvas->height;
    if (!view->window)
        return STATUS_OK;
    if (view->room < pixels) {
        free(view->rgba);
        view->rgba = malloc(pixels * sizeof *view->rgba);
        view->room = view->rgba ? pixels : 0;
    }
    if (!view->rgba)
        return STATUS_OUT_OF_MEMORY;
    for (size_t i = 0; i < pixels; i++) {
        uint32_t p = canvas->pixels[i];
        view->rgba[i] =
            0xff000000 | (p & 0xff00) | (p & 0xff) << 16 | (p >> 16 & 0xff);
    }
    page_show(view->rgba, canvas->width, canvas->height);
    return STATUS_OK;
}

void view_set_full(View *view, bool full)
{
    if (view->window)
        page_full(full);
}

bool view_is_full(const View *view)
{
    return view->window && page_is_full();
}

Input view_input(View *view)
{
    Input input = {.kind = INPUT_NONE};
    if (view->window && input_count > 0) {
        input = inputs[first_input];
        first_input = (first_input + 1) % INPUTS;
        input_count--;
    }
    return input;
}

/* The page waits between its frames; nothing arrives while C runs. */
void view_wait(View *view, int milliseconds)
{
    (void)view;
    (void)milliseconds;
}

Colour view_surface_pixel(const View *view, int x, int y)
{
    const Canvas *canvas = &view->paper.canvas;
    if (view->window || x < 0 || y < 0 || x >= canvas->width ||
        y >= canvas->height)
        return 0;
    return canvas->pixels[(size_t)y * (size_t)canvas->width + (size_t)x];
}
