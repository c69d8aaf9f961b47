#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/plot.h"
#include "scenes/scene.h"

enum { LISTING_VALUE = 128 };

/* A line of a listing: its place in the run, indent, markup. */
typedef struct Row {
    Line line;
    int indent;
    const char *markup; /* NULL ends the listing */
} Row;

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

/* The listings of methods; of all others Algorithm 3 is inside. */
static const struct {
    const char *method, *title;
    const Row *rows;
} listings[] = {
    {"forward-euler", "Forward Euler", forward_rows},
    {"symplectic-euler", "Symplectic Euler", symplectic_rows},
    {"verlet", "Velocity Verlet", verlet_rows},
};
enum { LISTINGS = sizeof listings / sizeof *listings };

/* What the active pane does, line by line. */
typedef struct Listing {
    const Simulation *simulation;
    const Trace *trace; /* NULL: nothing yet */
    const char *title;
    const Row *rows;
    int count;   /* without time the line that ends a step is not there */
    bool inside; /* another method, which ends a step in its own way */
} Listing;

/* Whether the settings switch this line off. */
static bool line_is_off(const Simulation *simulation, Line line)
{
    const Options *options = &simulation->options;
    return (line == LINE_PROJECT && options->filter == FILTER_NONE) ||
           (line == LINE_SEARCH && options->line_search == LINE_SEARCH_NONE);
}

/* Algorithm 3 with lines struck through goes by another name. */
static const char *newton_title(const Simulation *simulation)
{
    bool project = !line_is_off(simulation, LINE_PROJECT);
    bool search = !line_is_off(simulation, LINE_SEARCH);
    return project && search ? "Algorithm 3: projected Newton"
           : project         ? "Algorithm 3, line 5 is off"
           : search          ? "Algorithm 3, line 3 is off"
                             : "Algorithm 3, lines 3 and 5 are off";
}

static Listing find_listing(const Show *show)
{
    const Simulation *simulation = show->pane[show->active].simulation;
    const IntegratorMethod *method = simulation->run[0].method;
    Listing listing = {.simulation = simulation,
                       .title = "Algorithm 1: Newton's method",
                       .rows = plain_rows};
    if (simulation->descent.scalar) {
        listing.rows = scalar_rows;
        if (!line_is_off(simulation, LINE_SEARCH))
            listing.title = "Algorithm 1; line 4 is Algorithm 2";
    } else if (!simulation->descent.by_gradient) {
        listing.rows = newton_rows;
        listing.title = newton_title(simulation);
        listing.inside = method && strcmp(method->name, "backward-euler") != 0;
        if (listing.inside)
            listing.title = "Algorithm 3 inside another method";
        for (int i = 0; method && i < LISTINGS; i++)
            if (strcmp(method->name, listings[i].method) == 0) {
                listing.title = listings[i].title;
                listing.rows = listings[i].rows;
            }
        listing.inside = listing.inside && listing.rows == newton_rows;
    }
    bool time = simulation->scene->needs & NEEDS_TIME;
    while (listing.rows[listing.count].markup &&
           (time || listing.rows[listing.count].line != LINE_END))
        listing.count++;
    return listing;
}

/* 1/2, 1/4, ... where it is one of them. */
Number alpha_of(double alpha)
{
    int exponent;
    Number number = number_of(alpha);
    if (alpha > 0 && alpha < 1 && frexp(alpha, &exponent) == 0.5 &&
        exponent > -9)
        snprintf(number.text, sizeof number.text, "1/%d", 1 << (1 - exponent));
    return number;
}

/* "52 of 72 springs", or "60 blocks" of springs, contacts and cells */
static void projected_value(char *value, const Simulation *simulation,
                            int projected)
{
    if (simulation->options.filter == FILTER_NONE)
        snprintf(value, LISTING_VALUE, "off: P = \u2207\u00b2E");
    else if (projected >= 0 && simulation_projects_springs(simulation))
        snprintf(value, LISTING_VALUE, "%d of %d springs", projected,
                 simulation->system.springs);
    else if (projected >= 0)
        snprintf(value, LISTING_VALUE, "%d block%s", projected,
                 projected == 1 ? "" : "s");
}

/* "alpha = 1/4: refused" */
static void search_value(char *value, const Simulation *simulation,
                         const Trace *trace)
{
    if (simulation->options.line_search == LINE_SEARCH_NONE) {
        snprintf(value, LISTING_VALUE, "off: {alpha} = 1");
    } else if (trace->trials > 0 && trace->given_up && !trace->accepted) {
        snprintf(value, LISTING_VALUE, "no {alpha} found");
    } else if (trace->trials > 0) {
        snprintf(value, LISTING_VALUE, "{alpha} = %s%s",
                 alpha_of(trace_alpha(trace, trace->trials)).text,
                 trace->accepted ? "" : ": refused");
    }
}

/* "0.3 > 0.01 m/s"; where p was not needed only the tolerance is known. */
static void test_value(char *value, const Trace *trace, Line line,
                       const char *unit)
{
    bool above = trace->residual > trace->tolerance;
    const Number tolerance = number_of(trace->tolerance);
    if (!trace->passed)
        snprintf(value, LISTING_VALUE, "%s %s %s%s%s",
                 number_of(trace->residual).text, above ? ">" : "\u2264",
                 tolerance.text, unit,
                 above && trace->given_up ? ": given up" : "");
    else if (line == LINE_TEST)
        snprintf(value, LISTING_VALUE, "\u2264 %s%s: it ends", tolerance.text,
                 unit);
}

/* What stands at the right of a line that has been reached. */
static void line_value(char *value, const Simulation *simulation,
                       const Trace *trace, Line line)
{
    bool by_gradient = simulation->descent.by_gradient;
    bool known = isfinite(trace->residual);
    if (line == LINE_PROJECT)
        projected_value(value, simulation, trace->projected);
    if (line == LINE_SEARCH)
        search_value(value, simulation, trace);
    if (line == (by_gradient ? LINE_DO : LINE_TEST) && known)
        test_value(value, trace, line, by_gradient ? "" : " m/s");
    if (line == LINE_SOLVE && !by_gradient && known && !trace->passed)
        snprintf(value, LISTING_VALUE, "\u2016{p}\u2016_{\u221e} = %s m",
                 number_of(trace->residual * trace->h).text);
}

/* One line: number, text, value; lit or struck through. */
static void draw_row(Paper *paper, Box box, const Listing *listing, int number)
{
    const Row *row = &listing->rows[number - 1];
    const Trace *trace = listing->trace;
    bool off = line_is_off(listing->simulation, row->line);
    bool lit = trace && trace->line == row->line;
    bool reached =
        trace && (trace->line == LINE_NONE || trace->line >= row->line);
    const char *words = row->markup;
    char value[LISTING_VALUE] = "";
    double line = text_line(paper->em);
    double y = box.y + 0.5 * (box.height - line);
    int x = box.x + paper_pixels(paper, 2 + 1.2 * row->indent);
    int right = box.x + box.width - paper_pixels(paper, 0.6);
    if (listing->inside && row->line == LINE_END)
        words = "{x}^{n+1}, v^{n+1} from {x}^{i}, as the method has it";
    if (lit)
        canvas_card(&paper->canvas, box, 0.3 * paper->em, COLOUR_LIT, 0);
    paper_write(paper, FACE_REGULAR, 0.82, COLOUR_GREY, box.x + 1.2 * paper->em,
                y + 0.12 * paper->em, ALIGN_RIGHT, "%d", number);
    if (reached || off)
        line_value(value, listing->simulation, trace ? trace : &(Trace){0},
                   row->line);
    int room = right - x - paper_pixels(paper, 0.8) -
               paper_width(paper, FACE_REGULAR, 0.88, value);
    double size = fitting_size(paper, FACE_REGULAR, 1, 0.8, room, words);
    int text = paper_write(
        paper, FACE_REGULAR, size, off ? COLOUR_GREY : COLOUR_TEXT, x,
        y + 0.6 * (1 - size) * paper->em, ALIGN_LEFT, "%s", words);
    if (off) {
        double middle = floor(y + 0.62 * line) + 0.5;
        canvas_line(&paper->canvas, x, middle, x + text, middle,
                    fmax(1, 1.3 * paper->unit), COLOUR_GREY);
    }
    if (text <= room)
        paper_write(paper, FACE_REGULAR, 0.88, lit ? COLOUR_TEXT : COLOUR_FAINT,
                    right, y + 0.08 * paper->em, ALIGN_RIGHT, "%s", value);
}

/* Ems, with title and margin. */
static double listing_needs(const Show *show, double wide)
{
    (void)wide;
    return 1.5 * find_listing(show).count + 2.6;
}

static void draw_listing(Paper *paper, Box inside, const Show *show)
{
    DescentTrace space;
    Listing listing = find_listing(show);
    listing.trace = cards_trace(show, &space);
    int pitch = paper_pixels(paper, 1.75);
    if (pitch * listing.count > inside.height)
        pitch = inside.height / listing.count;
    for (int i = 0; i < listing.count; i++)
        draw_row(paper,
                 (Box){inside.x, inside.y + i * pitch, inside.width, pitch},
                 &listing, i + 1);
}

static const char *listing_title(const Show *show)
{
    return find_listing(show).title;
}

const Card card_listing = {
    .name = "listing",
    .titled = listing_title,
    .least = 14.6,
    .needs = listing_needs,
    .weight = 0.3,
    .draw = draw_listing,
};
