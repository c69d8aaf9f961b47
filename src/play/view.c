#include "play/view.h"

#include <stdio.h>
#include <stdlib.h>

struct View {
    Paper paper;
    int size[2]; /* pixels; 0: those of the window */
};

Status view_create(int width, int height, View **view)
{
    *view = calloc(1, sizeof **view);
    if (!*view)
        return STATUS_OUT_OF_MEMORY;
    (*view)->size[0] = width;
    (*view)->size[1] = height;
    return STATUS_OK;
}

void view_free(View *view)
{
    if (!view)
        return;
    paper_free(&view->paper);
    window_close();
    free(view);
}

/* Once: pictures without words are pictures, too. */
static void tell_of_font(const Paper *paper)
{
    static bool told;
    const char *given = getenv("ELASTO_FONT");
    bool wanted = !given || given[0] != '\0'; /* empty: no words, please */
    if (paper->text || !wanted || told)
        return;
    told = true;
    fprintf(stderr, "no font: DejaVu Sans is not installed; pictures have no "
                    "words (ELASTO_FONT=FILE.ttf names another font)\n");
}

Paper *view_paper(View *view)
{
    const Canvas *canvas = &view->paper.canvas;
    int size[2] = {view->size[0], view->size[1]};
    if (size[0] == 0)
        window_size(size);
    for (int i = 0; i < 2; i++)
        size[i] = size[i] < 1                 ? 1
                  : size[i] > CANVAS_MAX_SIZE ? CANVAS_MAX_SIZE
                                              : size[i];
    if (canvas->pixels && canvas->width == size[0] && canvas->height == size[1])
        return &view->paper;
    paper_free(&view->paper);
    if (paper_create(size[0], size[1], &view->paper)) {
        paper_free(&view->paper);
        return NULL;
    }
    tell_of_font(&view->paper);
    return &view->paper;
}

Status view_show(View *view)
{
    if (!view->paper.canvas.pixels)
        return STATUS_SCREEN_FAILED;
    return view->size[0] ? STATUS_OK : window_show(&view->paper.canvas);
}
