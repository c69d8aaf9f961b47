#include "picture/plot.h"

#include <math.h>
#include <stdio.h>

#include "picture/colour_map.h"

enum {
    PLOT_INTERVALS = 4,      /* between numbers, upwards */
    PLOT_MOST_INTERVALS = 8, /* to the right, where there is room */
    PLOT_TICK_LETTERS = 7,   /* room for a number to the right */
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
static double axis_step(const Axis *axis, double intervals)
{
    return plot_round_up((axis->high - axis->low) / intervals);
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
    double room = (double)box->width / (PLOT_TICK_LETTERS * paper->font.width);
    double step = axis_step(&plot->x, fmin(fmax(room, 2), PLOT_MOST_INTERVALS));
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
    double step = axis_step(&plot->y, PLOT_INTERVALS);
    int x = box->x - paper_pixels(paper, 3);
    for (double k = ceil(plot->y.low / step - 1e-9);
         k * step <= plot->y.high + 1e-9 * step; k++) {
        char number[PLOT_NUMBER_SIZE];
        double at[2];
        format_tick(number, k * step, step);
        plot_place(plot, plot->x.low, k * step, at);
        canvas_line(&paper->canvas, box->x, at[1], box->x + box->width, at[1],
                    fmax(1, 0.5 * paper->unit), COLOUR_GRID);
        paper_text(paper, x, (int)at[1] - paper_pixels(paper, 5), ALIGN_RIGHT,
                   COLOUR_FAINT, number);
    }
}

/* "energy in kJ over time in s", above the box. */
static void draw_plot_title(Paper *paper, const Plot *plot)
{
    char title[PLOT_TITLE_SIZE];
    snprintf(title, sizeof title, "%s over %s", plot->y.label, plot->x.label);
    paper_text(paper, plot->box.x,
               plot->box.y - paper->font.height - paper_pixels(paper, 2),
               ALIGN_LEFT, COLOUR_TEXT, title);
}

/* Room for the title above and for the numbers on the left and below. */
Box plot_inner_box(const Paper *paper, Box outer)
{
    int letter = paper->font.width, line = paper->font.height;
    int gap = paper_pixels(paper, 4);
    Box box = {outer.x + PLOT_NUMBER_LETTERS * letter + gap,
               outer.y + line + gap, 0, 0};
    box.width = outer.x + outer.width - 2 * letter - box.x;
    box.height = outer.y + outer.height - line - gap - box.y;
    return box;
}

/* The grid first. */
Plot plot_create(Paper *paper, Box outer, Axis x, Axis y)
{
    Plot plot = {plot_inner_box(paper, outer), x, y};
    paper_panel(paper, outer);
    draw_x_axis(paper, &plot);
    draw_y_axis(paper, &plot);
    draw_plot_title(paper, &plot);
    return plot;
}

/* Cuts the part of a ... b off that is beyond low ... high in coordinate k;
 * false: nothing is left. */
static bool cut_line(double a[2], double b[2], int k, double low, double high)
{
    double *ends[2] = {a, b};
    if ((a[k] < low && b[k] < low) || (a[k] > high && b[k] > high))
        return false;
    for (int i = 0; i < 2; i++) {
        double *end = ends[i], *other = ends[1 - i];
        double limit = fmin(fmax(end[k], low), high);
        if (end[k] == limit)
            continue;
        double t = (limit - end[k]) / (other[k] - end[k]);
        end[1 - k] += t * (other[1 - k] - end[1 - k]);
        end[k] = limit;
    }
    return true;
}

/* Cut in both directions; NaN draws nothing. */
void plot_line(Paper *paper, const Plot *plot, const double *a, const double *b,
               double width, Colour colour)
{
    const Axis *x = &plot->x, *y = &plot->y;
    double from[2] = {a[0], a[1]}, to[2] = {b[0], b[1]}, p[2], q[2];
    if (!cut_line(from, to, 0, x->low, x->high) ||
        !cut_line(from, to, 1, y->low, y->high))
        return;
    plot_place(plot, from[0], from[1], p);
    plot_place(plot, to[0], to[1], q);
    canvas_line(&paper->canvas, p[0], p[1], q[0], q[1],
                fmax(1, width * paper->unit), colour);
}

/* By its centre. */
bool plot_disc(Paper *paper, const Plot *plot, const double *a, double radius,
               Colour colour)
{
    double at[2];
    if (!(a[0] >= plot->x.low && a[0] <= plot->x.high && a[1] >= plot->y.low &&
          a[1] <= plot->y.high))
        return false;
    plot_place(plot, a[0], a[1], at);
    canvas_disc(&paper->canvas, at[0], at[1], radius * paper->unit, colour);
    return true;
}

/* Line by line. */
void plot_curve(Paper *paper, const Plot *plot, int count, const double *x,
                const double *y, Colour colour)
{
    for (int i = 1; i < count; i++) {
        const double from[2] = {x[i - 1], y[i - 1]}, to[2] = {x[i], y[i]};
        plot_line(paper, plot, from, to, 1.3, colour);
    }
}
