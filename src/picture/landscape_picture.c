#include <math.h>
#include <stdio.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/handles.h"
#include "scenes/small_scenes.h"

enum { MAP_CELLS = 120, MAP_LABEL_ROOM = 54, MAP_NUMBER_ROOM = 27 };

/* J s^2; both valleys have their bottom below 1. */
static const double map_levels[] = {0.4, 0.6, 1,  1.5, 2,  3,
                                    5,   7,   10, 15,  30, 50};
enum { MAP_LEVELS = sizeof map_levels / sizeof *map_levels };

/* ---- the map, drawn once for a view of it ------------------------------- */

/* Two by two pixels at a time. */
static void shade_map(Paper *paper, const Plot *plot,
                      const Simulation *simulation)
{
    const Box *box = &plot->box;
    double metre = (plot->x.high - plot->x.low) / box->width;
    for (int j = 0; j < box->height; j += 2)
        for (int i = 0; i < box->width; i += 2)
            if (descent_bends_down(simulation, plot->x.low + (i + 1) * metre,
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
            plot_line(paper, plot, ends[0], ends[1], 0.6, COLOUR_GREY);
    }
}

/* With a long step elasticity is large: the levels grow with h^2 then. */
static double level_factor(const Simulation *simulation)
{
    double h = simulation->run[0].h / 0.2;
    bool elastic = (simulation->exhibit.parts & PART_ELASTICITY) != 0;
    return elastic && h > 1 ? h * h : 1;
}

/* E on the map: the parts that are switched on, over the factor. */
static double map_value(const Simulation *simulation, double x, double y)
{
    return landscape_part_value(simulation, simulation->exhibit.parts, x, y) /
           level_factor(simulation);
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
            E[i][j] = map_value(simulation, map_grid(&plot->x, i),
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
    char text[48];
    double at[2];
    plot_number(text, sizeof text, level);
    plot_place(plot, x, y, at);
    int width = paper_width(paper, FACE_REGULAR, 0.82, text);
    int height = paper_pixels(paper, 1.05);
    canvas_rectangle(&paper->canvas, (int)at[0] - width / 2 - 1,
                     (int)at[1] - height / 2, width + 2, height, COLOUR_PANEL);
    paper_write(paper, FACE_REGULAR, 0.82, COLOUR_FAINT, at[0],
                at[1] - 0.53 * paper->em, ALIGN_CENTRE, "%s", text);
}

/* Numbers where contours cross a level line from x0 to x1, as far as they do
 * not get into each other's way. */
static void draw_level_numbers(Paper *paper, const Plot *plot,
                               const Simulation *simulation, double x0,
                               double x1, double y)
{
    double unit = (plot->x.high - plot->x.low) / plot->box.width * paper->unit;
    double step = x1 > x0 ? unit : -unit, last = x0;
    double before = map_value(simulation, x0, y);
    double factor = level_factor(simulation);
    int count = (int)(fabs(x1 - x0) / unit) - MAP_NUMBER_ROOM;
    for (int i = 1; i <= count; i++) {
        double x = x0 + i * step, E = map_value(simulation, x, y);
        for (int k = 0; k < MAP_LEVELS; k++)
            if ((before < map_levels[k]) != (E < map_levels[k]) &&
                fabs(x - last) >= MAP_LABEL_ROOM * unit) {
                draw_level_number(paper, plot, x, y, factor * map_levels[k]);
                last = x;
            }
        before = E;
    }
}

/* Shade, contours and their numbers on a paper of the size of the map. */
static void draw_map(Paper *paper, const Plot *plot,
                     const Simulation *simulation, bool text)
{
    double right = plot->x.high;
    shade_map(paper, plot, simulation);
    draw_contours(paper, plot, simulation);
    if (!text)
        return;
    draw_level_numbers(paper, plot, simulation, 0, plot->x.low, 1.07);
    draw_level_numbers(paper, plot, simulation, 0, right, -1.03);
    draw_level_numbers(paper, plot, simulation, 0.6, right, 0.25);
}

/* What the map depends on. */
static uint64_t map_key(const Plot *plot, const Simulation *simulation,
                        bool text)
{
    const System *system = &simulation->system;
    size_t n = (size_t)system->nodes, s = (size_t)system->springs;
    const double axes[4] = {plot->x.low, plot->x.high, plot->y.low,
                            plot->y.high};
    uint64_t key = paper_key(0, axes, sizeof axes);
    key = paper_key(key, &simulation->run[0].h, sizeof(double));
    key = paper_key(key, &simulation->exhibit.parts, sizeof(unsigned));
    key = paper_key(key, simulation->exhibit.target, 2 * sizeof(double));
    key = paper_key(key, system->k, s * sizeof(double));
    key = paper_key(key, system->l2, s * sizeof(double));
    key = paper_key(key, system->m, n * sizeof(double));
    key =
        paper_key(key, simulation->run[0].x + 2, 2 * (n - 1) * sizeof(double));
    return paper_key(key, &text, sizeof text);
}

/* The map as it was kept, or drawn and kept. */
static void show_map(Paper *paper, const Plot *plot,
                     const Simulation *simulation, bool text)
{
    bool drawn = false;
    Canvas *kept = paper_keep(paper, KEEP_MAP, map_key(plot, simulation, text),
                              plot->box.width, plot->box.height, &drawn);
    if (!kept)
        return;
    if (!drawn) {
        Paper map = *paper;
        Plot inner = *plot;
        map.canvas = *kept;
        inner.box.x = inner.box.y = 0;
        draw_map(&map, &inner, simulation, text);
    }
    canvas_copy(&paper->canvas, kept, plot->box.x, plot->box.y);
}

/* ---- what moves on it --------------------------------------------------- */

/* The two springs and their pins. */
static void draw_pinned_springs(Paper *paper, const Plot *plot,
                                const Simulation *simulation)
{
    const System *system = &simulation->system;
    const double *x = simulation->run[0].x;
    for (int s = 0; s < system->springs; s++)
        plot_line(paper, plot, x + 2 * system->e[2 * s],
                  x + 2 * system->e[2 * s + 1], 3.5, COLOUR_REST);
}

/* From a to a + p, with a head where alpha = 1 would lead. */
static void draw_arrow(Paper *paper, const Plot *plot, const double *a,
                       const double *p, double width, Colour colour)
{
    const double b[2] = {a[0] + p[0], a[1] + p[1]};
    double from[2], to[2], unit = paper->unit;
    Box before = canvas_clip(&paper->canvas, plot->box);
    plot_place(plot, a[0], a[1], from);
    plot_place(plot, b[0], b[1], to);
    canvas_arrow(&paper->canvas, from[0], from[1], to[0], to[1],
                 fmax(1, width * unit), 11 * unit, colour);
    canvas_clip(&paper->canvas, before);
}

/* Each update: thin its whole direction p, thick alpha p; uphill in red. */
static void draw_updates(Paper *paper, const Plot *plot, const Descent *descent)
{
    for (int i = 0; i < descent->count; i++) {
        const NewtonRecord *record = &descent->record[i];
        const double *from = record->from, *to = record->to;
        Colour colour = record->slope > 0 ? COLOUR_WARNING : COLOUR_P;
        if (record->alpha > 0) {
            const double p[2] = {(to[0] - from[0]) / record->alpha,
                                 (to[1] - from[1]) / record->alpha};
            draw_arrow(paper, plot, from, p, 1.2, colour);
        }
        plot_line(paper, plot, from, to, 3.2, colour);
        plot_disc(paper, plot, from, 5, COLOUR_X);
    }
}

/* A direction with words at its tip. */
static void draw_named_direction(Paper *paper, const Plot *plot, Labels *labels,
                                 const double from[2], const double p[2],
                                 Colour colour, const char *name, double slope)
{
    const double tip[2] = {from[0] + p[0], from[1] + p[1]};
    double at[2], start[2], place[2][2];
    char words[80];
    draw_arrow(paper, plot, from, p, 2.2, colour);
    plot_place(plot, tip[0], tip[1], at);
    plot_place(plot, from[0], from[1], start);
    if (!box_contains(plot->box, at[0], at[1]))
        return;
    labels_line(labels, start, at);
    snprintf(words, sizeof words, "%s (slope %.2g)", name, slope);
    plot_numbers(words, sizeof words);
    double length = fmax(hypot(at[0] - start[0], at[1] - start[1]), 1e-9);
    for (int k = 0; k < 2; k++) { /* beside the tip, or further on */
        place[0][k] = at[k];
        place[1][k] = at[k] + 1.6 * paper->em * (at[k] - start[k]) / length;
    }
    labels_put(paper, labels, FACE_BOLD, 1, colour, (const double(*)[2])place,
               2, 0.8 * paper->em, words);
}

/* The direction that the run does not take: projected where its own is not, as
 * it is where its own is projected.  With a single part on the map: the
 * direction in that part. */
static void draw_other_direction(Paper *paper, const Plot *plot, Labels *labels,
                                 const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    unsigned parts = simulation->exhibit.parts;
    bool raw = simulation->options.filter == FILTER_NONE;
    double p[2], slope;
    if (descent->direction[0] == 0 && descent->direction[1] == 0)
        return;
    if (parts != PART_BOTH) {
        draw_named_direction(
            paper, plot, labels, descent->point, descent->direction,
            descent->slope > 0 ? COLOUR_WARNING : COLOUR_P,
            parts == PART_INERTIA ? "inertia alone" : "elasticity alone",
            descent->slope);
        return;
    }
    slope = descent_direction(simulation, raw ? FILTER_CLAMP : FILTER_NONE, p);
    if (hypot(p[0] - descent->direction[0], p[1] - descent->direction[1]) >
        1e-9)
        draw_named_direction(paper, plot, labels, descent->point, p,
                             slope > 0 ? COLOUR_WARNING : COLOUR_GHOST,
                             raw ? "with projection" : "without", slope);
}

/* The direction from here, and here. */
static void draw_direction(Paper *paper, const Plot *plot,
                           const Descent *descent, bool arrow)
{
    const double *p = descent->direction;
    if (arrow && (p[0] != 0 || p[1] != 0))
        draw_arrow(paper, plot, descent->point, p, 2.2,
                   descent->slope > 0 ? COLOUR_WARNING : COLOUR_P);
    plot_disc(paper, plot, descent->point, 7, COLOUR_TEXT);
}

static void draw_words(Paper *paper, const Stage *stage, const Descent *descent,
                       unsigned parts)
{
    Legend legend = {0, 0};
    stage_legend(paper, stage, &legend, COLOUR_FAINT,
                 "contours: %s in J s\u00b2",
                 parts == PART_BOTH      ? "E"
                 : parts == PART_INERTIA ? "inertia"
                                         : "elasticity");
    stage_legend(paper, stage, &legend, COLOUR_SHADED, "shade: not convex");
    stage_legend(paper, stage, &legend, COLOUR_P, "direction p, downhill");
    if (descent->slope > 0 ||
        (descent->count > 0 && descent->record[descent->count - 1].slope > 0))
        stage_legend(paper, stage, &legend, COLOUR_WARNING, "uphill");
}

/* The map, the springs and the pins. */
Plot landscape_ground(Paper *paper, const Stage *stage, const Show *show)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    const System *system = &simulation->system;
    Plot plot = stage_plot(paper, stage, &stage_room, (Axis){.label = "x in m"},
                           (Axis){0});
    show_map(paper, &plot, simulation, stage->text && !show->bare);
    draw_pinned_springs(paper, &plot, simulation);
    Box before = canvas_clip(&paper->canvas, plot.box);
    for (int i = 1; i < system->nodes; i++)
        stage_pin(paper, stage, simulation->run[0].x + 2 * i, 5 * paper->unit);
    canvas_clip(&paper->canvas, before);
    plot_disc(paper, &plot, simulation->exhibit.target, 6, COLOUR_X_TILDE);
    return plot;
}

/* Words keep off the iterate, its direction and x_tilde, which gets its own. */
static void keep_places(Paper *paper, const Stage *stage, const Show *show,
                        Labels *labels)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    const Descent *descent = &simulation->descent;
    const double tip[2] = {descent->point[0] + descent->direction[0],
                           descent->point[1] + descent->direction[1]};
    double target[2];
    stage_pixel(stage, simulation->exhibit.target, target);
    const System *system = &simulation->system;
    const double *x = simulation->run[0].x;
    for (int i = 0; i < 2; i++)
        labels_box(labels, stage_switch_box(stage, i));
    for (int s = 0; s < system->springs; s++)
        keep_off_line(labels, stage, x + 2 * system->e[2 * s],
                      x + 2 * system->e[2 * s + 1]);
    for (int i = 1; i < system->nodes; i++)
        keep_off_disc(labels, paper, stage, x + 2 * i, 14);
    keep_off_line(labels, stage, descent->point, tip);
    keep_off_disc(labels, paper, stage, descent->point, 11);
    labels_disc(labels, target, 11 * paper->unit);
    if (stage->text)
        labels_put(paper, labels, FACE_BOLD, 1.1, COLOUR_X_TILDE,
                   (const double(*)[2])target, 1, 0.9 * paper->em, "{xt}");
}

/* From the ground up. */
static void landscape_draw(Paper *paper, const Stage *stage, const Show *show)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    Plot plot = landscape_ground(paper, stage, show);
    draw_updates(paper, &plot, &simulation->descent);
    if (!show->bare) {
        Labels labels = {.stage = plot.box};
        keep_places(paper, stage, show, &labels);
        draw_other_direction(paper, &plot, &labels, simulation);
    }
    draw_direction(paper, &plot, &simulation->descent,
                   simulation->exhibit.parts == PART_BOTH);
    if (!show->bare && stage->text)
        draw_words(paper, stage, &simulation->descent,
                   simulation->exhibit.parts);
}

static const Card *const landscape_cards[] = {&card_page, &card_listing,
                                              &card_line, &card_residual, NULL};

const Picture landscape_picture = {
    .name = "landscape",
    .cards = landscape_cards,
    .places = true,
    .around = LANDSCAPE_AROUND,
    .draw = landscape_draw,
};
