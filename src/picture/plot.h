/* plot.h - curves over axes with numbers, linear or logarithmic.
 */
#ifndef ELASTO_PLOT_H
#define ELASTO_PLOT_H

#include "picture/paper.h"

typedef struct Axis {
    double low, high;  /* high > low; > 0 where it is logarithmic */
    bool log;          /* numbers at powers of ten */
    bool whole;        /* numbers are whole ones */
    const char *label; /* markup, or NULL: below the right end of the axis;
                          that of y in the upper right corner */
} Axis;

typedef struct Plot {
    Box box; /* the inner area, inside the numbers */
    Axis x, y;
} Plot;

/* The smallest 1, 2, 5 times a power of ten that is not below value > 0. */
double plot_round_up(double value);

/* The smallest end of an axis from 0 that is not below value > 0 and carries
 * a number. */
double plot_round_axis(double value);

/* Numbers on the left and below, light lines across. */
Plot plot_create(Paper *paper, Box outer, Axis x, Axis y);

/* The same for a plot whose box is known. */
void plot_axes(Paper *paper, const Plot *plot);

/* Where a point is drawn, pixels; not finite where it has no place. */
void plot_place(const Plot *plot, double x, double y, double place[2]);

/* A line and a disc, as far as they are inside the axes.
 *   a, b           [2] in, in the units of the axes
 *   width, radius  units of the paper
 * The disc is left out where its centre is outside; returns whether it is
 * inside. */
void plot_line(Paper *paper, const Plot *plot, const double *a, const double *b,
               double width, Colour colour);
bool plot_disc(Paper *paper, const Plot *plot, const double *a, double radius,
               Colour colour);

/* A ring: a disc with a white one inside. */
void plot_hollow(Paper *paper, const Plot *plot, const double *a, double radius,
                 double inner, Colour colour);

/* Joins the points by lines, or as one curve whose joints are no paler than the
 * rest.  x, y [count] in. */
static inline void plot_lines(Paper *paper, const Plot *plot, int count,
                              const double *x, const double *y, double width,
                              Colour colour)
{
    for (int i = 1; i < count; i++)
        plot_line(paper, plot, (double[2]){x[i - 1], y[i - 1]},
                  (double[2]){x[i], y[i]}, width, colour);
}

void plot_curve(Paper *paper, const Plot *plot, int count, const double *x,
                const double *y, double width, Colour colour);

/* "1e5" as people write it: 100000, 2.5e7, 0.003; in markup with a
 * superscript where it needs a power.  text [size] out. */
void plot_number(char *text, size_t size, double value);

/* The numbers in a text that printf made, written as people do: "1.5e-06" is
 * 1.5 x 10^{-6}, and a minus is no hyphen.  text [size] in, markup out. */
void plot_numbers(char *text, size_t size);

#endif
