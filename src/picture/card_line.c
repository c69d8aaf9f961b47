/* card_line.c - the card with E along the search direction, and the line
 * search on it.
 */
#include <math.h>

#include "picture/cards.h"
#include "picture/colour_map.h"

enum { LINE_POINTS = 161 };

static const double BEYOND = 1.42; /* the axis ends, in first trials */
static const double ABOVE = 2.2;   /* the most range above 0, in depths, */
static const double CLIMB = 10;    /* and where p points uphill */
static const double WORD_SIZE = 0.88, WORDS_ROOM = 1.25; /* ems */
static const double WORDS_WIDE = 28; /* ems that all words need in one row */

/* What is drawn: the two functions on one grid of alpha. */
typedef struct Curves {
    double alpha[LINE_POINTS], exact[LINE_POINTS], model[LINE_POINTS];
    double other[LINE_POINTS]; /* exact, too, along the projected p; or NaN */
    double low, high;          /* of the axis */
} Curves;

static double exact_value(const Trace *trace, double alpha)
{
    double value = trace->difference(trace->function, alpha);
    return isfinite(value) ? value : NAN;
}

/* The model is the quadratic function with its minimum at alpha = 1: p solves
 * H^ p = -g, so p H^ p = -g p, the slope.  From the lowest of both curves to a
 * bit above 0; trials that lie far above are told in words. */
static void fill_curves(const Trace *trace, const Trace *other, Curves *curves)
{
    double end = BEYOND * trace_alpha(trace, 1);
    double low = 0, high = 0;
    for (int i = 0; i < LINE_POINTS; i++) {
        double alpha = end * i / (LINE_POINTS - 1);
        curves->alpha[i] = alpha;
        curves->exact[i] = exact_value(trace, alpha);
        curves->model[i] = trace->slope * (alpha - 0.5 * alpha * alpha);
        curves->other[i] = other ? exact_value(other, alpha) : NAN;
        low = fmin(low, fmin(curves->exact[i], curves->model[i]));
        low = fmin(low, curves->other[i]);
        if (!isnan(curves->exact[i]))
            high = fmax(high, curves->exact[i]);
    }
    double depth = fmax(-low, 1e-300);
    if (!(low < 0)) /* nothing is below: the first tenth tells the scale */
        depth = fmax(fabs(curves->exact[LINE_POINTS / 10]), 1e-300);
    curves->low = -1.12 * depth;
    curves->high =
        trace->slope > 0
            ? fmin(1.05 * fmax(high, 0.5 * trace->slope), CLIMB * depth)
            : fmin(fmax(high, 0.25 * depth), ABOVE * depth);
}

/* A trial above the axis is a small arrow at its upper edge, with its value. */
static void draw_trial(const Plot *plot, double alpha, double value,
                       bool accepted)
{
    Paper *paper = plot->paper;
    const double point[2] = {alpha, value};
    Colour colour = accepted ? COLOUR_ALPHA : COLOUR_WARNING;
    double at[2], unit = paper->unit;
    bool inside = value <= plot->y.high && value >= plot->y.low;
    plot_place(plot, (double[2]){alpha, inside ? value : plot->y.high}, at);
    if (inside && accepted)
        plot_disc(plot, point, 5.5, colour);
    else if (inside)
        plot_ring(plot, point, 4, 1.6, colour);
    else
        canvas_arrow(&paper->canvas, at[0], at[1] + 14 * unit, at[0], at[1],
                     1.6 * unit, 7 * unit, colour);
    if (value > plot->y.high)
        plot_words(plot, 1, (double[2]){alpha, plot->y.high}, colour,
                   "{alpha} = %s: +%s", number_of(alpha).text,
                   number_of(value).text);
}

/* On a page, of a descent whose p is not projected, also along the projected
 * one, until a step is made.  What the curves are, and the last trial, stand
 * above the plot, whose room does not depend on what there is to say: nothing
 * of it lies on a curve. */
void line_draw(const Plot *card)
{
    const Pane *pane = show_pane(card->show);
    const Trace *trace = pane->update;
    Curves curves;
    DescentTrace other = pane->descent;
    if (!trace || !trace->difference || !isfinite(trace->slope) ||
        trace->slope == 0) {
        cards_hint(card, text_undrawn);
        return;
    }
    bool both = text_is_known(&pane->facts, "{directions}");
    if (both)
        descent_direction(card->simulation, PROJECTION_CLAMP, other.from,
                          other.p);
    other.trace.function = &other;
    fill_curves(trace, both ? &other.trace : NULL, &curves);
    Axis x = {0, curves.alpha[LINE_POINTS - 1], false, false, "{alpha}"};
    Axis y = {curves.low, curves.high, false, false, NULL};
    Paper *paper = card->paper;
    Plot rest = *card;
    int rows = card->box.width / paper->em < WORDS_WIDE ? 2 : 1;
    int high = paper_pixels(paper, rows * WORDS_ROOM), at[2] = {0, 0};
    TextLine line = text_of(&pane->facts, text_trials);
    int air = paper_pixels(paper, 0.4); /* of what is raised */
    Box words = box_cut_off(&rest.box, EDGE_TOP, high);
    words.y -= air;
    words.height += air;
    Box before = canvas_clip(&paper->canvas, words);
    while (text_next(&line))
        words_flow(card, at, WORD_SIZE, 1, &line);
    canvas_clip(&paper->canvas, before);
    Plot plot = plot_create(&rest, x, y);
    const double origin[2] = {0, 0};
    plot_curve(&plot, LINE_POINTS, curves.alpha, curves.model, 1.3, COLOUR_P);
    plot_curve(&plot, LINE_POINTS, curves.alpha, curves.other, 2,
               COLOUR_PROJECT);
    plot_curve(&plot, LINE_POINTS, curves.alpha, curves.exact, 2, COLOUR_X);
    plot_disc(&plot, origin, 3.5, COLOUR_TEXT);
    double first = trace_alpha(trace, 1), full = exact_value(trace, first);
    bool star = card->simulation->options.star;
    if (trace->trials == 0 && star && full > plot.y.high)
        draw_trial(&plot, first, full, false);
    for (int t = 0; t < trace->trials; t++) {
        double at = trace_alpha(trace, t + 1);
        bool last = t == trace->trials - 1;
        draw_trial(&plot, at, exact_value(trace, at), last && trace->accepted);
    }
}
