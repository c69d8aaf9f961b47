#include <math.h>
#include <stdio.h>

#include "model/contact.h"
#include "model/friction.h"
#include "picture/colour_map.h"
#include "picture/square_pen.h"
#include "base/mathematics.h"

static const double SLAB = 1;           /* ems, depth of a thin wall */
static const double FORCE_ROOM = 4;     /* ems, the arrow of the key */
static const double FORCE_LEAST = 0.02; /* of the largest; less is not drawn */

bool square_next_touch(const SpringPen *pen, Touch *touch)
{
    const Contact *contact = pen->contact;
    const Obstacle *obstacle = NULL;
    const double *v = pen->simulation->run[pen->run].v;
    const Term *term = system_find_term(pen->system, &friction_energy);
    double h = pen->simulation->options.timestep, push = 0, rub = 0;
    int nodes = pen->system->nodes, pairs = nodes;
    Gap gap;
    for (pairs *= contact ? contact->obstacles : 0; !(push > 0);) {
        if (++touch->pair >= pairs)
            return false;
        int number = touch->pair / nodes;
        touch->node = touch->pair % nodes;
        obstacle = &contact->obstacle[number];
        if (!contact_has_pair(contact, pen->system, touch->node, number))
            continue;
        gap = contact_pair_gap(contact, pen->x, touch->node, number);
        push = contact_force(&contact->barrier, gap.d);
        push = isfinite(push) ? push : 0;
    }
    const double *u = obstacle->node < 0 ? obstacle->v : v + 2 * obstacle->node;
    const double *w = v + 2 * touch->node, t[2] = {-gap.n[1], gap.n[0]};
    double slip = t[0] * (w[0] - u[0]) + t[1] * (w[1] - u[1]);
    touch->rough = term && obstacle->friction > 0;
    touch->slides = false;
    if (touch->rough) {
        double speed = ((const Friction *)term->data)->slip_speed;
        rub = -obstacle->friction * push * friction_slope(slip * h, speed * h);
        touch->slides = fabs(slip) >= speed;
    }
    for (int c = 0; c < 2; c++)
        touch->force[c] = push * gap.n[c] + rub * t[c];
    return true;
}

/* The largest force that an obstacle and its friction put on a node of these
 * runs, N. */
static double largest_force(const SpringPen *pen, int runs)
{
    double most = 0;
    for (int r = 0; r < runs; r++)
        for (Touch touch = {.pair = -1}; square_next_touch(&pen[r], &touch);)
            most = fmax(most, math_hypot(touch.force[0], touch.force[1]));
    return isfinite(most) ? most : 0;
}

static void draw_force(const SpringPen *pen, const Touch *touch, double factor,
                       double least)
{
    const double *at = pen->x + 2 * (size_t)touch->node, *f = touch->force;
    const double tail[2] = {at[0] - factor * f[0], at[1] - factor * f[1]};
    double radius = fmax(pen->radius, 2);
    if (math_hypot(f[0], f[1]) > least)
        plot_arrow(pen->stage, tail, f, factor, 1.8, COLOUR_FORCE);
    if (touch->rough && touch->slides)
        plot_ring(pen->stage, at, 1.6 * radius, 1.5, COLOUR_FORCE);
    else if (touch->rough)
        plot_disc(pen->stage, at, 1.4 * radius, COLOUR_FORCE);
}

void square_contact_forces(const SpringPen *pen, int runs)
{
    const Plot *stage = pen->stage;
    double most = largest_force(pen, runs), round = plot_round_up(most);
    double factor = FORCE_ROOM * stage->em / stage->camera.scale[0] / round;
    if (!(most > 0))
        return;
    for (int r = runs - 1; r >= 0; r--)
        for (Touch touch = {.pair = -1}; square_next_touch(&pen[r], &touch);)
            draw_force(&pen[r], &touch, factor, FORCE_LEAST * most);
    plot_legend(pen->stage, COLOUR_FORCE, "contact force \u2264 %s N",
                number_of(round).text);
    if (system_find_term(pen->system, &friction_energy))
        plot_legend(pen->stage, COLOUR_FORCE, "\u25cf sticks   \u25cb slides");
}

/* Under a run's first wall, right of what lies on it, if the wall has a slope:
 * its coefficient of friction as a part of the options' and of the slope. */
static void draw_words(const SpringPen *pen)
{
    const Plot *stage = pen->stage;
    const Obstacle *wall = &pen->contact->obstacle[0];
    double em = stage->em, grip = pen->simulation->grip[pen->run];
    double from[2], at[2], slope = -wall->n[0] / wall->n[1];
    if (wall->kind != OBSTACLE_WALL || !(wall->n[1] > 0) ||
        !(fabs(slope) > 1e-6))
        return;
    camera_world(&stage->camera, stage->box.x - em, stage->box.y, from);
    for (int i = 0; i < pen->system->nodes; i++)
        from[0] = fmax(from[0], pen->x[2 * (size_t)i]);
    from[0] += 2 * em / stage->camera.scale[0];
    from[1] = wall->o[1] + slope * (from[0] - wall->o[0]);
    plot_place(stage, from, at);
    double low = at[1] + 5 * em - (stage->box.y + stage->box.height);
    if (low > 0) { /* further up along the wall */
        at[0] += low / fabs(slope);
        at[1] -= low;
    }
    paper_write(stage->paper, FACE_REGULAR, 0.95, COLOUR_TEXT, at[0],
                at[1] + 1.2 * em, ALIGN_LEFT, "%s%s\u03bc = %s tan %s\u00b0",
                grip > 0 ? number_of(grip).text : "", grip > 0 ? " " : "",
                number_of(wall->friction / fabs(slope)).text,
                number_of(fabs(atan(slope)) / DEGREE).text);
}

/* The half plane as far as the stage goes, or a slab, and how far it reaches.
 */
static void draw_wall(const Plot *stage, const Obstacle *wall, double reach,
                      bool thin)
{
    const Box *box = &stage->box;
    const double *n = wall->n, t[2] = {n[1], -n[0]};
    double scale = stage->camera.scale[0], middle[2], p[4][2], near[2][2];
    double far = 2 * (box->width + box->height) / scale;
    double deep = thin ? SLAB * stage->em / scale : far;
    camera_world(&stage->camera, box->x + 0.5 * box->width,
                 box->y + 0.5 * box->height, middle);
    double along =
        (middle[0] - wall->o[0]) * t[0] + (middle[1] - wall->o[1]) * t[1];
    for (int k = 0; k < 4; k++) /* a b on the surface, c d below it */
        for (int c = 0; c < 2; c++) {
            double side = k == 0 || k == 3 ? along - far : along + far;
            p[k][c] = wall->o[c] + side * t[c] - (k < 2 ? 0 : deep) * n[c];
            if (k < 2)
                near[k][c] = p[k][c] + reach * n[c];
        }
    plot_face(stage, (const double *[]){p[0], p[1], p[2], p[3]}, COLOUR_SOLID);
    plot_line(stage, p[0], p[1], 1.5, COLOUR_EDGE);
    if (reach * scale > 2)
        plot_dashes(stage, near[0], near[1], 1, NULL, COLOUR_GREY);
}

void square_contact_obstacles(const SpringPen *pen)
{
    const Plot *stage = pen->stage;
    const Contact *contact = pen->contact;
    bool apart = pen->simulation->runs > 1;
    double scale = stage->camera.scale[0] / stage->paper->unit;
    double reach = contact ? contact->barrier.d_hat : 0;
    for (int i = 0; contact && i < contact->obstacles; i++) {
        const Obstacle *obstacle = &contact->obstacle[i];
        const double *at = obstacle_point(obstacle, pen->x);
        double radius = obstacle->radius * scale;
        if (obstacle->kind == OBSTACLE_WALL) {
            draw_wall(stage, obstacle, reach, apart);
            continue;
        }
        plot_disc(stage, at, radius, COLOUR_SOLID);
        plot_ring(stage, at, radius, 1.5, COLOUR_EDGE);
        if (reach * stage->camera.scale[0] > 2)
            plot_ring(stage, at, radius + reach * scale, 0.8, COLOUR_RULE);
    }
    if (contact && apart && stage->text)
        draw_words(pen);
}
