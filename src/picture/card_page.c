#include <math.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "scenes/pages.h"

enum { WORDS = 4 };

/* What a page says, one below the other: a head and a text each. */
typedef struct Words {
    const char *head;
    const char *text;
    Colour colour;
} Words;

static const double HEAD_ROOM = 3.4; /* ems, of a head */
static const double LARGEST = 1.35;  /* of the letters, in ems */
static const double SMALLEST = 0.9;

/* The lines that a text takes, with a tenth more for broken ends. */
static int count_lines(Paper *paper, double size, int width, const char *text)
{
    int whole = paper_width(paper, FACE_REGULAR, size, text);
    return width < 1 ? 1 : (int)ceil(1.06 * whole / width + 0.05);
}

/* Pixels that the first `count` texts take in letters of this size. */
static double words_height(Paper *paper, Box inside, const Words *words,
                           int count, double size)
{
    double lines = 1.1 * count; /* and gaps, and the place of the code */
    for (int i = 0; i < count; i++) {
        int room = words[i].head ? paper_pixels(paper, HEAD_ROOM * size) : 0;
        lines += count_lines(paper, size, inside.width - room, words[i].text);
    }
    return lines * text_line(size * paper->em);
}

/* One text with its head in bold.  Returns where the next one begins. */
static int draw_words(Paper *paper, Box inside, int y, double size,
                      const Words *words)
{
    double line = text_line(size * paper->em);
    Box box = {inside.x, y, inside.width, inside.y + inside.height - y};
    int room = (int)(box.height / line);
    if (room < 1)
        return y;
    if (words->head) {
        int width = paper_pixels(paper, HEAD_ROOM * size);
        paper_write(paper, FACE_BOLD, size, words->colour, box.x, y, ALIGN_LEFT,
                    "%s", words->head);
        box.x += width;
        box.width -= width;
    }
    int lines = paper_paragraph(paper, FACE_REGULAR, size, COLOUR_TEXT, box,
                                room, words->text);
    return y + (int)((lines + 0.35) * line);
}

/* As large as fits; the claim only where there is room for it. */
static void draw_lecture(Paper *paper, Box inside, const Show *show)
{
    const LecturePage *page = show->lecture;
    int y = inside.y, count = WORDS;
    double size = LARGEST;
    if (!page)
        return;
    const Words words[WORDS] = {{NULL, page->text, COLOUR_TEXT},
                                {"Look", page->look, COLOUR_X},
                                {"Try", page->touch, COLOUR_HAND},
                                {"True", page->claim, COLOUR_FAINT}};
    if (words_height(paper, inside, words, WORDS, 1) > inside.height)
        count = WORDS - 1;
    while (size > SMALLEST &&
           words_height(paper, inside, words, count, size) > inside.height)
        size -= 0.05;
    for (int i = 0; i < count; i++)
        y = draw_words(paper, inside, y, size, &words[i]);
    if (y + text_line(0.88 * paper->em) <= inside.y + inside.height)
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
