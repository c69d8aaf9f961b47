/* plot.h - curves over axes with numbers and units.
 */
#ifndef ELASTO_PLOT_H
#define ELASTO_PLOT_H

#include "paper.h"

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

/* Panel, grid, numbers and labels inside the outer box. */
Plot plot_create(Paper *paper, Box outer, Axis x, Axis y);

/* Where a point is drawn, pixels. */
void plot_place(const Plot *plot, double x, double y, double place[2]);

/* Joins the points.  x, y [count] in. */
void plot_curve(Paper *paper, const Plot *plot, int count, const double *x,
                const double *y, Colour colour);

#endif
