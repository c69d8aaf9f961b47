#include "picture/curve_picture.h"

#include <math.h>
#include <stdio.h>

#include "picture/colour_map.h"
#include "picture/panels.h"
#include "picture/plot.h"

enum { CURVE_POINTS = 400, CURVE_LABEL_ROOM = 11 /* units */ };

static const double CURVE_REACH = 14; /* x from -14 to 14 */
static const double CURVE_LOW = -6;   /* f from here: minima of models ... */
static const double CURVE_HIGH = 14;  /* ... to here */

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
    update.f = scalar_value(&scalar->f, update.x0);
    update.first = scalar_first(&scalar->f, update.x0);
    update.second = scalar_second(&scalar->f, update.x0);
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
                          Colour colour)
{
    double from[2] = {0, 0};
    for (int i = 0; i <= CURVE_POINTS; i++) {
        double x = CURVE_REACH * (2.0 * i / CURVE_POINTS - 1);
        const double to[2] = {x, model ? model_value(model, x) : scalar_value(f, x)};
        if (i > 0)
            plot_line(paper, plot, from, to, 1.5, colour);
        from[0] = to[0];
        from[1] = to[1];
    }
}

/* From the minimum of the model up to f there, where the full step leads. */
static void draw_model_minimum(Paper *paper, const Plot *plot,
                               const ScalarFunction *f,
                               const ModelUpdate *model, bool text)
{
    double x1 = model->x0 + model->p, at[2];
    const double low[2] = {x1, model_value(model, x1)};
    const double high[2] = {x1, scalar_value(f, x1)};
    bool right = x1 > CURVE_REACH;
    char words[64];
    if (plot_disc(paper, plot, low, 4, COLOUR_STRETCH))
        plot_disc(paper, plot, low, 2.4, COLOUR_WHITE);
    plot_line(paper, plot, low, high, 0.8, COLOUR_STRETCH);
    if (!text || !isfinite(x1) || fabs(x1) <= CURVE_REACH)
        return;
    snprintf(words, sizeof words, "%sto x = %.3g%s", right ? "" : "<- ", x1,
             right ? " ->" : "");
    plot_place(plot, right ? CURVE_REACH : -CURVE_REACH, 0.5 * CURVE_LOW, at);
    paper_bold_text(paper, (int)at[0], (int)at[1],
                    right ? ALIGN_RIGHT : ALIGN_LEFT, COLOUR_STRETCH, words);
}

/* Small discs where the line search looked and went on. */
static void draw_refused(Paper *paper, const Plot *plot,
                         const ScalarFunction *f, const ModelUpdate *update)
{
    double alpha = 1;
    for (int i = 0; i < update->refused; i++, alpha *= 0.5) {
        double x = update->x0 + alpha * update->p;
        const double at[2] = {x, scalar_value(f, x)};
        plot_disc(paper, plot, at, 3, COLOUR_CONTOUR);
    }
}

/* "x2", below the disc or above it in turn, unless there is one already.
 *   used  [2] pixels, in/out: where the last one below and above is */
static void label_iterate(Paper *paper, const double at[2], int number,
                          double used[2], Colour colour)
{
    char text[16];
    int above = number % 2;
    double gap = paper_pixels(paper, CURVE_LABEL_ROOM);
    if (fabs(at[0] - used[above]) < 1.5 * gap)
        return;
    used[above] = at[0];
    snprintf(text, sizeof text, "x%d", number);
    paper_bold_text(paper, (int)at[0],
                    (int)(above ? at[1] - 0.6 * gap - paper->font.height
                                : at[1] + 0.6 * gap),
                    ALIGN_CENTRE, colour, text);
}

/* Discs on the curve; the last one is black. */
static void draw_iterates(Paper *paper, const Plot *plot,
                          const Descent *descent, bool text)
{
    double used[2] = {-1e9, -1e9};
    for (int i = 0; i <= descent->count; i++) {
        bool last = i == descent->count;
        double x = last ? descent->scalar.x : descent->record[i].from[0];
        const double point[2] = {x, scalar_value(&descent->scalar.f, x)};
        Colour colour = last ? COLOUR_TEXT : COLOUR_COMPRESS;
        double at[2];
        plot_place(plot, point[0], point[1], at);
        if (plot_disc(paper, plot, point, 4, colour) && text)
            label_iterate(paper, at, i, used, colour);
    }
}

/* What is drawn, in words. */
static void draw_curve_legend(Paper *paper, const ModelUpdate *update)
{
    TextBlock columns[2] = {0};
    text_block_add(&columns[0], COLOUR_COMPRESS, "f(x) = ln(exp(x) + exp(-x))");
    text_block_add(&columns[0], COLOUR_STRETCH, "quadratic model of f at x%d",
                   update->number);
    text_block_add(&columns[1], COLOUR_TEXT, "black disc: present iterate");
    text_block_add(&columns[1], COLOUR_FAINT, "grey discs: lengths refused");
    panels_draw_columns(paper, columns, 2);
}

/* f, model, iterates, words. */
void curve_picture_draw(Paper *paper, const Simulation *simulation, bool text)
{
    const Descent *descent = &simulation->descent;
    const ScalarFunction *f = &descent->scalar.f;
    const Axis x = {-CURVE_REACH, CURVE_REACH, "x"};
    const Axis y = {CURVE_LOW, CURVE_HIGH, "f(x)"};
    Box whole = {0, 0, paper->canvas.width, paper->canvas.height};
    Box middle = panels_middle_box(paper),
        inner = plot_inner_box(paper, middle);
    Plot plot = {whole, x, y};
    if (text && (inner.width < 1 || inner.height < 1))
        return;
    if (text)
        plot = plot_create(paper, middle, x, y);
    ModelUpdate update = last_update(descent);
    draw_function(paper, &plot, f, NULL, COLOUR_COMPRESS);
    draw_function(paper, &plot, f, &update, COLOUR_STRETCH);
    draw_model_minimum(paper, &plot, f, &update, text);
    draw_refused(paper, &plot, f, &update);
    draw_iterates(paper, &plot, descent, text);
    if (!text)
        return;
    panels_draw_update(paper, simulation);
    draw_curve_legend(paper, &update);
}
