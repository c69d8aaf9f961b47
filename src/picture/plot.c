/* plot.c - axes, curves, points and shapes of a plot. */
#include "picture/plot.h"

#include <math.h>
#include <string.h>

#include "picture/colour_map.h"

enum {
    PLOT_MAX_Y_INTERVALS = 4,  /* most intervals between the numbers of y */
    PLOT_MAX_TICKS = 40,       /* most ticks of an axis */
    PLOT_GRAPH_POINTS = 400,   /* points of a graph */
    PLOT_ELLIPSE_CORNERS = 120 /* corners of a polygon drawn for an ellipse */
};

static const double TURN = 6.283185307179586; /* 2 pi */

static const double TICK_SIZE = 0.82; /* ems, size of the axes' letters */
static const double X_NUMBER_WIDTH =
    5; /* ems, width of a number at the x axis */
static const double Y_NUMBER_HEIGHT = 1.6; /* ems, height at the y axis */
static const double Y_NUMBER_WIDTH = 3.1;  /* ems, width at the y axis */
static const double X_NUMBER_GAP = 0.25;   /* ems, gap above at the x axis */
static const double ARROW_HEAD = 0.62;     /* ems, length of arrow heads */

double plot_nice_number(double value)
{
    double power = pow(10, floor(log10(value)));
    double part = value / power * (1 - 1e-12);
    return power * (part <= 1 ? 1 : part <= 2 ? 2 : part <= 5 ? 5 : 10);
}

double plot_round_axis_end(double value)
{
    double step = plot_nice_number(value / PLOT_MAX_Y_INTERVALS);
    return step * ceil(value / step * (1 - 1e-12));
}

/* Returns the coordinate of a value, a logarithm on a logarithmic axis. */
static double axis_find_coordinate(const Axis *axis, double value)
{
    return axis->scale == SCALE_LOG ? log10(value) : value;
}

void plot_to_pixel(const Plot *plot, const double *at, double pixel[2])
{
    const double on[2] = {axis_find_coordinate(&plot->x, at[0]),
                          axis_find_coordinate(&plot->y, at[1])};
    camera_to_pixel(&plot->camera, on, pixel);
}

/* Sets the camera so that the box shows axis k from low to high. */
static void set_plot_camera(Plot *plot, int k, const Axis *axis)
{
    const Box *box = &plot->box;
    double low = axis_find_coordinate(axis, axis->low),
           high = axis_find_coordinate(axis, axis->high);
    double scale = (k ? box->height : box->width) / (high - low);
    plot->camera.scale[k] = scale;
    plot->camera.origin[k] =
        k ? box->y + box->height + scale * low : box->x - scale * low;
}

/* Returns the number at a tick; values below 1e-9 of the axis become 0. */
static NumberText format_tick(const Axis *axis, double value)
{
    double span = axis->high - axis->low;
    bool is_zero = axis->scale != SCALE_LOG && fabs(value) < 1e-9 * span;
    return format_number(is_zero             ? 0
                         : axis->shows_milli ? 1000 * value
                                             : value);
}

/* Lists the multiples of a step on the axis, or the powers of ten whose
 * exponent is such a multiple.  Returns the number of ticks. */
static int list_ticks(const Axis *axis, double step, double *ticks)
{
    double low = axis_find_coordinate(axis, axis->low),
           high = axis_find_coordinate(axis, axis->high);
    bool powers = axis->scale == SCALE_LOG;
    int count = 0;
    double first = powers ? ceil(low - 1e-9) / step : ceil(low / step - 1e-9);
    for (double k = first;
         k * step <= high + 1e-9 * step && count < PLOT_MAX_TICKS; k++)
        ticks[count++] = powers ? pow(10, round(k * step)) : k * step;
    return count;
}

/* Finds the ticks of an axis that is `ems` long, at least two on an axis y with
 * room for two numbers.  Returns the number of ticks.
 *   upright  the axis is y */
static int find_ticks(const Axis *axis, bool upright, double ems, double *ticks)
{
    double room = upright ? fmax(ems / Y_NUMBER_HEIGHT, 1)
                          : fmax(ems / X_NUMBER_WIDTH, 2);
    double intervals = fmin(room, (upright ? 1 : 2) * PLOT_MAX_Y_INTERVALS);
    double low = axis_find_coordinate(axis, axis->low),
           high = axis_find_coordinate(axis, axis->high);
    double step = plot_nice_number((high - low) / intervals);
    if (!(high - low > 0) || !isfinite(high - low))
        return 0;
    if (axis->scale == SCALE_LOG) /* step: a whole number of decades */
        step = ceil((floor(high + 1e-9) - ceil(low - 1e-9)) / intervals);
    if (axis->scale != SCALE_LINEAR)
        step = fmax(step, 1);
    int count = list_ticks(axis, step, ticks);
    if (count < 2 && upright && room > 1.5 && axis->scale == SCALE_LINEAR)
        count = list_ticks(axis, 0.5 * step, ticks);
    return count;
}

static void write_axis_text(const Plot *plot, Colour colour, double x, double y,
                            Align align, const char *words)
{
    paper_write(plot->paper, FACE_REGULAR, TICK_SIZE, colour, x, y, align, "%s",
                words);
}

static int measure_label(Paper *paper, const char *words)
{
    return paper_measure(paper, FACE_REGULAR, TICK_SIZE, words);
}

/* Draws a light line and a number for each tick of y; the line at 0 is darker.
 * Draws the numbers of x that the label of x leaves room for. */
static void draw_axes(const Plot *plot)
{
    Paper *paper = plot->paper;
    const Box *box = &plot->box;
    const char *x_label = plot->x.label, *y_label = plot->y.label;
    double em = paper->em, ticks[PLOT_MAX_TICKS], at[2];
    double right = box->x + box->width, end = right;
    double below = box->y + box->height + X_NUMBER_GAP * em;
    int count = find_ticks(&plot->y, true, box->height / em, ticks);
    int thin = (int)fmax(1, paper->unit);
    for (int i = 0; i < count; i++) {
        bool zero =
            plot->y.scale != SCALE_LOG && fabs(ticks[i]) < 1e-12 * plot->y.high;
        plot_to_pixel(plot, (double[2]){plot->x.low, ticks[i]}, at);
        canvas_fill(&paper->canvas,
                    (Box){box->x, (int)floor(at[1] + 1e-9), box->width, thin},
                    zero ? COLOUR_BORDER : COLOUR_GRID);
        write_axis_text(plot, COLOUR_FAINT, box->x - 0.35 * em,
                        at[1] - 0.65 * TICK_SIZE * em, ALIGN_RIGHT,
                        format_tick(&plot->y, ticks[i]).text);
    }
    if (y_label && box->height > 1.6 * TICK_SIZE * em)
        write_axis_text(plot, COLOUR_TEXT, right, box->y + 0.1 * em,
                        ALIGN_RIGHT, y_label);
    if (x_label) {
        write_axis_text(plot, COLOUR_TEXT, right, below, ALIGN_RIGHT, x_label);
        end -= measure_label(paper, x_label) + paper_to_pixels(paper, 0.5);
    }
    count = find_ticks(&plot->x, false, box->width / em, ticks);
    for (int i = 0; i < count; i++) {
        NumberText number = format_tick(&plot->x, ticks[i]);
        plot_to_pixel(plot, (double[2]){ticks[i], plot->y.low}, at);
        if (at[0] + measure_label(paper, number.text) / 2 <= end)
            write_axis_text(plot, COLOUR_FAINT, at[0], below, ALIGN_CENTRE,
                            number.text);
    }
}

/* Returns the box inside the axes: without `above` and `below` ems, and without
 * the width of the numbers of y. */
static Box find_box_inside_axes(const Plot *outer, const Axis *y, double above,
                                double below)
{
    Paper *paper = outer->paper;
    Box box = outer->box;
    double ticks[PLOT_MAX_TICKS], left = paper_to_pixels(paper, Y_NUMBER_WIDTH);
    int count = find_ticks(y, true, box.height / paper->em, ticks);
    for (int i = 0; i < count; i++)
        left = fmax(left, measure_label(paper, format_tick(y, ticks[i]).text) +
                              paper_to_pixels(paper, 0.4));
    box.x += (int)left;
    box.y += paper_to_pixels(paper, above);
    box.width -= (int)left + paper_to_pixels(paper, 0.6);
    box.height -= paper_to_pixels(paper, above + below);
    box.width = box.width < 1 ? 1 : box.width;
    box.height = box.height < 1 ? 1 : box.height;
    return box;
}

Plot plot_create(const Plot *card, Axis x, Axis y)
{
    Plot plot = *card;
    plot.x = x;
    plot.y = y;
    plot.box = find_box_inside_axes(card, &y, 0.5, 1.5);
    set_plot_camera(&plot, 0, &x);
    set_plot_camera(&plot, 1, &y);
    draw_axes(&plot);
    return plot;
}

/* Sets the axis to the range low ... high of camera coordinates. */
static void axis_set_range(Axis *axis, double low, double high)
{
    axis->low = axis->scale == SCALE_LOG ? pow(10, low) : low;
    axis->high = axis->scale == SCALE_LOG ? pow(10, high) : high;
}

Plot plot_create_on_stage(const Plot *stage, Axis x, Axis y)
{
    Plot plot = *stage, outer = *stage;
    double low[2], high[2];
    const Box *box = &plot.box;
    plot.x = x;
    plot.y = y;
    box_cut_off(&outer.box, EDGE_LEFT, stage->paper->em / 2);
    /* The second pass makes room for the numbers that the first finds. */
    for (int pass = 0; pass < 2; pass++) {
        if (stage->has_text && pass > 0)
            plot.box = find_box_inside_axes(&outer, &plot.y, 2.2, 1.7);
        camera_to_world(&stage->camera, box->x, box->y + box->height, low);
        camera_to_world(&stage->camera, box->x + box->width, box->y, high);
        if (y.high == 0)
            axis_set_range(&plot.y, low[1], high[1]);
    }
    axis_set_range(&plot.x, low[0], high[0]);
    if (y.high != 0)
        set_plot_camera(&plot, 1, &y);
    if (stage->has_text)
        draw_axes(&plot);
    return plot;
}

/* ---- shapes ------------------------------------------------------------- */

/* Whether the plot has axes and therefore clips at its box. */
static bool has_axes(const Plot *plot)
{
    return plot->x.high > plot->x.low;
}

/* Returns the width of a line in pixels, at least 1. */
static double find_line_width(const Plot *plot, double width)
{
    return fmax(1, width * plot->paper->unit);
}

/* Draws the visible part of a line between two pixels; NaN draws nothing. */
static void draw_clipped_line(const Plot *plot, const double *a,
                              const double *b, double width, Colour colour)
{
    double line[4] = {a[0], a[1], b[0], b[1]};
    if (!has_axes(plot) || box_clip_line(&plot->box, 0, line))
        canvas_line(&plot->paper->canvas, line[0], line[1], line[2], line[3],
                    find_line_width(plot, width), colour);
}

void plot_line(const Plot *plot, const double *a, const double *b, double width,
               Colour colour)
{
    double p[2], q[2];
    plot_to_pixel(plot, a, p);
    plot_to_pixel(plot, b, q);
    draw_clipped_line(plot, p, q, width, colour);
}

void plot_dashes(const Plot *plot, const double *a, const double *b,
                 double width, double *phase, Colour colour)
{
    Canvas *canvas = &plot->paper->canvas;
    double p[2], q[2];
    Box before = canvas_set_clip(canvas, plot->box);
    plot_to_pixel(plot, a, p);
    plot_to_pixel(plot, b, q);
    canvas_dashes(canvas, p, q, find_line_width(plot, width), plot->paper->unit,
                  phase, colour);
    canvas_set_clip(canvas, before);
}

void plot_ellipse(const Plot *plot, const double *middle, const double *a,
                  const double *b, double width, bool dashed, Colour colour)
{
    double from[2], phase = 0;
    for (int i = 0; i <= PLOT_ELLIPSE_CORNERS; i++) {
        double t = TURN * i / PLOT_ELLIPSE_CORNERS;
        const double to[2] = {middle[0] + a[0] * cos(t) + b[0] * sin(t),
                              middle[1] + a[1] * cos(t) + b[1] * sin(t)};
        if (i > 0 && dashed)
            plot_dashes(plot, from, to, width, &phase, colour);
        else if (i > 0)
            plot_line(plot, from, to, width, colour);
        memcpy(from, to, sizeof from);
    }
}

void plot_springs(const Plot *plot, const System *system, const double *x,
                  double width, Colour colour)
{
    for (int s = 0; s < system->springs; s++)
        if (!spring_is_broken(system, s))
            plot_line(plot, x + 2 * system->e[2 * s],
                      x + 2 * system->e[2 * s + 1], width, colour);
}

void plot_quad(const Plot *plot, const double *const corner[4], Colour colour)
{
    double p[8];
    for (int k = 0; k < 4; k++)
        plot_to_pixel(plot, corner[k], p + 2 * k);
    const double half[6] = {p[0], p[1], p[4], p[5], p[6], p[7]};
    canvas_triangle(&plot->paper->canvas, p, false, colour);
    canvas_triangle(&plot->paper->canvas, half, false, colour);
}

/* Joints are moved to the border between two pixels, in the direction in which
 * the line is longer.  Elsewhere two pieces would each cover a part of one
 * pixel, which would look paler. */
void plot_curve(const Plot *plot, int count, const double *x, const double *y,
                double width, Colour colour)
{
    double p[2] = {NAN, NAN};
    for (int i = 0; i < count; i++) {
        double q[2];
        plot_to_pixel(plot, (double[2]){x[i], y[i]}, q);
        if (isfinite(p[0] + p[1]) && isfinite(q[0] + q[1])) {
            const double d[2] = {q[0] - p[0], q[1] - p[1]};
            if (fabs(d[0]) < 1 && fabs(d[1]) < 1 && i + 1 < count)
                continue; /* points nearer than a pixel are skipped */
            int k = fabs(d[0]) >= fabs(d[1]) ? 0 : 1;
            double end = floor(q[k] + 0.5);
            q[1 - k] += (end - q[k]) * d[1 - k] / d[k];
            q[k] = end;
            draw_clipped_line(plot, p, q, width, colour);
        }
        memcpy(p, q, sizeof p);
    }
}

void plot_graph(const Plot *plot, double (*y)(const void *data, double x),
                const void *data, double width, Colour colour)
{
    double at[PLOT_GRAPH_POINTS + 1], value[PLOT_GRAPH_POINTS + 1];
    double low = plot->x.low, high = plot->x.high;
    for (int i = 0; i <= PLOT_GRAPH_POINTS; i++) {
        double part = (double)i / PLOT_GRAPH_POINTS;
        at[i] = plot->x.scale == SCALE_LOG ? low * pow(high / low, part)
                                           : low + (high - low) * part;
        value[i] = y(data, at[i]);
    }
    plot_curve(plot, PLOT_GRAPH_POINTS + 1, at, value, width, colour);
}

/* Maps a point to pixels.  Returns whether the point is visible. */
static bool find_visible_pixel(const Plot *plot, const double *at, double p[2])
{
    plot_to_pixel(plot, at, p);
    return !has_axes(plot) || (at[0] >= plot->x.low && at[0] <= plot->x.high &&
                               at[1] >= plot->y.low && at[1] <= plot->y.high);
}

bool plot_disc(const Plot *plot, const double *at, double radius, Colour colour)
{
    double p[2];
    bool seen = find_visible_pixel(plot, at, p);
    if (seen)
        canvas_disc(&plot->paper->canvas, p[0], p[1],
                    radius * plot->paper->unit, colour);
    return seen;
}

void plot_hollow_disc(const Plot *plot, const double *at, double radius,
                      double inner, Colour colour)
{
    if (plot_disc(plot, at, radius, colour))
        plot_disc(plot, at, inner, COLOUR_WHITE);
}

void plot_ring(const Plot *plot, const double *at, double radius, double width,
               Colour colour)
{
    double p[2], unit = plot->paper->unit;
    if (find_visible_pixel(plot, at, p))
        canvas_ring(&plot->paper->canvas, p[0], p[1], radius * unit,
                    find_line_width(plot, width), colour);
}

/* Draws a dark square with a light middle. */
void plot_draw_pin(const Plot *plot, const double *at, double radius)
{
    Canvas *canvas = &plot->paper->canvas;
    double p[2], size = fmax(radius, 3) * plot->paper->unit * 1.15;
    plot_to_pixel(plot, at, p);
    if (!(fabs(p[0]) < 1e6 && fabs(p[1]) < 1e6))
        return;
    Box box = {(int)floor(p[0] - size + 0.5), (int)floor(p[1] - size + 0.5),
               (int)(2 * size + 0.5), (int)(2 * size + 0.5)};
    canvas_fill(canvas, box, COLOUR_TEXT);
    canvas_fill(canvas, box_inset(box, (int)fmax(1, 0.45 * size)),
                COLOUR_WHITE);
}

void plot_arrow(const Plot *plot, const double *a, const double *d,
                double factor, double width, Colour colour)
{
    Paper *paper = plot->paper;
    const double b[2] = {a[0] + factor * d[0], a[1] + factor * d[1]};
    double p[2], q[2];
    Box before = canvas_set_clip(&paper->canvas, plot->box);
    plot_to_pixel(plot, a, p);
    plot_to_pixel(plot, b, q);
    canvas_arrow(&paper->canvas, p[0], p[1], q[0], q[1],
                 find_line_width(plot, width), ARROW_HEAD * paper->em, colour);
    canvas_set_clip(&paper->canvas, before);
}

bool plot_pick_point(const Plot *plot, int count, const double *at,
                     double reach, double x, double y, PickKind kind,
                     Pick *pick)
{
    bool found = false;
    for (int i = count - 1; i >= 0; i--) {
        double p[2];
        plot_to_pixel(plot, at + 2 * i, p);
        double distance = math_hypot(p[0] - x, p[1] - y);
        if (!(distance < reach))
            continue;
        reach = distance;
        pick->kind = kind;
        pick->index = i;
        found = true;
    }
    return found;
}

void find_centred_view(double least, double needed, double factor,
                       double bounds[4])
{
    while (least < needed && least < 1e100)
        least *= factor;
    bounds[2] = bounds[3] = least;
    bounds[0] = bounds[1] = -least;
}
