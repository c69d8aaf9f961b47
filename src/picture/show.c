#include "picture/show.h"

#include <math.h>
#include <string.h>

#include "picture/cards.h"

static const double WORDS_ROOM = 1.8; /* ems, of a legend or a label */

void show_create(const Simulation *simulation, Show *show)
{
    const Picture *picture = picture_of(simulation->scene);
    *show = (Show){.panes = 1, .selected = -1, .large = -1};
    show->pane[0].simulation = simulation;
    show->lens = LENS_FITS;
    for (int c = 0; picture->cards[c]; c++) {
        show->closed |= (unsigned)picture->cards[c]->closed << c;
        show->hidden |= (unsigned)picture->cards[c]->lecture << c;
    }
}

/* The part of the world that fits a stage; all panes of a page have the scale
 * of the last one. */
static void find_bounds(const Plot *own, double bounds[4])
{
    const Show *show = own->show;
    int last = show->panes - 1;
    const Plot of_last = {
        .show = show, .simulation = show->pane[last].simulation, .pane = last};
    const Plot *stage = show->lecture ? &of_last : own;
    const Picture *picture = picture_of(stage->simulation->scene);
    const Held *held = &stage->show->held;
    if (held->on && !held->away && held->pane == stage->pane)
        memcpy(bounds, held->bounds, sizeof held->bounds);
    else if (picture->bounds)
        picture->bounds(stage, bounds);
    else
        memcpy(bounds, picture->around, sizeof picture->around);
}

Plot show_stage(Paper *paper, const Show *show, const Layout *layout, int pane)
{
    Plot stage = {.paper = paper,
                  .show = show,
                  .simulation = show->pane[pane].simulation,
                  .box = layout->pane[pane],
                  .pane = pane,
                  .text = !show->bare,
                  .em = layout->em};
    double bounds[4];
    bool stretched = picture_of(stage.simulation->scene)->stretched;
    Box room = stage.box;
    if (show->lecture && show->panes > 1) { /* words above and below it */
        room.y += (int)(WORDS_ROOM * layout->em);
        room.height -= (int)(2 * WORDS_ROOM * layout->em);
    }
    find_bounds(&stage, bounds);
    stage.camera = camera_create(room, bounds, stretched, &show->lens);
    return stage;
}

Camera show_camera(const Show *show, const Layout *layout, int pane)
{
    return show_stage(NULL, show, layout, pane).camera;
}

void show_hold(Show *show, int pane)
{
    const Plot stage = {
        .show = show, .simulation = show->pane[pane].simulation, .pane = pane};
    Held held = {.on = true, .pane = pane};
    find_bounds(&stage, held.bounds);
    show->held = held;
}

Pick show_pick(const Show *show, const Layout *layout, double x, double y)
{
    Hit hit = layout_hit(layout, x, y);
    Pick pick = {.kind = PICK_NONE, .near = -1};
    if (hit.zone != ZONE_STAGE || hit.index >= show->panes)
        return pick;
    Plot stage = show_stage(NULL, show, layout, hit.index);
    const Picture *picture = picture_of(stage.simulation->scene);
    pick.pane = hit.index;
    camera_world(&stage.camera, x, y, pick.point);
    if (!picture->own_handles && handles_pick(&stage, x, y, &pick))
        return pick;
    pick.kind = picture->places ? PICK_PLACE : PICK_NONE;
    if (picture->pick)
        picture->pick(&stage, x, y, &pick);
    return pick;
}

long show_step_at(const Show *show, const Layout *layout, double x)
{
    const Box *bars = &layout->bars;
    double step = (x - bars->x) / fmax(bars->width, 1) * frame_span(show);
    return (long)fmin(fmax(step < 0.25 ? 0 : floor(step) + 1, 0), show->bars);
}

const double *pane_x(const Pane *pane)
{
    return pane->x ? pane->x : pane->simulation->run[0].x;
}

int show_sample(const Simulation *simulation, Energy row[HISTORY_SERIES])
{
    const Picture *picture = picture_of(simulation->scene);
    return picture->sample ? picture->sample(simulation, row) : 0;
}
