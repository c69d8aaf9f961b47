/* plot.h - curves over axes with numbers and units.
 */
#ifndef ELASTO_PLOT_H
#define ELASTO_PLOT_H

#include "picture/paper.h"

typedef struct Axis {
    double low, high;  /* high > low */
    const char *label; /* quantity and unit: "time in s" */
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

/* What is left of the outer box without the numbers and the labels. */
Box plot_inner_box(const Paper *paper, Box outer);

/* Panel, grid, numbers and labels inside the outer box. */
Plot plot_create(Paper *paper, Box outer, Axis x, Axis y);

/* Where a point is drawn, pixels. */
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

/* Joins the points.  x, y [count] in. */
void plot_curve(Paper *paper, const Plot *plot, int count, const double *x,
                const double *y, Colour colour);

#endif
