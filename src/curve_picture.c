#include "curve_picture.h"

#include <math.h>
#include <stdio.h>

#include "colour_map.h"
#include "plot.h"
#include "text_block.h"

enum { CURVE_POINTS = 400, CURVE_TOP = 96, CURVE_BOTTOM = 70 };

static const double CURVE_REACH = 14; /* x from -14 to 14 */

/* The model of f at x0: f + f' (x - x0) + f'' (x - x0)^2 / 2 */
typedef struct QuadraticModel {
    double x0, f, first, second;
} QuadraticModel;

/* At x0. */
static QuadraticModel model_at(const ScalarFunction *f, double x0)
{
    return (QuadraticModel){x0, f->value(x0), f->first(x0), f->second(x0)};
}

/* Draws f (model NULL) or the model over the whole axis. */
static void draw_function(Paper *paper, const Plot *plot,
                          const ScalarFunction *f, const QuadraticModel *model,
                          Colour colour)
{
    double from[2] = {0, 0}, to[2];
    for (int i = 0; i <= CURVE_POINTS; i++) {
        double x = CURVE_REACH * (2.0 * i / CURVE_POINTS - 1);
        double y = f->value(x);
        if (model) {
            double d = x - model->x0;
            y = model->f + d * (model->first + 0.5 * d * model->second);
        }
        plot_place(plot, x, y, to);
        bool inside = y >= plot->y.low && y <= plot->y.high;
        if (i > 0 && inside)
            canvas_line(&paper->canvas, from[0], from[1], to[0], to[1],
                        fmax(1, 1.3 * paper->unit), colour);
        from[0] = to[0];
        from[1] = to[1];
    }
}

/* A disc on the curve with the number of the iterate. */
static void draw_iterate(Paper *paper, const Plot *plot,
                         const ScalarFunction *f, double x, int number,
                         Colour colour)
{
    double at[2];
    char text[16];
    if (!(fabs(x) <= CURVE_REACH))
        return;
    plot_place(plot, x, f->value(x), at);
    canvas_disc(&paper->canvas, at[0], at[1], 3.5 * paper->unit, colour);
    snprintf(text, sizeof text, "%d", number);
    if (paper_shows_text(paper))
        paper_text(paper, (int)at[0], (int)at[1] + paper_pixels(paper, 5),
                   ALIGN_CENTRE, colour, text);
}

/* What is drawn, in words. */
static void draw_curve_legend(Paper *paper, double x, int count)
{
    TextBlock block = {0};
    text_block_add(&block, COLOUR_COMPRESS, "f(x) = ln(exp(x) + exp(-x))");
    text_block_add(&block, COLOUR_STRETCH, "its quadratic model at the disc");
    text_block_add(&block, COLOUR_TEXT, "x %d = %.6g%s", count, x,
                   fabs(x) > CURVE_REACH ? "  (off the picture)" : "");
    Box size = text_block_size(&block, paper);
    int edge = paper_pixels(paper, 5);
    text_block_draw(&block, paper, edge,
                    paper->canvas.height - edge - size.height, ALIGN_LEFT);
}

/* f, model, iterates. */
void curve_picture_draw(Paper *paper, const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    const ScalarFunction *f = &descent->scalar.f;
    int top = paper_pixels(paper, CURVE_TOP), edge = paper_pixels(paper, 5);
    Box box = {edge, top, paper->canvas.width - 2 * edge,
               paper->canvas.height - top - paper_pixels(paper, CURVE_BOTTOM)};
    if (box.width < 1 || box.height < paper_pixels(paper, 50))
        return;
    Plot plot = plot_create(paper, box, (Axis){-CURVE_REACH, CURVE_REACH, "x"},
                            (Axis){0, CURVE_REACH, "f"});
    int count = descent->count;
    double x0 =
        count > 0 ? descent->record[count - 1].from[0] : descent->scalar.x;
    QuadraticModel model = model_at(f, x0);
    draw_function(paper, &plot, f, NULL, COLOUR_COMPRESS);
    draw_function(paper, &plot, f, &model, COLOUR_STRETCH);
    for (int i = 0; i < count; i++)
        draw_iterate(paper, &plot, f, descent->record[i].from[0], i,
                     i == count - 1 ? COLOUR_STRETCH : COLOUR_FAINT);
    draw_iterate(paper, &plot, f, descent->scalar.x, count, COLOUR_TEXT);
    if (paper_shows_text(paper))
        draw_curve_legend(paper, descent->scalar.x, count);
}
