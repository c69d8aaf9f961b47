#include "picture/landscape_picture.h"

#include <math.h>
#include <stdio.h>

#include "picture/colour_map.h"
#include "scenes/landscape_scene.h"
#include "picture/panels.h"
#include "picture/plot.h"

enum { MAP_CELLS = 120, MAP_LABEL_ROOM = 24, MAP_NUMBER_ROOM = 12 };

static const double MAP_REACH = 1.7; /* m, at least, up, down, left, right */

/* J s^2; both valleys have their bottom below 1. */
static const double map_levels[] = {0.4, 0.6, 1,  1.5, 2,  3,
                                    5,   7,   10, 15,  30, 50};
enum { MAP_LEVELS = sizeof map_levels / sizeof *map_levels };

/* Axes with the same scale that fill the box. */
static Plot map_in_box(Box box)
{
    double scale = fmin(box.width, box.height) / (2 * MAP_REACH);
    double across = 0.5 * box.width / scale, up = 0.5 * box.height / scale;
    return (Plot){box, {-across, across, "x in m"}, {-up, up, "y in m"}};
}

/* The map alone, or in the middle of the texts. */
static Plot map_plot(const Paper *paper, bool text)
{
    Box whole = {0, 0, paper->canvas.width, paper->canvas.height};
    return map_in_box(text ? plot_inner_box(paper, panels_middle_box(paper))
                           : whole);
}

/* Inverse of plot_place. */
bool landscape_picture_pick(const Paper *paper, bool text, double x, double y,
                            double *point)
{
    Plot plot = map_plot(paper, text && paper_shows_text(paper));
    double a = (x - plot.box.x) / plot.box.width;
    double b = (y - plot.box.y) / plot.box.height;
    if (!(a >= 0 && a <= 1 && b >= 0 && b <= 1))
        return false;
    point[0] = plot.x.low + a * (plot.x.high - plot.x.low);
    point[1] = plot.y.high - b * (plot.y.high - plot.y.low);
    return true;
}

/* Two by two pixels at a time. */
static void shade_map(Paper *paper, const Plot *plot,
                      const Simulation *simulation)
{
    const Box *box = &plot->box;
    double metre = (plot->x.high - plot->x.low) / box->width;
    for (int j = 0; j < box->height; j += 2)
        for (int i = 0; i < box->width; i += 2)
            if (!landscape_is_convex(simulation, plot->x.low + (i + 1) * metre,
                                     plot->y.high - (j + 1) * metre))
                canvas_rectangle(&paper->canvas, box->x + i, box->y + j, 2, 2,
                                 COLOUR_SHADE);
}

/* Coordinate of grid line i of MAP_CELLS. */
static double map_grid(const Axis *axis, int i)
{
    return axis->low + (axis->high - axis->low) * i / MAP_CELLS;
}

/* Where the level is crossed between two corners with values e; a corner is a
 * point and its value.  Returns how many crossings were added to `out`. */
static int cross_edge(const double a[3], const double b[3], double level,
                      double *out)
{
    if ((a[2] < level) == (b[2] < level))
        return 0;
    double t = (level - a[2]) / (b[2] - a[2]);
    out[0] = a[0] + t * (b[0] - a[0]);
    out[1] = a[1] + t * (b[1] - a[1]);
    return 1;
}

/* The piece of a contour in one cell, drawn in its two triangles. */
static void draw_cell(Paper *paper, const Plot *plot, const double corner[4][3],
                      double level)
{
    static const int triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    for (int k = 0; k < 2; k++) {
        double ends[3][2];
        int count = 0;
        for (int i = 0; i < 3; i++)
            count += cross_edge(corner[triangles[k][i]],
                                corner[triangles[k][(i + 1) % 3]], level,
                                ends[count]);
        if (count == 2)
            plot_line(paper, plot, ends[0], ends[1], 0.6, COLOUR_CONTOUR);
    }
}

/* All levels in one cell. */
static void draw_levels(Paper *paper, const Plot *plot,
                        const double corner[4][3])
{
    double least = fmin(fmin(corner[0][2], corner[1][2]),
                        fmin(corner[2][2], corner[3][2]));
    double most = fmax(fmax(corner[0][2], corner[1][2]),
                       fmax(corner[2][2], corner[3][2]));
    for (int k = 0; k < MAP_LEVELS; k++)
        if (map_levels[k] >= least && map_levels[k] <= most)
            draw_cell(paper, plot, corner, map_levels[k]);
}

/* Cell by cell. */
static void draw_contours(Paper *paper, const Plot *plot,
                          const Simulation *simulation)
{
    double E[MAP_CELLS + 1][MAP_CELLS + 1];
    for (int i = 0; i <= MAP_CELLS; i++)
        for (int j = 0; j <= MAP_CELLS; j++)
            E[i][j] = landscape_value(simulation, map_grid(&plot->x, i),
                                      map_grid(&plot->y, j));
    for (int i = 0; i < MAP_CELLS; i++)
        for (int j = 0; j < MAP_CELLS; j++) {
            double x = map_grid(&plot->x, i), right = map_grid(&plot->x, i + 1);
            double y = map_grid(&plot->y, j), above = map_grid(&plot->y, j + 1);
            const double corner[4][3] = {{x, y, E[i][j]},
                                         {right, y, E[i + 1][j]},
                                         {right, above, E[i + 1][j + 1]},
                                         {x, above, E[i][j + 1]}};
            draw_levels(paper, plot, corner);
        }
}

/* The value of a contour on it, on a piece of background. */
static void draw_level_number(Paper *paper, const Plot *plot, double x,
                              double y, double level)
{
    char text[16];
    double at[2];
    snprintf(text, sizeof text, "%g", level);
    plot_place(plot, x, y, at);
    int width = font_width(&paper->font, text), height = paper->font.height;
    Box back = {(int)at[0] - width / 2, (int)at[1] - height / 2, width, height};
    paper_panel(paper, back);
    paper_text(paper, (int)at[0], back.y, ALIGN_CENTRE, COLOUR_FAINT, text);
}

/* Numbers where contours cross a level line from x0 to x1, as far as they do
 * not get into each other's way. */
static void draw_level_numbers(Paper *paper, const Plot *plot,
                               const Simulation *simulation, double x0,
                               double x1, double y)
{
    double unit = (plot->x.high - plot->x.low) / plot->box.width * paper->unit;
    double step = x1 > x0 ? unit : -unit, last = x0;
    double before = landscape_value(simulation, x0, y);
    int count = (int)(fabs(x1 - x0) / unit) - MAP_NUMBER_ROOM;
    for (int i = 1; i <= count; i++) {
        double x = x0 + i * step, E = landscape_value(simulation, x, y);
        for (int k = 0; k < MAP_LEVELS; k++)
            if ((before < map_levels[k]) != (E < map_levels[k]) &&
                fabs(x - last) >= MAP_LABEL_ROOM * unit) {
                draw_level_number(paper, plot, x, y, map_levels[k]);
                last = x;
            }
        before = E;
    }
}

/* The two springs and their pins. */
static void draw_pinned_springs(Paper *paper, const Plot *plot,
                                const Simulation *simulation)
{
    const System *system = &simulation->system;
    const double *x = simulation->run[0].x;
    for (int s = 0; s < system->springs; s++)
        plot_line(paper, plot, x + 2 * system->e[2 * s],
                  x + 2 * system->e[2 * s + 1], 2, COLOUR_REST);
    for (int i = 1; i < system->nodes; i++)
        plot_disc(paper, plot, x + 2 * i, 5, COLOUR_FAINT);
}

/* From a along p, with a head where alpha = 1 would lead. */
static void draw_arrow(Paper *paper, const Plot *plot, const double *a,
                       const double *p, Colour colour)
{
    const double tip[2] = {a[0] + p[0], a[1] + p[1]};
    double unit = (plot->x.high - plot->x.low) / plot->box.width * paper->unit;
    double length = hypot(p[0], p[1]), head = 6 * unit;
    plot_line(paper, plot, a, tip, 1, colour);
    if (!(length > head))
        return;
    for (int side = -1; side <= 1; side += 2) {
        const double end[2] = {
            tip[0] - head * (p[0] - 0.5 * side * p[1]) / length,
            tip[1] - head * (p[1] + 0.5 * side * p[0]) / length};
        plot_line(paper, plot, tip, end, 1, colour);
    }
}

/* Each update: thin its whole direction p, thick alpha p. */
static void draw_updates(Paper *paper, const Plot *plot, const Descent *descent)
{
    for (int i = 0; i < descent->count; i++) {
        const NewtonRecord *record = &descent->record[i];
        const double *from = record->from, *to = record->to;
        Colour colour = record->slope > 0 ? COLOUR_WARNING : COLOUR_COMPRESS;
        if (record->alpha > 0) {
            const double p[2] = {(to[0] - from[0]) / record->alpha,
                                 (to[1] - from[1]) / record->alpha};
            draw_arrow(paper, plot, from, p, colour);
        }
        plot_line(paper, plot, from, to, 2.5, colour);
        plot_disc(paper, plot, from, 3.5, colour);
    }
}

/* The direction from here, and here. */
static void draw_direction(Paper *paper, const Plot *plot,
                           const Descent *descent)
{
    const double *p = descent->direction;
    if (p[0] != 0 || p[1] != 0)
        draw_arrow(paper, plot, descent->point, p,
                   descent->slope > 0 ? COLOUR_WARNING : COLOUR_TEXT);
    plot_disc(paper, plot, descent->point, 5, COLOUR_TEXT);
}

/* What is drawn, in words. */
static void draw_map_legend(Paper *paper)
{
    TextBlock columns[3] = {0};
    text_block_add(&columns[0], COLOUR_FAINT, "lines: E in J s^2");
    text_block_add(&columns[0], COLOUR_SHADED, "shade: E not convex");
    text_block_add(&columns[1], COLOUR_COMPRESS, "update downhill");
    text_block_add(&columns[1], COLOUR_WARNING, "uphill");
    text_block_add(&columns[2], COLOUR_TEXT, "arrow: next p");
    text_block_add(&columns[2], COLOUR_FAINT, "grey: springs, pins");
    panels_draw_columns(paper, columns, 3);
}

/* From the ground up. */
void landscape_picture_draw(Paper *paper, const Simulation *simulation,
                            bool text)
{
    Plot plot = map_plot(paper, text);
    if (plot.box.width < 1 || plot.box.height < 1)
        return;
    if (text)
        plot_create(paper, panels_middle_box(paper), plot.x, plot.y);
    shade_map(paper, &plot, simulation);
    draw_contours(paper, &plot, simulation);
    draw_pinned_springs(paper, &plot, simulation);
    if (text) {
        double right = plot.x.high;
        draw_level_numbers(paper, &plot, simulation, 0, -right, 1.07);
        draw_level_numbers(paper, &plot, simulation, 0, right, -1.03);
        draw_level_numbers(paper, &plot, simulation, 0.6, right, 0.25);
    }
    draw_updates(paper, &plot, &simulation->descent);
    draw_direction(paper, &plot, &simulation->descent);
    if (!text)
        return;
    panels_draw_update(paper, simulation);
    draw_map_legend(paper);
}
