/* friction.c - Coulomb friction as an energy of the slip. */
#include "model/friction.h"

#include <math.h>
#include <stdlib.h>

#include "model/self_contact.h"

/* Returns f0(y) in metres. */
static double friction_potential(double y, double e)
{
    double a = fabs(y);
    return a < e ? a * a / e * (1 - a / (3 * e)) : a - e / 3;
}

double friction_slope(double y, double e)
{
    double a = fmin(fabs(y) / e, 1);
    return copysign(a * (2 - a), y);
}

/* Returns f0''(y) in 1/m. */
static double friction_curvature(double y, double e)
{
    return 2 / e * fmax(0, 1 - fabs(y) / e);
}

/* Returns f0(y + t) - f0(y) - f0'(y) t >= 0 in metres with full relative
 * accuracy: the integral over s from 0 to t of (t - s) f0''(y + s), mirrored so
 * that t >= 0. f0'' is linear from -e to 0 and from 0 to e. */
static double friction_taylor_remainder(double y, double t, double e)
{
    double way = fabs(t), start = copysign(1, t) * y, sum = 0;
    for (int piece = -1; piece < 1; piece++) {
        double from = fmax(piece * e - start, 0);
        double to = fmin((piece + 1) * e - start, way), length = to - from;
        double first = friction_curvature(start + from, e);
        double last = friction_curvature(start + to, e);
        if (length > 0)
            sum += length * (0.5 * (first + last) * (way - to) +
                             length * (2 * first + last) / 6);
    }
    return sum;
}

/* Returns how far the contact slides along its tangent if the element's vectors
 * a and b change by `vectors`. */
static double tangential_component(const Element *row, const double vectors[4])
{
    double sum = 0;
    for (int i = 0; i < 2 * row->vector_count; i++)
        sum += row->v[i] * vectors[i];
    return sum;
}

/* Returns the slip y (m) of the displacement h v.  v [2n] in. */
static double compute_slip(const SlidingContact *contact, double h,
                           const double *v)
{
    double vectors[4];
    element_compute_vectors(&contact->element, v, vectors);
    return h * tangential_component(&contact->element, vectors) -
           contact->obstacle_travel;
}

/* Returns `at` with the contact term in place of its term of friction. */
static EvalPoint select_contact_term(const EvalPoint *at)
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
    EvalPoint at = make_eval_point(step->system, step->x, NULL, step->x);
    at.term = step->term;
    at = select_contact_term(&at);
    friction->e = friction->slip_speed * step->h;
    friction->contact_count = 0;
    for (ElementIterator walk = elements_begin(&at, NULL, 0);
         elements_next(&walk);) {
        SlidingContact contact = {walk.element, 0};
        contact.element.r = walk.kind->friction_limit(
            &at, &walk.element, contact.element.v, &contact.obstacle_travel);
        contact.element.derivative_factor = 1;
        contact.element.search_cursor = 0;
        contact.obstacle_travel *= step->h;
        if (!(contact.element.r > 0))
            continue;
        if (friction->contact_count == friction->contact_capacity) {
            int room = 2 * friction->contact_capacity + 64;
            friction =
                realloc(step->term->data,
                        sizeof *friction + (size_t)room * sizeof contact);
            if (!friction)
                return STATUS_OUT_OF_MEMORY;
            step->term->data = friction;
            friction->contact_capacity = room;
        }
        friction->contact[friction->contact_count++] = contact;
    }
    return STATUS_OK;
}

/* Books the energy that friction dissipated in this step. */
static void friction_end_step(const TermStep *step)
{
    const Friction *friction = step->term->data;
    for (int i = 0; i < friction->contact_count; i++) {
        const SlidingContact *contact = &friction->contact[i];
        double y = compute_slip(contact, step->h, step->v);
        system_add_loss(step->system, step->term->kind,
                        contact->element.r * friction_slope(y, friction->e) *
                            y);
    }
}

static const Friction *get_friction_data(const EvalPoint *at)
{
    return at->term->data;
}

static int count_sliding_contacts(const EvalPoint *at)
{
    return get_friction_data(at)->contact_count;
}

/* Element i is contact i; Element.s is the slip y (m).  Returns false outside a
 * step (EvalPoint.u is NULL), where friction has no energy. */
static bool slip_get_element(const EvalPoint *at, int i, double way,
                             Element *element)
{
    const SlidingContact *contact = &get_friction_data(at)->contact[i];
    (void)way;
    if (!at->u)
        return false;
    *element = contact->element;
    element->s = compute_slip(contact, 1, at->u);
    return true;
}

/* The Hessian of friction has the same blocks as that of its contact term. */
static int count_slip_blocks(const EvalPoint *at)
{
    EvalPoint source = select_contact_term(at);
    return source.term->kind->element->count_blocks(&source);
}

static int get_slip_block_nodes(const EvalPoint *at, int block, int node[3])
{
    EvalPoint source = select_contact_term(at);
    return source.term->kind->element->get_block_nodes(&source, block, node);
}

static double slip_potential(const EvalPoint *at, const Element *element)
{
    return element->r *
           friction_potential(element->s, get_friction_data(at)->e);
}

static void slip_gradient(const EvalPoint *at, const Element *element,
                          double g[4])
{
    double force = at->weight * element->r *
                   friction_slope(element->s, get_friction_data(at)->e);
    for (int i = 0; i < 4; i++)
        g[i] = force * element->v[i];
}

/* H = mu lambda f0'' t t^T, which has no negative eigenvalue. */
static bool slip_hessian(const EvalPoint *at, const Element *element,
                         Projection projection, double H[4][4])
{
    double bend = at->weight * element->r *
                  friction_curvature(element->s, get_friction_data(at)->e);
    (void)projection;
    for (int i = 0; i < 4; i++)
        for (int k = i; k < 4; k++)
            H[i][k] = H[k][i] = bend * element->v[i] * element->v[k];
    return false;
}

static double slip_taylor_remainder(const EvalPoint *at, const Element *element,
                                    const double P[4], double alpha)
{
    return element->r *
           friction_taylor_remainder(element->s,
                                     alpha * tangential_component(element, P),
                                     get_friction_data(at)->e);
}

static const ElementKind slips = {
    .count_elements = count_sliding_contacts,
    .get_element = slip_get_element,
    .get_block_nodes = get_slip_block_nodes,
    .potential = slip_potential,
    .gradient = slip_gradient,
    .hessian = slip_hessian,
    .taylor_remainder = slip_taylor_remainder,
    .count_blocks = count_slip_blocks,
};

/* First members in the initialisers of both TermKinds of friction. */
#define FRICTION                                                               \
    ELEMENTS(slips), .loss_name = "friction", .rank = RANK_FRICTION,           \
                     .begin_step = friction_begin_step,                        \
                     .end_step = friction_end_step, .depends_on_x_n = true

const TermKind friction_energy = {FRICTION, .name = "friction",
                                  .is_external = true};
const TermKind self_friction_energy = {FRICTION};

double friction_obstacle_work(const System *system, const double *u)
{
    const Friction *friction = system_term_data(system, &friction_energy);
    double sum = 0;
    for (int i = 0; friction && i < friction->contact_count; i++) {
        const SlidingContact *contact = &friction->contact[i];
        double y = compute_slip(contact, 1, u);
        sum -= contact->element.r * friction_slope(y, friction->e) *
               contact->obstacle_travel;
    }
    return sum;
}

Status friction_configure(System *system, const TermKind *kind, bool wanted,
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
