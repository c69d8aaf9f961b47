#include <math.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/marks.h"

/* The exact path and its radius. */
static void draw_exact_circle(Paper *paper, const Stage *stage)
{
    const double middle[2] = {0, 0}, start[2] = {1, 0};
    double at[2];
    stage_ring(paper, stage, middle, stage->camera.scale[0], 5, COLOUR_GRID);
    stage_line(paper, stage, middle, start, 1.2, COLOUR_GREY);
    stage_disc(paper, stage, middle, 3.5 * paper->unit, COLOUR_GREY);
    const double half[2] = {0.5, 0};
    stage_pixel(stage, half, at);
    if (stage->text)
        paper_write(paper, FACE_REGULAR, 0.9, COLOUR_FAINT, at[0],
                    at[1] + 0.2 * paper->em, ALIGN_CENTRE, "1 m");
}

Colour circle_colour(const Simulation *simulation, int run)
{
    return colour_of_method(simulation->run[run].method->name);
}

/* Trails, and a disc where each run is now. */
static void circle_draw(Paper *paper, const Stage *stage, const Show *show)
{
    const Pane *pane = &show->pane[stage->pane];
    const Simulation *simulation = pane->simulation;
    const Trail *trail = pane->trail;
    Legend legend = {0, 0};
    draw_exact_circle(paper, stage);
    for (int r = 0; trail && r < simulation->runs; r++)
        for (int i = 1; i < trail->count; i++)
            stage_line(paper, stage, trail->point[r][i - 1], trail->point[r][i],
                       2.2, circle_colour(simulation, r));
    for (int r = 0; r < simulation->runs; r++)
        stage_disc(paper, stage, simulation->run[r].x, 7 * paper->unit,
                   circle_colour(simulation, r));
    if (show->bare || !stage->text)
        return;
    stage_legend(paper, stage, &legend, COLOUR_GREY, "exact: |{x}| = 1 m");
    for (int r = 0; r < simulation->runs; r++) {
        char radius[48];
        const double *x = simulation->run[r].x;
        plot_number(radius, sizeof radius, hypot(x[0], x[1]));
        stage_legend(paper, stage, &legend, circle_colour(simulation, r),
                     "%s: %s m", simulation->run[r].method->label, radius);
    }
    stage_scale(paper, stage);
}

/* The node of the nearest run. */
static Pick circle_pick(const Show *show, const Stage *stage, double x,
                        double y)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    Pick pick = {PICK_NONE, stage->pane, 0, {0, 0}};
    double best = 16;
    camera_world(&stage->camera, x, y, pick.point);
    for (int r = 0; r < simulation->runs; r++) {
        double at[2];
        stage_pixel(stage, simulation->run[r].x, at);
        double distance = hypot(at[0] - x, at[1] - y);
        if (distance < best) {
            best = distance;
            pick.kind = PICK_NODE;
            pick.index = r;
        }
    }
    return pick;
}

/* Position and radius of node 0 in each run. */
static void circle_sample(const Simulation *simulation, History *history,
                          Trail *trail)
{
    double value[HISTORY_SERIES] = {0}, point[2 * TRAIL_RUNS] = {0};
    history->series = simulation->runs;
    for (int r = 0; r < simulation->runs; r++) {
        const double *x = simulation->run[r].x;
        history->name[r] = simulation->run[r].method->label;
        value[r] = hypot(x[0], x[1]);
        point[2 * r] = x[0];
        point[2 * r + 1] = x[1];
    }
    history_add(history, simulation_time(simulation), value);
    if (trail)
        trail_add(trail, simulation->runs, point);
}

static const Card *const circle_cards[] = {&card_page, &card_radius,
                                           &card_methods, NULL};

const Picture circle_picture = {
    .name = "circle",
    .cards = circle_cards,
    .around = {-1.75, -1.75, 1.75, 1.75},
    .draw = circle_draw,
    .pick = circle_pick,
    .sample = circle_sample,
};
