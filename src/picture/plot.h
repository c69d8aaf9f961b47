/* plot.h - drawing in metres, or in the units of two axes.
 *
 * A Plot is a box of the paper with a camera.  The stage of a pane is a plot in
 * metres without axes.  The inside of a card is a plot to which plot_create
 * adds axes.
 *
 * Points are [2] in the units of the axes, widths and radii in units of the
 * paper, other sizes in ems.  In a plot with axes, lines and arrows are clipped
 * at the box, and discs and rings whose centre lies outside are left out.  A
 * stage is clipped by its canvas. */
#pragma once

#include "base/mathematics.h"
#include "picture/paper.h"
#include "picture/frame_content.h"

typedef struct Axis {
    double low, high; /* high > low; both > 0 on a logarithmic axis */
    /* places of the ticks: any, whole numbers, powers of ten */
    enum { SCALE_LINEAR, SCALE_INTEGER, SCALE_LOG } scale;
    bool shows_milli; /* numbers at the ticks are 1000 times the values */
    /* Markup; x: below the axis at the right end, y: above the upper end. */
    const char *label;
} Axis;

typedef struct Plot {
    Paper *paper; /* NULL: the plot only computes positions */
    const FrameContent *content;
    const Pane *pane; /* pane of the stage; in cards the active pane */
    const Simulation *simulation; /* simulation of the pane */
    bool is_answer_shown;         /* a page shows its answer */
    Box box;                      /* pixels, without the numbers of the axes */
    Camera camera;                /* maps logarithms on a logarithmic axis */
    Axis x, y;           /* low = high = 0: no axes, and the unit is metres */
    bool has_text;       /* words are drawn */
    double em;           /* pixels */
    int legend_pixel[2]; /* pixels, place of the legend's next words */
} Plot;

/* Makes the plot of a box, with coordinates in metres.  A plot without paper
 * can convert positions, not draw. */
static inline Plot plot_create_in_box(Paper *paper, const FrameContent *content,
                                      const Pane *pane, Box box, double em)
{
    return (Plot){.paper = paper,
                  .content = content,
                  .pane = pane,
                  .simulation = pane->simulation,
                  .is_answer_shown =
                      content->lecture.page && !content->lecture.hides_answer,
                  .box = box,
                  .has_text = true,
                  .em = em};
}

/* Returns the index of the plot's pane in the frame. */
static inline int plot_pane_index(const Plot *plot)
{
    return (int)(plot->pane - plot->content->pane);
}

/* A point or vector as the value of a function:
 * plot_line(plot, a, point_along(a, t, d).xy, ...). */
typedef struct Point {
    double xy[2];
} Point;

/* Returns a + t d. */
static inline Point point_along(const double *a, double t, const double *d)
{
    return (Point){{a[0] + t * d[0], a[1] + t * d[1]}};
}

/* Returns b - a. */
static inline Point vector_between(const double *a, const double *b)
{
    return point_along(b, -1, a);
}

/* Returns |b - a|. */
static inline double point_distance(const double *a, const double *b)
{
    return math_hypot(b[0] - a[0], b[1] - a[1]);
}

static inline double vector_length(const double *d)
{
    return math_hypot(d[0], d[1]);
}

/* Rounds value > 0 up to 1, 2 or 5 times a power of ten. */
double plot_nice_number(double value);

/* Rounds value > 0 up to the last tick of an axis that begins at 0. */
double plot_round_axis_end(double value);

/* Makes the plot inside a card, and draws its axes with their numbers. */
Plot plot_create(const Plot *card, Axis x, Axis y);

/* Makes the plot inside a stage.  Draws its axes if the stage has text.  The
 * axes cover what the camera sees; y.high != 0: y covers y.low ... y.high. */
Plot plot_create_on_stage(const Plot *stage, Axis x, Axis y);

/* Maps a point to pixels: not finite for values <= 0 on a logarithmic axis. */
void plot_to_pixel(const Plot *plot, const double *at, double pixel[2]);

/* Picks the point nearest to pixel (x, y), the last one if several are equally
 * near.  Returns false if no point lies within `reach` pixels.
 *   at  [count][2] in, points */
bool plot_pick_point(const Plot *plot, int count, const double *at,
                     double reach, double x, double y, PickKind kind,
                     Pick *pick);

/* Finds bounds of a square around the origin.  Half a side is `least` metres,
 * multiplied by `factor` until half a side is at least `needed` metres: a view
 * that grows by steps seldom moves. */
void find_centred_view(double least, double needed, double factor,
                       double bounds[4]);

/* ---- shapes; the phase of dashes is that of canvas_dashes ---------------- */

void plot_line(const Plot *plot, const double *a, const double *b, double width,
               Colour colour);
void plot_dashes(const Plot *plot, const double *a, const double *b,
                 double width, double *phase, Colour colour);

/* Draws the curve middle + a cos t + b sin t. */
void plot_ellipse(const Plot *plot, const double *middle, const double *a,
                  const double *b, double width, bool dashed, Colour colour);

/* Draws all unbroken springs of a system at positions x [2n]. */
void plot_springs(const Plot *plot, const System *system, const double *x,
                  double width, Colour colour);

/* A filled quadrilateral; neighbours have no seam between them. */
void plot_quad(const Plot *plot, const double *const corner[4], Colour colour);

/* Draws a polyline through points x, y [count]. */
void plot_curve(const Plot *plot, int count, const double *x, const double *y,
                double width, Colour colour);
/* Draws the graph of the function y over the whole axis of x. */
void plot_graph(const Plot *plot, double (*y)(const void *data, double x),
                const void *data, double width, Colour colour);

/* Draws a disc.  Returns whether the centre is inside the plot.  A hollow disc
 * is white up to the radius `inner`. */
bool plot_disc(const Plot *plot, const double *at, double radius,
               Colour colour);
void plot_hollow_disc(const Plot *plot, const double *at, double radius,
                      double inner, Colour colour);
void plot_ring(const Plot *plot, const double *at, double radius, double width,
               Colour colour);

/* Draws the mark of a pinned node. */
void plot_draw_pin(const Plot *plot, const double *at, double radius);

/* Draws an arrow from a to a + factor d. */
void plot_arrow(const Plot *plot, const double *a, const double *d,
                double factor, double width, Colour colour);

/* ---- words (words.c) ---------------------------------------------------- */

/* Adds words to the legend, formatted as by printf.  The legend runs from the
 * upper left corner to the right and goes on in a second line. */
void plot_legend(Plot *plot, Colour colour, const char *format, ...);

/* Draws a scale bar in the lower left corner: 1, 2 or 5 times 10^n metres. */
void plot_draw_scale_bar(const Plot *plot);

/* Returns the cost of a place for a label, which is high if the box covers
 * drawn pixels or reaches out of the plot. */
double plot_find_label_cost(const Plot *plot, Box place);

/* Writes a label, formatted as by printf, in bold beside one of the points,
 * where the label covers the fewest drawn pixels.
 *   at  [points][2] in; earlier points are preferred */
void plot_label(const Plot *plot, int points, const double *at, Colour colour,
                const char *format, ...);

/* ---- numbers (number_text.c) --------------------------------------------- */

/* A number as markup, such as 0.25 or 10^{7}.  format_number has 3 digits. */
typedef struct NumberText {
    char text[48];
} NumberText;
NumberText format_digits(double value, int digits);
NumberText format_number(double value);

/* Returns an option's value as markup: 1e-06 becomes 10^{-6}.  A value that the
 * user is typing ends with "_" and stays as it is. */
NumberText format_power_of_ten(const char *value);

/* ---- stages (picture.c) -------------------------------------------------- */

/* Makes the stage of a pane; paper NULL: the stage only computes positions. */
Plot stage_create(Paper *paper, const FrameContent *content,
                  const Layout *layout, int pane);

/* Draws a ring at each of the scene's handles, which the mouse can drag. */
void stage_draw_handles(const Plot *stage);
