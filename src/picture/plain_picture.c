#include <math.h>

#include "picture/colour_map.h"
#include "picture/kinds.h"
#include "picture/marks.h"
#include "scenes/scene.h"

/* Half as much again as the nodes and handles reach, around the origin. */
static void plain_bounds(const Show *show, int pane, double bounds[4])
{
    const Simulation *simulation = show->pane[pane].simulation;
    double at[SCENE_MAX_HANDLES][2], reach = 1;
    int handles = simulation->scene->handles
                      ? simulation->scene->handles(simulation, at)
                      : 0;
    for (int i = 0; i < handles; i++)
        reach = fmax(reach, fmax(fabs(at[i][0]), fabs(at[i][1])));
    bounds[2] = bounds[3] = 1.5 * (isfinite(reach) ? reach : 1);
    bounds[0] = bounds[1] = -bounds[2];
}

/* Springs and nodes of every run. */
static void plain_draw(Paper *paper, const Stage *stage, const Show *show)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    const System *system = &simulation->system;
    for (int r = 0; r < simulation->runs; r++) {
        const double *x = simulation->run[r].x;
        for (int s = 0; s < system->springs; s++)
            stage_line(paper, stage, x + 2 * system->e[2 * s],
                       x + 2 * system->e[2 * s + 1], 2, COLOUR_X);
        for (int i = 0; i < system->nodes; i++)
            if (system->pinned && system->pinned[i])
                stage_pin(paper, stage, x + 2 * i, 6 * paper->unit);
            else
                stage_disc(paper, stage, x + 2 * i, 6 * paper->unit,
                           colour_of_run(r));
    }
    if (stage->text)
        stage_scale(paper, stage);
}

static Pick plain_pick(const Show *show, const Stage *stage, double x, double y)
{
    Pick pick = {PICK_PLACE, stage->pane, 0, {0, 0}};
    (void)show;
    camera_world(&stage->camera, x, y, pick.point);
    return pick;
}

static const Card *const no_cards[] = {NULL};

const Picture plain_picture = {
    .name = "plain",
    .cards = no_cards,
    .bounds = plain_bounds,
    .draw = plain_draw,
    .pick = plain_pick,
};
