#include "plot.h"

#include <math.h>
#include <stdio.h>

#include "colour_map.h"

enum {
    PLOT_INTERVALS = 4,
    PLOT_NUMBER_SIZE = 32,
    PLOT_TITLE_SIZE = 96,
    PLOT_NUMBER_LETTERS = 5 /* room on the left */
};

/* 10^k below value, times 1, 2, 5 or 10. */
double plot_round_up(double value)
{
    double power = pow(10, floor(log10(value)));
    double part = value / power * (1 - 1e-12);
    return power * (part <= 1 ? 1 : part <= 2 ? 2 : part <= 5 ? 5 : 10);
}

/* The smallest multiple of the distance of its numbers. */
double plot_round_axis(double value)
{
    double step = plot_round_up(value / PLOT_INTERVALS);
    return step * ceil(value / step * (1 - 1e-12));
}

/* Distance of the numbers on an axis. */
static double axis_step(const Axis *axis)
{
    return plot_round_up((axis->high - axis->low) / PLOT_INTERVALS);
}

/* Linear in both directions. */
void plot_place(const Plot *plot, double x, double y, double place[2])
{
    double a = (x - plot->x.low) / (plot->x.high - plot->x.low);
    double b = (y - plot->y.low) / (plot->y.high - plot->y.low);
    place[0] = plot->box.x + a * plot->box.width;
    place[1] = plot->box.y + (1 - b) * plot->box.height;
}

/* Number k of an axis with this step; rounding must not show as 1e-17. */
static void format_tick(char *text, double value, double step)
{
    double clean = fabs(value) < 1e-9 * step ? 0 : value;
    snprintf(text, PLOT_NUMBER_SIZE, "%.4g", clean);
}

/* Vertical grid lines with their numbers below. */
static void draw_x_axis(Paper *paper, const Plot *plot)
{
    const Box *box = &plot->box;
    double step = axis_step(&plot->x);
    int y = box->y + box->height + paper_pixels(paper, 3);
    for (double k = ceil(plot->x.low / step - 1e-9);
         k * step <= plot->x.high + 1e-9 * step; k++) {
        char number[PLOT_NUMBER_SIZE];
        double at[2];
        format_tick(number, k * step, step);
        plot_place(plot, k * step, plot->y.low, at);
        canvas_line(&paper->canvas, at[0], box->y, at[0], box->y + box->height,
                    fmax(1, 0.5 * paper->unit), COLOUR_GRID);
        paper_text(paper, (int)at[0], y, ALIGN_CENTRE, COLOUR_FAINT, number);
    }
}

/* Horizontal grid lines with their numbers on the left. */
static void draw_y_axis(Paper *paper, const Plot *plot)
{
    const Box *box = &plot->box;
    double step = axis_step(&plot->y);
    int x = box->x - paper_pixels(paper, 3);
    for (double k = ceil(plot->y.low / step - 1e-9);
         k * step <= plot->y.high + 1e-9 * step; k++) {
        char number[PLOT_NUMBER_SIZE];
        double at[2];
        format_tick(number, k * step, step);
        plot_place(plot, plot->x.low, k * step, at);
        canvas_line(&paper->canvas, box->x, at[1], box->x + box->width, at[1],
                    fmax(1, 0.5 * paper->unit), COLOUR_GRID);
        paper_text(paper, x, (int)at[1] - paper_pixels(paper, 4), ALIGN_RIGHT,
                   COLOUR_FAINT, number);
    }
}

/* "energy in kJ over time in s", above the box. */
static void draw_plot_title(Paper *paper, const Plot *plot)
{
    char title[PLOT_TITLE_SIZE];
    snprintf(title, sizeof title, "%s over %s", plot->y.label, plot->x.label);
    paper_text(paper, plot->box.x, plot->box.y - paper->font.height - 1,
               ALIGN_LEFT, COLOUR_TEXT, title);
}

/* Leaves room for the numbers on the left and below. */
Plot plot_create(Paper *paper, Box outer, Axis x, Axis y)
{
    int letter = paper->font.width, line = paper->font.height;
    int gap = paper_pixels(paper, 4);
    Plot plot = {.x = x, .y = y};
    plot.box.x = outer.x + PLOT_NUMBER_LETTERS * letter + gap;
    plot.box.y = outer.y + line + gap;
    plot.box.width = outer.x + outer.width - 2 * letter - plot.box.x;
    plot.box.height = outer.y + outer.height - line - gap - plot.box.y;
    paper_panel(paper, outer);
    draw_x_axis(paper, &plot);
    draw_y_axis(paper, &plot);
    draw_plot_title(paper, &plot);
    return plot;
}

/* Line by line. */
void plot_curve(Paper *paper, const Plot *plot, int count, const double *x,
                const double *y, Colour colour)
{
    double width = fmax(1, paper->unit);
    for (int i = 1; i < count; i++) {
        double from[2], to[2];
        plot_place(plot, x[i - 1], y[i - 1], from);
        plot_place(plot, x[i], y[i], to);
        canvas_line(&paper->canvas, from[0], from[1], to[0], to[1], width,
                    colour);
    }
}
