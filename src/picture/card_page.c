#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "scenes/pages.h"

enum { WORDS = 3 };

/* What a page says, one below the other: a head and a text each. */
typedef struct Words {
    const char *head;
    const char *text;
    Colour colour;
} Words;

static const double HEAD_ROOM = 3.2; /* ems of the letters, of a head */
static const double TEST_ROOM = 4.4; /* of the head of a test */
static const double GAP = 0.35;      /* lines, between two texts */
static const double LETTERS = 1.2;   /* ems, on every page */
static const double LETTER = 0.52;   /* ems of the letters, one on average */
static const double SMALLEST = 0.9;  /* where the window is too small */

/* One text with its head in bold, or with `draw` false only measured.  Returns
 * where the next one begins. */
static int put_words(Paper *paper, Box inside, int y, double size, double head,
                     const Words *words, bool draw)
{
    double line = text_line(size * paper->em);
    Box box = {inside.x, y, inside.width, 0};
    if (words->head) {
        int width = paper_pixels(paper, head * size);
        if (draw)
            paper_write(paper, FACE_BOLD, size, words->colour, box.x, y,
                        ALIGN_LEFT, "%s", words->head);
        box.x += width;
        box.width -= width;
    }
    int lines = 0, most = (int)((inside.y + inside.height - y) / line);
    if (!draw)
        lines =
            paper_paragraph(paper, FACE_REGULAR, size, 0, box, 0, words->text);
    else if (most > 0)
        lines = paper_paragraph(paper, FACE_REGULAR, size, COLOUR_TEXT, box,
                                most, words->text);
    return y + (int)((lines + GAP) * line);
}

static int put_page(Paper *paper, Box inside, double size,
                    const LecturePage *page, bool draw)
{
    const Words words[WORDS] = {{NULL, page->text, COLOUR_TEXT},
                                {"Look", page->look, COLOUR_X},
                                {"Try", page->touch, COLOUR_HAND}};
    int y = inside.y;
    for (int i = 0; i < WORDS; i++)
        y = put_words(paper, inside, y, size, HEAD_ROOM, &words[i], draw);
    return y - (int)(GAP * text_line(size * paper->em));
}

double page_letters(Paper *paper, Box inside, const LecturePage *page)
{
    double size = LETTERS;
    while (size > SMALLEST && put_page(paper, inside, size, page, false) >
                                  inside.y + inside.height)
        size -= 0.05;
    return size;
}

/* The same letters on every page; smaller ones where they do not fit. */
static void draw_lecture(Paper *paper, Box inside, const Show *show)
{
    const LecturePage *page = show->lecture;
    if (page)
        put_page(paper, inside, page_letters(paper, inside, page), page, true);
}

Box page_draw_claim(Paper *paper, Box inside, const Show *show)
{
    if (!show->lecture)
        return inside;
    const Words words = {"Tested", show->lecture->claim, COLOUR_FAINT};
    int y = put_words(paper, inside, inside.y, 1, TEST_ROOM, &words, true);
    return (Box){inside.x, y, inside.width, inside.y + inside.height - y};
}

/* How many lines a text takes, a little more rather than less. */
static int guess_lines(const char *text, double wide)
{
    int lines = 1;
    double used = 0;
    while (*text) {
        double word = LETTER; /* the blank after it */
        for (; *text && *text != ' '; text++)
            word += (*text & 0xc0) != 0x80 ? LETTER : 0;
        text += *text == ' ';
        if (used + word - LETTER > wide) {
            lines++;
            used = 0;
        }
        used += word;
    }
    return lines;
}

/* As much as its words take: ems. */
static double page_needs(const Show *show, double wide)
{
    const LecturePage *page = show->lecture;
    double letters = wide / LETTERS, narrow = letters - HEAD_ROOM;
    if (!page)
        return card_page.least;
    double lines = guess_lines(page->text, letters) +
                   guess_lines(page->look, narrow) +
                   guess_lines(page->touch, narrow) + (WORDS - 1) * GAP;
    return text_line(lines * LETTERS) + 2.8; /* title and margin */
}

const Card card_page = {
    .name = "page",
    .title = "{page}\nthe lecture: Page Down",
    .least = 12,
    .needs = page_needs,
    .weight = 0.3,
    .draw = draw_lecture,
};
