#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/plot.h"
#include "scenes/scene.h"

enum { LISTING_VALUE = 96 };

/* A line of a listing: its place in the run, indent, markup. */
typedef struct Row {
    Line line;
    int indent;
    const char *markup;
} Row;

typedef struct Listing {
    const char *method; /* of the integrator; NULL ends the table */
    const char *title;
    const Row *rows; /* the last one has no markup */
    const char *end; /* in the place of the rows' LINE_END; NULL: theirs */
} Listing;

/* Algorithm 3 */
static const Row newton_rows[] = {
    {LINE_START, 0, "{x}^{i} \u2190 {x}^{n}"},
    {LINE_DO, 0, "do"},
    {LINE_PROJECT, 1, "P \u2190 SPDProjection(\u2207\u00b2E({x}^{i}))"},
    {LINE_SOLVE, 1, "{p} \u2190 \u2212P^{\u22121} \u2207E({x}^{i})"},
    {LINE_SEARCH, 1, "{alpha} \u2190 BackTrackingLineSearch({x}^{i}, {p})"},
    {LINE_UPDATE, 1, "{x}^{i} \u2190 {x}^{i} + {alpha} {p}"},
    {LINE_TEST, 0, "while \u2016{p}\u2016_{\u221e} / h > \u03b5"},
    {LINE_END, 0,
     "{x}^{n+1} \u2190 {x}^{i};   v^{n+1} \u2190 ({x}^{n+1} \u2212 {x}^{n}) / "
     "h"},
    {LINE_NONE, 0, NULL}};

/* Algorithm 1, which tests the gradient before it does anything. */
static const Row plain_rows[] = {
    {LINE_START, 0, "{x}^{0} \u2190 start"},
    {LINE_DO, 0, "while \u2016\u2207E({x}^{i})\u2016 > \u03b5"},
    {LINE_SOLVE, 1,
     "{p} \u2190 \u2212\u2207\u00b2E({x}^{i})^{\u22121} \u2207E({x}^{i})"},
    {LINE_UPDATE, 1, "{x}^{i+1} \u2190 {x}^{i} + {p}"},
    {LINE_NONE, 0, NULL}};

/* The same in one variable, with Algorithm 2 inside. */
static const Row scalar_rows[] = {
    {LINE_START, 0, "{x}^{0} \u2190 start"},
    {LINE_DO, 0, "while |f \u2032({x}^{i})| > \u03b5"},
    {LINE_SOLVE, 1, "{p} \u2190 \u2212f \u2032({x}^{i}) / f \u2033({x}^{i})"},
    {LINE_SEARCH, 1, "{alpha} \u2190 BackTrackingLineSearch({x}^{i}, {p})"},
    {LINE_UPDATE, 1, "{x}^{i+1} \u2190 {x}^{i} + {alpha} {p}"},
    {LINE_NONE, 0, NULL}};

static const Row forward_rows[] = {
    {LINE_START, 0, "{x}^{n+1} \u2190 {x}^{n} + h v^{n}"},
    {LINE_END, 0, "v^{n+1} \u2190 v^{n} + h M^{\u22121} f({x}^{n})"},
    {LINE_NONE, 0, NULL}};

static const Row symplectic_rows[] = {
    {LINE_START, 0, "v^{n+1} \u2190 v^{n} + h M^{\u22121} f({x}^{n})"},
    {LINE_END, 0, "{x}^{n+1} \u2190 {x}^{n} + h v^{n+1}"},
    {LINE_NONE, 0, NULL}};

static const Row verlet_rows[] = {
    {LINE_START, 0,
     "v^{n+\u00bd} \u2190 v^{n} + \u00bd h M^{\u22121} f({x}^{n})"},
    {LINE_UPDATE, 0, "{x}^{n+1} \u2190 {x}^{n} + h v^{n+\u00bd}"},
    {LINE_END, 0,
     "v^{n+1} \u2190 v^{n+\u00bd} + \u00bd h M^{\u22121} f({x}^{n+1})"},
    {LINE_NONE, 0, NULL}};

static const Listing listings[] = {
    {"backward-euler", "Algorithm 3: projected Newton", newton_rows, NULL},
    {"forward-euler", "Forward Euler", forward_rows, NULL},
    {"symplectic-euler", "Symplectic Euler", symplectic_rows, NULL},
    {"verlet", "Velocity Verlet", verlet_rows, NULL},
    {NULL, "Algorithm 3 inside another method", newton_rows,
     "{x}^{n+1}, v^{n+1} from {x}^{i}, as the method has it"},
};

static const char algorithm_1[] = "Algorithm 1: Newton's method";
static const Listing scalar_listing = {NULL, algorithm_1, scalar_rows, NULL};
static const Listing plain_listing = {NULL, algorithm_1, plain_rows, NULL};

static const Listing *find_listing(const Simulation *simulation)
{
    const Listing *row = listings;
    const IntegratorMethod *method = simulation->run[0].method;
    if (simulation->descent.scalar)
        return &scalar_listing;
    if (simulation->descent.by_gradient)
        return &plain_listing;
    if (!method) /* a minimisation without time */
        return &listings[0];
    while (row->method && strcmp(row->method, method->name) != 0)
        row++;
    return row;
}

/* Whether the settings switch this line off. */
static bool line_is_off(const Simulation *simulation, Line line)
{
    const Options *options = &simulation->options;
    return (line == LINE_PROJECT && options->filter == FILTER_NONE) ||
           (line == LINE_SEARCH && options->line_search == LINE_SEARCH_NONE);
}

/* 1/2, 1/4, ... where it is one of them. */
void alpha_text(char *text, size_t size, double alpha)
{
    int exponent;
    if (alpha > 0 && alpha < 1 && frexp(alpha, &exponent) == 0.5 &&
        exponent > -9)
        snprintf(text, size, "1/%d", 1 << (1 - exponent));
    else
        plot_number(text, size, alpha);
}

/* "52 of 72 springs", or "60 blocks" of springs, contacts and cells */
static void projected_value(char *value, const Simulation *simulation,
                            const Trace *trace)
{
    if (simulation->options.filter == FILTER_NONE)
        snprintf(value, LISTING_VALUE, "off: P = \u2207\u00b2E");
    else if (trace->projected >= 0 && simulation_projects_springs(simulation))
        snprintf(value, LISTING_VALUE, "%d of %d springs", trace->projected,
                 simulation->system.springs);
    else if (trace->projected >= 0)
        snprintf(value, LISTING_VALUE, "%d block%s", trace->projected,
                 trace->projected == 1 ? "" : "s");
}

/* "alpha = 1/4: refused" */
static void search_value(char *value, const Simulation *simulation,
                         const Trace *trace)
{
    double alpha = trace->first > 0 ? trace->first : 1;
    char number[32];
    if (simulation->options.line_search == LINE_SEARCH_NONE) {
        snprintf(value, LISTING_VALUE, "off: {alpha} = 1");
        return;
    }
    if (trace->trials < 1)
        return;
    if (trace->given_up && !trace->accepted) {
        snprintf(value, LISTING_VALUE, "no {alpha} found");
        return;
    }
    alpha = ldexp(alpha, 1 - trace->trials);
    alpha_text(number, sizeof number, alpha);
    snprintf(value, LISTING_VALUE, "{alpha} = %s%s", number,
             trace->accepted ? "" : ": refused");
}

/* What stands at the right of a line that has been reached. */
static void line_value(char *value, const Simulation *simulation,
                       const Trace *trace, Line line)
{
    double h = trace->h, tolerance = trace->tolerance;
    bool by_gradient = simulation->descent.by_gradient;
    const char *unit = by_gradient ? "" : " m/s";
    Line test = by_gradient ? LINE_DO : LINE_TEST;
    char a[32], b[32];
    value[0] = '\0';
    if (line == LINE_PROJECT)
        projected_value(value, simulation, trace);
    if (line == LINE_SEARCH)
        search_value(value, simulation, trace);
    if (line != test && (line != LINE_SOLVE || by_gradient))
        return;
    if (!isfinite(trace->residual))
        return;
    plot_number(b, sizeof b, tolerance);
    if (trace->passed) {
        if (line == LINE_TEST)
            snprintf(value, LISTING_VALUE, "\u2264 %s%s: it ends", b, unit);
        return;
    }
    if (line == LINE_SOLVE) {
        plot_number(a, sizeof a, trace->residual * h);
        snprintf(value, LISTING_VALUE, "\u2016{p}\u2016_{\u221e} = %s m", a);
    } else {
        bool above = trace->residual > tolerance;
        plot_number(a, sizeof a, trace->residual);
        snprintf(value, LISTING_VALUE, "%s %s %s%s%s", a,
                 above ? ">" : "\u2264", b, unit,
                 above && trace->given_up ? ": given up" : "");
    }
}

/* One line: number, text, value; lit or struck through. */
static void draw_row(Paper *paper, Box box, const Simulation *simulation,
                     const Trace *trace, const Row *row, int number)
{
    bool off = line_is_off(simulation, row->line);
    bool lit = trace && trace->line == row->line && row->line != LINE_NONE;
    bool reached =
        trace && (trace->line == LINE_NONE || trace->line >= row->line);
    Colour colour = off ? COLOUR_GREY : COLOUR_TEXT;
    char value[LISTING_VALUE] = "";
    double size = 1, line = text_line(paper->em);
    double y = box.y + 0.5 * (box.height - line);
    int x = box.x + paper_pixels(paper, 2 + 1.2 * row->indent);
    int right = box.x + box.width - paper_pixels(paper, 0.6);
    if (lit)
        canvas_card(&paper->canvas, box, 0.3 * paper->em, COLOUR_LIT, 0);
    paper_write(paper, FACE_REGULAR, 0.82, COLOUR_GREY, box.x + 1.2 * paper->em,
                y + 0.12 * paper->em, ALIGN_RIGHT, "%d", number);
    if (reached || off)
        line_value(value, simulation, trace ? trace : &(Trace){0}, row->line);
    int text = paper_width(paper, FACE_REGULAR, size, row->markup);
    int room = right - x - paper_pixels(paper, 0.8) -
               paper_width(paper, FACE_REGULAR, 0.88, value);
    if (text > room) /* smaller letters, if that is enough */
        size = fmax(0.8, (double)room / text);
    text = paper_write(paper, FACE_REGULAR, size, colour, x,
                       y + 0.6 * (1 - size) * paper->em, ALIGN_LEFT, "%s",
                       row->markup);
    if (off) {
        double middle = floor(y + 0.62 * line) + 0.5;
        canvas_line(&paper->canvas, x, middle, x + text, middle,
                    fmax(1, 1.3 * paper->unit), COLOUR_GREY);
    }
    if (text <= room)
        paper_write(paper, FACE_REGULAR, 0.88, lit ? COLOUR_TEXT : COLOUR_FAINT,
                    right, y + 0.08 * paper->em, ALIGN_RIGHT, "%s", value);
}

/* Without time the line that ends a step is not there. */
static int count_rows(const Simulation *simulation, const Listing *listing)
{
    bool time = simulation->scene->needs & NEEDS_TIME;
    int rows = 0;
    while (listing->rows[rows].markup &&
           (time || listing->rows[rows].line != LINE_END))
        rows++;
    return rows;
}

/* Ems, with title and margin. */
static double listing_needs(const Show *show, double wide)
{
    const Simulation *simulation = show->pane[show->active].simulation;
    (void)wide;
    return 1.5 * count_rows(simulation, find_listing(simulation)) + 2.6;
}

static void draw_listing(Paper *paper, Box inside, const Show *show)
{
    DescentTrace space;
    const Simulation *simulation = show->pane[show->active].simulation;
    const Listing *listing = find_listing(simulation);
    const Trace *trace = cards_trace(show, &space);
    int rows = count_rows(simulation, listing);
    int pitch = paper_pixels(paper, 1.75);
    if (pitch * rows > inside.height)
        pitch = inside.height / rows;
    for (int i = 0; i < rows; i++) {
        Box box = {inside.x, inside.y + i * pitch, inside.width, pitch};
        Row row = listing->rows[i];
        if (row.line == LINE_END && listing->end)
            row.markup = listing->end;
        draw_row(paper, box, simulation, trace, &row, i + 1);
    }
}

/* Algorithm 3 with lines struck through goes by another name. */
static const char *listing_title(const Show *show)
{
    const Simulation *simulation = show->pane[show->active].simulation;
    const Listing *listing = find_listing(simulation);
    bool project = !line_is_off(simulation, LINE_PROJECT);
    bool search = !line_is_off(simulation, LINE_SEARCH);
    if (listing->rows == scalar_rows)
        return search ? "Algorithm 1; line 4 is Algorithm 2" : algorithm_1;
    if (listing->rows != newton_rows || listing->end || (project && search))
        return listing->title;
    return project  ? "Algorithm 3, line 5 is off"
           : search ? "Algorithm 3, line 3 is off"
                    : "Algorithm 3, lines 3 and 5 are off";
}

const Card card_listing = {
    .name = "listing",
    .title = "Algorithm 3",
    .titled = listing_title,
    .least = 14.6,
    .needs = listing_needs,
    .weight = 0.3,
    .draw = draw_listing,
};
