#include <math.h>
#include <stdio.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/plot.h"

enum { LINE_POINTS = 161 };

static const double BEYOND = 1.42; /* the axis ends, in first trials */
static const double ABOVE = 2.2;   /* the least range above 0, in depths */

/* What is drawn: the two functions on one grid of alpha. */
typedef struct Curves {
    double alpha[LINE_POINTS], exact[LINE_POINTS], model[LINE_POINTS];
    double low, high; /* of the axis */
} Curves;

/* E(x + alpha p) - E(x) of a quadratic function with minimum at alpha = 1:
 * p solves P p = -g, so p P p = -g p, the slope. */
static double model_value(double slope, double alpha)
{
    return slope * (alpha - 0.5 * alpha * alpha);
}

static double exact_value(const Trace *trace, double alpha)
{
    double value = trace->difference(trace->function, alpha);
    return isfinite(value) ? value : NAN;
}

/* From the lowest of both curves to a bit above 0; trials that lie far above
 * are told in words. */
static void fill_curves(const Trace *trace, Curves *curves)
{
    double end = BEYOND * (trace->first > 0 ? trace->first : 1);
    double low = 0, high = 0;
    for (int i = 0; i < LINE_POINTS; i++) {
        double alpha = end * i / (LINE_POINTS - 1);
        curves->alpha[i] = alpha;
        curves->exact[i] = exact_value(trace, alpha);
        curves->model[i] = model_value(trace->slope, alpha);
        low = fmin(low, fmin(curves->exact[i], curves->model[i]));
        if (!isnan(curves->exact[i]))
            high = fmax(high, curves->exact[i]);
    }
    double depth = fmax(-low, 1e-300);
    if (!(low < 0)) /* nothing is below: the first tenth tells the scale */
        depth = fmax(fabs(curves->exact[LINE_POINTS / 10]), 1e-300);
    curves->low = -1.12 * depth;
    curves->high = fmin(fmax(high, 0.25 * depth), ABOVE * depth);
}

/* A trial above the axis is a small arrow at its upper edge. */
static void draw_trial(Paper *paper, const Plot *plot, double alpha,
                       double value, bool accepted)
{
    const double point[2] = {alpha, value};
    Colour colour = accepted ? COLOUR_ALPHA : COLOUR_WARNING;
    double at[2], unit = paper->unit;
    bool inside = value <= plot->y.high && value >= plot->y.low;
    plot_place(plot, alpha, inside ? value : plot->y.high, at);
    if (inside && accepted)
        plot_disc(paper, plot, point, 5.5, colour);
    else if (inside)
        canvas_ring(&paper->canvas, at[0], at[1], 4 * unit, 1.6 * unit, colour);
    else
        canvas_arrow(&paper->canvas, at[0], at[1] + 14 * unit, at[0], at[1],
                     1.6 * unit, 7 * unit, colour);
}

/* The last trial in words, at a place that does not move: where a curve that
 * falls at first is not. */
static void draw_verdict(Paper *paper, const Plot *plot, const Trace *trace,
                         double alpha, double value)
{
    char number[48], length[32];
    double y = plot->box.y + plot->box.height - 1.25 * paper->em;
    if (trace->slope > 0) /* other words stand there */
        y -= 1.2 * paper->em;
    plot_number(number, sizeof number, value);
    alpha_text(length, sizeof length, alpha);
    paper_write(
        paper, FACE_BOLD, 0.9, trace->accepted ? COLOUR_ALPHA : COLOUR_WARNING,
        plot->box.x + 0.5 * paper->em, y, ALIGN_LEFT, "{alpha} = %s %s: %s%s",
        length, trace->accepted ? "taken" : "refused", value > 0 ? "+" : "",
        number);
}

/* Where the curves are not: above 0 at the left; below it where they rise. */
static void draw_words(Paper *paper, const Plot *plot, const Trace *trace)
{
    double x = plot->box.x + 0.5 * paper->em, y = plot->box.y;
    bool uphill = trace->slope > 0;
    if (uphill)
        y += plot->box.height - 1.3 * paper->em;
    x += paper_write(paper, FACE_REGULAR, 0.85, COLOUR_X, x, y, ALIGN_LEFT,
                     "exact") +
         paper->em;
    x += paper_write(paper, FACE_REGULAR, 0.85, COLOUR_P, x, y, ALIGN_LEFT,
                     "quadratic model") +
         paper->em;
    if (uphill)
        paper_write(paper, FACE_BOLD, 0.85, COLOUR_WARNING, x, y, ALIGN_LEFT,
                    "{p} points uphill");
}

static void draw_curves(Paper *paper, Box inside, const Trace *trace)
{
    static const char *const alpha = "{alpha}";
    Curves curves;
    fill_curves(trace, &curves);
    Axis x = {0, curves.alpha[LINE_POINTS - 1], false, false, alpha};
    Axis y = {curves.low, curves.high, false, false, NULL};
    Plot plot = plot_create(paper, inside, x, y);
    double first = trace->first > 0 ? trace->first : 1;
    const double origin[2] = {0, 0};
    plot_curve(paper, &plot, LINE_POINTS, curves.alpha, curves.model, 1.3,
               COLOUR_P);
    plot_curve(paper, &plot, LINE_POINTS, curves.alpha, curves.exact, 2,
               COLOUR_X);
    plot_disc(paper, &plot, origin, 3.5, COLOUR_TEXT);
    draw_words(paper, &plot, trace);
    for (int t = 0; t < trace->trials; t++) {
        double end = ldexp(first, -t), at = end;
        bool last = t == trace->trials - 1;
        if (last &&
            trace->line == LINE_SEARCH) /* it hops from the one before */
            at += trace->rest * (t > 0 ? end : -end);
        draw_trial(paper, &plot, at, exact_value(trace, at),
                   last && trace->accepted);
        if (last)
            draw_verdict(paper, &plot, trace, end, exact_value(trace, end));
    }
}

static void draw_line(Paper *paper, Box inside, const Show *show)
{
    DescentTrace space;
    const Trace *trace = cards_trace(show, &space);
    if (trace && trace->difference && isfinite(trace->slope) &&
        trace->slope != 0) {
        draw_curves(paper, inside, trace);
        return;
    }
    paper_write(paper, FACE_REGULAR, 0.92, COLOUR_GREY,
                inside.x + 0.5 * inside.width,
                inside.y + 0.5 * inside.height - 0.7 * paper->em, ALIGN_CENTRE,
                trace && trace->passed && trace->line ? "no {p} was needed"
                : trace && trace->line ? "from line 4 on, where {p} is known"
                : show->step == 0      ? "N makes a step"
                                       : "no update was needed");
}

static const char *line_title(const Show *show)
{
    bool scalar =
        show->pane[show->active].simulation->descent.scalar.f.value != NULL;
    return scalar ? "f({x} + {alpha} {p}) \u2212 f({x})"
                  : "E({x} + {alpha} {p}) \u2212 E({x})   in J s\u00b2";
}

const Card card_line = {
    .name = "line",
    .title = "E along p",
    .titled = line_title,
    .least = 8,
    .weight = 1.2,
    .draw = draw_line,
};
