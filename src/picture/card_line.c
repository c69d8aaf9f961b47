/* card_line.c - the card of E along p, with the trials of the line search. */
#include <math.h>

#include "picture/cards.h"

enum { PLOT_POINTS = 161 };

/* The alpha axis ends at AXIS_END times the first trial step, at PAGE_END times
 * with the curve of the projected p.  The E axis ends at MAX_ABOVE times the
 * depth of the curves at most, at MAX_UPHILL times if p is uphill. */
static const double AXIS_END = 1.42, PAGE_END = 1.1, MAX_ABOVE = 2.2,
                    MAX_UPHILL = 4;
static const double WORD_SIZE = 0.88;  /* ems, size of words above the plot */
static const double ROW_HEIGHT = 1.25; /* ems, height of a row of words */
static const double WORDS_WIDTH = 28;  /* ems, a narrower legend has two rows */

/* Changes of E along p as functions of alpha. */
typedef struct LineCurves {
    double alpha[PLOT_POINTS], exact_E[PLOT_POINTS], model_E[PLOT_POINTS];
    double projected_E[PLOT_POINTS]; /* E along the projected p; NaN: none */
    double low, high;                /* ends of the axis of E */
} LineCurves;

static double energy_along_p(const NewtonTrace *trace, double alpha)
{
    double value = trace->energy_difference(trace->difference_data, alpha);
    return isfinite(value) ? value : NAN;
}

/* Fills the curves, and the ends of the E axis from below the curves' minimum
 * to above 0.  The quadratic model has its minimum at alpha = 1: by Newton's
 * equation H p = -g its curvature p^T H p is minus its slope g^T p. */
static void compute_line_curves(const NewtonTrace *trace,
                                const NewtonTrace *other, LineCurves *curves)
{
    double end =
        (other ? PAGE_END : AXIS_END) * find_trial_step_length(trace, 1);
    double low = 0, high = 0;
    for (int i = 0; i < PLOT_POINTS; i++) {
        double alpha = end * i / (PLOT_POINTS - 1);
        curves->alpha[i] = alpha;
        curves->exact_E[i] = energy_along_p(trace, alpha);
        curves->model_E[i] = trace->slope * (alpha - 0.5 * alpha * alpha);
        curves->projected_E[i] = other ? energy_along_p(other, alpha) : NAN;
        low = fmin(low, fmin(curves->exact_E[i], curves->model_E[i]));
        low = fmin(low, curves->projected_E[i]);
        if (!isnan(curves->exact_E[i]))
            high = fmax(high, curves->exact_E[i]);
    }
    /* If no curve falls, depth is the model's rise to alpha = 1, slope/2. */
    double depth = fmax(low < 0 ? -low : 0.5 * trace->slope, 1e-300);
    curves->low = -1.12 * depth;
    curves->high =
        trace->slope > 0
            ? fmin(1.05 * fmax(high, 0.5 * trace->slope), MAX_UPHILL * depth)
            : fmin(fmax(high, 0.25 * depth), MAX_ABOVE * depth);
}

/* Draws a trial of the line search as a dot; if its value lies above the plot,
 * as an arrow upwards with the value in figures. */
static void draw_trial_step(const Plot *plot, double alpha, double value,
                            bool accepted)
{
    Paper *paper = plot->paper;
    const double point[2] = {alpha, value};
    Colour colour = accepted ? COLOUR_ALPHA : COLOUR_WARNING;
    double at[2], unit = paper->unit;
    bool inside = value <= plot->y.high;
    plot_to_pixel(plot, (double[2]){alpha, inside ? value : plot->y.high}, at);
    if (inside && accepted)
        plot_disc(plot, point, 5.5, colour);
    else if (inside)
        plot_ring(plot, point, 4, 1.6, colour);
    else
        canvas_arrow(&paper->canvas, at[0], at[1] + 14 * unit, at[0], at[1],
                     1.6 * unit, 7 * unit, colour);
    if (inside && !accepted)
        plot_label(plot, 1, point, colour, "%s", format_number(alpha).text);
    if (value > plot->y.high)
        plot_label(plot, 1, (double[2]){alpha, plot->y.high}, colour,
                   "{alpha} = %s: +%s", format_number(alpha).text,
                   format_number(value).text);
}

/* Writes the legend in one or two rows, which are cut off from the plot. */
static void draw_line_legend(const Plot *card, Box *rest)
{
    Paper *paper = card->paper;
    int rows = card->box.width / paper->em < WORDS_WIDTH ? 2 : 1;
    int high = paper_to_pixels(paper, rows * ROW_HEIGHT), at[2] = {0, 0};
    TextLine line = lines_begin(&card->pane->values, card_line.legend);
    int air = paper_to_pixels(paper, 0.4); /* pixels above for superscripts */
    Box words = box_cut_off(rest, EDGE_TOP, high);
    words.y -= air;
    words.height += air;
    Box before = canvas_set_clip(&paper->canvas, words);
    while (text_next_line(&line))
        card_write_lines(card, at, WORD_SIZE, 1, &line, true);
    canvas_set_clip(&paper->canvas, before);
}

/* Draws the curves and the trials.  A page about projection also shows E along
 * the projected p until the first step is made. */
void draw_line_search_card(const Plot *card)
{
    const Pane *pane = card->pane;
    const NewtonTrace *trace = pane->shown_trace;
    LineCurves curves;
    DescentTrace other = pane->descent;
    if (!trace || !trace->energy_difference || !isfinite(trace->slope) ||
        trace->slope == 0) {
        card_write_hint(card, text_undrawn);
        return;
    }
    bool both = text_has_line_to_show(&pane->values, "{directions}");
    if (both)
        descent_find_p(card->simulation, PROJECTION_CLAMP, other.start,
                       other.p);
    other.trace.difference_data = &other;
    compute_line_curves(trace, both ? &other.trace : NULL, &curves);
    Axis x = {0, curves.alpha[PLOT_POINTS - 1], .label = "{alpha}"};
    Axis y = {curves.low, curves.high, .label = NULL};
    Plot rest = *card;
    if (!card->content->has_document)
        draw_line_legend(card, &rest.box);
    Plot plot = plot_create(&rest, x, y);
    plot_curve(&plot, PLOT_POINTS, curves.alpha, curves.model_E, 1.3, COLOUR_P);
    plot_curve(&plot, PLOT_POINTS, curves.alpha, curves.projected_E, 2,
               COLOUR_PROJECT);
    plot_curve(&plot, PLOT_POINTS, curves.alpha, curves.exact_E, 2, COLOUR_X);
    plot_disc(&plot, (double[2]){0, 0}, 3.5, COLOUR_TEXT);
    double first = find_trial_step_length(trace, 1);
    double full = energy_along_p(trace, first);
    bool is_main = card->simulation->options.main_card;
    if (trace->trials == 0 && is_main && full > plot.y.high)
        draw_trial_step(&plot, first, full, false);
    for (int t = 0; t < trace->trials; t++) {
        double at = find_trial_step_length(trace, t + 1);
        bool last = t == trace->trials - 1;
        draw_trial_step(&plot, at, energy_along_p(trace, at),
                        last && trace->is_accepted);
    }
}
