#include "play/view.h"

#include <stdio.h>
#include <stdlib.h>

#include "play/window.h"

static const double SMALL_LETTER = 9; /* pixels */

struct View {
    Paper paper;
    bool window;   /* else nobody sees it */
    int size[2];   /* then its own, pixels */
    bool fontless; /* that there is no font was said */
};

Status view_create_surface(int width, int height, View **view)
{
    *view = calloc(1, sizeof **view);
    if (!*view)
        return STATUS_OUT_OF_MEMORY;
    (*view)->size[0] = width;
    (*view)->size[1] = height;
    return STATUS_OK;
}

Status view_create_window(const char *title, const int size[2], bool full,
                          View **view, char *reason, size_t length)
{
    Status status = view_create_surface(0, 0, view);
    if (status)
        return status;
    (*view)->window = true;
    if (window_open(title, size, full))
        return STATUS_OK;
    view_failure(reason, length);
    view_free(*view);
    *view = NULL;
    return STATUS_SCREEN_FAILED;
}

void view_free(View *view)
{
    if (!view)
        return;
    paper_free(&view->paper);
    if (view->window)
        window_close();
    free(view);
}

void view_set_title(View *view, const char *title)
{
    if (view->window)
        window_set_title(title);
}

void view_set_full(View *view, bool full)
{
    if (view->window && full != window_is_full())
        window_set_full(full);
}

bool view_is_full(const View *view)
{
    return view->window && window_is_full();
}

double view_letter(const View *view)
{
    return view->window ? window_letter() : SMALL_LETTER;
}

/* Once: pictures without words are pictures, too. */
static void tell_of_font(View *view)
{
    const char *given = getenv("ELASTO_FONT");
    bool wanted = !given || given[0] != '\0'; /* empty: no words, please */
    if (view->paper.text || !wanted || view->fontless)
        return;
    view->fontless = true;
    fprintf(stderr, "no font: DejaVu Sans is not installed; pictures have no "
                    "words (ELASTO_FONT=FILE.ttf names another font)\n");
}

Paper *view_paper(View *view)
{
    const Canvas *canvas = &view->paper.canvas;
    if (view->window)
        window_size(view->size);
    for (int i = 0; i < 2; i++)
        view->size[i] = view->size[i] < 1                 ? 1
                        : view->size[i] > CANVAS_MAX_SIZE ? CANVAS_MAX_SIZE
                                                          : view->size[i];
    if (canvas->pixels && canvas->width == view->size[0] &&
        canvas->height == view->size[1])
        return &view->paper;
    paper_free(&view->paper);
    if (paper_create(view->size[0], view->size[1], &view->paper)) {
        paper_free(&view->paper);
        return NULL;
    }
    tell_of_font(view);
    return &view->paper;
}

Status view_show(View *view)
{
    if (!view->paper.canvas.pixels)
        return STATUS_SCREEN_FAILED;
    return view->window ? window_show(&view->paper.canvas) : STATUS_OK;
}

Input view_input(View *view)
{
    return view->window ? window_input() : (Input){.kind = INPUT_NONE};
}

void view_wait(View *view, int milliseconds)
{
    if (view->window && milliseconds > 0)
        window_wait(milliseconds);
}
