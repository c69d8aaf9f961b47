#include "picture/circle_picture.h"

#include <math.h>

#include "picture/colour_map.h"
#include "picture/panels.h"
#include "picture/plot.h"
#include "picture/text_block.h"

enum { CIRCLE_CORNERS = 180 };

static const double CIRCLE_PART = 0.34; /* of the paper: there is room around */
static const double TWO_PI = 6.283185307179586;
static const double RADIUS_AXIS = 2; /* m, upper end; curves may leave it */

/* Forward, symplectic, backward Euler. */
static const Colour circle_colours[SIMULATION_MAX_RUNS] = {
    COLOUR_STRETCH, COLOUR_THIRD, COLOUR_COMPRESS};

/* The exact path, as a polygon of many corners, and its radius. */
static void draw_exact_circle(Paper *paper, const Mapping *mapping, bool text)
{
    const double middle[2] = {0, 0}, start[2] = {1, 0};
    for (int i = 0; i < CIRCLE_CORNERS; i++) {
        double s = TWO_PI * i / CIRCLE_CORNERS;
        double t = TWO_PI * (i + 1) / CIRCLE_CORNERS;
        const double a[2] = {cos(s), sin(s)}, b[2] = {cos(t), sin(t)};
        paper_line(paper, mapping, a, b, 3, COLOUR_GRID);
    }
    paper_line(paper, mapping, middle, start, 0.7, COLOUR_CONTOUR);
    paper_disc(paper, mapping, middle, 2, COLOUR_CONTOUR);
    if (text)
        paper_text(paper, (int)(mapping->x0 + 0.5 * mapping->scale),
                   (int)mapping->y0 + paper_pixels(paper, 2), ALIGN_CENTRE,
                   COLOUR_FAINT, "1 m");
}

/* Trails, and a disc where each run is now. */
void circle_picture_draw(Paper *paper, const Simulation *simulation,
                         const Hud *hud)
{
    const Trail *trail = &hud->trail;
    Mapping mapping = paper_mapping(paper, 2, CIRCLE_PART);
    draw_exact_circle(paper, &mapping, hud->text && paper_shows_text(paper));
    for (int r = 0; r < simulation->runs; r++)
        for (int i = 1; i < trail->count; i++)
            paper_line(paper, &mapping, trail->point[r][i - 1],
                       trail->point[r][i], 1.3, circle_colours[r]);
    for (int r = 0; r < simulation->runs; r++)
        paper_disc(paper, &mapping, simulation->run[r].x, 5, circle_colours[r]);
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
    Plot plot =
        plot_create(paper, panels_plot_box(paper),
                    (Axis){0, plot_round_up(fmax(last, least)), "time in s"},
                    (Axis){0, RADIUS_AXIS, "radius in m"});
    text_block_add(&block, COLOUR_FAINT, "%-16s  radius now", "");
    for (int r = 0; r < simulation->runs && r < SIMULATION_MAX_RUNS; r++) {
        const TimeIntegrator *run = &simulation->run[r];
        plot_curve(paper, &plot, history->count, history->time,
                   history->value[r], circle_colours[r]);
        text_block_add(&block, circle_colours[r], "%-16s %9.4g m",
                       run->method->label, run_radius(run));
    }
    text_block_add(&block, COLOUR_FAINT, "%-16s %9.4g m", "exact (grey)", 1.0);
    panels_draw_legend(paper, &block);
}
