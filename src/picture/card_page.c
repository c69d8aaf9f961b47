/* card_page.c - the texts of a page, and the claim below a page's code. */
#include <math.h>
#include <string.h>

#include "picture/cards.h"

/* A text of the card, with a heading on its left side. */
typedef struct PageText {
    const char *heading; /* word in bold letters at the left, or NULL */
    const char *text;    /* markup with live values, or NULL */
    Colour colour;       /* colour of the heading */
    double size_ratio;   /* letters' size / size of the page's letters */
} PageText;

/* Sizes of a page's letters (ems): usual, largest on a wide card, smallest, and
 * smallest with the introduction beside the answer. */
static const double LETTERS = 1.2, LARGEST = 1.45, SMALLEST = 0.8,
                    SMALLEST_WITH_INTRO = 1.1;
static const double LINE_WIDTH = 24; /* card width / size of large letters */
/* Lengths in multiples of the size of the page's letters: letters of a formula,
 * width of a text's heading, width of the heading "Tested". */
static const double FORMULA_SIZE = 1.25, HEADING_WIDTH = 3.2,
                    TESTED_WIDTH = 4.4;
static const double GAP = 0.35; /* gap between two texts, in line heights */

/* Draws a text with its heading, or only measures the text.
 *   y     pixels, top of the text
 *   size  ems, size of the page's letters
 *   room  width for the heading / size of the page's letters
 * Returns the top of the next text. */
static int typeset_text(Paper *paper, Box inside, int y, double size,
                        double room, const PageText *words,
                        const FrameContent *content, bool draw)
{
    double letters = size * words->size_ratio, em = letters * paper->em;
    Box box = {inside.x, y, inside.width, 0};
    TextLine line = lines_begin(&active_pane(content)->values, words->text);
    if (words->heading)
        box_cut_off(
            &box, EDGE_LEFT,
            paper_to_pixels(paper, room * fmax(size, paper->min_letter_size)));
    while (text_next_line(&line)) {
        int lines =
            (int)((inside.y + inside.height - box.y) / text_line_height(em));
        if (!draw || lines > 0)
            box.y +=
                paper_write_paragraph(paper, FACE_REGULAR, letters, COLOUR_TEXT,
                                      box, draw ? lines : 0, line.text);
    }
    if (draw && words->heading && box.y > y)
        paper_write(paper, FACE_BOLD, size, words->colour, inside.x, y,
                    ALIGN_LEFT, "%s", words->heading);
    return box.y +
           (box.y > y ? (int)(GAP * text_line_height(size * paper->em)) : 0);
}

/* Draws the texts of a page one below the other, or only measures them.
 *   size        ems, size of the letters
 *   keeps_text  the introduction stays beside question and answer
 * Returns the height of all texts in pixels. */
static int typeset_page(Paper *paper, Box inside, double size,
                        const FrameContent *content, bool keeps_text, bool draw)
{
    const LectureContent *lecture = &content->lecture;
    const LecturePage *page = lecture->page;
    const char *how =
        page_wants_click(page) ? "Click on the picture. N shows the answer."
        : page->answer_name ? "Type a number, then Enter. N shows the answer."
                            : "Say it, then press N or Space.";
    bool asks = lecture->hides_answer;
    const PageText words[] = {
        {NULL, asks || keeps_text || !lecture->question ? page->intro : NULL,
         COLOUR_TEXT, 1},
        {NULL, page->formula, COLOUR_TEXT, FORMULA_SIZE},
        {"Ask", asks || !lecture->heading[0] ? lecture->question : NULL,
         COLOUR_X, 1},
        {"You", asks ? NULL : lecture->verdict, COLOUR_HAND, 1},
        {"Look", asks ? NULL : lecture->answer_text, COLOUR_X, 1},
        {asks ? "How" : "Try", asks ? how : page->try, COLOUR_HAND, 1}};
    int y = inside.y;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        y = typeset_text(paper, inside, y, size, HEADING_WIDTH, &words[i],
                         content, draw);
    return y - (int)(GAP * text_line_height(size * paper->em)) - inside.y;
}

/* Returns the larger height in pixels of the texts with the answer hidden and
 * shown, so that the letters keep their size when the answer is shown. */
static int measure_page(Paper *paper, Box inside, double size,
                        const FrameContent *content, bool keeps_text)
{
    FrameContent other = *content;
    LectureContent *lecture = &other.lecture;
    LiveValues *values = &other.pane[other.active_pane_index].values;
    if (!lecture->question)
        return typeset_page(paper, inside, size, content, keeps_text, false);
    lecture->hides_answer = false;
    lecture->heading[0] = '\0';
    if (lecture->page->answer_name && !lecture->verdict)
        lecture->verdict = "0"; /* placeholder for the verdict's line */
    values_add_flag(values, "told", true);
    int after = typeset_page(paper, inside, size, &other, keeps_text, false);
    lecture->hides_answer = true;
    for (int i = 0; i < values->count; i++)
        if (strcmp(values->value[i].name, "told") == 0)
            values->value[i].name = "";
    int before = typeset_page(paper, inside, size, &other, keeps_text, false);
    return before > after ? before : after;
}

/* Draws the texts of a page in the largest letters with which all texts fit.
 * The question stays beside the answer; the introduction does not if it would
 * make the letters smaller than SMALLEST_WITH_INTRO. */
void draw_page_card(const Plot *card)
{
    const double most =
        fmin(fmax(card->box.width / (LINE_WIDTH * card->em), LETTERS), LARGEST);
    double size = most;
    bool keeps_text = true;
    while (size > SMALLEST &&
           measure_page(card->paper, card->box, size, card->content,
                        keeps_text) > card->box.height) {
        size -= 0.05;
        if (keeps_text && size < SMALLEST_WITH_INTRO) {
            size = most;
            keeps_text = false;
        }
    }
    typeset_page(card->paper, card->box, size, card->content, keeps_text, true);
}

Box page_draw_claim(Paper *paper, Box inside, const FrameContent *content)
{
    const PageText words = {"Tested", content->lecture.page->claim,
                            COLOUR_FAINT, 1};
    int high =
        typeset_text(paper, inside, 0, 1, TESTED_WIDTH, &words, content, false);
    int top = inside.y + inside.height - high;
    typeset_text(paper, inside, top, 1, TESTED_WIDTH, &words, content, true);
    inside.height -= high + paper_to_pixels(paper, 0.5);
    return inside;
}

/* Returns the card's height in ems for letters of this size (ems). */
static double find_card_height(const FrameContent *content, double wide,
                               double em, double size, bool keeps_text)
{
    Paper paper = {.font = content->fonts, .em = em, .min_letter_size = 1};
    Box box = {0, 0, (int)(wide * em + 0.5), 0};
    const double around = 2.6; /* ems, height of title and margins */
    return measure_page(&paper, box, size, content, keeps_text) / em + around;
}

double page_find_height(const FrameContent *content, double wide, double em)
{
    return find_card_height(content, wide, em, LETTERS, true);
}

double page_find_least_height(const FrameContent *content, double wide,
                              double em)
{
    return find_card_height(content, wide, em, SMALLEST, false);
}
