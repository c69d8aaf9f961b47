#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/colour_map.h"

static const double WIDE_PITCH = 2.1; /* ems, of a line with room on a page */

/* A line of a listing; its texts have facts. */
typedef struct Row {
    const char *of; /* the switch that tells which listing is shown; inside of
                       line 5 the one that lights it */
    Line line;      /* its place in the run */
    int indent;
    const char *off; /* the switch that strikes it through, or NULL */
    const char *markup;
    const char *value; /* at its right, where it has been reached; or NULL */
} Row;

static const Row rows[] = {
    {"{Algorithm 3}", LINE_START, 0, NULL, "{x}^{i} \u2190 {x}^{n}", NULL},
    {"{Algorithm 3}", LINE_DO, 0, NULL, "do", NULL},
    {"{Algorithm 3}", LINE_PROJECT, 1, "{raw}",
     "P \u2190 SPDProjection(\u2207\u00b2E({x}^{i}))",
     "{raw}off: P = \u2207\u00b2E\n"
     "{of springs}{projected} of {springs} springs\n"
     "{projected} block{s}"},
    {"{Algorithm 3}", LINE_SOLVE, 1, NULL,
     "{p} \u2190 \u2212P^{\u22121} \u2207E({x}^{i})",
     "\u2016{p}\u2016_{\u221e} = {p size} m"},
    /* Algorithm 1 tests the gradient before it does anything; in one unknown
     * Algorithm 2 is inside. */
    {"{by gradient}", LINE_START, 0, NULL, "{x}^{0} \u2190 start", NULL},
    {"{by gradient}", LINE_DO, 0, NULL,
     "{one unknown}while |f \u2032({x}^{i})| > \u03b5\n"
     "while \u2016\u2207E({x}^{i})\u2016 > \u03b5",
     "{residual} {>} {tolerance}{given}"},
    {"{one unknown}", LINE_SOLVE, 1, NULL,
     "{p} \u2190 \u2212f \u2032({x}^{i}) / f \u2033({x}^{i})", NULL},
    {"{search}", LINE_SEARCH, 1, "{whole}",
     "{alpha} \u2190 BackTrackingLineSearch({x}^{i}, {p})",
     "{whole}off: {alpha} = 1\n"
     "{refused}{given up}no {alpha} found\n"
     "{refused}{alpha} = {length:/}: refused\n"
     "{taken}{alpha} = {length:/}"},
    {"{Algorithm 3}", LINE_UPDATE, 1, NULL,
     "{x}^{i} \u2190 {x}^{i} + {alpha} {p}", NULL},
    {"{Algorithm 3}", LINE_TEST, 0, NULL,
     "while \u2016{p}\u2016_{\u221e} / h > \u03b5",
     "{residual} {>} {tolerance} m/s{given}\n"
     "{passed}\u2264 {tolerance} m/s: it ends"},
    {"{Algorithm 3}{time}", LINE_END, 0, NULL,
     "{inside}{x}^{n+1}, v^{n+1} from {x}^{i}, as the method has it\n"
     "{x}^{n+1} \u2190 {x}^{i};   v^{n+1} \u2190 ({x}^{n+1} \u2212 {x}^{n}) / "
     "h",
     NULL},
    {"{Algorithm 1}", LINE_SOLVE, 1, NULL,
     "{p} \u2190 \u2212\u2207\u00b2E({x}^{i})^{\u22121} \u2207E({x}^{i})",
     NULL},
    {"{Algorithm 1}", LINE_UPDATE, 1, NULL, "{x}^{i+1} \u2190 {x}^{i} + {p}",
     NULL},
    {"{one unknown}", LINE_UPDATE, 1, NULL,
     "{x}^{i+1} \u2190 {x}^{i} + {alpha} {p}", NULL},
    {"{forward-euler}", LINE_START, 0, NULL,
     "{x}^{n+1} \u2190 {x}^{n} + h v^{n}", NULL},
    {"{forward-euler}", LINE_END, 0, NULL,
     "v^{n+1} \u2190 v^{n} + h M^{\u22121} f({x}^{n})", NULL},
    {"{symplectic-euler}", LINE_START, 0, NULL,
     "v^{n+1} \u2190 v^{n} + h M^{\u22121} f({x}^{n})", NULL},
    {"{symplectic-euler}", LINE_END, 0, NULL,
     "{x}^{n+1} \u2190 {x}^{n} + h v^{n+1}", NULL},
    {"{verlet}", LINE_START, 0, NULL,
     "v^{n+\u00bd} \u2190 v^{n} + \u00bd h M^{\u22121} f({x}^{n})", NULL},
    {"{verlet}", LINE_UPDATE, 0, NULL,
     "{x}^{n+1} \u2190 {x}^{n} + h v^{n+\u00bd}", NULL},
    {"{verlet}", LINE_END, 0, NULL,
     "v^{n+1} \u2190 v^{n+\u00bd} + \u00bd h M^{\u22121} f({x}^{n+1})", NULL},
};
enum { ROWS = sizeof rows / sizeof *rows };

/* A line: number, text, value; lit or struck through. */
static void draw_row(Paper *paper, Box box, const Pane *pane, const Row *row,
                     bool lit, int number)
{
    const Trace *trace = pane->update;
    const Facts *facts = &pane->facts;
    bool reached =
        trace && (trace->line == LINE_NONE || trace->line >= row->line);
    bool struck = text_is_known(facts, row->off);
    TextLine words = text_first(facts, row->markup);
    TextLine value = text_first(facts, reached || struck ? row->value : NULL);
    char digits[12];
    double size = box.height < 0.95 * WIDE_PITCH * paper->em ? 1 : 1.2;
    int indent = paper_pixels(paper, 2 + 1.2 * row->indent);
    int wide = paper_width(paper, FACE_REGULAR, 0.88 * size, value.words);
    Box count = {box.x, box.y, paper_pixels(paper, 1.2), box.height};
    Box room = {box.x + indent, box.y,
                box.width - indent - wide - paper_pixels(paper, 1.4),
                box.height};
    if (lit)
        canvas_fill(&paper->canvas, box, COLOUR_LIT);
    snprintf(digits, sizeof digits, "%d", number);
    paper_fit(paper, FACE_REGULAR, 0.82, COLOUR_GREY, count, ALIGN_RIGHT,
              digits);
    int text =
        paper_fit(paper, FACE_REGULAR, size, struck ? COLOUR_GREY : COLOUR_TEXT,
                  room, ALIGN_LEFT, words.words);
    if (struck)
        canvas_fill(&paper->canvas,
                    (Box){room.x, box.y + box.height / 2, text,
                          (int)fmax(1, 1.3 * paper->unit)},
                    COLOUR_GREY);
    box.width -= paper_pixels(paper, 0.6);
    if (text <= room.width)
        paper_fit(paper, FACE_REGULAR, 0.88 * size,
                  lit ? COLOUR_TEXT : COLOUR_FAINT, box, ALIGN_RIGHT,
                  value.words);
}

/* The rows of what the active pane does: shown [ROWS] out.  Returns how many
 * there are. */
static int find_rows(const Show *show, const Row **shown)
{
    int count = 0;
    for (int i = 0; i < ROWS; i++)
        if (text_is_known(&show_pane(show)->facts, rows[i].of))
            shown[count++] = &rows[i];
    return count;
}

/* Ems, with title and margin. */
double listing_needs(const Show *show, double wide)
{
    const Row *shown[ROWS];
    (void)wide;
    return 1.5 * find_rows(show, shown) + 2.6;
}

static void draw_rows(const Plot *card, int count, const Row *const *shown,
                      bool inside_line)
{
    const Pane *pane = show_pane(card->show);
    Box inside = card->box;
    const Trace *trace = pane->update;
    double em = card->em * (card->show->lecture ? WIDE_PITCH : 1.75);
    int pitch = (int)fmin(lround(em), inside.height / (double)count);
    for (int i = 0; i < count; i++) {
        bool lit = inside_line ? text_is_known(&pane->facts, shown[i]->of)
                               : trace && trace->line == shown[i]->line;
        draw_row(card->paper,
                 (Box){inside.x, inside.y + i * pitch, inside.width, pitch},
                 pane, shown[i], lit, i + 1);
    }
}

void listing_draw(const Plot *card)
{
    const Row *shown[ROWS];
    draw_rows(card, find_rows(card->show, shown), shown, false);
}

/* Line 5 from inside. */
void search_draw(const Plot *card)
{
    static const Row search_rows[] = {
        {"{line 4}", LINE_SEARCH, 0, NULL, "{alpha} \u2190 1", NULL},
        {"{line 5}", LINE_SEARCH, 0, NULL,
         "while E({x}^{i} + {alpha} {p}) > E({x}^{i})",
         "{refused}E {+}{change} J s\u00b2: higher\n"
         "{taken}E {+}{change} J s\u00b2"},
        {"{line 5}{refused}", LINE_SEARCH, 1, NULL,
         "{alpha} \u2190 {alpha} / 2", NULL},
        {"{line 5}{taken}", LINE_SEARCH, 0, NULL, "return {alpha}",
         "{taken}{alpha} = {length:/}"}};
    enum { COUNT = sizeof search_rows / sizeof *search_rows };
    const Row *shown[COUNT];
    for (int i = 0; i < COUNT; i++)
        shown[i] = &search_rows[i];
    draw_rows(card, COUNT, shown, true);
}

/* The newest updates, as many as there is room for; of a star this is the upper
 * half, and below are the residuals as points. */
void prints_draw(const Plot *card)
{
    Paper *paper = card->paper;
    Plot below = *card;
    Box inside = card->box;
    const Trace *trace = show_pane(card->show)->update;
    bool star = inside.width > STAR_WIDE * paper->em;
    double size = star ? 1.5 : 0.95;
    if (star && trace) {
        inside.height /= 2;
        below.box.y += inside.height;
        below.box.height -= inside.height;
        residual_draw(&below);
    }
    int pitch = paper_pixels(paper, 1.5 * size), room = inside.height / pitch;
    int count = trace ? trace->updates : 0,
        first = count > room - 1 ? count - (room - 1) : 0;
    if (count == 0) {
        cards_hint(card, "N makes a step");
        return;
    }
    for (int i = first; i < count && i - first < room; i++)
        paper_write(paper, FACE_MONO, size, COLOUR_TEXT, inside.x,
                    inside.y + (i - first) * pitch, ALIGN_LEFT,
                    "%s%d: residual = %s  step size = %s",
                    inside.width < 29 * paper->em ? "" : "Iteration ", i,
                    number_with(trace->record[i].residual, 4).text,
                    number_of(trace->record[i].alpha).text);
    if (count - first < room && trace->residual <= trace->tolerance)
        paper_write(paper, FACE_MONO, size, COLOUR_FAINT, inside.x,
                    inside.y + (count - first) * pitch, ALIGN_LEFT,
                    "then residual \u2264 %s: the loop ends",
                    number_of(trace->tolerance).text);
}
