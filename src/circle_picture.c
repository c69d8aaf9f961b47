#include "circle_picture.h"

#include <math.h>

#include "colour_map.h"
#include "panels.h"
#include "plot.h"
#include "text_block.h"

enum { CIRCLE_CORNERS = 180 };

static const double CIRCLE_PART = 0.30; /* of the paper: there is room around */
static const double TWO_PI = 6.283185307179586;

/* Forward, symplectic, backward Euler. */
static const Colour circle_colours[SIMULATION_MAX_RUNS] = {
    COLOUR_STRETCH, COLOUR_THIRD, COLOUR_COMPRESS};

/* A line between two points in metres. */
static void draw_stroke(Paper *paper, const Mapping *mapping, const double *a,
                        const double *b, double width, Colour colour)
{
    canvas_line(&paper->canvas, mapping->x0 + mapping->scale * a[0],
                mapping->y0 - mapping->scale * a[1],
                mapping->x0 + mapping->scale * b[0],
                mapping->y0 - mapping->scale * b[1], width, colour);
}

/* The exact path, as a polygon of many corners. */
static void draw_exact_circle(Paper *paper, const Mapping *mapping)
{
    for (int i = 0; i < CIRCLE_CORNERS; i++) {
        double s = TWO_PI * i / CIRCLE_CORNERS;
        double t = TWO_PI * (i + 1) / CIRCLE_CORNERS;
        const double a[2] = {cos(s), sin(s)}, b[2] = {cos(t), sin(t)};
        draw_stroke(paper, mapping, a, b, fmax(1, 1.5 * paper->unit),
                    COLOUR_GRID);
    }
}

/* Trails, and a disc where each run is now. */
void circle_picture_draw(Paper *paper, const Simulation *simulation,
                         const Hud *hud)
{
    Mapping mapping = paper_mapping(paper, 2, CIRCLE_PART);
    draw_exact_circle(paper, &mapping);
    for (int r = 0; r < simulation->runs; r++) {
        const Trail *trail = &hud->trail;
        const double *x = simulation->run[r].x;
        for (int i = 1; i < trail->count; i++)
            draw_stroke(paper, &mapping, trail->point[r][i - 1],
                        trail->point[r][i], fmax(1, paper->unit),
                        circle_colours[r]);
        canvas_disc(&paper->canvas, mapping.x0 + mapping.scale * x[0],
                    mapping.y0 - mapping.scale * x[1], 4 * paper->unit,
                    circle_colours[r]);
    }
}

/* Radius of a run now, m. */
static double run_radius(const TimeIntegrator *run)
{
    return hypot(run->x[0], run->x[1]);
}

/* Plot and legend. */
void circle_picture_panels(Paper *paper, const Simulation *simulation,
                           const Hud *hud)
{
    const History *history = &hud->history;
    TextBlock block = {0};
    double last = simulation_time(simulation);
    double least = 100 * simulation->options.timestep;
    double high = fmin(fmax(history->high, 2), 1e300);
    Plot plot =
        plot_create(paper, panels_plot_box(paper),
                    (Axis){0, plot_round_up(fmax(last, least)), "time in s"},
                    (Axis){0, plot_round_axis(high), "radius in m"});
    for (int r = 0; r < simulation->runs; r++) {
        const TimeIntegrator *run = &simulation->run[r];
        plot_curve(paper, &plot, history->count, history->time,
                   history->value[r], circle_colours[r]);
        text_block_add(&block, circle_colours[r], "%-16s %8.4g m",
                       run->method->label, run_radius(run));
    }
    text_block_add(&block, COLOUR_FAINT, "%-16s %8.4g m", "exact", 1.0);
    panels_draw_legend(paper, &block);
}
