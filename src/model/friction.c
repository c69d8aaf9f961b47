#include "model/friction.h"

#include <math.h>
#include <stdlib.h>

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

/* ---- the term ------------------------------------------------------------ */

/* t.a, where a is made of displacements u [2n]. */
static double slid(const Slide *slide, const double *u)
{
    const double *t = slide->row.n;
    double a[4];
    element_vectors(&slide->row, u, a);
    return t[0] * a[0] + t[1] * a[1];
}

/* Normal forces and tangents at x_n. */
static void begin(Term *term, System *system, const double *x_n,
                  const double *v_n, double h)
{
    Friction *friction = term->data;
    const Contact *contact = contact_of(system);
    Place at = place_at(system, x_n, NULL, x_n);
    Element row;
    (void)v_n;
    at.term = system_find_term(system, &contact_energy);
    friction->e = friction->slip_speed * h;
    friction->slides = 0;
    for (int i = 0; i < contact_elements.count(&at); i++) {
        if (!contact_elements.get(&at, i, 0, &row))
            continue;
        const Obstacle *obstacle = &contact->obstacle[row.from];
        if (!(obstacle->friction > 0))
            continue;
        const double t[2] = {-row.n[1], row.n[0]};
        row.n[0] = t[0];
        row.n[1] = t[1];
        row.r = obstacle->friction * contact_force(&contact->barrier, row.s);
        friction->slide[friction->slides++] =
            (Slide){row, h * (t[0] * obstacle->v[0] + t[1] * obstacle->v[1])};
    }
}

/* What was rubbed off in this step. */
static void end(Term *term, System *system, const double *x, const double *v,
                double h)
{
    const Friction *friction = term->data;
    (void)x;
    for (int i = 0; i < friction->slides; i++) {
        const Slide *slide = &friction->slide[i];
        double y = h * slid(slide, v) - slide->carry;
        system_lose(system, term->kind,
                    slide->row.r * friction_slope(y, friction->e) * y);
    }
}

static const Friction *friction_of(const Place *at)
{
    return at->term->data;
}

static int count(const Place *at)
{
    return friction_of(at)->slides;
}

/* s is y.  Nothing of it is stored: outside of a step (u NULL) it is 0. */
static bool get(const Place *at, int i, double way, Element *element)
{
    const Slide *slide = &friction_of(at)->slide[i];
    (void)way;
    if (!at->u)
        return false;
    *element = slide->row;
    element->s = slid(slide, at->u) - slide->carry;
    return true;
}

static double value(const Place *at, const Element *element)
{
    return element->r * friction_value(element->s, friction_of(at)->e);
}

static void gradient(const Place *at, const Element *element, double g[4])
{
    double force =
        at->w * element->r * friction_slope(element->s, friction_of(at)->e);
    g[0] = force * element->n[0];
    g[1] = force * element->n[1];
}

/* mu lambda f0'' t t^T, never negative */
static bool hessian(const Place *at, const Element *element, Filter filter,
                    double H[4][4])
{
    const double *t = element->n;
    double bend =
        at->w * element->r * friction_curvature(element->s, friction_of(at)->e);
    (void)filter;
    H[0][0] = bend * t[0] * t[0];
    H[0][1] = H[1][0] = bend * t[0] * t[1];
    H[1][1] = bend * t[1] * t[1];
    return false;
}

static double remainder_along(const Place *at, const Element *element,
                              const double P[4], double alpha)
{
    double t = element->n[0] * P[0] + element->n[1] * P[1];
    return element->r *
           friction_remainder(element->s, alpha * t, friction_of(at)->e);
}

static const ElementKind slides = {.count = count,
                                   .get = get,
                                   .blocks = contact_blocks,
                                   .nodes = contact_nodes,
                                   .value = value,
                                   .gradient = gradient,
                                   .hessian = hessian,
                                   .remainder = remainder_along};

const TermKind friction_energy = {
    ELEMENTS(slides), .loss = "friction", .place = PLACE_FRICTION,
    .begin = begin,   .end = end,         .end_of_step = true,
};

double friction_work_of_obstacles(const System *system, const double *u)
{
    const Friction *friction = system_data(system, &friction_energy);
    double sum = 0;
    for (int i = 0; friction && i < friction->slides; i++) {
        const Slide *slide = &friction->slide[i];
        double y = slid(slide, u) - slide->carry;
        sum -= slide->row.r * friction_slope(y, friction->e) * slide->carry;
    }
    return sum;
}

Status friction_add(System *system, double slip_speed)
{
    const Contact *contact = contact_of(system);
    size_t room =
        (size_t)system->nodes * (size_t)(contact ? contact->obstacles : 0);
    Friction *friction = calloc(1, sizeof *friction + room * sizeof(Slide));
    if (!friction)
        return STATUS_OUT_OF_MEMORY;
    friction->slip_speed = slip_speed;
    friction->slide = (Slide *)(friction + 1);
    return system_add_term(system, &friction_energy, friction);
}
