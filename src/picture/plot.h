/* plot.h - drawing in metres, or in the units of two axes.
 *
 * The stage of a pane is a plot whose axes have no numbers: both in metres, of
 * one scale unless the picture is stretched; the inside of a card is one, too,
 * before it has axes.  So there is one line, one disc, one arrow, one word for
 * all pictures and cards, and each knows what it is of.  Points are [2] in the
 * units of the axes; widths and radii in units of the paper, other sizes in
 * ems. Where there are axes, lines and arrows are cut at their box, discs and
 * rings whose centre is beyond it are left out; a stage is cut by its canvas.
 */
#ifndef ELASTO_PLOT_H
#define ELASTO_PLOT_H

#include "base/mathematics.h"
#include "picture/paper.h"
#include "picture/show.h"

typedef struct Axis {
    double low, high;  /* high > low; > 0 where it is logarithmic */
    bool log;          /* numbers at powers of ten */
    bool whole;        /* numbers are whole ones */
    const char *label; /* markup, or NULL: below the right end of the axis;
                          that of y in the upper right corner */
} Axis;

typedef struct Plot {
    Paper *paper; /* NULL: it only tells where things are */
    const Show *show;
    const Simulation *simulation; /* of the pane; of a card the active one's */
    bool told;                    /* a page whose answer is shown */
    Box box;                      /* pixels; inside the numbers of the axes */
    Camera camera; /* of the logarithm, where an axis is logarithmic */
    Axis x, y;     /* 0 ... 0: a stage in metres */
    int pane;      /* index in the show */
    bool text;     /* there is room for words */
    double em;     /* pixels */
    int flow[2];   /* pixels, where the next words of the legend go */
} Plot;

/* A point or a way, by value: plot_line(plot, a, along(a, t, d).at, ...) */
typedef struct Point {
    double at[2];
} Point;

/* a + t d; from a to b. */
static inline Point along(const double *a, double t, const double *d)
{
    return (Point){{a[0] + t * d[0], a[1] + t * d[1]}};
}

static inline Point way(const double *a, const double *b)
{
    return along(b, -1, a);
}

/* How far they are from each other; how long d is. */
static inline double apart(const double *a, const double *b)
{
    return math_hypot(b[0] - a[0], b[1] - a[1]);
}

static inline double length_of(const double *d)
{
    return math_hypot(d[0], d[1]);
}

/* The smallest 1, 2, 5 times a power of ten that is not below value > 0; the
 * smallest end of an axis from 0 that carries a number. */
double plot_round_up(double value);
double plot_round_axis(double value);

/* Axes in a card, with numbers on the left and below, light lines across. */
Plot plot_create(const Plot *card, Axis x, Axis y);

/* Axes over a stage, drawn where there is room for words: what its camera sees
 * of x and y, the powers of ten of a logarithmic one; where y.high is not 0,
 * its own range.
 */
Plot plot_on(const Plot *stage, Axis x, Axis y);

/* Where a point is drawn, pixels; not finite where it has no place. */
void plot_place(const Plot *plot, const double *at, double pixel[2]);

/* Picks, as this kind, the one of the points [count][2] that is nearest to
 * pixel (x, y), of several the last one; false: none is within reach, pixels.
 */
bool plot_pick(const Plot *plot, int count, const double *at, double reach,
               double x, double y, PickKind kind, Pick *pick);

/* A square view around the middle, of at least so many metres, in which `most`
 * fits; it grows by this factor, so that it does not move all the time. */
void bounds_around(double reach, double most, double factor, double bounds[4]);

/* ---- shapes: dashes have a phase as in canvas.h, NULL: begins -------------
 */

void plot_line(const Plot *plot, const double *a, const double *b, double width,
               Colour colour);
void plot_dashes(const Plot *plot, const double *a, const double *b,
                 double width, double *phase, Colour colour);

/* middle + a cos t + b sin t. */
void plot_ellipse(const Plot *plot, const double *middle, const double *a,
                  const double *b, double width, bool dashed, Colour colour);

/* All springs of a system that are whole, at x [2n]. */
void plot_springs(const Plot *plot, const System *system, const double *x,
                  double width, Colour colour);

/* Four corners, with no seam to its neighbours. */
void plot_face(const Plot *plot, const double *const corner[4], Colour colour);

/* Points x, y [count] joined; y(x) over the whole axis. */
void plot_curve(const Plot *plot, int count, const double *x, const double *y,
                double width, Colour colour);
void plot_graph(const Plot *plot, double (*y)(const void *data, double x),
                const void *data, double width, Colour colour);

/* The disc returns whether its centre is inside; hollow: one with a white disc
 * inside. */
bool plot_disc(const Plot *plot, const double *at, double radius,
               Colour colour);
void plot_hollow(const Plot *plot, const double *at, double radius,
                 double inner, Colour colour);
void plot_ring(const Plot *plot, const double *at, double radius, double width,
               Colour colour);

/* A node that never moves. */
void plot_pin(const Plot *plot, const double *at, double radius);

/* From a to a + factor d. */
void plot_arrow(const Plot *plot, const double *a, const double *d,
                double factor, double width, Colour colour);

/* ---- words (words.c) ---------------------------------------------------- */

/* They are made as printf does, and only where there is room for words. */

/* Words in colours from the upper left corner to the right, on a second line
 * if there is no room. */
void plot_legend(Plot *plot, Colour colour, const char *format, ...);

/* Lower left: a line as long as so many metres. */
void plot_scale(const Plot *plot);

/* What a place costs: more, the more of it has ink or is outside of the plot.
 */
double plot_cost(const Plot *plot, Box place);

/* In bold beside one of these points, off what has been drawn, which is found
 * by its pixels, on a ground of thin white.
 *   at  [points][2] in; the first ones are preferred */
void plot_words(const Plot *plot, int points, const double *at, Colour colour,
                const char *format, ...);

/* "1e5" as people write it, with so many digits, or three: 100000, 2.5e7,
 * 0.003; in markup with a superscript where it needs a power. */
typedef struct Number {
    char text[48];
} Number;
Number number_with(double value, int digits);
Number number_of(double value);

/* ---- stages (show.c) ---------------------------------------------------- */

/* The stage of a pane; paper NULL: it only tells where things are. */
Plot show_stage(Paper *paper, const Show *show, const Layout *layout, int pane);

/* Open rings where the scene's handles are, which the mouse can drag. */
void stage_handles(const Plot *stage);

#endif
