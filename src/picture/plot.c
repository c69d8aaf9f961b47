#include "picture/plot.h"

#include <math.h>
#include <string.h>

#include "picture/colour_map.h"
#include "base/mathematics.h"

enum {
    PLOT_INTERVALS = 4,   /* between numbers, upwards */
    PLOT_MOST_LINES = 40, /* of any axis */
    PLOT_POINTS = 400     /* of a graph */
};

static const double TICK_SIZE = 0.82;    /* ems, letters at the axes */
static const double TICK_ROOM = 5;       /* ems, a number to the right needs */
static const double NUMBER_ROOM = 3.1;   /* ems, left of the plot */
static const double BELOW_ROOM = 1.5;    /* ems, below it */
static const double NUMBER_BELOW = 0.25; /* ems, from the plot to a number */
static const double HEAD = 0.62;         /* ems, length of an arrow's head */
static const double ARROW_LEAST = 1.5;   /* ems, the longest arrow has */

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

/* Where a value stands on its axis. */
static double on_axis(const Axis *axis, double value)
{
    return axis->log ? log10(value) : value;
}

void plot_place(const Plot *plot, const double *at, double pixel[2])
{
    const double on[2] = {on_axis(&plot->x, at[0]), on_axis(&plot->y, at[1])};
    camera_pixel(&plot->camera, on, pixel);
}

/* The axis k that the box shows from low to high. */
static void set_camera(Plot *plot, int k, const Axis *axis)
{
    const Box *box = &plot->box;
    double low = on_axis(axis, axis->low), high = on_axis(axis, axis->high);
    double scale = (k ? box->height : box->width) / (high - low);
    plot->camera.scale[k] = scale;
    plot->camera.origin[k] =
        k ? box->y + box->height + scale * low : box->x - scale * low;
}

/* A number of an axis; rounding must not show as 1e-17. */
static Number tick_number(const Axis *axis, double value)
{
    double span = axis->high - axis->low;
    bool nothing = !axis->log && fabs(value) < 1e-9 * span;
    return number_of(nothing ? 0 : value);
}

/* The values that carry a number on this axis; returns how many. */
static int axis_ticks(const Axis *axis, double intervals, double *ticks)
{
    int count = 0;
    if (!(axis->high > axis->low) || (axis->log && !(axis->low > 0)))
        return 0;
    if (axis->log) {
        int low = (int)ceil(log10(axis->low) - 1e-9);
        int high = (int)floor(log10(axis->high) + 1e-9);
        int step = (int)ceil((high - low) / intervals);
        step = step < 1 ? 1 : step;
        for (int k = low; k <= high && count < PLOT_MOST_LINES; k += step)
            ticks[count++] = pow(10, k);
        return count;
    }
    double step = plot_round_up((axis->high - axis->low) / intervals);
    if (axis->whole)
        step = fmax(step, 1);
    for (double k = ceil(axis->low / step - 1e-9);
         k * step <= axis->high + 1e-9 * step && count < PLOT_MOST_LINES; k++)
        ticks[count++] = k * step;
    return count;
}

/* Numbers below, the label at the end of the axis. */
static void draw_x_axis(const Plot *plot)
{
    Paper *paper = plot->paper;
    const Box *box = &plot->box;
    double ticks[PLOT_MOST_LINES], at[2];
    double room = box->width / (TICK_ROOM * paper->em);
    int count = axis_ticks(&plot->x, fmin(fmax(room, 2), 8), ticks);
    double y = box->y + box->height + NUMBER_BELOW * paper->em;
    int right = box->x + box->width;
    if (plot->x.label)
        right -= paper_width(paper, FACE_REGULAR, TICK_SIZE, plot->x.label) +
                 paper_pixels(paper, 0.5);
    for (int i = 0; i < count; i++) {
        Number number = tick_number(&plot->x, ticks[i]);
        plot_place(plot, (double[2]){ticks[i], plot->y.low}, at);
        int half = paper_width(paper, FACE_REGULAR, TICK_SIZE, number.text) / 2;
        if (at[0] + half > right)
            continue;
        paper_write(paper, FACE_REGULAR, TICK_SIZE, COLOUR_FAINT, at[0], y,
                    ALIGN_CENTRE, "%s", number.text);
    }
    if (plot->x.label)
        paper_write(paper, FACE_REGULAR, TICK_SIZE, COLOUR_TEXT,
                    box->x + box->width, y, ALIGN_RIGHT, "%s", plot->x.label);
}

/* Light lines across with their numbers on the left; 0 is darker. */
static void draw_y_axis(const Plot *plot)
{
    Paper *paper = plot->paper;
    const Box *box = &plot->box;
    double ticks[PLOT_MOST_LINES], at[2];
    double room = box->height / (1.6 * paper->em);
    int count =
        axis_ticks(&plot->y, fmin(fmax(room, 1), PLOT_INTERVALS), ticks);
    double x = box->x - 0.35 * paper->em;
    for (int i = 0; i < count; i++) {
        bool zero = !plot->y.log && fabs(ticks[i]) < 1e-12 * plot->y.high;
        plot_place(plot, (double[2]){plot->x.low, ticks[i]}, at);
        double row = floor(at[1] + 1e-9) + 0.5; /* sharp on the screen */
        canvas_line(&paper->canvas, box->x, row, box->x + box->width, row,
                    fmax(1, floor(paper->unit)),
                    zero ? COLOUR_BORDER : COLOUR_GRID);
        paper_write(paper, FACE_REGULAR, TICK_SIZE, COLOUR_FAINT, x,
                    at[1] - 0.65 * TICK_SIZE * paper->em, ALIGN_RIGHT, "%s",
                    tick_number(&plot->y, ticks[i]).text);
    }
    if (plot->y.label && box->height > 1.6 * TICK_SIZE * paper->em)
        paper_write(paper, FACE_REGULAR, TICK_SIZE, COLOUR_TEXT,
                    box->x + box->width, box->y + 0.1 * paper->em, ALIGN_RIGHT,
                    "%s", plot->y.label);
}

/* Numbers and lines. */
static void draw_axes(const Plot *plot)
{
    draw_y_axis(plot);
    draw_x_axis(plot);
}

/* Pixels left of the plot: the widest number of the axis beyond the usual
 * ones. */
static int number_room(Paper *paper, const Axis *axis, int height)
{
    double ticks[PLOT_MOST_LINES], room = height / (1.6 * paper->em);
    int most = paper_pixels(paper, NUMBER_ROOM);
    int count = axis_ticks(axis, fmin(fmax(room, 1), PLOT_INTERVALS), ticks);
    for (int i = 0; i < count; i++) {
        Number number = tick_number(axis, ticks[i]);
        int width = paper_width(paper, FACE_REGULAR, TICK_SIZE, number.text) +
                    paper_pixels(paper, 0.4);
        most = width > most ? width : most;
    }
    return most;
}

/* Its box, at least a pixel wide and high. */
static void set_box(Plot *plot, Box box)
{
    plot->box = box;
    plot->box.width = box.width < 1 ? 1 : box.width;
    plot->box.height = box.height < 1 ? 1 : box.height;
}

Plot plot_create(Paper *paper, Box outer, Axis x, Axis y)
{
    Plot plot = {.paper = paper, .x = x, .y = y, .text = true, .em = paper->em};
    int left = number_room(paper, &y, outer.height);
    int below = paper_pixels(paper, BELOW_ROOM);
    int above = paper_pixels(paper, 0.5), right = paper_pixels(paper, 0.6);
    set_box(&plot,
            (Box){outer.x + left, outer.y + above, outer.width - left - right,
                  outer.height - above - below});
    set_camera(&plot, 0, &x);
    set_camera(&plot, 1, &y);
    draw_axes(&plot);
    return plot;
}

void plot_unit(Plot *plot, double unit)
{
    plot->y.low *= unit;
    plot->y.high *= unit;
    set_camera(plot, 1, &plot->y);
}

const PlotRoom plot_room = {3.2, 4, 2.4, 4.2};

/* What the camera sees from low to high. */
static void set_range(Axis *axis, double low, double high)
{
    axis->low = axis->log ? pow(10, low) : low;
    axis->high = axis->log ? pow(10, high) : high;
}

Plot plot_on(const Plot *stage, const PlotRoom *room, Axis x, Axis y)
{
    Plot plot = *stage;
    Box box = stage->box;
    double low[2], high[2];
    plot.x = x;
    plot.y = y;
    if (stage->text) {
        box.x += paper_pixels(stage->paper, room->left);
        box.width -= paper_pixels(stage->paper, room->wide);
        box.y += paper_pixels(stage->paper, room->above);
        box.height -= paper_pixels(stage->paper, room->high);
        if (box.width < 1 || box.height < 1)
            box = stage->box;
    }
    plot.box = box;
    camera_world(&stage->camera, box.x, box.y + box.height, low);
    camera_world(&stage->camera, box.x + box.width, box.y, high);
    set_range(&plot.x, low[0], high[0]);
    if (y.high == 0)
        set_range(&plot.y, low[1], high[1]);
    else
        set_camera(&plot, 1, &y);
    if (stage->text)
        draw_axes(&plot);
    return plot;
}

/* ---- shapes ------------------------------------------------------------- */

/* Whether it has axes: then it is cut at its box. */
static bool has_axes(const Plot *plot)
{
    return plot->x.high > plot->x.low;
}

/* The line between two pixels, as far as it is inside; NaN draws nothing. */
static void draw_line(const Plot *plot, const double *a, const double *b,
                      double width, Colour colour)
{
    double line[4] = {a[0], a[1], b[0], b[1]};
    if (!has_axes(plot) || box_cut(&plot->box, 0, line))
        paper_line(plot->paper, line, line + 2, width, colour);
}

void plot_line(const Plot *plot, const double *a, const double *b, double width,
               Colour colour)
{
    double p[2], q[2];
    plot_place(plot, a, p);
    plot_place(plot, b, q);
    draw_line(plot, p, q, width, colour);
}

void plot_dashes(const Plot *plot, const double *a, const double *b,
                 double width, double *phase, Colour colour)
{
    Paper *paper = plot->paper;
    double p[2], q[2];
    plot_place(plot, a, p);
    plot_place(plot, b, q);
    canvas_dashes(&paper->canvas, p[0], p[1], q[0], q[1],
                  fmax(1, width * paper->unit), 5 * paper->unit,
                  4 * paper->unit, phase, colour);
}

/* Moves the end of a line from p to q to the middle between two pixels of the
 * direction in which it is longer, so that the next line begins where no pixel
 * is covered by parts of both: their joint would be paler. */
static void end_between_pixels(const double p[2], double q[2])
{
    double dx = q[0] - p[0], dy = q[1] - p[1];
    int k = fabs(dx) >= fabs(dy) ? 0 : 1;
    double along = k == 0 ? dx : dy, across = k == 0 ? dy : dx;
    double end = floor(q[k] + 0.5);
    q[1 - k] += (end - q[k]) * across / along;
    q[k] = end;
}

void plot_curve(const Plot *plot, int count, const double *x, const double *y,
                double width, Colour colour)
{
    double p[2] = {NAN, NAN};
    for (int i = 0; i < count; i++) {
        double q[2];
        plot_place(plot, (double[2]){x[i], y[i]}, q);
        if (isfinite(p[0] + p[1]) && isfinite(q[0] + q[1])) {
            if (fabs(q[0] - p[0]) < 1 && fabs(q[1] - p[1]) < 1 && i + 1 < count)
                continue; /* less than a pixel: wait for the next point */
            end_between_pixels(p, q);
            draw_line(plot, p, q, width, colour);
        }
        memcpy(p, q, sizeof p);
    }
}

void plot_graph(const Plot *plot, double (*y)(const void *data, double x),
                const void *data, double width, Colour colour)
{
    double at[PLOT_POINTS + 1], value[PLOT_POINTS + 1], low = plot->x.low;
    for (int i = 0; i <= PLOT_POINTS; i++) {
        at[i] = low + (plot->x.high - low) * i / PLOT_POINTS;
        value[i] = y(data, at[i]);
    }
    plot_curve(plot, PLOT_POINTS + 1, at, value, width, colour);
}

bool plot_disc(const Plot *plot, const double *at, double radius, Colour colour)
{
    double p[2];
    if (has_axes(plot) && !(at[0] >= plot->x.low && at[0] <= plot->x.high &&
                            at[1] >= plot->y.low && at[1] <= plot->y.high))
        return false;
    plot_place(plot, at, p);
    canvas_disc(&plot->paper->canvas, p[0], p[1], radius * plot->paper->unit,
                colour);
    return true;
}

void plot_hollow(const Plot *plot, const double *at, double radius,
                 double inner, Colour colour)
{
    if (plot_disc(plot, at, radius, colour))
        plot_disc(plot, at, inner, COLOUR_WHITE);
}

void plot_ring(const Plot *plot, const double *at, double radius, double width,
               Colour colour)
{
    double p[2], unit = plot->paper->unit;
    plot_place(plot, at, p);
    canvas_ring(&plot->paper->canvas, p[0], p[1], radius * unit,
                fmax(1, width * unit), colour);
}

/* A dark square with a light middle. */
void plot_pin(const Plot *plot, const double *at, double radius)
{
    Canvas *canvas = &plot->paper->canvas;
    double p[2], size = fmax(radius, 3) * plot->paper->unit * 1.15;
    plot_place(plot, at, p);
    if (!(fabs(p[0]) < 1e6 && fabs(p[1]) < 1e6))
        return;
    Box box = {(int)floor(p[0] - size + 0.5), (int)floor(p[1] - size + 0.5),
               (int)(2 * size + 0.5), (int)(2 * size + 0.5)};
    canvas_rectangle(canvas, box.x, box.y, box.width, box.height, COLOUR_TEXT);
    box = box_inset(box, (int)fmax(1, 0.45 * size));
    canvas_rectangle(canvas, box.x, box.y, box.width, box.height, COLOUR_WHITE);
}

void plot_arrow(const Plot *plot, const double *a, const double *d,
                double factor, double width, Colour colour)
{
    Paper *paper = plot->paper;
    const double b[2] = {a[0] + factor * d[0], a[1] + factor * d[1]};
    double p[2], q[2];
    Box before = canvas_clip(&paper->canvas, plot->box);
    plot_place(plot, a, p);
    plot_place(plot, b, q);
    canvas_arrow(&paper->canvas, p[0], p[1], q[0], q[1],
                 fmax(1, width * paper->unit), HEAD * paper->em, colour);
    canvas_clip(&paper->canvas, before);
}

/* The longest of d [2n], those that are not finite left out. */
static double longest_arrow(int nodes, const double *d)
{
    double most = 0;
    for (int i = 0; i < nodes; i++) {
        double length = math_hypot(d[2 * i], d[2 * i + 1]);
        if (isfinite(length) && length > most)
            most = length;
    }
    return most;
}

double plot_arrows(const Plot *plot, int nodes, int stride, const double *x,
                   const double *d, double part, double most, Colour colour)
{
    double scale = plot->camera.scale[0], factor = 1;
    double length = longest_arrow(nodes, d) * scale;
    double least = fmin(ARROW_LEAST * plot->em, 0.1 * most);
    if (!(length > 0) || !isfinite(length))
        return 0;
    if (length < least)
        factor = pow(10, ceil(log10(least / length)));
    if (length > most)
        factor = pow(10, -ceil(log10(length / most)));
    for (int i = 0; i < nodes; i += stride)
        if (math_hypot(d[2 * i], d[2 * i + 1]) * factor * scale > 1.5)
            plot_arrow(plot, x + 2 * i, d + 2 * i, part * factor, 1.6, colour);
    return factor;
}

void bounds_around(double reach, double most, double factor, double bounds[4])
{
    while (reach < most && reach < 1e100)
        reach *= factor;
    bounds[2] = bounds[3] = reach;
    bounds[0] = bounds[1] = -reach;
}
