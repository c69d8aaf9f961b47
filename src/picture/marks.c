#include "picture/marks.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "picture/colour_map.h"

static const double HEAD = 0.62;        /* ems, length of an arrow's head */
static const double ARROW_LEAST = 1.5;  /* ems, the longest arrow has */
static const double LEGEND_SIZE = 0.92; /* ems */
static const double SLAB = 1;           /* ems, depth of a thin wall */
static const double SCALE_PART = 0.2;   /* of the stage's width, the scale */

void stage_line(Paper *paper, const Stage *stage, const double *a,
                const double *b, double width, Colour colour)
{
    double p[2], q[2];
    stage_pixel(stage, a, p);
    stage_pixel(stage, b, q);
    paper_line(paper, p, q, width, colour);
}

void stage_dashes(Paper *paper, const Stage *stage, const double *a,
                  const double *b, double width, Colour colour)
{
    double p[2], q[2];
    stage_pixel(stage, a, p);
    stage_pixel(stage, b, q);
    canvas_dashes(&paper->canvas, p[0], p[1], q[0], q[1],
                  fmax(1, width * paper->unit), 5 * paper->unit,
                  4 * paper->unit, NULL, colour);
}

void stage_arrow(Paper *paper, const Stage *stage, const double *a,
                 const double *d, double factor, double width, Colour colour)
{
    const double b[2] = {a[0] + factor * d[0], a[1] + factor * d[1]};
    double p[2], q[2];
    stage_pixel(stage, a, p);
    stage_pixel(stage, b, q);
    canvas_arrow(&paper->canvas, p[0], p[1], q[0], q[1],
                 fmax(1, width * paper->unit), HEAD * paper->em, colour);
}

void stage_disc(Paper *paper, const Stage *stage, const double *a,
                double radius, Colour colour)
{
    double p[2];
    stage_pixel(stage, a, p);
    canvas_disc(&paper->canvas, p[0], p[1], radius, colour);
}

void stage_ring(Paper *paper, const Stage *stage, const double *a,
                double radius, double width, Colour colour)
{
    double p[2];
    stage_pixel(stage, a, p);
    canvas_ring(&paper->canvas, p[0], p[1], radius,
                fmax(1, width * paper->unit), colour);
}

void keep_off_line(Labels *labels, const Stage *stage, const double *a,
                   const double *b)
{
    double p[2], q[2];
    stage_pixel(stage, a, p);
    stage_pixel(stage, b, q);
    labels_line(labels, p, q);
}

void keep_off_disc(Labels *labels, const Paper *paper, const Stage *stage,
                   const double *a, double radius)
{
    double p[2];
    stage_pixel(stage, a, p);
    labels_disc(labels, p, radius * paper->unit);
}

/* A dark square with a light middle. */
void stage_pin(Paper *paper, const Stage *stage, const double *a, double radius)
{
    double p[2], size = fmax(radius, 3 * paper->unit) * 1.15;
    stage_pixel(stage, a, p);
    if (!(fabs(p[0]) < 1e6 && fabs(p[1]) < 1e6))
        return;
    Box box = {(int)floor(p[0] - size + 0.5), (int)floor(p[1] - size + 0.5),
               (int)(2 * size + 0.5), (int)(2 * size + 0.5)};
    canvas_rectangle(&paper->canvas, box.x, box.y, box.width, box.height,
                     COLOUR_TEXT);
    box = box_inset(box, (int)fmax(1, 0.45 * size));
    canvas_rectangle(&paper->canvas, box.x, box.y, box.width, box.height,
                     COLOUR_WHITE);
}

/* The longest of d [2n], those that are not finite left out. */
static double longest_arrow(int nodes, const double *d)
{
    double most = 0;
    for (int i = 0; i < nodes; i++) {
        double length = hypot(d[2 * i], d[2 * i + 1]);
        if (isfinite(length) && length > most)
            most = length;
    }
    return most;
}

double stage_arrows(Paper *paper, const Stage *stage, int nodes, int stride,
                    const double *x, const double *d, double part, double most,
                    Colour colour)
{
    double scale = stage->camera.scale[0], factor = 1;
    double length = longest_arrow(nodes, d) * scale;
    double least = fmin(ARROW_LEAST * paper->em, 0.1 * most);
    if (!(length > 0) || !isfinite(length))
        return 0;
    if (length < least)
        factor = pow(10, ceil(log10(least / length)));
    if (length > most)
        factor = pow(10, -ceil(log10(length / most)));
    for (int i = 0; i < nodes; i += stride)
        if (hypot(d[2 * i], d[2 * i + 1]) * factor * scale > 1.5)
            stage_arrow(paper, stage, x + 2 * i, d + 2 * i, part * factor, 1.6,
                        colour);
    return factor;
}

/* ---- obstacles ---------------------------------------------------------- */

/* The half plane as two triangles that reach beyond the stage, or a slab. */
static void draw_wall(Paper *paper, const Stage *stage, const Obstacle *wall,
                      double reach, bool thin)
{
    const Box *box = &stage->box;
    const double *n = wall->n;
    double middle[2], p[4][2];
    camera_world(&stage->camera, box->x + 0.5 * box->width,
                 box->y + 0.5 * box->height, middle);
    double far = 2 * (box->width + box->height) / stage->camera.scale[0];
    double t[2] = {n[1], -n[0]};
    double along =
        (middle[0] - wall->o[0]) * t[0] + (middle[1] - wall->o[1]) * t[1];
    double foot[2] = {wall->o[0] + along * t[0], wall->o[1] + along * t[1]};
    const double a[2] = {foot[0] - far * t[0], foot[1] - far * t[1]};
    const double b[2] = {foot[0] + far * t[0], foot[1] + far * t[1]};
    double deep = thin ? SLAB * paper->em / stage->camera.scale[0] : far;
    const double c[2] = {b[0] - deep * n[0], b[1] - deep * n[1]};
    const double d[2] = {a[0] - deep * n[0], a[1] - deep * n[1]};
    stage_pixel(stage, a, p[0]);
    stage_pixel(stage, b, p[1]);
    stage_pixel(stage, c, p[2]);
    stage_pixel(stage, d, p[3]);
    for (int k = 0; k < 2; k++) {
        const double corners[6] = {p[0][0],     p[0][1],     p[1 + k][0],
                                   p[1 + k][1], p[2 + k][0], p[2 + k][1]};
        canvas_triangle(&paper->canvas, corners, false, COLOUR_SOLID);
    }
    stage_line(paper, stage, a, b, 1.5, COLOUR_EDGE);
    const double a2[2] = {a[0] + reach * n[0], a[1] + reach * n[1]};
    const double b2[2] = {b[0] + reach * n[0], b[1] + reach * n[1]};
    if (reach * stage->camera.scale[0] > 2)
        stage_dashes(paper, stage, a2, b2, 1, COLOUR_GREY);
}

void stage_obstacles(Paper *paper, const Stage *stage, const Contact *contact,
                     const double *x, bool thin)
{
    double scale = stage->camera.scale[0], reach = contact->barrier.d_hat;
    for (int i = 0; i < contact->obstacles; i++) {
        const Obstacle *obstacle = &contact->obstacle[i];
        const double *at = obstacle_point(obstacle, x);
        double radius = obstacle->radius * scale;
        if (obstacle->kind == OBSTACLE_WALL) {
            draw_wall(paper, stage, obstacle, reach, thin);
            continue;
        }
        stage_disc(paper, stage, at, radius, COLOUR_SOLID);
        stage_ring(paper, stage, at, radius, 1.5, COLOUR_EDGE);
        if (reach * scale > 2)
            stage_ring(paper, stage, at, radius + reach * scale, 0.8,
                       COLOUR_RULE);
    }
}

/* ---- words -------------------------------------------------------------- */

/* 1, 2 or 5 times a power of ten metres. */
void stage_scale(Paper *paper, const Stage *stage)
{
    const Box *box = &stage->box;
    double scale = stage->camera.scale[0];
    double metres = plot_round_up(SCALE_PART * box->width / scale / 2.5);
    double length = metres * scale, x = box->x + paper->em;
    double y = floor(box->y + box->height - 0.9 * paper->em) + 0.5;
    const char *name = "m";
    double shown = metres;
    if (!(length > 4) || !isfinite(length) || length > 0.6 * box->width)
        return;
    if (metres >= 1000) {
        name = "km";
        shown = metres / 1000;
    } else if (metres < 0.01) {
        name = "mm";
        shown = metres * 1000;
    }
    char number[48];
    plot_number(number, sizeof number, shown);
    canvas_rectangle(&paper->canvas, (int)(x - 0.4 * paper->em),
                     (int)(y - 1.4 * paper->em),
                     (int)(length + 0.8 * paper->em), paper_pixels(paper, 1.8),
                     COLOUR_PANEL);
    canvas_line(&paper->canvas, x, y, x + length, y, fmax(1, 1.5 * paper->unit),
                COLOUR_GREY);
    for (int k = 0; k < 2; k++)
        canvas_line(&paper->canvas, x + k * length, y - 0.25 * paper->em,
                    x + k * length, y + 0.25 * paper->em,
                    fmax(1, 1.5 * paper->unit), COLOUR_GREY);
    paper_write(paper, FACE_REGULAR, 0.85, COLOUR_FAINT, x + 0.5 * length,
                y - 1.4 * paper->em, ALIGN_CENTRE, "%s %s", number, name);
}

/* The next words of the legend after `before` pixels for a sign. */
static void legend_words(Paper *paper, const Stage *stage, Legend *legend,
                         int before, Colour colour, const char *format,
                         va_list arguments)
{
    char words[128];
    vsnprintf(words, sizeof words, format, arguments);
    int width = before + paper_width(paper, FACE_REGULAR, LEGEND_SIZE, words);
    int margin = paper_pixels(paper, 0.9);
    if (legend->x > 0 && legend->x + width > stage->box.width - 2 * margin) {
        legend->x = 0;
        legend->y += paper_pixels(paper, 1.35);
    }
    double x = stage->box.x + margin + legend->x;
    double y = stage->box.y + 0.6 * paper->em + legend->y;
    int air = paper_pixels(paper, 0.3); /* the picture may reach up to here */
    canvas_rectangle(&paper->canvas, (int)x - air, (int)y, width + 2 * air,
                     paper_pixels(paper, 1.25), COLOUR_PANEL);
    if (before > 0) {
        double middle = y + 0.65 * LEGEND_SIZE * paper->em;
        double length = before - 0.6 * paper->em;
        canvas_arrow(&paper->canvas, x, middle, x + length, middle,
                     fmax(1, 1.8 * paper->unit), HEAD * paper->em, colour);
    }
    paper_write(paper, FACE_REGULAR, LEGEND_SIZE, colour, x + before, y,
                ALIGN_LEFT, "%s", words);
    legend->x += width + paper_pixels(paper, 1.6);
}

void stage_legend(Paper *paper, const Stage *stage, Legend *legend,
                  Colour colour, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    legend_words(paper, stage, legend, 0, colour, format, arguments);
    va_end(arguments);
}

void stage_key(Paper *paper, const Stage *stage, Legend *legend, double length,
               Colour colour, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    legend_words(paper, stage, legend, paper_pixels(paper, length + 0.6),
                 colour, format, arguments);
    va_end(arguments);
}

const StageRoom stage_room = {3.2, 4, 2.4, 4.2};

/* What the camera sees from low to high. */
static void set_range(Axis *axis, double low, double high)
{
    axis->low = axis->log ? pow(10, low) : low;
    axis->high = axis->log ? pow(10, high) : high;
}

Plot stage_plot(Paper *paper, const Stage *stage, const StageRoom *room, Axis x,
                Axis y)
{
    Plot plot = {stage->box, x, y};
    double low[2], high[2];
    if (stage->text) {
        plot.box.x += paper_pixels(paper, room->left);
        plot.box.width -= paper_pixels(paper, room->wide);
        plot.box.y += paper_pixels(paper, room->above);
        plot.box.height -= paper_pixels(paper, room->high);
        if (plot.box.width < 1 || plot.box.height < 1)
            plot.box = stage->box;
    }
    Box box = plot.box;
    camera_world(&stage->camera, box.x, box.y + box.height, low);
    camera_world(&stage->camera, box.x + box.width, box.y, high);
    set_range(&plot.x, low[0], high[0]);
    if (y.high == 0)
        set_range(&plot.y, low[1], high[1]);
    if (stage->text)
        plot_axes(paper, &plot);
    return plot;
}

void bounds_around(double reach, double most, double factor, double bounds[4])
{
    while (reach < most && reach < 1e100)
        reach *= factor;
    bounds[2] = bounds[3] = reach;
    bounds[0] = bounds[1] = -reach;
}

Box stage_note(Paper *paper, const Stage *stage, double x, double y, int width,
               int height, Box body)
{
    const Box *box = &stage->box;
    int margin = paper_pixels(paper, 0.7), apart = paper_pixels(paper, 1.1);
    int right = box->x + box->width, low = box->y + box->height;
    Box note = {(int)x + apart, (int)y + apart, width + 2 * margin,
                height + 2 * margin};
    if (note.x + note.width > right)
        note.x = (int)x - apart - note.width;
    if (body.width > 0) { /* right of it, left, below, above */
        int beyond = body.x + body.width + apart, under = body.y + body.height;
        if (beyond + note.width <= right)
            note.x = beyond;
        else if (body.x - apart - note.width >= box->x)
            note.x = body.x - apart - note.width;
        else if (under + apart + note.height <= low)
            note.y = under + apart;
        else if (body.y - apart - note.height >= box->y)
            note.y = body.y - apart - note.height;
    }
    if (note.y + note.height > low)
        note.y = low - note.height;
    note.x = note.x < box->x ? box->x : note.x;
    note.y = note.y < box->y ? box->y : note.y;
    canvas_card(&paper->canvas, note, 0.4 * paper->em, COLOUR_NOTE,
                COLOUR_GREY);
    return box_inset(note, margin);
}
