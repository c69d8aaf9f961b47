#include <math.h>
#include <stdio.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/kinds.h"
#include "picture/marks.h"

enum { CURVE_POINTS = 400 };

static const double CURVE_REACH = 14; /* x from -14 to 14 */
static const double CURVE_LOW = -6;   /* f from here: minima of models ... */
static const double CURVE_HIGH = 14;  /* ... to here */
static const double LABEL_ROOM = 1.5; /* ems */

static void curve_bounds(const Show *show, int pane, double bounds[4])
{
    (void)show;
    (void)pane;
    bounds[0] = -1.08 * CURVE_REACH;
    bounds[1] = 1.25 * CURVE_LOW;
    bounds[2] = 1.05 * CURVE_REACH;
    bounds[3] = 1.1 * CURVE_HIGH;
}

/* An update and the model that it came from:
 * q(x) = f + f' (x - x0) + f'' (x - x0)^2 / 2 at x0, least at x0 + p. */
typedef struct ModelUpdate {
    double x0, f, first, second, p;
    double alpha; /* 0: not made yet, or refused */
    int refused;  /* lengths 1, 1/2, ... that the line search did not take */
    int number;   /* of the iterate x0 */
} ModelUpdate;

/* The last update, or the first one that is to come. */
static ModelUpdate last_update(const Descent *descent)
{
    const ScalarNewton *scalar = &descent->scalar;
    ModelUpdate update = {.x0 = scalar->x, .p = scalar->p};
    if (descent->count > 0) {
        const NewtonRecord *record = &descent->record[descent->count - 1];
        update.x0 = record->from[0];
        update.alpha = record->alpha;
        update.refused = record->trials - (record->alpha > 0);
        update.number = descent->count - 1;
        if (record->alpha > 0)
            update.p = (record->to[0] - record->from[0]) / record->alpha;
    }
    update.f = scalar_at(&scalar->f, update.x0).value;
    update.first = scalar_at(&scalar->f, update.x0).first;
    update.second = scalar_at(&scalar->f, update.x0).second;
    return update;
}

/* Height of the model. */
static double model_value(const ModelUpdate *model, double x)
{
    double d = x - model->x0;
    return model->f + d * (model->first + 0.5 * d * model->second);
}

/* f (model NULL) or the model over the whole axis. */
static void draw_function(Paper *paper, const Plot *plot,
                          const ScalarFunction *f, const ModelUpdate *model,
                          double width, Colour colour)
{
    double x[CURVE_POINTS + 1], y[CURVE_POINTS + 1], low = plot->x.low;
    for (int i = 0; i <= CURVE_POINTS; i++) {
        x[i] = low + (plot->x.high - low) * i / CURVE_POINTS;
        y[i] = model ? model_value(model, x[i]) : scalar_at(f, x[i]).value;
    }
    plot_curve(paper, plot, CURVE_POINTS + 1, x, y, width, colour);
}

/* From the minimum of the model up to f there, where the full step leads. */
static void draw_model_minimum(Paper *paper, const Plot *plot,
                               const ScalarFunction *f,
                               const ModelUpdate *model, bool text)
{
    double x1 = model->x0 + model->p, at[2];
    const double low[2] = {x1, model_value(model, x1)};
    const double high[2] = {x1, scalar_at(f, x1).value};
    bool right = x1 > plot->x.high;
    char number[48];
    if (plot_disc(paper, plot, low, 6, COLOUR_P))
        plot_disc(paper, plot, low, 3.6, COLOUR_WHITE);
    plot_line(paper, plot, low, high, 1.2, COLOUR_P);
    if (!text || !isfinite(x1) || (x1 >= plot->x.low && !right))
        return;
    plot_number(number, sizeof number, x1);
    plot_place(plot, right ? plot->x.high : plot->x.low,
               0.5 * (plot->y.low + 0), at);
    paper_write(paper, FACE_BOLD, 1, COLOUR_P, at[0], at[1],
                right ? ALIGN_RIGHT : ALIGN_LEFT, "%sto x = %s%s",
                right ? "" : "\u2190 ", number, right ? " \u2192" : "");
}

/* Rings where the line search looked and went on. */
static void draw_refused(Paper *paper, const Plot *plot,
                         const ScalarFunction *f, const ModelUpdate *update)
{
    double alpha = 1;
    for (int i = 0; i < update->refused; i++, alpha *= 0.5) {
        double x = update->x0 + alpha * update->p;
        const double at[2] = {x, scalar_at(f, x).value};
        if (plot_disc(paper, plot, at, 5, COLOUR_WARNING))
            plot_disc(paper, plot, at, 3.2, COLOUR_WHITE);
    }
}

/* x with its number, below the disc or above it in turn, unless there is one
 * already.
 *   used  [2] pixels, in/out: where the last one below and above is */
static void label_iterate(Paper *paper, const double at[2], int number,
                          double used[2], Colour colour)
{
    int above = number % 2;
    double gap = LABEL_ROOM * paper->em;
    if (fabs(at[0] - used[above]) < gap)
        return;
    used[above] = at[0];
    paper_write(paper, FACE_BOLD, 1, colour, at[0],
                above ? at[1] - 1.25 * gap : at[1] + 0.6 * gap, ALIGN_CENTRE,
                "x^{%d}", number);
}

/* Discs on the curve; the last one is black. */
static void draw_iterates(Paper *paper, const Plot *plot,
                          const Descent *descent, bool text)
{
    double used[2] = {-1e9, -1e9};
    for (int i = 0; i <= descent->count; i++) {
        bool last = i == descent->count;
        double x = last ? descent->scalar.x : descent->record[i].from[0];
        const double point[2] = {x, scalar_at(&descent->scalar.f, x).value};
        Colour colour = last ? COLOUR_TEXT : COLOUR_X;
        double at[2];
        plot_place(plot, point[0], point[1], at);
        if (plot_disc(paper, plot, point, last ? 7 : 5.5, colour) && text)
            label_iterate(paper, at, i, used, colour);
    }
}

/* f, model, iterates, words. */
static void curve_draw(Paper *paper, const Stage *stage, const Show *show)
{
    const Descent *descent = &show->pane[stage->pane].simulation->descent;
    const ScalarFunction *f = &descent->scalar.f;
    ModelUpdate update = last_update(descent);
    Legend legend = {0, 0};
    Plot plot = stage_plot(paper, stage, "x", NULL);
    draw_function(paper, &plot, f, NULL, 2.4, COLOUR_X);
    draw_function(paper, &plot, f, &update, 1.6, COLOUR_P);
    draw_model_minimum(paper, &plot, f, &update, stage->text);
    draw_refused(paper, &plot, f, &update);
    draw_iterates(paper, &plot, descent, stage->text);
    if (show->bare || !stage->text)
        return;
    stage_legend(paper, stage, &legend, COLOUR_X,
                 "f(x) = ln(e^{x} + e^{\u2212x})");
    stage_legend(paper, stage, &legend, COLOUR_P, "quadratic model at x^{%d}",
                 update.number);
    if (update.refused > 0)
        stage_legend(paper, stage, &legend, COLOUR_WARNING, "refused lengths");
}

/* The present iterate, which is dragged along the curve. */
static Pick curve_pick(const Show *show, const Stage *stage, double x, double y)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    Pick pick = {PICK_PLACE, stage->pane, 0, {0, 0}};
    double at[2];
    camera_world(&stage->camera, x, y, pick.point);
    stage_pixel(stage, simulation->run[0].x, at);
    if (hypot(at[0] - x, at[1] - y) < 14)
        pick.kind = PICK_START;
    return pick;
}

static const Card *const curve_cards[] = {&card_page, &card_listing, &card_line,
                                          &card_residual, NULL};

const Picture curve_picture = {
    .name = "curve",
    .cards = curve_cards,
    .stretched = true,
    .bounds = curve_bounds,
    .draw = curve_draw,
    .pick = curve_pick,
};
