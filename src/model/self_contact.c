/* self_contact.c - barrier energy of points near edges of the boundary. */
#include "model/self_contact.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/area.h"
#include "model/barrier.h"

static SelfContact *self_contact_data(const EvalPoint *at)
{
    return at->term->data;
}

static double dot2(const double a[2], const double b[2])
{
    return a[0] * b[0] + a[1] * b[1];
}

/* ---- blocks of the matrix ----------------------------------------------- */

static int compare_pairs(const void *one, const void *other)
{
    const PointEdgePair *a = one, *b = other;
    return a->node != b->node ? a->node - b->node
                              : a->edge_spring - b->edge_spring;
}

/* Returns the index of the pair's block in the Hessian; -1: no block. */
static int find_pair_block(const SelfContact *self, PointEdgePair pair)
{
    const PointEdgePair *found =
        self->pair_count == 0
            ? NULL
            : bsearch(&pair, self->pair, (size_t)self->start_pair_count,
                      sizeof pair, compare_pairs);
    for (int i = self->start_pair_count; i < self->pair_count && !found; i++)
        if (compare_pairs(&self->pair[i], &pair) == 0)
            found = &self->pair[i];
    return found ? (int)(found - self->pair) : -1;
}

static Status add_pair(SelfContact *self, PointEdgePair pair)
{
    if (self->pair_count == self->pair_capacity) {
        int room = 2 * self->pair_capacity + 64;
        PointEdgePair *more = realloc(self->pair, (size_t)room * sizeof *more);
        if (!more)
            return STATUS_OUT_OF_MEMORY;
        self->pair = more;
        self->pair_capacity = room;
    }
    self->pair[self->pair_count++] = pair;
    return STATUS_OK;
}

/* Makes blocks for the pairs that come near if all nodes keep their velocities.
 * The list depends on x_n and v_n alone, not on the steps before. */
static Status self_contact_begin_step(const TermStep *step)
{
    System *system = step->system;
    SelfContact *self = step->term->data;
    Boundary *boundary = &self->boundary;
    int old = self->pair_count, edge, cursor = 0;
    bool grown = old > self->start_pair_count;
    Status status = STATUS_OK;
    boundary_update(boundary, system, step->x, step->v, step->h, self->d_hat);
    for (int i = 0; i < boundary->point_count && !status; i++)
        while (!status &&
               (edge = boundary_near_edge(boundary, system, i, &cursor)) >= 0)
            status =
                add_pair(self, (PointEdgePair){boundary->point_node[i], edge});
    int count = self->pair_count - old;
    PointEdgePair *fresh = self->pair + old;
    self->pair_count = old;
    if (status || count + old == 0)
        return status;
    qsort(fresh, (size_t)count, sizeof *fresh, compare_pairs);
    size_t bytes = (size_t)count * sizeof *fresh;
    if (grown || count != old || memcmp(self->pair, fresh, bytes) != 0) {
        system_mark_changed(system, true);
        boundary->system_version = system->version; /* boundary stays valid */
    }
    memmove(self->pair, fresh, bytes);
    self->pair_count = self->start_pair_count = count;
    return STATUS_OK;
}

static Status self_contact_extend_pattern(const EvalPoint *at, bool *grown)
{
    SelfContact *self = self_contact_data(at);
    Status status = STATUS_OK;
    for (ElementIterator walk = elements_begin(at, NULL, 0);
         !status && elements_next(&walk);)
        if (walk.element.block_index < 0) {
            *grown = true;
            status =
                add_pair(self, (PointEdgePair){walk.element.node[0],
                                               walk.element.partner_index});
        }
    return status;
}

static int count_pair_blocks(const EvalPoint *at)
{
    return self_contact_data(at)->pair_count;
}

static int get_pair_nodes(const System *system, PointEdgePair pair, int node[3])
{
    node[0] = pair.node;
    node[1] = system->e[2 * pair.edge_spring];
    node[2] = system->e[2 * pair.edge_spring + 1];
    return 3;
}

static int get_pair_block_nodes(const EvalPoint *at, int block, int node[3])
{
    const SelfContact *self = self_contact_data(at);
    return self->pair_count == 0
               ? 0
               : get_pair_nodes(at->system, self->pair[block], node);
}

/* ---- elements ----------------------------------------------------------- */

static void gather_near_edges(const EvalPoint *at, const double *p,
                              double alpha)
{
    SelfContact *self = self_contact_data(at);
    boundary_update(&self->boundary, at->system, at->x, p, alpha,
                    0.5 * self->d_hat);
}

static int count_point_edge_pairs(const EvalPoint *at)
{
    return self_contact_data(at)->boundary.point_count;
}

/* Computes s = (d/d_hat)^2, the normal n and the place r from q and e. */
static void compute_pair_distance(const SelfContact *self, Element *element)
{
    const double *q = element->v, *e = element->v + 2;
    double along = dot2(q, e), length2 = dot2(e, e), d;
    if (along > 0 && along < length2) {
        double length = sqrt(length2), side = cross(e, q);
        double sign = copysign(1 / length, side);
        d = fabs(side) / length;
        element->r = along / length2;
        element->n[0] = -sign * e[1];
        element->n[1] = sign * e[0];
    } else {
        element->r = along > 0;
        element->n[0] = q[0] - element->r * e[0];
        element->n[1] = q[1] - element->r * e[1];
        d = sqrt(dot2(element->n, element->n));
        element->n[0] /= d;
        element->n[1] /= d;
    }
    element->s = (d / self->d_hat) * (d / self->d_hat);
}

/* Whether d is smaller than the rounding of the positions.  The point may then
 * be on the other side of the edge, so x is infeasible. */
static bool distance_is_below_rounding(const SelfContact *self,
                                       const Element *element, const double *x)
{
    double size = 0;
    for (int i = 0; i < 6; i++)
        size = fmax(size, fabs(x[2 * element->node[i / 2] + i % 2]));
    double least = 16 * DBL_EPSILON * size / self->d_hat;
    return !(element->s > least * least);
}

/* Finds the next edge near point i (element->search_cursor).  The boxes of the
 * boundary cover the motion along p, so `way` is not needed. */
static bool pair_get_element(const EvalPoint *at, int i, double way,
                             Element *element)
{
    static const double differences[2][3] = {{1, -1, 0}, {0, -1, 1}};
    SelfContact *self = self_contact_data(at);
    Boundary *boundary = &self->boundary;
    int edge;
    while ((edge = boundary_near_edge(boundary, at->system, i,
                                      &element->search_cursor)) >= 0) {
        const PointEdgePair pair = {boundary->point_node[i], edge};
        element->vector_count = 2;
        element->node_count = get_pair_nodes(at->system, pair, element->node);
        element->node_weight = differences;
        element->derivative_factor = at->weight;
        element->partner_index = edge;
        compute_node_differences(at->x, element->node[0], element->node[2],
                                 element->node[1], element->v);
        compute_pair_distance(self, element);
        if (!boundary->is_swept && element->s >= 1)
            continue;
        if (distance_is_below_rounding(self, element, at->x))
            element->s = 0;
        element->block_index =
            boundary->is_swept ? -1 : find_pair_block(self, pair);
        return true;
    }
    (void)way;
    return false;
}

static double pair_potential(const EvalPoint *at, const Element *element)
{
    return self_contact_data(at)->c * barrier_value(element->s);
}

/* Returns the force -dW/dd >= 0 (N). */
static double pair_force(const SelfContact *self, double S)
{
    return -self->c * barrier_slope(S) * 2 * sqrt(S) / self->d_hat;
}

/* The distance d changes by n.(dq - r de) if q, e change by dq, de. */
static void pair_gradient(const EvalPoint *at, const Element *element,
                          double g[4])
{
    double F = pair_force(self_contact_data(at), element->s);
    for (int i = 0; i < 4; i++)
        g[i] = F * element->n[i % 2] * (i < 2 ? -1 : element->r);
}

/* The second derivative of W(d), with F = -W', is W'' w_n^2 >= 0 plus
 *     F (2 w_t e_n/|e| + d e_n^2/|e|^2)   if p is beside the edge,
 *     -F/d w_t^2                          if p is beyond an end.
 * The vectors q, e of the element change by dq, de; w = dq - r de; w_n = n.w,
 * e_n = n.de with the gap's direction n; w_t = t.w with t across n.
 * Only the added part, a 2x2 matrix in (w_t, e_n), is projected. */
static bool pair_hessian(const EvalPoint *at, const Element *element,
                         Projection projection, double H[4][4])
{
    const SelfContact *self = self_contact_data(at);
    const double *n = element->n, *e = element->v + 2;
    double S = element->s, r = element->r, d = sqrt(S) * self->d_hat;
    double F = pair_force(self, S), length = sqrt(dot2(e, e));
    double bend = self->c / (self->d_hat * self->d_hat) *
                  (4 * S * barrier_curvature(S) + 2 * barrier_slope(S));
    double sign = copysign(1, cross(e, n)); /* makes t.e >= 0 */
    const double t[2] = {sign * n[1], -sign * n[0]};
    bool beside = r > 0 && r < 1;
    double Q[3] = {beside ? 0 : -F / d, beside ? F / length : 0,
                   beside ? F * d / (length * length) : 0};
    bool changed = project_psd_2x2(projection, Q);
    const double wn[4] = {n[0], n[1], -r * n[0], -r * n[1]};
    const double wt[4] = {t[0], t[1], -r * t[0], -r * t[1]};
    const double en[4] = {0, 0, n[0], n[1]};
    for (int i = 0; i < 4; i++)
        for (int k = i; k < 4; k++)
            H[i][k] = H[k][i] = bend * wn[i] * wn[k] + Q[0] * wt[i] * wt[k] +
                                Q[1] * (wt[i] * en[k] + en[i] * wt[k]) +
                                Q[2] * en[i] * en[k];
    return changed;
}

/* A quadratic function of a, the part of the step that is done. */
typedef struct Quadratic {
    double c0, c1, c2; /* coefficients of 1, a, a^2 */
} Quadratic;

/* Returns the change of top^2/l in the step (a = 1) without its linear part,
 * which is added to *first.  A negative top counts as 0 unless `always`. */
static double ratio_taylor_remainder(Quadratic top, Quadratic l, bool always,
                                     double *first)
{
    double N = top.c0, change = top.c1 + top.c2, end = l.c0 + l.c1 + l.c2;
    bool starts = always || N > 0, ends = always || N + change > 0;
    if (!starts)
        return ends ? (N + change) * (N + change) / end : 0;
    double one = (2 * N * top.c1 - N * N * l.c1 / l.c0) / l.c0;
    *first += one;
    if (!ends)
        return -N * N / l.c0 - one;
    return (2 * N * top.c2 + change * change - N * N * l.c2 / l.c0 -
            one * (l.c1 + l.c2)) /
           end;
}

static double pair_taylor_remainder(const EvalPoint *at, const Element *element,
                                    const double P[4], double alpha)
{
    const SelfContact *self = self_contact_data(at);
    const double *q = element->v, *e = element->v + 2;
    const double dq[2] = {alpha * P[0], alpha * P[1]};
    const double de[2] = {alpha * P[2], alpha * P[3]};
    double d_hat2 = self->d_hat * self->d_hat, first = 0;
    const Quadratic l = {dot2(e, e), 2 * dot2(e, de), dot2(de, de)};
    const Quadratic side = {cross(e, q), cross(de, q) + cross(e, dq),
                            cross(de, dq)};
    const Quadratic low = {-dot2(q, e), -dot2(dq, e) - dot2(q, de),
                           -dot2(dq, de)};
    const Quadratic high = {-low.c0 - l.c0, -low.c1 - l.c1, -low.c2 - l.c2};
    double rest = ratio_taylor_remainder(side, l, true, &first) +
                  ratio_taylor_remainder(low, l, false, &first) +
                  ratio_taylor_remainder(high, l, false, &first);
    double S = element->s, slope = barrier_slope(S);
    if (S < 1 && S + (first + rest) / d_hat2 >= 1) /* d ends above d_hat */
        return self->c * (-barrier_value(S) - slope * first / d_hat2);
    return self->c * (slope * rest / d_hat2 +
                      barrier_taylor_remainder(S, (first + rest) / d_hat2));
}

/* Finds the first alpha > 0 at which the point p is on the edge: the quadratic
 * equation e x q = 0 holds, and the place r on the line is in [0, 1].  If p
 * moves along the line of the edge, e x q stays 0, and the neighbouring edge
 * finds the collision with the edge's end. */
static double pair_max_alpha(const EvalPoint *at, const Element *element,
                             const double P[4])
{
    static const double ENDS = 1e-9; /* tolerance of r at the ends 0, 1 */
    const double *q = element->v, *e = element->v + 2, *dq = P, *de = P + 2;
    double c0 = cross(e, q), c1 = cross(de, q) + cross(e, dq);
    double c2 = cross(de, dq), discriminant = c1 * c1 - 4 * c2 * c0;
    double first = INFINITY;
    (void)at;
    if (!(discriminant >= 0))
        return INFINITY;
    double k = -0.5 * (c1 + copysign(sqrt(discriminant), c1));
    const double root[2] = {k / c2, c0 / k};
    for (int i = 0; i < 2; i++) {
        double alpha = root[i];
        const double Q[2] = {q[0] + alpha * dq[0], q[1] + alpha * dq[1]};
        const double E[2] = {e[0] + alpha * de[0], e[1] + alpha * de[1]};
        double r = dot2(Q, E) / dot2(E, E);
        if (alpha > 0 && alpha < first && r >= -ENDS && r <= 1 + ENDS)
            first = alpha;
    }
    return ELEMENT_LIMIT * first;
}

/* Returns the friction limit, mu times the normal force.
 *   t  out, t.(dq, de) is the slip if the vectors q, e change by dq, de */
static double pair_friction_limit(const EvalPoint *at, const Element *element,
                                  double t[4], double *speed)
{
    const SelfContact *self = self_contact_data(at);
    const double *n = element->n;
    t[0] = -n[1];
    t[1] = n[0];
    t[2] = element->r * n[1];
    t[3] = -element->r * n[0];
    *speed = 0;
    return self->mu * pair_force(self, element->s);
}

static const ElementKind near_pairs = {
    .count_elements = count_point_edge_pairs,
    .get_element = pair_get_element,
    .get_block_nodes = get_pair_block_nodes,
    .potential = pair_potential,
    .gradient = pair_gradient,
    .hessian = pair_hessian,
    .taylor_remainder = pair_taylor_remainder,
    .count_blocks = count_pair_blocks,
    .find_elements = gather_near_edges,
    .max_alpha = pair_max_alpha,
    .friction_limit = pair_friction_limit,
};

/* ---- the term ----------------------------------------------------------- */

/* Returns the largest eigenvalue of W's Hessian at d = d_hat, 16 c/d_hat^2. */
static double pair_max_stiffness(const EvalPoint *at)
{
    const SelfContact *self = self_contact_data(at);
    return 16 * self->c / (self->d_hat * self->d_hat);
}

static void self_contact_free(void *data)
{
    SelfContact *self = data;
    free(self->pair);
    free(self->boundary.x);
}

const TermKind self_contact_energy = {
    .name = "bodies that touch",
    ELEMENTS(near_pairs),
    .energy_name = "contact",
    .rank = RANK_CONTACT,
    .begin_step = self_contact_begin_step,
    .extend_pattern = self_contact_extend_pattern,
    .max_stiffness = pair_max_stiffness,
    .free = self_contact_free,
};

SelfContact *get_self_contact(const System *system)
{
    return system_term_data(system, &self_contact_energy);
}

Status self_contact_configure(System *system, const SquareMesh *mesh,
                              const Barrier *barrier, double friction)
{
    SelfContact *self =
        system_add_term(system, &self_contact_energy, sizeof *self);
    if (!self || (!self->boundary.x && boundary_create(mesh, &self->boundary)))
        return STATUS_OUT_OF_MEMORY;
    self->d_hat = barrier->d_hat;
    self->c = barrier->c / 8;
    self->mu = friction;
    return STATUS_OK;
}
