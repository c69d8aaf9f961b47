/* square_mouse.c - what of the square is under the mouse. */
#include <math.h>

#include "picture/plot.h"
#include "picture/square_picture.h"
#include "model/fracture.h"
#include "scenes/scene.h"

/* Squared distance of a pixel to a line between two pixels. */
static double distance2(const double p[2], const double q[2], double x,
                        double y)
{
    double dx = q[0] - p[0], dy = q[1] - p[1];
    double length2 = dx * dx + dy * dy, t = 0;
    if (length2 > 0)
        t = fmin(fmax(((x - p[0]) * dx + (y - p[1]) * dy) / length2, 0), 1);
    double ex = p[0] + t * dx - x, ey = p[1] + t * dy - y;
    return ex * ex + ey * ey;
}

/* Before the first step a spring of the left or right edge is that edge. */
static void pick_edge(const Show *show, const Simulation *simulation,
                      Pick *pick)
{
    const int *e = simulation->system.e + 2 * (size_t)pick->index;
    int sides = square_mesh_sides(&simulation->mesh, e[0]) &
                square_mesh_sides(&simulation->mesh, e[1]);
    if (!show->paused || simulation->steps > 0 ||
        !(sides & (MESH_LEFT | MESH_RIGHT)))
        return;
    pick->kind = PICK_EDGE;
    pick->index = sides & MESH_LEFT ? 0 : 1;
}

/* The nearest node, else the nearest spring, within reach of the mouse. */
Pick square_pick(const Show *show, const Plot *stage, double x, double y)
{
    const Pane *pane = &show->pane[stage->pane];
    const System *system = &pane->simulation->system;
    const double *at = pane_x(pane);
    double spacing = stage->camera.scale[0] * pane->simulation->mesh.spacing;
    double reach = fmin(fmax(0.3 * spacing, 7), 16), best = reach * reach;
    Pick pick = {PICK_NONE, stage->pane, 0, {0, 0}};
    camera_world(&stage->camera, x, y, pick.point);
    for (int i = 0; i < system->nodes; i++) {
        double p[2];
        plot_place(stage, at + 2 * (size_t)i, p);
        double d2 = (p[0] - x) * (p[0] - x) + (p[1] - y) * (p[1] - y);
        if (d2 < best) {
            best = d2;
            pick.kind = PICK_NODE;
            pick.index = i;
        }
    }
    best = reach * reach / 4;
    for (int s = 0; pick.kind == PICK_NONE && s < system->springs; s++) {
        double p[2], q[2];
        if (spring_is_broken(system, s))
            continue;
        plot_place(stage, at + 2 * (size_t)system->e[2 * s], p);
        plot_place(stage, at + 2 * (size_t)system->e[2 * s + 1], q);
        double d2 = distance2(p, q, x, y);
        if (d2 < best) {
            best = d2;
            pick.kind = PICK_SPRING;
            pick.index = s;
        }
    }
    if (pick.kind == PICK_SPRING)
        pick_edge(show, pane->simulation, &pick);
    return pick;
}
