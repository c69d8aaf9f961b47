/* plot.h - drawing in metres, or in the units of two axes.
 *
 * A Plot is a box of the paper with a camera.  The stage of a pane is a plot in
 * metres without axes; its x and y have one scale unless the picture is
 * stretched.  The inside of a card is a plot, too, and plot_create gives it
 * axes. Thus all pictures and cards share the same functions for lines, discs,
 * arrows and labels.
 *
 * Points are [2] in the units of the axes, widths and radii in units of the
 * paper, other sizes in ems.  In a plot with axes, lines and arrows are clipped
 * at the box, and discs and rings whose centre lies outside are left out.  A
 * stage is clipped by its canvas.
 */
#ifndef ELASTO_PLOT_H
#define ELASTO_PLOT_H

#include "base/mathematics.h"
#include "picture/paper.h"
#include "picture/frame_content.h"

typedef struct Axis {
    double low, high;  /* high > low; both > 0 on a logarithmic axis */
    bool log;          /* is logarithmic: numbers stand at powers of ten */
    bool whole;        /* shows whole numbers only */
    const char *label; /* markup, or NULL.  x: below the right end of the axis,
                          y: in the upper right corner */
} Axis;

typedef struct Plot {
    Paper *paper; /* NULL: the plot only computes positions */
    const FrameContent *content;
    const Simulation
        *simulation;  /* of the pane; in a card, of the active pane */
    bool revealed;    /* is on a page whose answer is shown */
    Box box;          /* pixels; without the numbers of the axes */
    Camera camera;    /* maps the logarithm where an axis is logarithmic */
    Axis x, y;        /* low = high = 0: a stage in metres */
    int pane;         /* index in the show */
    bool has_text;    /* has room for words */
    double em;        /* pixels */
    int legend_at[2]; /* pixels, position of the legend's next words */
} Plot;

/* A point or vector that a function returns by value, for use as in
 * plot_line(plot, a, point_along(a, t, d).at, ...). */
typedef struct Point {
    double at[2];
} Point;

/* a + t d */
static inline Point point_along(const double *a, double t, const double *d)
{
    return (Point){{a[0] + t * d[0], a[1] + t * d[1]}};
}

/* b - a */
static inline Point vector_between(const double *a, const double *b)
{
    return point_along(b, -1, a);
}

/* |b - a| */
static inline double point_distance(const double *a, const double *b)
{
    return math_hypot(b[0] - a[0], b[1] - a[1]);
}

static inline double vector_length(const double *d)
{
    return math_hypot(d[0], d[1]);
}

/* The smallest 1, 2 or 5 times a power of ten that is at least value > 0. */
double plot_round_up(double value);

/* The smallest number that is at least value > 0 and that an axis from 0 to it
 * shows at its end. */
double plot_round_axis(double value);

/* Draws axes in a card: numbers on the left and below, light lines across. */
Plot plot_create(const Plot *card, Axis x, Axis y);

/* Draws axes over a stage that has room for words.  Each axis covers the range
 * that the camera sees, except y if y.high is not 0: then y keeps its own. */
Plot plot_on_stage(const Plot *stage, Axis x, Axis y);

/* Maps a point to pixels; not finite if the point has no logarithm. */
void plot_pixel(const Plot *plot, const double *at, double pixel[2]);

/* Picks the point of [count][2] that is nearest to pixel (x, y), the last one
 * of equal distances.  Returns false if none lies within `reach` pixels. */
bool plot_pick_point(const Plot *plot, int count, const double *at,
                     double reach, double x, double y, PickKind kind,
                     Pick *pick);

/* Bounds of a square view around the origin: half a side is `reach` metres
 * times the smallest power of `factor` that makes it at least `most`.  A view
 * that grows by steps seldom moves. */
void bounds_grow(double reach, double most, double factor, double bounds[4]);

/* ---- shapes; the phase of dashes is that of canvas_dashes -----------------
 */

void plot_line(const Plot *plot, const double *a, const double *b, double width,
               Colour colour);
void plot_dashes(const Plot *plot, const double *a, const double *b,
                 double width, double *phase, Colour colour);

/* The curve middle + a cos t + b sin t. */
void plot_ellipse(const Plot *plot, const double *middle, const double *a,
                  const double *b, double width, bool dashed, Colour colour);

/* All unbroken springs of a system at positions x [2n]. */
void plot_springs(const Plot *plot, const System *system, const double *x,
                  double width, Colour colour);

/* A filled quadrilateral; neighbours have no seam between them. */
void plot_quad(const Plot *plot, const double *const corner[4], Colour colour);

/* A polyline through points x, y [count]; a function y over the whole axis. */
void plot_curve(const Plot *plot, int count, const double *x, const double *y,
                double width, Colour colour);
void plot_graph(const Plot *plot, double (*y)(const void *data, double x),
                const void *data, double width, Colour colour);

/* A disc; returns whether its centre is inside.  A hollow disc is white up to
 * the radius `inner`. */
bool plot_disc(const Plot *plot, const double *at, double radius,
               Colour colour);
void plot_hollow_disc(const Plot *plot, const double *at, double radius,
                      double inner, Colour colour);
void plot_ring(const Plot *plot, const double *at, double radius, double width,
               Colour colour);

/* The mark of a pinned node. */
void plot_pin(const Plot *plot, const double *at, double radius);

/* An arrow from a to a + factor d. */
void plot_arrow(const Plot *plot, const double *a, const double *d,
                double factor, double width, Colour colour);

/* ---- words (words.c) ---------------------------------------------------- */

/* Adds words to the legend, formatted as by printf.  The legend runs from the
 * upper left corner to the right and goes on in a second line. */
void plot_legend(Plot *plot, Colour colour, const char *format, ...);

/* Draws a scale of 1, 2 or 5 times a power of ten metres, lower left. */
void plot_scale(const Plot *plot);

/* Cost of a label's position: high if the box covers drawn pixels or reaches
 * out of the plot. */
double plot_label_cost(const Plot *plot, Box place);

/* Writes a label, formatted as by printf, in bold beside one of the points at
 * [points][2], where it covers the fewest drawn pixels; earlier points are
 * preferred. */
void plot_label(const Plot *plot, int points, const double *at, Colour colour,
                const char *format, ...);

/* A number as markup: 100000, 0.003, or with a power of ten such as
 * 2.5 10^{7}; format_number writes three digits. */
typedef struct Number {
    char text[48];
} Number;
Number format_digits(double value, int digits);
Number format_number(double value);

/* ---- stages (show.c) ---------------------------------------------------- */

/* The stage of a pane; paper NULL: the stage only computes positions. */
Plot stage_create(Paper *paper, const FrameContent *content,
                  const Layout *layout, int pane);

/* Draws a ring at each of the scene's handles, which the mouse can drag. */
void stage_handles(const Plot *stage);

#endif
