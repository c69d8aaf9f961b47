/* cards.c - the column of cards; the lists and the code that can take its
 * place. */
#include "picture/cards.h"

#include <math.h>
#include <string.h>

#include "picture/colour_map.h"

static const double TITLE =
    2.0; /* ems, height of a title bar; layout.c has the same */
static const double CODE_LETTER = 0.7; /* ems, width of a letter of code */

double trace_step_length(const Trace *trace, int trial)
{
    return ldexp(trace->first > 0 ? trace->first : 1, 1 - trial);
}

Box card_inner_box(Box card, double em)
{
    int margin = (int)lround(0.8 * em), bar = (int)lround(TITLE * em);
    return (Box){card.x + margin, card.y + bar, card.width - 2 * margin,
                 card.height - bar - margin / 2};
}

void card_write_hint(const Plot *card, const char *text)
{
    TextLine line = text_first_line(&active_pane(card->content)->values, text);
    paper_fit(card->paper, FACE_REGULAR, 0.92, COLOUR_GREY, card->box,
              ALIGN_CENTRE, line.words);
}

/* Draws frame, title and cross of a card.  Returns the box inside. */
static Box draw_frame(Paper *paper, Box box, const char *words, bool closed)
{
    int margin = paper_pixels(paper, 0.8), bar = paper_pixels(paper, TITLE);
    Box title = {box.x + margin, box.y, box.width - bar - margin, bar};
    canvas_framed_box(&paper->canvas, box, COLOUR_WHITE, COLOUR_BORDER);
    paper_fit(paper, FACE_BOLD, 0.96, closed ? COLOUR_FAINT : COLOUR_TEXT,
              title, ALIGN_LEFT, words);
    title.x = box.x + box.width - bar;
    title.width = bar;
    paper_fit(paper, FACE_REGULAR, 1.2, COLOUR_GREY, title, ALIGN_CENTRE,
              closed ? "+" : "\u00d7");
    return card_inner_box(box, paper->em);
}

/* Arrangement of a list in columns. */
typedef struct HelpGrid {
    int rows, columns; /* rows in each column, number of columns */
    double line;       /* pixels, height of a row */
} HelpGrid;

static HelpGrid help_grid(const FrameContent *content, Box inside, double em)
{
    const double line = 1.5, least = 1.3, wide = 24; /* ems */
    HelpGrid grid = {content->list.rows > 0 ? content->list.rows : 1, 1,
                     line * em};
    int most = (int)fmax(inside.width / (wide * em), 1);
    while (grid.rows * least * em > inside.height && grid.columns < most) {
        grid.columns++;
        grid.rows = (content->list.rows + grid.columns - 1) / grid.columns;
    }
    grid.line = fmin(grid.line, inside.height / (double)grid.rows);
    return grid;
}

int frame_find_row(const FrameContent *content, const Layout *layout, double x,
                   double y)
{
    int margin = (int)lround(0.9 * layout->em);
    Box inside = card_inner_box(box_inset(layout->column, margin), layout->em);
    HelpGrid grid = help_grid(content, inside, layout->em);
    if (content->column < COLUMN_PAGES || !box_contains(inside, x, y))
        return -1;
    int column = (int)((x - inside.x) * grid.columns / inside.width);
    int row = (int)((y - inside.y) / grid.line);
    int at = column * grid.rows + row;
    return row < grid.rows && at < content->list.rows ? at : -1;
}

/* Draws a list, key and meaning in each row.  A text that is still too wide in
 * the smallest legible letters loses its last words. */
static void draw_help(Paper *paper, Box inside, const FrameContent *content)
{
    const double SMALLEST =
        0.85; /* the smallest letters, as a part of the usual ones */
    HelpGrid grid = help_grid(content, inside, paper->em);
    double em = paper->em, size = fmin(0.95, grid.line / (1.3 * em));
    double key = 0, wide = inside.width / (double)grid.columns;
    for (int i = 0; i < content->list.rows; i++)
        key = fmax(
            key, paper_width(paper, FACE_BOLD, size, content->list.row[i].key));
    key += 0.6 * size * em;
    for (int i = 0; i < content->list.rows; i++) {
        const ListRow *row = &content->list.row[i];
        char text[SENTENCE_SIZE];
        snprintf(text, sizeof text, "%s", row->text);
        paper_shorten(paper, FACE_REGULAR, SMALLEST * size,
                      (int)(wide - key - 0.6 * em), text, sizeof text);
        double x = inside.x + i / grid.rows * wide;
        int before = row->head ? 0 : (int)key;
        double y = inside.y + i % grid.rows * grid.line;
        paper_write(paper, FACE_BOLD, size, COLOUR_TEXT, x, y, ALIGN_LEFT, "%s",
                    row->key);
        paper_fit(paper, row->head ? FACE_BOLD : FACE_REGULAR, size,
                  row->grey ? COLOUR_GREY : COLOUR_TEXT,
                  (Box){(int)x + before, (int)y,
                        (int)(wide - before - 0.5 * em),
                        (int)fmax(grid.line, 1.3 * size * em)},
                  ALIGN_LEFT, text);
    }
}

/* Measures the code of a page: returns the letters of its widest line.
 *   lines   out, number of lines
 *   indent  out, blanks that all lines begin with */
static double code_letters(const LecturePage *page, int *lines, size_t *indent)
{
    size_t widest = 0;
    *indent = SIZE_MAX;
    for (*lines = 0; page->code[*lines]; ++*lines) {
        const char *line = page->code[*lines];
        size_t length = strlen(line), blanks = strspn(line, " ");
        *indent = length > 0 && blanks < *indent ? blanks : *indent;
        widest = length > widest ? length : widest;
    }
    return (double)widest - (double)*indent;
}

double code_needed_width(const LecturePage *page)
{
    size_t indent;
    int lines;
    const double margins = 4.4; /* ems */
    return CODE_LETTER * code_letters(page, &lines, &indent) + margins;
}

/* Draws code in letters as large as fit, and lights the lines at work.  If not
 * all lines fit, lines between the first one and the last lit one are left out.
 */
static void draw_code(Paper *paper, Box inside, const FrameContent *content)
{
    const LecturePage *page = content->lecture.page;
    const double letter = 0.603, high = 1.3, low = 1.17, most = 1.9; /* ems */
    size_t indent;
    int lines;
    double letters = code_letters(page, &lines, &indent), air = 0.3 * paper->em;
    double cell = floor((inside.width - 2 * air) /
                        letters); /* letters have a width of whole pixels */
    double wide = floor((cell + 0.49) / letter);
    double size = fmin(wide, inside.height / (low * lines)) / paper->em;
    size = fmax(fmin(size, most), paper->min_letter);
    int line =
        (int)fmax(fmin(paper_pixels(paper, high * size), inside.height / lines),
                  low * size * paper->em);
    int fit = inside.height / line, lit = 0, gone;
    TextStyle style = {FACE_MONO, size * paper->em, COLOUR_TEXT, true, 0};
    for (int i = 0; i < lines; i++)
        lit = strstr(page->code[i], lecture_lit_code(content)) ? i : lit;
    gone = fit >= lines ? 0 : (int)fmax(fmin(lit + 2, lines) - fit, 0);
    fit = fit < lines ? fit : lines;
    for (int k = 0; k < 2 * fit;
         k++) { /* first all grounds, then all letters */
        int row = k % fit, y = inside.y + row * line;
        bool more = gone > 0 && row == 1;
        const char *words = more ? "..." : page->code[row + (row ? gone : 0)];
        if (k < fit && strstr(words, lecture_lit_code(content)))
            canvas_fill(&paper->canvas, (Box){inside.x, y, inside.width, line},
                        COLOUR_LIT);
        if (k >= fit && words[0])
            text_draw(paper->text, &paper->canvas, &style, inside.x + air, y,
                      ALIGN_LEFT, words + (more ? 0 : indent));
    }
}

void card_draw(Paper *paper, Box inside, const FrameContent *content, int card)
{
    const Pane *pane = active_pane(content);
    const Card *row = picture_of(pane->simulation->scene)->cards[card];
    const Plot plot = {.paper = paper,
                       .content = content,
                       .simulation = pane->simulation,
                       .box = inside,
                       .pane = content->active,
                       .has_text = true,
                       .em = paper->em};
    if (content->cards.covered >> card & 1)
        card_write_hint(&plot, "after your guess");
    else if (row->words)
        card_write_text(&plot, &pane->values, row->words);
    else if (row->rows)
        card_write_rows(&plot, row->rows);
    else
        row->draw(&plot);
}

void cards_draw(Paper *paper, const Layout *layout, const FrameContent *content)
{
    const Picture *picture =
        picture_of(active_pane(content)->simulation->scene);
    static const char *const titles[] = {
        [COLUMN_PAGES] = "The pages of the lecture",
        [COLUMN_LETTERS] = "What the letters mean",
        [COLUMN_KEYS] = "Keys and mouse",
        [COLUMN_OPTIONS] = "Numbers of this scene"};
    bool code = content->column == COLUMN_CODE;
    if (layout->page) { /* help or code takes the place of the cards */
        Box inside = draw_frame(
            paper, box_inset(layout->column, paper_pixels(paper, 0.9)),
            code ? content->lecture.page->file : titles[content->column],
            false);
        Box before = canvas_set_clip(&paper->canvas, inside);
        if (code)
            draw_code(paper, page_draw_claim(paper, inside, content), content);
        else
            draw_help(paper, inside, content);
        canvas_set_clip(&paper->canvas, before);
    }
    for (int i = 0; i < layout->cards; i++) {
        const Card *card = picture->cards[i];
        TextLine title =
            text_first_line(&active_pane(content)->values, card->title);
        Box box = layout->card[i];
        if (box.width < 1)
            continue; /* the card is hidden */
        bool closed = box.height <= paper_pixels(paper, TITLE) + 1;
        Box inside = draw_frame(paper, box, title.words, closed);
        if (closed || inside.width < 1 || inside.height < 1)
            continue;
        Box before = canvas_set_clip(&paper->canvas, box_inset(box, 1));
        card_draw(paper, inside, content, i);
        canvas_set_clip(&paper->canvas, before);
    }
}
