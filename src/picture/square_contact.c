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

/* What its pair's obstacle does to its node; false: nothing. */
static bool find_touch(const SpringPen *pen, Touch *touch)
{
    const System *system = pen->system;
    const Contact *contact = pen->contact;
    int number = touch->pair / system->nodes, node = touch->node;
    const Obstacle *obstacle = &contact->obstacle[number];
    if (!contact_has_pair(contact, system, node, number))
        return false;
    Gap gap = contact_pair_gap(contact, pen->x, node, number);
    double push = contact_force(&contact->barrier, gap.d), rub = 0;
    if (!(push > 0) || !isfinite(push))
        return false;
    const Term *term = system_find_term(system, &friction_energy);
    const double *v = pen->simulation->run[pen->run].v;
    const double *u = obstacle->node < 0 ? obstacle->v : v + 2 * obstacle->node;
    double h = pen->simulation->options.timestep, t[2] = {-gap.n[1], gap.n[0]};
    double slip = t[0] * (v[2 * node] - u[0]) + t[1] * (v[2 * node + 1] - u[1]);
    touch->rough = term && obstacle->friction > 0;
    touch->slides = false;
    if (touch->rough) {
        const Friction *friction = term->data;
        rub = -obstacle->friction * push *
              friction_slope(slip * h, friction->slip_speed * h);
        touch->slides = fabs(slip) >= friction->slip_speed;
    }
    for (int c = 0; c < 2; c++)
        touch->force[c] = push * gap.n[c] + rub * t[c];
    return true;
}

bool square_next_touch(const SpringPen *pen, Touch *touch)
{
    int pairs = pen->contact ? pen->contact->obstacles * pen->system->nodes : 0;
    while (++touch->pair < pairs) {
        touch->node = touch->pair % pen->system->nodes;
        if (find_touch(pen, touch))
            return true;
    }
    return false;
}

/* Whether friction holds no node of a run that touches something. */
static bool slides(const SpringPen *pen)
{
    bool moves = false;
    for (Touch touch = {.pair = -1}; square_next_touch(pen, &touch);) {
        if (touch.rough && !touch.slides)
            return false;
        moves = moves || touch.rough;
    }
    return moves;
}

double square_contact_most(const SpringPen *pen)
{
    double most = 0;
    for (Touch touch = {.pair = -1}; square_next_touch(pen, &touch);)
        most = fmax(most, math_hypot(touch.force[0], touch.force[1]));
    return isfinite(most) ? most : 0;
}

void square_contact_forces(const SpringPen *pen, double most)
{
    double scale = pen->stage->camera.scale[0], em = pen->paper->em;
    double factor = FORCE_ROOM * em / (plot_round_up(most) * scale);
    double radius = fmax(pen->radius / pen->paper->unit, 2);
    if (!(most > 0))
        return;
    for (Touch touch = {.pair = -1}; square_next_touch(pen, &touch);) {
        const double *at = pen->x + 2 * (size_t)touch.node;
        const double tail[2] = {at[0] - factor * touch.force[0],
                                at[1] - factor * touch.force[1]};
        if (math_hypot(touch.force[0], touch.force[1]) > FORCE_LEAST * most)
            plot_arrow(pen->stage, tail, touch.force, factor, 1.8,
                       COLOUR_FORCE);
        if (touch.rough && touch.slides)
            plot_ring(pen->stage, at, 1.6 * radius, 1.5, COLOUR_FORCE);
        else if (touch.rough)
            plot_disc(pen->stage, at, 1.4 * radius, COLOUR_FORCE);
    }
}

void square_contact_legend(const SpringPen *pen, double most)
{
    if (!(most > 0))
        return;
    plot_key(pen->stage, FORCE_ROOM, COLOUR_FORCE, "contact force %s N",
             number_of(plot_round_up(most)).text);
    if (system_find_term(pen->system, &friction_energy))
        plot_legend(pen->stage, COLOUR_FORCE, "\u25cf sticks   \u25cb slides");
}

/* Of a wall's surface, m upwards for each to the right. */
static double slope_of(const Obstacle *wall)
{
    return -wall->n[0] / wall->n[1];
}

bool square_contact_words(const SpringPen *pen, char *text, size_t size)
{
    const Obstacle *wall = &pen->contact->obstacle[0];
    double slope = slope_of(wall), grip = pen->simulation->grip[pen->run];
    if (wall->kind != OBSTACLE_WALL || !(wall->n[1] > 0) ||
        !(fabs(slope) > 1e-6))
        return false;
    int used = grip > 0 ? snprintf(text, size, "%.3g ", grip) : 0;
    snprintf(text + used, size - (size_t)used,
             "\u03bc = %.3g tan %.3g\u00b0: %s", wall->friction / fabs(slope),
             fabs(atan(slope)) / DEGREE, slides(pen) ? "slides" : "holds");
    return true;
}

/* These words under the left end of that wall. */
static void draw_words(const SpringPen *pen)
{
    const Plot *stage = pen->stage;
    double em = pen->paper->em, left[2], at[2];
    char words[64];
    if (!square_contact_words(pen, words, sizeof words))
        return;
    const Obstacle *wall = &pen->contact->obstacle[0];
    double slope = slope_of(wall);
    camera_world(&stage->camera, stage->box.x + em, stage->box.y, left);
    const double foot[2] = {left[0],
                            wall->o[1] + slope * (left[0] - wall->o[0])};
    plot_place(stage, foot, at);
    double low = at[1] + 5 * em - (stage->box.y + stage->box.height);
    if (low > 0) { /* further up along the wall */
        at[0] += low / fabs(slope);
        at[1] -= low;
    }
    paper_write(pen->paper, FACE_REGULAR, 0.95, COLOUR_TEXT, at[0],
                at[1] + 1.5 * em, ALIGN_LEFT, "%s", words);
}

/* The half plane as two triangles that reach beyond the stage, or a slab. */
static void draw_wall(const Plot *stage, const Obstacle *wall, double reach,
                      bool thin)
{
    Paper *paper = stage->paper;
    const Box *box = &stage->box;
    const double *n = wall->n;
    double middle[2], p[4][2];
    camera_world(&stage->camera, box->x + 0.5 * box->width,
                 box->y + 0.5 * box->height, middle);
    double far = 2 * (box->width + box->height) / stage->camera.scale[0];
    double t[2] = {n[1], -n[0]};
    double along =
        (middle[0] - wall->o[0]) * t[0] + (middle[1] - wall->o[1]) * t[1];
    double foot[2] = {wall->o[0] + along * t[0], wall->o[1] + along * t[1]};
    const double a[2] = {foot[0] - far * t[0], foot[1] - far * t[1]};
    const double b[2] = {foot[0] + far * t[0], foot[1] + far * t[1]};
    double deep = thin ? SLAB * paper->em / stage->camera.scale[0] : far;
    const double c[2] = {b[0] - deep * n[0], b[1] - deep * n[1]};
    const double d[2] = {a[0] - deep * n[0], a[1] - deep * n[1]};
    plot_place(stage, a, p[0]);
    plot_place(stage, b, p[1]);
    plot_place(stage, c, p[2]);
    plot_place(stage, d, p[3]);
    for (int k = 0; k < 2; k++) {
        const double corners[6] = {p[0][0],     p[0][1],     p[1 + k][0],
                                   p[1 + k][1], p[2 + k][0], p[2 + k][1]};
        canvas_triangle(&paper->canvas, corners, false, COLOUR_SOLID);
    }
    plot_line(stage, a, b, 1.5, COLOUR_EDGE);
    const double a2[2] = {a[0] + reach * n[0], a[1] + reach * n[1]};
    const double b2[2] = {b[0] + reach * n[0], b[1] + reach * n[1]};
    if (reach * stage->camera.scale[0] > 2)
        plot_dashes(stage, a2, b2, 1, NULL, COLOUR_GREY);
}

void square_contact_obstacles(const SpringPen *pen)
{
    const Plot *stage = pen->stage;
    const Contact *contact = pen->contact;
    bool apart = pen->simulation->runs > 1;
    double scale = stage->camera.scale[0] / pen->paper->unit;
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
