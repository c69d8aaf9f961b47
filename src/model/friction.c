/* friction.c - Coulomb friction as an energy of the slip. */
#include "model/friction.h"

#include <math.h>
#include <stdlib.h>

#include "model/self_contact.h"

/* Returns f0(y), m. */
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

/* Returns f0''(y), 1/m. */
static double friction_curvature(double y, double e)
{
    return 2 / e * fmax(0, 1 - fabs(y) / e);
}

/* On [0, e] and on [-e, 0] f0'' is linear, so the remainder of the step t from
 * y to z is t^2 (2 f0''(y) + f0''(z))/6. */
static double remainder_on_piece(double y, double t, double z, double e)
{
    return t * t * (2 * friction_curvature(y, e) + friction_curvature(z, e)) /
           6;
}

/* Returns f0(z) - f0(y) - f0'(y) t for y >= 0 and z = y + t >= 0; t may be
 * negative. */
static double remainder_on_side(double y, double t, double e)
{
    double z = y + t;
    if (y <= e && z <= e)
        return remainder_on_piece(y, t, z, e);
    if (y > e && z > e)
        return 0;
    if (y > e) /* into [0, e]: from y to e, f0 is linear and adds 0 */
        return remainder_on_piece(e, z - e, z, e);
    /* out of [0, e]: beyond e the slope is 1, at y it is 1 - missing^2 */
    double missing = 1 - y / e;
    return remainder_on_piece(y, e - y, e, e) + missing * missing * (z - e);
}

/* Returns f0(y + t) - f0(y) - f0'(y) t >= 0, m, with full relative accuracy.  A
 * step that passes 0 is split there, by
 * R(a -> c) = R(a -> b) + (f'(b) - f'(a)) (c - b) + R(b -> c). */
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

/* Returns t.(a, b), where a and b are those of displacements or a direction. */
static double tangent_part(const Element *row, const double vectors[4])
{
    double sum = 0;
    for (int i = 0; i < 2 * row->vectors; i++)
        sum += row->v[i] * vectors[i];
    return sum;
}

static double slip_of(const SlidingContact *slide, const double *u)
{
    double vectors[4];
    element_vectors(&slide->element, u, vectors);
    return tangent_part(&slide->element, vectors) - slide->carry;
}

/* Returns the point for the contact term whose elements have this friction. */
static EvalPoint point_of_contact_term(const EvalPoint *at)
{
    bool obstacles = at->term->kind == &friction_energy;
    EvalPoint source = *at;
    source.term = system_find_term(
        at->system, obstacles ? &contact_energy : &self_contact_energy);
    return source;
}

/* Freezes the normal forces and tangents at x_n. */
static Status friction_begin_step(const TermStep *step)
{
    Friction *friction = step->term->data;
    EvalPoint at = eval_point_at(step->system, step->x, NULL, step->x);
    at.term = step->term;
    at = point_of_contact_term(&at);
    friction->e = friction->slip_speed * step->h;
    friction->slides = 0;
    for (ElementIterator walk = elements_begin(&at, NULL, 0);
         elements_next(&walk);) {
        SlidingContact slide = {walk.element, 0};
        slide.element.r = walk.kind->friction_limit(
            &at, &walk.element, slide.element.v, &slide.carry);
        slide.element.factor = 1;
        slide.element.next_place = 0;
        slide.carry *= step->h;
        if (!(slide.element.r > 0))
            continue;
        if (friction->slides == friction->room) {
            int room = 2 * friction->room + 64;
            friction = realloc(step->term->data,
                               sizeof *friction + (size_t)room * sizeof slide);
            if (!friction)
                return STATUS_OUT_OF_MEMORY;
            step->term->data = friction;
            friction->room = room;
        }
        friction->slide[friction->slides++] = slide;
    }
    return STATUS_OK;
}

/* Books the energy that friction dissipated in this step. */
static void friction_end_step(const TermStep *step)
{
    const Friction *friction = step->term->data;
    for (int i = 0; i < friction->slides; i++) {
        const SlidingContact *slide = &friction->slide[i];
        double vectors[4];
        element_vectors(&slide->element, step->v, vectors);
        double y =
            step->h * tangent_part(&slide->element, vectors) - slide->carry;
        system_book_loss(step->system, step->term->kind,
                         slide->element.r * friction_slope(y, friction->e) * y);
    }
}

static const Friction *friction_of(const EvalPoint *at)
{
    return at->term->data;
}

static int slip_count(const EvalPoint *at)
{
    return friction_of(at)->slides;
}

/* s is the slip y.  Outside a step (u NULL) friction has no energy. */
static bool slip_element(const EvalPoint *at, int i, double way,
                         Element *element)
{
    const SlidingContact *slide = &friction_of(at)->slide[i];
    (void)way;
    if (!at->u)
        return false;
    *element = slide->element;
    element->s = slip_of(slide, at->u);
    return true;
}

/* The Hessian of friction has the same blocks as that of its contact term. */
static int slip_block_count(const EvalPoint *at)
{
    EvalPoint source = point_of_contact_term(at);
    return source.term->kind->element->block_count(&source);
}

static int slip_block_nodes(const EvalPoint *at, int block, int node[3])
{
    EvalPoint source = point_of_contact_term(at);
    return source.term->kind->element->block_nodes(&source, block, node);
}

static double slip_value(const EvalPoint *at, const Element *element)
{
    return element->r * friction_value(element->s, friction_of(at)->e);
}

static void slip_gradient(const EvalPoint *at, const Element *element,
                          double g[4])
{
    double force = at->weight * element->r *
                   friction_slope(element->s, friction_of(at)->e);
    for (int i = 0; i < 4; i++)
        g[i] = force * element->v[i];
}

/* H = mu lambda f0'' t t^T, which has no negative eigenvalue. */
static bool slip_hessian(const EvalPoint *at, const Element *element,
                         Projection projection, double H[4][4])
{
    double bend = at->weight * element->r *
                  friction_curvature(element->s, friction_of(at)->e);
    (void)projection;
    for (int i = 0; i < 4; i++)
        for (int k = i; k < 4; k++)
            H[i][k] = H[k][i] = bend * element->v[i] * element->v[k];
    return false;
}

static double slip_line_remainder(const EvalPoint *at, const Element *element,
                                  const double P[4], double alpha)
{
    return element->r * friction_remainder(element->s,
                                           alpha * tangent_part(element, P),
                                           friction_of(at)->e);
}

static const ElementKind slides = {
    .count = slip_count,
    .get = slip_element,
    .block_nodes = slip_block_nodes,
    .value = slip_value,
    .gradient = slip_gradient,
    .hessian = slip_hessian,
    .line_remainder = slip_line_remainder,
    .block_count = slip_block_count,
};

const TermKind friction_energy = {
    ELEMENTS(slides),
    .name = "friction",
    .loss = "friction",
    .place = PLACE_FRICTION,
    .begin_step = friction_begin_step,
    .end_step = friction_end_step,
    .depends_on_start = true,
    .backward_euler_only = true,
};

const TermKind self_friction_energy = {
    ELEMENTS(slides),
    .loss = "friction",
    .place = PLACE_FRICTION,
    .begin_step = friction_begin_step,
    .end_step = friction_end_step,
    .internal = true,
    .depends_on_start = true,
    .backward_euler_only = true,
};

double friction_work_of_obstacles(const System *system, const double *u)
{
    const Friction *friction = system_term_data(system, &friction_energy);
    double sum = 0;
    for (int i = 0; friction && i < friction->slides; i++) {
        const SlidingContact *slide = &friction->slide[i];
        double y = slip_of(slide, u);
        sum -= slide->element.r * friction_slope(y, friction->e) * slide->carry;
    }
    return sum;
}

Status friction_set(System *system, const TermKind *kind, bool wanted,
                    double slip_speed)
{
    if (!wanted) {
        system_remove_term(system, kind);
        return STATUS_OK;
    }
    Friction *friction = system_add_term(system, kind, sizeof *friction);
    if (!friction)
        return STATUS_OUT_OF_MEMORY;
    friction->slip_speed = slip_speed;
    return STATUS_OK;
}
