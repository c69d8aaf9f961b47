#include "model/friction.h"

#include <math.h>
#include <stdlib.h>

#include "model/mass_spring_energy.h"

/* f0, m. */
static double friction_value(double y, double e)
{
    double a = fabs(y);
    return a < e ? a * a / e * (1 - a / (3 * e)) : a - e / 3;
}

double friction_slope(double y, double e)
{
    double a = fmin(fabs(y) / e, 1);
    return copysign(a * (2 - a), y);
}

/* f0'', 1/m. */
static double friction_curvature(double y, double e)
{
    return 2 / e * fmax(0, 1 - fabs(y) / e);
}

/* On one piece, [0, e] mirrored or not, f0'' is linear: the remainder of a step
 * t from y to z is t^2 (2 f0''(y) + f0''(z))/6. */
static double remainder_on_piece(double y, double t, double z, double e)
{
    return t * t * (2 * friction_curvature(y, e) + friction_curvature(z, e)) /
           6;
}

/* From y >= 0 to y + t >= 0, in either direction. */
static double remainder_on_side(double y, double t, double e)
{
    double z = y + t;
    if (y <= e && z <= e)
        return remainder_on_piece(y, t, z, e);
    if (y > e && z > e)
        return 0;
    if (y > e) /* into the piece: the slope at y is the one at e */
        return remainder_on_piece(e, z - e, z, e);
    /* out of it: from e on the slope is larger by `missing` than it was at y */
    double missing = 1 - y / e;
    return remainder_on_piece(y, e - y, e, e) + missing * missing * (z - e);
}

/* f0(y + t) - f0(y) - f0'(y) t >= 0, m, with full relative accuracy:
 * R(a -> c) = R(a -> b) + (f'(b) - f'(a)) (c - b) + R(b -> c) with b = 0 where
 * the way passes it. */
static double friction_remainder(double y, double t, double e)
{
    double z = y + t;
    if (y < 0) { /* f0 is even */
        y = -y;
        t = -t;
        z = -z;
    }
    if (z >= 0)
        return remainder_on_side(y, t, e);
    return remainder_on_side(y, -y, e) - friction_slope(y, e) * z +
           remainder_on_side(0, -z, e);
}

/* ---- the term -------------------------------------------------------- */

/* t.(u_i - u_b), of displacements u [2n]. */
static double slid(const Slide *slide, const double *u)
{
    const double *own = u + 2 * slide->e[0], *ball = u + 2 * slide->e[1];
    double sum = 0;
    for (int c = 0; c < 2; c++)
        sum += slide->t[c] * (own[c] - (slide->e[1] < 0 ? 0 : ball[c]));
    return sum;
}

/* Normal forces and tangents at x_n. */
static bool begin(Term *term, System *system, const double *x_n,
                  const double *v_n, double h)
{
    Friction *friction = term->data;
    const Contact *contact = contact_of(system);
    Gap gap;
    (void)v_n;
    friction->e = friction->slip_speed * h;
    friction->slides = 0;
    for (ContactPair pair = {-1, 0};
         contact_next(contact, system, x_n, &pair, &gap);) {
        const Obstacle *obstacle = &contact->obstacle[pair.obstacle];
        double t[2] = {-gap.n[1], gap.n[0]};
        if (!(obstacle->friction > 0))
            continue;
        friction->slide[friction->slides++] = (Slide){
            .e = {pair.node, obstacle->node},
            .t = {t[0], t[1]},
            .weight =
                obstacle->friction * contact_force(&contact->barrier, &gap),
            .carry = h * (t[0] * obstacle->v[0] + t[1] * obstacle->v[1])};
    }
    return false;
}

/* What was rubbed off in this step. */
static bool end(Term *term, System *system, const double *x, const double *v,
                double h)
{
    Friction *friction = term->data;
    (void)x;
    for (int s = 0; s < friction->slides; s++) {
        Slide *slide = &friction->slide[s];
        slide->y = h * slid(slide, v) - slide->carry;
        system_lose(system, term->kind,
                    slide->weight * friction_slope(slide->y, friction->e) *
                        slide->y);
    }
    return false;
}

static double way(const Slide *slide, const Place *at)
{
    return slid(slide, at->u) - slide->carry;
}

static bool valid(const Place *at)
{
    const Friction *friction = at->term->data;
    return isfinite(friction->slip_speed) && friction->slip_speed > 0 &&
           contact_of(at->system);
}

/* Nothing of it is stored: outside of a step (u NULL) it is 0. */
static double value(const Place *at)
{
    const Friction *friction = at->term->data;
    double sum = 0;
    for (int s = 0; at->u && s < friction->slides; s++) {
        const Slide *slide = &friction->slide[s];
        sum += slide->weight * friction_value(way(slide, at), friction->e);
    }
    return sum;
}

static void gradient(const Place *at, double *g)
{
    const Friction *friction = at->term->data;
    for (int s = 0; s < friction->slides; s++) {
        const Slide *slide = &friction->slide[s];
        double force =
            at->w * slide->weight * friction_slope(way(slide, at), friction->e);
        spring_add_force(slide->e, force, slide->t, g);
    }
}

/* mu lambda f0'' t t^T, never negative */
static int hessian(const Place *at, Filter filter, const int *slot,
                   const double *q, double *out)
{
    const Friction *friction = at->term->data;
    const Contact *contact = contact_of(at->system);
    (void)filter;
    for (int s = 0; s < friction->slides; s++) {
        const Slide *slide = &friction->slide[s];
        const double *t = slide->t;
        double bend = at->w * slide->weight *
                      friction_curvature(way(slide, at), friction->e);
        double H[3] = {bend * t[0] * t[0], bend * t[0] * t[1],
                       bend * t[1] * t[1]};
        contact_add_block(contact, slide->e, H, slot, q, out);
    }
    return 0;
}

static double remainder_along(const Place *at, const double *p, double alpha)
{
    const Friction *friction = at->term->data;
    double sum = 0;
    for (int s = 0; s < friction->slides; s++) {
        const Slide *slide = &friction->slide[s];
        sum += slide->weight * friction_remainder(way(slide, at),
                                                  alpha * slid(slide, p),
                                                  friction->e);
    }
    return at->w * sum;
}

const TermKind friction_energy = {
    .loss = "friction",
    .valid = valid,
    .value = value,
    .gradient = gradient,
    .entries = contact_entries,
    .pattern = contact_pattern,
    .hessian = hessian,
    .remainder = remainder_along,
    .begin = begin,
    .end = end,
    .end_of_step = true,
};

double friction_work_of_obstacles(const System *system, const double *u)
{
    const Friction *friction = system_data(system, &friction_energy);
    double sum = 0;
    for (int s = 0; friction && s < friction->slides; s++) {
        const Slide *slide = &friction->slide[s];
        double y = slid(slide, u) - slide->carry;
        sum -= slide->weight * friction_slope(y, friction->e) * slide->carry;
    }
    return sum;
}

Status friction_add(System *system, double slip_speed)
{
    const Term *obstacles = system_find_term(system, &contact_energy);
    const Contact *contact = contact_of(system);
    int place = obstacles ? (int)(obstacles - system->term) + 1 : system->terms;
    size_t room =
        (size_t)system->nodes * (size_t)(contact ? contact->obstacles : 0);
    Friction *friction = calloc(1, sizeof *friction + room * sizeof(Slide));
    if (!friction)
        return STATUS_OUT_OF_MEMORY;
    friction->slip_speed = slip_speed;
    friction->slide = (Slide *)(friction + 1);
    return system_insert_term(system, place, &friction_energy, friction);
}
