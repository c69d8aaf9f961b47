/* cards.c - draws the column: the cards, or a list, or a page's code. */
#include "picture/cards.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double CODE_LETTER = 0.7; /* ems, width of a letter of code */

Box card_find_inner_box(Box card, double em)
{
    int margin = (int)lround(0.8 * em), bar = (int)lround(TITLE_BAR * em);
    return (Box){card.x + margin, card.y + bar, card.width - 2 * margin,
                 card.height - bar - margin / 2};
}

/* Draws frame, title and cross of a card.  Returns the box inside. */
static Box draw_card_frame(Paper *paper, Box box, const char *words,
                           bool closed)
{
    int bar = paper_to_pixels(paper, TITLE_BAR);
    Box title = {box.x, box.y, box.width, bar};
    Box cross = box_cut_off(&title, EDGE_RIGHT, bar);
    box_cut_off(&title, EDGE_LEFT, paper_to_pixels(paper, 0.8));
    canvas_framed_box(&paper->canvas, box, COLOUR_WHITE, COLOUR_BORDER);
    paper_write_in_box(paper, FACE_BOLD, 0.96,
                       closed ? COLOUR_FAINT : COLOUR_TEXT, title, ALIGN_LEFT,
                       words);
    paper_write_in_box(paper, FACE_REGULAR, 1.2, COLOUR_GREY, cross,
                       ALIGN_CENTRE, closed ? "+" : "\u00d7");
    return card_find_inner_box(box, paper->em);
}

/* ---- lists -------------------------------------------------------------- */

/* The columns of a list. */
typedef struct ListGrid {
    int rows, columns; /* number of rows in a column, and of columns */
    double row_height; /* pixels, height of a row */
} ListGrid;

static ListGrid arrange_list_grid(const ListContent *list, Box inside,
                                  double em)
{
    const double line = 1.5, least = 1.3, wide = 24; /* ems */
    ListGrid grid = {list->row_count > 0 ? list->row_count : 1, 1, line * em};
    int most = (int)fmax(inside.width / (wide * em), 1);
    while (grid.rows * least * em > inside.height && grid.columns < most) {
        grid.columns++;
        grid.rows = (list->row_count + grid.columns - 1) / grid.columns;
    }
    grid.row_height = fmin(grid.row_height, inside.height / (double)grid.rows);
    return grid;
}

int frame_find_list_row(const FrameContent *content, const Layout *layout,
                        double x, double y)
{
    int margin = (int)lround(0.9 * layout->em);
    Box inside =
        card_find_inner_box(box_inset(layout->column, margin), layout->em);
    ListGrid grid = arrange_list_grid(&content->list, inside, layout->em);
    if (content->column < COLUMN_PAGES || !box_contains(inside, x, y))
        return -1;
    int column = (int)((x - inside.x) * grid.columns / inside.width);
    int row = (int)((y - inside.y) / grid.row_height);
    int at = column * grid.rows + row;
    return row < grid.rows && at < content->list.row_count ? at : -1;
}

/* Draws the key and the text of each row, all in letters of one size.  A text
 * that is too wide even in the smallest letters loses its last words. */
static void draw_list(Paper *paper, Box inside, const ListContent *list)
{
    const double smallest = 0.85; /* smallest factor of the letters' size */
    const ListGrid grid = arrange_list_grid(list, inside, paper->em);
    double em = paper->em, size = fmin(0.95, grid.row_height / (1.3 * em));
    double key = 0, longest = 1, column = inside.width / (double)grid.columns;
    for (int i = 0; i < list->row_count; i++) {
        const ListRow *row = &list->row[i];
        key = fmax(key, paper_measure(paper, FACE_BOLD, size, row->key));
        longest =
            fmax(longest, paper_measure(paper, FACE_REGULAR, size, row->text));
    }
    key += 0.6 * size * em;
    const int wide = (int)(column - key - 0.6 * em);
    size *= fmin(fmax(wide / longest, smallest), 1);
    for (int i = 0; i < list->row_count; i++) {
        const ListRow *row = &list->row[i];
        char text[SENTENCE_SIZE];
        Box room = {(int)(inside.x + i / grid.rows * column),
                    (int)(inside.y + i % grid.rows * grid.row_height),
                    (int)column, (int)fmax(grid.row_height, 1.3 * size * em)};
        snprintf(text, sizeof text, "%s", row->text);
        paper_shorten_words(paper, size, wide, text, sizeof text);
        paper_write_in_box(paper, FACE_BOLD, size, COLOUR_TEXT, room,
                           ALIGN_LEFT, row->key);
        bool heading = row->style == ROW_HEADING;
        room.x += heading ? 0 : (int)key;
        paper_write_in_box(paper, heading ? FACE_BOLD : FACE_REGULAR, size,
                           row->style == ROW_GREY ? COLOUR_GREY : COLOUR_TEXT,
                           room, ALIGN_LEFT, text);
    }
}

/* ---- code --------------------------------------------------------------- */

/* Counts the lines of the code.  Returns the letters in the longest line. */
static double measure_code_width(const LecturePage *page, int *lines)
{
    double widest = 0;
    for (*lines = 0; page->code[*lines]; ++*lines)
        widest = fmax(widest, (double)strlen(page->code[*lines]));
    return widest;
}

double code_find_width(const LecturePage *page)
{
    int lines;
    const double margins = 4.4; /* ems */
    return CODE_LETTER * measure_code_width(page, &lines) + margins;
}

/* Draws code in letters as large as fit; the lines being executed are lit.  If
 * the code is too long, leaves out lines, but never the last lit line. */
static void draw_code(Paper *paper, Box inside, const FrameContent *content)
{
    const char *const *code = content->lecture.page->code;
    const char *mark = lecture_find_highlight(content);
    const double letter = 0.603, high = 1.3, low = 1.17, most = 1.9; /* ems */
    int lines;
    double letters = measure_code_width(content->lecture.page, &lines);
    double air = 0.3 * paper->em;
    /* The width of a letter is a whole number of pixels. */
    double cell = floor((inside.width - 2 * air) / letters);
    double wide = floor((cell + 0.49) / letter);
    double size = fmin(wide, inside.height / (low * lines)) / paper->em;
    size = fmax(fmin(size, most), paper->min_letter_size);
    int line = (int)fmax(
        fmin(paper_to_pixels(paper, high * size), inside.height / lines),
        low * size * paper->em);
    int fit = inside.height / line, lit = 0;
    TextStyle style = {FACE_MONO, size * paper->em, COLOUR_TEXT, true, 0};
    for (int i = 0; i < lines; i++)
        lit = strstr(code[i], mark) ? i : lit;
    int gone = (int)fmax(fmin(lit + 2, lines) - fit, 0);
    fit = fit < lines ? fit : lines;
    /* The backgrounds of lit lines are drawn first, then all letters. */
    for (int k = 0; k < 2 * fit; k++) {
        int row = k % fit, y = inside.y + row * line;
        const char *words = gone > 0 && row == 1 ? "..."
                            : row > 0            ? code[row + gone]
                                                 : code[0];
        if (k < fit && strstr(words, mark))
            canvas_fill(&paper->canvas, (Box){inside.x, y, inside.width, line},
                        COLOUR_LIT);
        if (k >= fit && words[0])
            text_draw(paper->font, &paper->canvas, &style, inside.x + air, y,
                      ALIGN_LEFT, words);
    }
}

/* ---- cards -------------------------------------------------------------- */

void card_draw(Paper *paper, Box inside, const FrameContent *content, int card)
{
    const Pane *pane = active_pane(content);
    const Card *row = active_picture(content)->cards[card];
    const Plot plot =
        plot_create_in_box(paper, content, pane, inside, paper->em);
    if (content->cards.covered_cards >> card & 1)
        card_write_hint(&plot, "after your guess");
    else if (row->draw)
        row->draw(&plot);
    else if (row->words)
        card_write_text(&plot, &pane->values, row->words);
    else
        card_write_listing(&plot, row->listing);
}

static void draw_code_or_list(Paper *paper, const Layout *layout,
                              const FrameContent *content)
{
    static const char *const titles[] = {
        [COLUMN_PAGES] = "The pages of the lecture",
        [COLUMN_LETTERS] = "What the letters mean",
        [COLUMN_KEYS] = "Keys and mouse",
        [COLUMN_OPTIONS] = "Numbers of this scene"};
    bool code = content->column == COLUMN_CODE;
    Box box = box_inset(layout->column, paper_to_pixels(paper, 0.9));
    Box inside = draw_card_frame(
        paper, box,
        code ? content->lecture.page->file : titles[content->column], false);
    Box before = canvas_set_clip(&paper->canvas, inside);
    if (code)
        draw_code(paper, page_draw_claim(paper, inside, content), content);
    else
        draw_list(paper, inside, &content->list);
    canvas_set_clip(&paper->canvas, before);
}

void cards_draw(Paper *paper, const Layout *layout, const FrameContent *content)
{
    const Picture *picture = active_picture(content);
    if (layout->has_list)
        draw_code_or_list(paper, layout, content);
    for (int i = 0; i < layout->card_count; i++) {
        Box box = layout->card[i];
        if (box.width < 1)
            continue; /* hidden cards have no width */
        TextLine title = text_find_known_line(&active_pane(content)->values,
                                              picture->cards[i]->title);
        bool closed = box.height <= paper_to_pixels(paper, TITLE_BAR) + 1;
        Box inside = draw_card_frame(paper, box, title.text, closed);
        if (closed || inside.width < 1 || inside.height < 1)
            continue;
        Box before = canvas_set_clip(&paper->canvas, box_inset(box, 1));
        card_draw(paper, inside, content, i);
        canvas_set_clip(&paper->canvas, before);
    }
}
