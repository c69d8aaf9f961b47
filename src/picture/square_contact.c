/* square_contact.c - walls, balls and contact forces around the square. */
#include <math.h>

#include "model/friction.h"
#include "model/self_contact.h"
#include "picture/colour_map.h"
#include "picture/square_pen.h"

static const double SLAB = 1;         /* ems, thickness of a thin wall */
static const double FORCE_ARROW = 4;  /* ems, arrow's length in the legend */
static const double MIN_FORCE = 0.02; /* smallest drawn force / largest force */

/* Computes the force of a contact on its node, with friction, from x and v
 * alone: the past stores no forces.  Returns the speed of the slip in units of
 * the slip speed eps_v; NaN: the contact has no friction.
 *   at        evaluation point of the contact term
 *   force     [2] N, out
 *   friction  term of the friction at these contacts; NULL: none */
static double compute_contact_force(const SquarePen *pen, const EvalPoint *at,
                                    const EnergyTerm *friction,
                                    const Element *element, double force[2])
{
    const ElementKind *kind = at->term->kind->element;
    double h = pen->simulation->options.timestep, g[4], t[4], v[4], carry;
    double grip = kind->friction_limit(at, element, t, &carry), rub = 0;
    double part = NAN;
    kind->gradient(at, element, g);
    if (friction && grip > 0) {
        double speed = ((const Friction *)friction->data)->slip_speed;
        double slip = -carry;
        element_compute_vectors(element, pen->v, v);
        for (int i = 0; i < 2 * element->vector_count; i++)
            slip += t[i] * v[i];
        rub = -grip * friction_slope(slip * h, speed * h);
        part = fabs(slip) / speed;
    }
    for (int c = 0; c < 2; c++)
        force[c] = rub * t[c] - g[c];
    return part;
}

/* Draws the contact forces of one kind on the nodes of a run.
 *   factor  m/N, length of an arrow over its force; 0: draws nothing
 *   most    N, in and out, the largest force so far */
static void draw_contact_forces(const SquarePen *pen, bool between_bodies,
                                double factor, double *most)
{
    const System *system = pen->system;
    EvalPoint at = make_eval_point(system, NULL, NULL, pen->x);
    at.term = system_find_term(system, between_bodies ? &self_contact_energy
                                                      : &contact_energy);
    const EnergyTerm *friction = system_find_term(
        system, between_bodies ? &self_friction_energy : &friction_energy);
    if (!at.term)
        return;
    for (ElementIterator walk = elements_begin(&at, NULL, 0);
         elements_next(&walk);) {
        double f[2], radius = fmax(pen->node_radius, 2);
        double slip =
            compute_contact_force(pen, &at, friction, &walk.element, f);
        const double *x = pen->x + 2 * walk.element.node[0];
        double size = vector_length(f);
        *most = fmax(*most, size);
        if (factor == 0)
            continue;
        if (size > MIN_FORCE * *most)
            plot_arrow(pen->stage, point_along(x, -factor, f).xy, f, factor,
                       1.8, COLOUR_FORCE);
        if (slip >= 1)
            plot_ring(pen->stage, x, 1.6 * radius, 1.5, COLOUR_FORCE);
        else if (slip >= 0)
            plot_disc(pen->stage, x, 1.4 * radius, COLOUR_FORCE);
    }
}

void square_draw_forces(const SquarePen *pen, int runs)
{
    Plot *stage = pen->stage;
    double most = 0; /* N, the largest force */
    for (int i = 0; i < 2 * runs; i++)
        draw_contact_forces(&pen[i / 2], i % 2, 0, &most);
    if (most == 0 || !isfinite(most))
        return;
    double round = plot_nice_number(most);
    double factor = FORCE_ARROW * stage->em / stage->camera.scale[0] / round;
    for (int i = 2 * runs - 1; i >= 0; i--)
        draw_contact_forces(&pen[i / 2], i % 2, factor, &most);
    plot_legend(stage, COLOUR_FORCE, "contact force \u2264 %s N",
                format_number(round).text);
    if (system_find_term(pen->system, &friction_energy) ||
        system_find_term(pen->system, &self_friction_energy))
        plot_legend(stage, COLOUR_FORCE, "\u25cf sticks   \u25cb slides");
}

void square_draw_mu_label(const SquarePen *pen)
{
    const Plot *stage = pen->stage;
    const Obstacle *wall = &pen->contact->obstacle[0];
    double slope = -wall->n[0] / wall->n[1], end[2] = {-INFINITY, INFINITY};
    double at[4], p[2], out = 2 * stage->em / stage->camera.scale[0];
    bool seen = false;
    if (wall->kind != OBSTACLE_WALL || !(wall->n[1] > 0) ||
        !(fabs(slope) > 1e-6))
        return;
    for (int i = 0; i < pen->system->nodes; i++) {
        end[0] = fmax(end[0], pen->x[2 * (size_t)i]);
        end[1] = fmin(end[1], pen->x[2 * (size_t)i]);
    }
    for (int k = 0; k < 2; k++) { /* label places: right, left of the body */
        at[2 * k] = end[k] + (k ? -out : out);
        at[2 * k + 1] = wall->o[1] + slope * (at[2 * k] - wall->o[0]);
        plot_to_pixel(stage, at + 2 * k, p);
        seen = seen || box_contains(stage->box, p[0], p[1]);
    }
    if (seen)
        plot_label(stage, 2, at, COLOUR_TEXT, "\u03bc = %s tan %s\u00b0",
                   format_number(wall->mu / fabs(slope)).text,
                   format_number(fabs(atan(slope)) / DEGREE).text);
}

/* Draws a wall as a half plane or a thin slab, and dashes at the distance
 * `reach` where the contact force begins; pages label the dashes. */
static void draw_wall(const Plot *stage, const Obstacle *wall, double reach,
                      bool as_slab)
{
    const Box *box = &stage->box;
    const double *n = wall->n, t[2] = {n[1], -n[0]};
    double scale = stage->camera.scale[0], middle[2];
    double far = 2 * (box->width + box->height) / scale;
    double deep = as_slab ? SLAB * stage->em / scale : far;
    camera_to_world(&stage->camera, box->x + 0.5 * box->width,
                    box->y + 0.5 * box->height, middle);
    const double *o = wall->o;
    double at = (middle[0] - o[0]) * n[1] - (middle[1] - o[1]) * n[0];
    const Point left = point_along(o, at - far, t),
                right = point_along(o, at + far, t);
    const Point low[2] = {point_along(left.xy, -deep, n),
                          point_along(right.xy, -deep, n)};
    const double *const corner[] = {left.xy, right.xy, low[1].xy, low[0].xy};
    plot_quad(stage, corner, COLOUR_SOLID);
    plot_line(stage, left.xy, right.xy, 1.5, COLOUR_EDGE);
    const Point aside = point_along(
        point_along(o, at + 0.35 * box->width / scale, t).xy, reach, n);
    plot_to_pixel(stage, aside.xy, middle);
    if (reach * scale > 2)
        plot_dashes(stage, point_along(left.xy, reach, n).xy,
                    point_along(right.xy, reach, n).xy, 1, NULL, COLOUR_GREY);
    if (reach * scale > 2 * stage->em && stage->content->lecture.page &&
        box_contains(*box, middle[0], middle[1]))
        plot_label(stage, 1, aside.xy, COLOUR_FAINT, "\u03b4\u0302");
}

void square_draw_obstacles(const SquarePen *pen)
{
    const Plot *stage = pen->stage;
    const Contact *contact = pen->contact;
    double scale = stage->camera.scale[0] / stage->paper->unit;
    double reach = contact ? contact->barrier.d_hat : 0;
    for (int i = 0; contact && i < contact->obstacle_count; i++) {
        const Obstacle *obstacle = &contact->obstacle[i];
        const double *at = obstacle_get_position(obstacle, pen->x);
        double radius = obstacle->radius * scale;
        if (obstacle->kind == OBSTACLE_WALL) {
            draw_wall(stage, obstacle, reach, pen->simulation->runs > 1);
            continue;
        }
        plot_disc(stage, at, radius, COLOUR_SOLID);
        plot_ring(stage, at, radius, 1.5, COLOUR_EDGE);
        if (reach * stage->camera.scale[0] > 2)
            plot_ring(stage, at, radius + reach * scale, 0.8, COLOUR_RULE);
    }
}
