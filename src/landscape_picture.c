#include "landscape_picture.h"

#include <math.h>

#include "colour_map.h"
#include "landscape_scene.h"
#include "text_block.h"

enum { MAP_CELLS = 120, MAP_LEVELS = 24 };

static const double MAP_REACH = 1.8; /* m, from the middle to each side */

/* The map fills the smaller side. */
static Mapping map_mapping(const Paper *paper)
{
    return paper_mapping(paper, 2 * MAP_REACH, 1);
}

/* Inverse of the mapping. */
void landscape_picture_pick(const Paper *paper, double x, double y,
                            double *point)
{
    Mapping mapping = map_mapping(paper);
    point[0] = (x - mapping.x0) / mapping.scale;
    point[1] = (mapping.y0 - y) / mapping.scale;
}

/* A line between two points in metres. */
static void draw_map_line(Paper *paper, const double *a, const double *b,
                          double width, Colour colour)
{
    Mapping mapping = map_mapping(paper);
    canvas_line(&paper->canvas, mapping.x0 + mapping.scale * a[0],
                mapping.y0 - mapping.scale * a[1],
                mapping.x0 + mapping.scale * b[0],
                mapping.y0 - mapping.scale * b[1], fmax(1, width * paper->unit),
                colour);
}

/* A disc at a point in metres. */
static void draw_map_disc(Paper *paper, const double *a, double radius,
                          Colour colour)
{
    Mapping mapping = map_mapping(paper);
    canvas_disc(&paper->canvas, mapping.x0 + mapping.scale * a[0],
                mapping.y0 - mapping.scale * a[1], radius * paper->unit,
                colour);
}

/* Coordinate of grid line i, m. */
static double map_grid(int i)
{
    return MAP_REACH * (2.0 * i / MAP_CELLS - 1);
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
static void draw_cell(Paper *paper, const double corner[4][3], double level)
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
            draw_map_line(paper, ends[0], ends[1], 0.5, COLOUR_CONTOUR);
    }
}

/* Levels grow like the squares: close together near the bottom. */
static void draw_levels(Paper *paper, const double corner[4][3], double low,
                        double high)
{
    double least = fmin(fmin(corner[0][2], corner[1][2]),
                        fmin(corner[2][2], corner[3][2]));
    double most = fmax(fmax(corner[0][2], corner[1][2]),
                       fmax(corner[2][2], corner[3][2]));
    for (int k = 1; k < MAP_LEVELS; k++) {
        double part = (double)k / MAP_LEVELS;
        double level = low + part * part * part * (high - low);
        if (level >= least && level <= most)
            draw_cell(paper, corner, level);
    }
}

/* All contours. */
static void draw_contours(Paper *paper, const Simulation *simulation)
{
    double E[MAP_CELLS + 1][MAP_CELLS + 1], low = INFINITY, high = -INFINITY;
    for (int i = 0; i <= MAP_CELLS; i++)
        for (int j = 0; j <= MAP_CELLS; j++) {
            E[i][j] = landscape_value(simulation, map_grid(i), map_grid(j));
            low = fmin(low, E[i][j]);
            high = fmax(high, E[i][j]);
        }
    for (int i = 0; i < MAP_CELLS; i++)
        for (int j = 0; j < MAP_CELLS; j++) {
            double x = map_grid(i), right = map_grid(i + 1);
            double y = map_grid(j), above = map_grid(j + 1);
            const double corner[4][3] = {{x, y, E[i][j]},
                                         {right, y, E[i + 1][j]},
                                         {right, above, E[i + 1][j + 1]},
                                         {x, above, E[i][j + 1]}};
            draw_levels(paper, corner, low, high);
        }
}

/* The two springs and their pins. */
static void draw_pinned_springs(Paper *paper, const Simulation *simulation)
{
    const System *system = &simulation->system;
    const double *x = simulation->run[0].x;
    for (int s = 0; s < system->springs; s++)
        draw_map_line(paper, x + 2 * system->e[2 * s],
                      x + 2 * system->e[2 * s + 1], 0.8, COLOUR_REST);
    for (int i = 1; i < system->nodes; i++)
        draw_map_disc(paper, x + 2 * i, 4, COLOUR_FAINT);
}

/* Each update: blue downhill, red uphill. */
static void draw_updates(Paper *paper, const Descent *descent)
{
    for (int i = 0; i < descent->count; i++) {
        const NewtonRecord *record = &descent->record[i];
        Colour colour = record->slope > 0 ? COLOUR_WARNING : COLOUR_COMPRESS;
        draw_map_line(paper, record->from, record->to, 1.5, colour);
        draw_map_disc(paper, record->from, 3, colour);
    }
}

/* The direction from here: orange before it is tried, red if it failed. */
static void draw_direction(Paper *paper, const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    const double *p = descent->direction;
    Colour colour = COLOUR_STRETCH;
    if (simulation->done && simulation->status != STATUS_OK) {
        p = simulation->run[0].newton->p;
        colour = COLOUR_WARNING;
    }
    const double ahead[2] = {descent->point[0] + p[0],
                             descent->point[1] + p[1]};
    draw_map_line(paper, descent->point, ahead, 1, colour);
    draw_map_disc(paper, descent->point, 4.5, COLOUR_TEXT);
}

/* What is drawn, in words. */
void landscape_picture_legend(Paper *paper)
{
    TextBlock block = {0};
    text_block_add(&block, COLOUR_FAINT,
                   "contours of E(x, y), the pins at x = -1 m and 1 m");
    text_block_add(&block, COLOUR_COMPRESS, "update downhill");
    text_block_add(&block, COLOUR_WARNING, "update or direction uphill");
    text_block_add(&block, COLOUR_STRETCH, "next direction p");
    Box size = text_block_size(&block, paper);
    int edge = paper_pixels(paper, 5);
    text_block_draw(&block, paper, edge,
                    paper->canvas.height - edge - size.height, ALIGN_LEFT);
}

/* From the ground up. */
void landscape_picture_draw(Paper *paper, const Simulation *simulation)
{
    draw_contours(paper, simulation);
    draw_pinned_springs(paper, simulation);
    draw_updates(paper, &simulation->descent);
    draw_direction(paper, simulation);
}
