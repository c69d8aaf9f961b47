#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "scenes/pages.h"

/* A paragraph with a bold first word.  Returns where the next one begins. */
static int draw_paragraph(Paper *paper, Box inside, int y, Colour colour,
                          const char *head, const char *text)
{
    double size = 0.96;
    int line = paper_pixels(paper, 1.3 * size);
    Box box = {inside.x, y, inside.width, inside.y + inside.height - y};
    int room = box.height / line;
    if (room < 1)
        return y;
    if (head) {
        int width = paper_pixels(paper, 3.2);
        paper_write(paper, FACE_BOLD, size, colour, box.x, y, ALIGN_LEFT, "%s",
                    head);
        box.x += width;
        box.width -= width;
    }
    int lines = paper_paragraph(paper, FACE_REGULAR, size, COLOUR_TEXT, box,
                                room, text);
    return y + lines * line + paper_pixels(paper, 0.4);
}

static void draw_lecture(Paper *paper, Box inside, const Show *show)
{
    const LecturePage *page = show->lecture;
    int y = inside.y;
    if (!page)
        return;
    y = draw_paragraph(paper, inside, y, COLOUR_TEXT, NULL, page->text);
    y = draw_paragraph(paper, inside, y, COLOUR_X, "Look", page->look);
    y = draw_paragraph(paper, inside, y, COLOUR_HAND, "Try", page->touch);
    if (y + paper_pixels(paper, 1.2) <= inside.y + inside.height)
        paper_write(paper, FACE_REGULAR, 0.88, COLOUR_FAINT, inside.x, y,
                    ALIGN_LEFT, "code (key K): %s in %s", page->function,
                    page->file);
}

static const char *page_title(const Show *show)
{
    return show->lecture ? show->lecture_title : "the lecture: Page Down";
}

const Card card_page = {
    .name = "page",
    .title = "the page",
    .titled = page_title,
    .least = 12,
    .weight = 1.15,
    .draw = draw_lecture,
};
