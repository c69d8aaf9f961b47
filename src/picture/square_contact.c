#include "picture/square_contact.h"

#include <math.h>
#include <stdio.h>

#include "model/contact.h"
#include "model/friction.h"
#include "picture/colour_map.h"

static const double FORCE_ROOM = 4;     /* ems, the arrow of the key */
static const double FORCE_LEAST = 0.02; /* of the largest; less is not drawn */

bool square_contact_apart(const Simulation *simulation)
{
    return simulation->runs > 1 &&
           simulation->run[1].system != &simulation->system;
}

void square_contact_obstacles(const ContactView *view, bool thin)
{
    const Contact *contact = contact_of(view->run->system);
    if (contact)
        stage_obstacles(view->paper, view->stage, contact, view->x, thin);
}

bool square_contact_touch(const ContactView *view, int node, int number,
                          Touch *touch)
{
    const System *system = view->run->system;
    const Contact *contact = contact_of(system);
    const Obstacle *obstacle = &contact->obstacle[number];
    *touch = (Touch){0};
    if (!contact_has_pair(contact, system, node, number))
        return false;
    Gap gap = contact_pair_gap(contact, view->x, node, number);
    double push = contact_force(&contact->barrier, &gap), rub = 0;
    if (!(push > 0) || !isfinite(push))
        return false;
    const Term *term = system_find_term(system, &friction_energy);
    const double *v = view->run->v;
    const double *u = obstacle->node < 0 ? obstacle->v : v + 2 * obstacle->node;
    double t[2] = {-gap.n[1], gap.n[0]};
    double slip = t[0] * (v[2 * node] - u[0]) + t[1] * (v[2 * node + 1] - u[1]);
    if (term && obstacle->friction > 0) {
        const Friction *friction = term->data;
        double e = friction->slip_speed * view->h;
        rub = -obstacle->friction * push * friction_slope(slip * view->h, e);
        touch->rough = true;
        touch->slides = fabs(slip) >= friction->slip_speed;
    }
    for (int c = 0; c < 2; c++)
        touch->force[c] = push * gap.n[c] + rub * t[c];
    return true;
}

/* Whether friction holds no node of a run that touches something. */
static bool slides(const ContactView *view)
{
    const Contact *contact = contact_of(view->run->system);
    bool moves = false;
    for (int o = 0; o < contact->obstacles; o++)
        for (int i = 0; i < view->run->system->nodes; i++) {
            Touch touch;
            if (square_contact_touch(view, i, o, &touch) && touch.rough) {
                if (!touch.slides)
                    return false;
                moves = true;
            }
        }
    return moves;
}

double square_contact_most(const ContactView *view)
{
    const Contact *contact = contact_of(view->run->system);
    double most = 0;
    for (int o = 0; contact && o < contact->obstacles; o++)
        for (int i = 0; i < view->run->system->nodes; i++) {
            Touch touch;
            if (square_contact_touch(view, i, o, &touch))
                most = fmax(most, hypot(touch.force[0], touch.force[1]));
        }
    return isfinite(most) ? most : 0;
}

/* A disc where it sticks, a ring where it slides. */
static void draw_state(const ContactView *view, const double *at,
                       const Touch *touch)
{
    double radius = fmax(view->node, 2 * view->paper->unit);
    if (touch->slides)
        stage_ring(view->paper, view->stage, at, 1.6 * radius, 1.5,
                   COLOUR_FORCE);
    else
        stage_disc(view->paper, view->stage, at, 1.4 * radius, COLOUR_FORCE);
}

void square_contact_forces(const ContactView *view, double most)
{
    const Contact *contact = contact_of(view->run->system);
    if (!contact || !(most > 0))
        return;
    double factor = FORCE_ROOM * view->paper->em /
                    (plot_round_up(most) * view->stage->camera.scale[0]);
    for (int o = 0; o < contact->obstacles; o++)
        for (int i = 0; i < view->run->system->nodes; i++) {
            const double *at = view->x + 2 * (size_t)i;
            Touch touch;
            if (!square_contact_touch(view, i, o, &touch))
                continue;
            const double tail[2] = {at[0] - factor * touch.force[0],
                                    at[1] - factor * touch.force[1]};
            if (hypot(touch.force[0], touch.force[1]) > FORCE_LEAST * most)
                stage_arrow(view->paper, view->stage, tail, touch.force, factor,
                            1.8, COLOUR_FORCE);
            if (touch.rough)
                draw_state(view, at, &touch);
        }
}

void square_contact_legend(const ContactView *view, double most, Legend *legend)
{
    char number[48];
    if (!(most > 0))
        return;
    plot_number(number, sizeof number, plot_round_up(most));
    stage_key(view->paper, view->stage, legend, FORCE_ROOM, COLOUR_FORCE,
              "contact force %s N", number);
    if (system_find_term(view->run->system, &friction_energy))
        stage_legend(view->paper, view->stage, legend, COLOUR_FORCE,
                     "\u25cf sticks   \u25cb slides");
}

/* Of a wall's surface, m upwards for each to the right. */
static double slope_of(const Obstacle *wall)
{
    return -wall->n[0] / wall->n[1];
}

bool square_contact_words(const ContactView *view, char *text, size_t size)
{
    const Contact *contact = contact_of(view->run->system);
    if (!contact || contact->obstacle[0].kind != OBSTACLE_WALL)
        return false;
    const Obstacle *wall = &contact->obstacle[0];
    double slope = slope_of(wall);
    if (!(wall->n[1] > 0) || !(fabs(slope) > 1e-6))
        return false;
    int used = view->grip > 0 ? snprintf(text, size, "%.3g ", view->grip) : 0;
    snprintf(text + used, size - (size_t)used,
             "\u03bc = %.3g tan %.3g\u00b0: %s", wall->friction / fabs(slope),
             fabs(atan(slope)) / DEGREE, slides(view) ? "slides" : "holds");
    return true;
}

void square_contact_label(const ContactView *view)
{
    const Contact *contact = contact_of(view->run->system);
    const Stage *stage = view->stage;
    double em = view->paper->em, left[2], at[2];
    char words[64];
    if (!square_contact_words(view, words, sizeof words))
        return;
    const Obstacle *wall = &contact->obstacle[0];
    double slope = slope_of(wall);
    camera_world(&stage->camera, stage->box.x + em, stage->box.y, left);
    const double foot[2] = {left[0],
                            wall->o[1] + slope * (left[0] - wall->o[0])};
    stage_pixel(stage, foot, at);
    double low = at[1] + 5 * em - (stage->box.y + stage->box.height);
    if (low > 0) { /* further up along the wall */
        at[0] += low / fabs(slope);
        at[1] -= low;
    }
    paper_write(view->paper, FACE_REGULAR, 0.95, COLOUR_TEXT, at[0],
                at[1] + 1.5 * em, ALIGN_LEFT, "%s", words);
}
