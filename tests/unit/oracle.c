/* oracle.c - each energy a second time, with dual numbers of 19 digits. */
#include "oracle.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/cells.h"
#include "model/damping.h"
#include "model/friction.h"
#include "model/mass_spring_energy.h"
#include "model/neo_hookean.h"
#include "model/plasticity.h"
#include "model/pull_energy.h"
#include "model/self_contact.h"

/* Returns a + factor b. */
static Jet jet_add(Jet a, Real factor, Jet b)
{
    return (Jet){a.f + factor * b.f, a.p + factor * b.p, a.q + factor * b.q,
                 a.pq + factor * b.pq};
}

static Jet jet_mul(Jet a, Jet b)
{
    return (Jet){a.f * b.f, a.p * b.f + a.f * b.p, a.q * b.f + a.f * b.q,
                 a.pq * b.f + a.f * b.pq + a.p * b.q + a.q * b.p};
}

/* Returns F(a), given the values of F, F' and F'' at a. */
static Jet jet_apply(Jet a, Real F, Real F1, Real F2)
{
    return (Jet){F, F1 * a.p, F1 * a.q, F1 * a.pq + F2 * a.p * a.q};
}

/* Adds factor times a part to the sum, and its absolute value to abs_sum. */
static void add_part(Probe *probe, Jet *sum, Real factor, Jet part)
{
    probe->part_count++;
    *sum = jet_add(*sum, factor, part);
    probe->abs_sum = jet_add(
        probe->abs_sum, fabsl(factor),
        (Jet){fabsl(part.f), fabsl(part.p), fabsl(part.q), fabsl(part.pq)});
}

/* Returns x, with a random error of one ulp if the probe has jitter. */
static Real add_jitter(Probe *probe, Real x)
{
    return probe->jitter
               ? x * (1 + DBL_EPSILON * random_uniform(probe->jitter, -1, 1))
               : x;
}

/* Returns coordinate c of x or, with of_u, of the step u that leads to x. */
static Jet get_coordinate(Probe *probe, int c, bool of_u)
{
    const EvalPoint *at = probe->at;
    Real x = of_u ? at->u[c] : at->x ? at->x[c] : (Real)at->x_n[c] + at->u[c];
    if (probe->p)
        x += probe->alpha * probe->p[c];
    return (Jet){add_jitter(probe, x), probe->p ? probe->p[c] : 0,
                 probe->q ? probe->q[c] : 0, 0};
}

static Jet node_offset(Probe *probe, int i, int j, int axis, bool of_u)
{
    return jet_add(get_coordinate(probe, 2 * i + axis, of_u), -1,
                   get_coordinate(probe, 2 * j + axis, of_u));
}

Real exact_strain(const System *system, const double *x, int s)
{
    int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
    Real dx = (Real)x[i] - x[j], dy = (Real)x[i + 1] - x[j + 1];
    return (dx * dx + dy * dy) / system->l2[s] - 1;
}

/* Returns the random or chosen error of a flow limit. A spring that has flowed
 * begins the next step at its limit, and rounding decides whether it flows. */
static Real choose_yield_error(Probe *probe, Real E)
{
    Real side = probe->jitter ? random_uniform(probe->jitter, -1, 1)
                              : probe->yield_side;
    return 8 * DBL_EPSILON * (1 + fabsl(E)) * side;
}

/* Adds k l^2 V(E), E the strain of spring s: plasticity.h, damping.h. */
static void add_spring_energy(Probe *probe, Jet *sum, const void *data, int s)
{
    const System *system = probe->at->system;
    const Plasticity *flow =
        data == system_term_data(system, &plastic_energy) ? data : NULL;
    const Damping *damped =
        probe->at->u ? system_term_data(system, &damping) : NULL;
    Real theta = damped ? damped->eta / probe->h : 0;
    Jet E = {.f = -1}, V;
    for (int axis = 0; axis < 2; axis++) {
        Jet d = node_offset(probe, system->e[2 * s], system->e[2 * s + 1], axis,
                            false);
        E = jet_add(E, 1 / (Real)system->l2[s], jet_mul(d, d));
    }
    Real e = E.f - (flow ? flow->ep[s] : 0), kappa = 0;
    Real held = fabsl(e), over = 0, hard = 1; /* |e| up to yield, and excess */
    bool flows = false;
    if (flow) {
        kappa = flow->kappa[s];
        hard = 1 - add_jitter(probe, 1 / (1 + (Real)flow->hardening));
        Real yield = flow->initial_yield_strain + flow->hardening * (Real)kappa;
        held = fminl(held, yield);
        over = fabsl(e) - held;
        flows = fabsl(e) - yield > choose_yield_error(probe, E.f);
    }
    V = jet_apply(E, held * (held / 2 + over) + hard * over * over / 2,
                  copysignl(held + hard * over, e), flows ? hard : 1);
    Jet rate = E;
    rate.f -= theta > 0 ? exact_strain(system, probe->at->x_n, s) : 0;
    V = jet_add(V, theta / 2, jet_mul(rate, rate));
    V.f += flow ? flow->hardening * kappa * kappa / 2 : 0;
    add_part(probe, sum, (Real)system->k[s] * system->l2[s], V);
}

/* Adds c f(s): barrier.h. */
static void add_barrier(Probe *probe, Jet *sum, Real c, Jet s)
{
    if (s.f < 1)
        add_part(probe, sum, c,
                 jet_apply(s, s.f > 0 ? (s.f - 1) * logl(s.f) : INFINITY,
                           logl(s.f) + 1 - 1 / s.f, (1 + s.f) / (s.f * s.f)));
}

/* Returns the gap of contact.h divided by d_hat, and the gap's direction n. */
static Jet find_relative_gap(Probe *probe, const Contact *contact, int i, int k,
                             Real n[2])
{
    const Obstacle *it = &contact->obstacle[k];
    Jet d[2], s = {0};
    for (int axis = 0; axis < 2; axis++) {
        d[axis] = it->ball_node >= 0
                      ? node_offset(probe, i, it->ball_node, axis, false)
                      : get_coordinate(probe, 2 * i + axis, false);
        Real o = it->o[axis] - probe->rewind_time * it->v[axis];
        d[axis].f -= it->ball_node >= 0 ? 0 : add_jitter(probe, o);
        n[axis] = it->n[axis];
    }
    if (it->kind == OBSTACLE_BALL) {
        Jet r2 = jet_add(jet_mul(d[0], d[0]), 1, jet_mul(d[1], d[1]));
        Real r = sqrtl(r2.f);
        s = jet_apply(r2, r - it->radius, 1 / (2 * r), -1 / (4 * r2.f * r));
        n[0] = d[0].f / r;
        n[1] = d[1].f / r;
    } else {
        s = jet_add((Jet){0}, n[0], d[0]);
        s = jet_add(s, n[1], d[1]);
    }
    if (contact->free_ball_index >= 0 &&
        contact->obstacle[contact->free_ball_index].ball_node == i)
        s.f -= contact->obstacle[contact->free_ball_index].radius;
    return jet_add((Jet){0}, 1 / (Real)contact->barrier.d_hat, s);
}

/* Returns f0(y): friction.h. */
static Jet evaluate_friction_law(Jet y, Real e)
{
    Real a = fabsl(y.f) / e, sign = copysignl(1, y.f);
    return a < 1 ? jet_apply(y, y.f * y.f / e * (1 - a / 3), sign * a * (2 - a),
                             2 / e * (1 - a))
                 : jet_apply(y, fabsl(y.f) - e / 3, sign, 0);
}

/* Adds W of friction.h for node i and obstacle k, with the contact at x_n. */
static void add_wall_friction(Probe *probe, Jet *sum, const Contact *contact,
                              int i, int k)
{
    const Obstacle *it = &contact->obstacle[k];
    const EnergyTerm *term =
        system_find_term(probe->at->system, &friction_energy);
    if (!term || !probe->at->u || !(it->mu > 0))
        return;
    EvalPoint start = *probe->at;
    Probe before = {.at = &start,
                    .jitter = probe->jitter,
                    .rewind_time = probe->motion_time};
    Real n[2], e = ((const Friction *)term->data)->slip_speed * probe->h;
    start.x = start.x_n;
    Real s = find_relative_gap(&before, contact, i, k, n).f;
    if (!(s < 1))
        return;
    Jet y = {.f = -probe->h * (n[0] * add_jitter(probe, it->v[1]) -
                               n[1] * add_jitter(probe, it->v[0]))};
    for (int axis = 0; axis < 2; axis++)
        y = jet_add(y, axis ? n[0] : -n[1],
                    it->ball_node >= 0
                        ? node_offset(probe, i, it->ball_node, axis, true)
                        : get_coordinate(probe, 2 * i + axis, true));
    add_part(probe, sum,
             it->mu * contact->barrier.c / contact->barrier.d_hat *
                 -(logl(s) + 1 - 1 / s),
             evaluate_friction_law(y, e));
}

/* Adds c f(d/d_hat) of node i and obstacle k: contact.h. */
static void add_wall_barrier(Probe *probe, Jet *sum, const Contact *contact,
                             int i, int k)
{
    Real n[2];
    add_barrier(probe, sum, contact->barrier.c,
                find_relative_gap(probe, contact, i, k, n));
}

static void add_wall_contact(Probe *probe, Jet *sum, const void *data, int i)
{
    const System *system = probe->at->system;
    const Contact *contact = get_contact(system);
    int node = i % system->nodes, k = i / system->nodes;
    if (contact_includes_pair(contact, system, node, k))
        (data == contact ? add_wall_barrier
                         : add_wall_friction)(probe, sum, contact, node, k);
}

/* Boundary of the bodies, as in boundary.h. Spring [i][k] begins at node i and
 * leads, for k = 0 to 3, up, right, up right and down right. */
typedef struct Outline {
    int edge_count, point_count, *point_node,
        (*edge_nodes)[2];               /* counts; nodes of points, edges */
    unsigned char (*is_intact)[4];      /* [n] 1: the spring is unbroken */
    unsigned char (*triangle_count)[4]; /* [n] number at each spring */
    unsigned char *role; /* [n] flags NODE_IN_TRIANGLE, NODE_ON_EDGE */
    double *x;           /* [2n] m, positions rounded to doubles */
} Outline;

enum { NODE_IN_TRIANGLE = 1, NODE_ON_EDGE = 2 };

static void add_outline_triangle(Outline *outline, int a, int high, int corner)
{
    const int node[4] = {a, a + high, a + high + 1, a + 1};
    unsigned char(*sides)[4] = outline->triangle_count;
    ++*(corner / 2 ? &sides[node[3]][1] : &sides[a][1]);
    ++*(corner % 3 ? &sides[node[1]][0] : &sides[a][0]);
    ++*(corner % 2 ? &sides[a][2] : &sides[node[3]][3]);
    for (int k = 0; k < 4; k++)
        outline->role[node[k]] |= k != (corner + 2) % 4 ? NODE_IN_TRIANGLE : 0;
}

static void add_outline_cell(Outline *outline, int a, int high)
{
    bool solid[4];
    for (int corner = 0; corner < 4; corner++)
        solid[corner] = outline->is_intact[corner / 2 ? a + 1 : a][1] &&
                        outline->is_intact[corner % 3 ? a + high : a][0] &&
                        (corner % 2 ? outline->is_intact[a][2]
                                    : outline->is_intact[a + 1][3]);
    bool both = solid[0] && solid[2], others = solid[1] && solid[3];
    for (int corner = 0; corner < 4; corner++)
        if (solid[corner] && corner % 2 == (others && !both))
            add_outline_triangle(outline, a, high, corner);
}

/* Returns the boundary, which is empty without self-contact. */
static Outline find_outline(const System *system)
{
    static double *bytes;
    if (!get_self_contact(system))
        return (Outline){0};
    const SquareMesh *shape = &get_self_contact(system)->boundary.mesh;
    int n = system->nodes, high = shape->rows + 1, wide = shape->columns + 1;
    bytes = realloc(bytes, (size_t)n * (25 + 9 * sizeof(int)));
    CHECK(bytes != NULL);
    Outline it = {.x = bytes, .point_node = (int *)(bytes + 2 * n)};
    it.edge_nodes = (int(*)[2])(it.point_node + n);
    it.is_intact = (unsigned char(*)[4])(it.edge_nodes + 4 * n);
    it.triangle_count = it.is_intact + n;
    it.role = (unsigned char *)(it.triangle_count + n);
    memset(it.is_intact, 0, 9 * (size_t)n);
    for (int s = 0; s < system->springs; s++) {
        int i = system->e[2 * s], j = system->e[2 * s + 1];
        int low = i < j ? i : j, way = i + j - 2 * low;
        bool up = way == 1 && low % high < high - 1;
        it.is_intact[low][up            ? 0
                          : way < high  ? 3
                          : way == high ? 1
                                        : 2] = system->k[s] != 0;
    }
    for (int i = 0; i < n; i++)
        if (i % high < high - 1 && i / high % wide < wide - 1)
            add_outline_cell(&it, i, high);
    for (int i = 0; i < 4 * n; i++)
        if (it.triangle_count[i / 4][i % 4] == 1) {
            const int way[4] = {1, high, high + 1, high - 1};
            int *edge = it.edge_nodes[it.edge_count++];
            edge[0] = i / 4;
            edge[1] = i / 4 + way[i % 4];
            it.role[edge[0]] |= NODE_ON_EDGE;
            it.role[edge[1]] |= NODE_ON_EDGE;
        }
    for (int i = 0; i < n; i++)
        if (it.role[i] != NODE_IN_TRIANGLE)
            it.point_node[it.point_count++] = i;
    return it;
}

/* Returns d^2/d_hat^2 of point p and an edge. r: position of the nearest point
 * along the edge, 0 to 1; n: unit vector from there to p */
static Jet find_point_edge_gap(Probe *probe, const SelfContact *self, int p,
                               const int end[2], Real *r, Real n[2])
{
    Jet d[2], e[2], q[2], length2, along, d2;
    for (int axis = 0; axis < 2; axis++) {
        e[axis] = node_offset(probe, end[1], end[0], axis, false);
        q[axis] = node_offset(probe, p, end[0], axis, false);
        d[axis] = q[axis];
    }
    along = jet_add(jet_mul(q[0], e[0]), 1, jet_mul(q[1], e[1]));
    length2 = jet_add(jet_mul(e[0], e[0]), 1, jet_mul(e[1], e[1]));
    Real l = length2.f;
    *r = fminl(fmaxl(along.f / l, 0), 1);
    if (*r == 1)
        for (int axis = 0; axis < 2; axis++)
            d[axis] = node_offset(probe, p, end[1], axis, false);
    d2 = jet_add(jet_mul(d[0], d[0]), 1, jet_mul(d[1], d[1]));
    if (*r > 0 && *r < 1) {
        Jet side = jet_add(jet_mul(e[0], q[1]), -1, jet_mul(e[1], q[0]));
        d2 = jet_mul(jet_mul(side, side),
                     jet_apply(length2, 1 / l, -1 / (l * l), 2 / (l * l * l)));
    }
    for (int axis = 0; axis < 2; axis++)
        n[axis] = (q[axis].f - *r * e[axis].f) / sqrtl(d2.f);
    return jet_add((Jet){0}, 1 / ((Real)self->d_hat * self->d_hat), d2);
}

/* Adds W of friction.h for point p and an edge, with the contact at x_n. */
static void add_self_friction(Probe *probe, Jet *sum, const SelfContact *self,
                              int p, const int end[2])
{
    const System *system = probe->at->system;
    const EnergyTerm *term = system_find_term(system, &self_friction_energy);
    if (!term || !probe->at->u)
        return;
    EvalPoint start = *probe->at;
    Probe before = {.at = &start, .h = probe->h, .jitter = probe->jitter};
    Real n[2], r, e = ((const Friction *)term->data)->slip_speed * probe->h;
    start.x = start.x_n;
    Real S = find_point_edge_gap(&before, self, p, end, &r, n).f;
    Jet y = {0};
    if (!(S < 1))
        return;
    for (int axis = 0; axis < 2; axis++) {
        Real t = axis ? n[0] : -n[1];
        y = jet_add(y, t, get_coordinate(probe, 2 * p + axis, true));
        y = jet_add(y, -t * (1 - r),
                    get_coordinate(probe, 2 * end[0] + axis, true));
        y = jet_add(y, -t * r, get_coordinate(probe, 2 * end[1] + axis, true));
    }
    add_part(probe, sum,
             self->mu * self->c / self->d_hat * 2 * sqrtl(S) *
                 -(logl(S) + 1 - 1 / S),
             evaluate_friction_law(y, e));
}

/* Returns true if a point is further than `most` from an edge, as most points
 * are: the pair then has no energy. */
static bool is_far(const double *x, int p, const int end[2], double most)
{
    for (int c = 0; c < 2; c++) {
        double a = x[2 * end[0] + c], b = x[2 * end[1] + c], at = x[2 * p + c];
        if ((at > a + most && at > b + most) ||
            (at < a - most && at < b - most))
            return true;
    }
    return false;
}

/* Adds the barrier or the friction of point-edge pair i: self_contact.h. */
static void add_self_contact(Probe *probe, Jet *sum, const void *data, int i)
{
    const SelfContact *self = get_self_contact(probe->at->system);
    const Outline *outline = probe->outline;
    const int p = outline->point_node[i % outline->point_count];
    const int *end = outline->edge_nodes[i / outline->point_count];
    const double *x = data == self ? outline->x : probe->at->x_n;
    Real n[2], r;
    if (p == end[0] || p == end[1] || is_far(x, p, end, 1.001 * self->d_hat))
        return;
    if (data == self)
        add_barrier(probe, sum, self->c,
                    find_point_edge_gap(probe, self, p, end, &r, n));
    else
        add_self_friction(probe, sum, self, p, end);
}

/* Computes J of triangle t, area / area at rest; false: it is torn. */
static bool find_cell_area(Probe *probe, const CellBarriers *cells, int t,
                           Jet *J)
{
    const double *k = probe->at->system->k;
    const int *node = cells->triangles.node[t], *side = cells->side_springs[t];
    Jet e[2][2];
    if (k[side[0]] == 0 || k[side[1]] == 0 || k[side[2]] == 0)
        return false;
    for (int axis = 0; axis < 2; axis++)
        for (int edge = 0; edge < 2; edge++)
            e[edge][axis] =
                node_offset(probe, node[1 + edge], node[0], axis, false);
    *J = jet_add(jet_mul(e[0][0], e[1][1]), -1, jet_mul(e[0][1], e[1][0]));
    *J = jet_add((Jet){0}, 1 / (2 * (Real)cells->triangles.rest_area), *J);
    return true;
}

/* Adds A0 k_c f(J/J_hat) of triangle t: cells.h. */
static void add_cell_energy(Probe *probe, Jet *sum, const void *data, int t)
{
    const CellBarriers *cells = data;
    Jet J;
    if (find_cell_area(probe, cells, t, &J))
        add_barrier(probe, sum, cells->c, jet_add((Jet){0}, 1 / 0.4L, J));
}

/* Adds A0 (mu/2 (|F|^2 - 2) - mu ln J + lambda/2 (ln J)^2): neo_hookean.h. */
static void add_triangle_energy(Probe *probe, Jet *sum, const void *data, int t)
{
    const NeoHookean *solid = data;
    const int *node = solid->triangles.node[t];
    Jet F[4], size = {.f = -2}, J, L;
    for (int c = 0; c < 4; c++)
        F[c] =
            jet_add((Jet){0}, 1 / sqrtl(2 * (Real)solid->triangles.rest_area),
                    node_offset(probe, node[1 + c / 2], node[0], c % 2, false));
    for (int c = 0; c < 4; c++)
        size = jet_add(size, 1, jet_mul(F[c], F[c]));
    J = jet_add(jet_mul(F[0], F[3]), -1, jet_mul(F[1], F[2]));
    if (!(J.f > 0)) {
        add_part(probe, sum, 1, (Jet){.f = INFINITY});
        return;
    }
    L = jet_apply(J, logl(J.f), 1 / J.f, -1 / (J.f * J.f));
    add_part(probe, sum, solid->triangles.rest_area * (Real)solid->mu / 2,
             size);
    add_part(probe, sum, -solid->triangles.rest_area * (Real)solid->mu, L);
    add_part(probe, sum, solid->triangles.rest_area * (Real)solid->lambda / 2,
             jet_mul(L, L));
}

/* Adds k/2 |x - o|^2 of coordinate c: pull_energy.h. */
static void add_pull_energy(Probe *probe, Jet *sum, const void *data, int c)
{
    const NodePull *pull = data;
    Jet d = get_coordinate(probe, c, false);
    d.f -= pull->target[c % 2];
    if (pull->node == c / 2)
        add_part(probe, sum, (Real)pull->k / 2, jet_mul(d, d));
}

/* Objects over which a term sums */
typedef enum TermPart {
    PART_SPRING,
    PART_COORDINATE,
    PART_WALL_PAIR,
    PART_CELL,
    PART_TRIANGLE,
    PART_EDGE_PAIR
} TermPart;

static int count_parts(const Probe *probe, TermPart parts, const void *data)
{
    const System *system = probe->at->system;
    const Contact *contact = get_contact(system);
    switch (parts) {
    case PART_SPRING:
        return system->springs;
    case PART_COORDINATE:
        return 2 * system->nodes;
    case PART_WALL_PAIR:
        return contact->obstacle_count * system->nodes;
    case PART_CELL:
    case PART_TRIANGLE:
        return ((const Triangles *)data)->count;
    default:
        return probe->outline->edge_count * probe->outline->point_count;
    }
}

/* ---- what clamping adds ------------------------------------------------- */

/* Own coordinates q_k of a part, on which its energy depends. derivative: of
 * q_k by the nodes' x and y; dx_dq: displacement that adds 1 to q_k only */
typedef struct LocalAxes {
    int n, node[3];
    Real dq_dx[4][6];
    double dx_dq[4][6];
} LocalAxes;

/* Fills the frame of the difference of two nodes, or of one node if j < 0. */
static void fill_two_node_axes(LocalAxes *frame, int i, int j)
{
    *frame = (LocalAxes){.n = 2, .node = {i, j < 0 ? i : j, i}};
    for (int c = 0; c < 2; c++) {
        frame->dq_dx[c][c] = frame->dx_dq[c][c] = 1;
        frame->dq_dx[c][2 + c] = j < 0 ? 0 : -1;
    }
}

/* Fills the frame of two vectors, which are weighted sums of three nodes. */
static void fill_three_node_axes(LocalAxes *frame, const int node[3],
                                 const double w[2][3])
{
    *frame = (LocalAxes){.n = 4, .node = {node[0], node[1], node[2]}};
    double det = w[0][1] * w[1][2] - w[0][2] * w[1][1];
    for (int k = 0; k < 4; k++) {
        int m = k / 2, c = k % 2;
        for (int i = 0; i < 3; i++)
            frame->dq_dx[k][2 * i + c] = w[m][i];
        frame->dx_dq[k][2 + c] = (m ? -w[0][2] : w[1][2]) / det;
        frame->dx_dq[k][4 + c] = (m ? w[0][1] : -w[1][1]) / det;
    }
}

/* Fills the frame of a point and an edge with the two motions that can have a
 * negative curvature: the point slides along the edge, and the edge turns. */
static void fill_point_edge_axes(Probe *probe, LocalAxes *frame, int i)
{
    const SelfContact *self = get_self_contact(probe->at->system);
    const Outline *outline = probe->outline;
    const int p = outline->point_node[i % outline->point_count];
    const int *end = outline->edge_nodes[i / outline->point_count];
    Real n[2], r;
    if (p == end[0] || p == end[1] || is_far(outline->x, p, end, self->d_hat))
        return;
    find_point_edge_gap(probe, self, p, end, &r, n);
    *frame = (LocalAxes){.n = 2, .node = {p, end[0], end[1]}};
    for (int c = 0; c < 2; c++) {
        Real t = c ? n[0] : -n[1];
        const Real read[2][6] = {{t, 0, (r - 1) * t, 0, -r * t, 0},
                                 {0, 0, -n[c], 0, n[c], 0}};
        for (int k = 0; k < 6; k += 2)
            for (int m = 0; m < 2; m++)
                frame->dq_dx[m][k + c] = read[m][k];
        frame->dx_dq[0][c] = (double)t;
        frame->dx_dq[1][c] = (double)(r * n[c]);
        frame->dx_dq[1][4 + c] = (double)n[c];
    }
}

/* Returns the frame of part i; n = 0 if the energy of the part is convex. */
static LocalAxes make_local_axes(Probe *probe, TermPart parts, const void *data,
                                 int i)
{
    static const double edges[2][3] = {{-1, 1, 0}, {-1, 0, 1}};
    const System *system = probe->at->system;
    const Triangles *triangles = data;
    LocalAxes frame = {0};
    if (parts == PART_SPRING)
        fill_two_node_axes(&frame, system->e[2 * i], system->e[2 * i + 1]);
    else if (parts == PART_WALL_PAIR)
        fill_two_node_axes(
            &frame, i % system->nodes,
            ((const Contact *)data)->obstacle[i / system->nodes].ball_node);
    else if (parts == PART_CELL || parts == PART_TRIANGLE)
        fill_three_node_axes(&frame, triangles->node[i], edges);
    else if (parts == PART_EDGE_PAIR)
        fill_point_edge_axes(probe, &frame, i);
    return frame;
}

/* Formula of each term, and its parts; data is the term's EnergyTerm.data */
static const struct {
    const TermKind *kind;
    TermPart part_kind;
    void (*add_energy)(Probe *probe, Jet *sum, const void *data, int i);
} formulas[] = {{&mass_spring_energy, PART_SPRING, add_spring_energy},
                {&plastic_energy, PART_SPRING, add_spring_energy},
                {&contact_energy, PART_WALL_PAIR, add_wall_contact},
                {&friction_energy, PART_WALL_PAIR, add_wall_contact},
                {&cell_energy, PART_CELL, add_cell_energy},
                {&central_field, PART_COORDINATE, add_pull_energy},
                {&hand_energy, PART_COORDINATE, add_pull_energy},
                {&neo_hookean_energy, PART_TRIANGLE, add_triangle_energy},
                {&self_contact_energy, PART_EDGE_PAIR, add_self_contact},
                {&self_friction_energy, PART_EDGE_PAIR, add_self_contact}};

static int find_formula_row(const TermKind *kind)
{
    int row = (int)(sizeof formulas / sizeof *formulas) - 1;
    while (row >= 0 && formulas[row].kind != kind)
        row--;
    return row;
}

/* Adds to p [2n] the displacement that changes own coordinate k by `sign`. */
static void add_dx_dq(const LocalAxes *frame, int k, double sign, double *p)
{
    for (int i = 0; i < 6; i++)
        p[2 * frame->node[i / 2] + i % 2] += sign * frame->dx_dq[k][i];
}

/* Finds the negative eigenvalues of a part's Hessian block, in the part's own
 * coordinates; returns their number. p, q [2n] are 0 before and after.
 *   lift  [4] out, the change that makes each of these eigenvalues 0
 *   rows  [4][6] out, eigenvectors over the coordinates of the frame's nodes */
static int find_projection(const Probe *probe, int row, const void *data,
                           int part, double *p, double *q, LocalAxes *frame,
                           Real lift[4], Real rows[4][6])
{
    Probe own = *probe;
    *frame = make_local_axes(&own, formulas[row].part_kind, data, part);
    Real A[16], v[16];
    int n = frame->n;
    own.p = p;
    own.q = q;
    for (int i = 0; i < n * n; i++) {
        Jet W = {0};
        add_dx_dq(frame, i / n, 1, p);
        add_dx_dq(frame, i % n, 1, q);
        formulas[row].add_energy(&own, &W, data, part);
        add_dx_dq(frame, i / n, -1, p);
        add_dx_dq(frame, i % n, -1, q);
        A[i] = W.pq;
    }
    exact_eigenvectors(n, A, v);
    for (int k = 0; k < n; k++) {
        lift[k] = -fminl(A[(n + 1) * k], 0);
        for (int i = 0; i < 6; i++) {
            rows[k][i] = 0;
            for (int m = 0; m < n; m++)
                rows[k][i] += v[n * m + k] * frame->dq_dx[m][i];
        }
    }
    return n;
}

/* Returns the boundary with the positions x + alpha p. */
static Outline find_outline_at_point(const Probe *probe)
{
    Probe plain = *probe;
    Outline outline = find_outline(probe->at->system);
    plain.jitter = NULL;
    for (int c = 0; outline.x && c < 2 * probe->at->system->nodes; c++)
        outline.x[c] = (double)get_coordinate(&plain, c, false).f;
    return outline;
}

Jet oracle_energy(Probe *probe, const TermKind *only)
{
    const System *system = probe->at->system;
    Outline outline = find_outline_at_point(probe);
    Jet sum = {0};
    probe->outline = &outline;
    probe->abs_sum = (Jet){0};
    for (int t = 0; t < system->term_count; t++) {
        int row = find_formula_row(system->term[t].kind);
        const void *data = system->term[t].data;
        if (row < 0 || (only && only != formulas[row].kind))
            continue;
        int count = count_parts(probe, formulas[row].part_kind, data);
        for (int i = 0; i < count; i++)
            formulas[row].add_energy(probe, &sum, data, i);
    }
    probe->abs_sum = jet_add((Jet){0}, probe->at->weight, probe->abs_sum);
    return jet_add((Jet){0}, probe->at->weight, sum);
}

Jet oracle_step_energy(Probe *probe, const double *u_tilde)
{
    const System *system = probe->at->system;
    Jet sum = oracle_energy(probe, NULL);
    Probe still = *probe;
    still.jitter = NULL;
    for (int c = 0; c < 2 * system->nodes; c++) {
        Jet away = get_coordinate(&still, c, true);
        away.f -= u_tilde[c];
        add_part(probe, &sum, system->m[c / 2] / (Real)2, jet_mul(away, away));
    }
    return sum;
}

Real exact_potential(const System *system, const double *x)
{
    EvalPoint at = make_eval_point(system, x, NULL, x);
    Probe probe = {.at = &at};
    return oracle_energy(&probe, NULL).f;
}

/* ---- derivatives of a step ---------------------------------------------- */

/* Finds the nodes of part i, and returns their number. */
static int find_part_nodes(const Probe *probe, TermPart parts, const void *data,
                           int i, int node[3])
{
    const System *system = probe->at->system;
    const Outline *outline = probe->outline;
    const int *from = parts == PART_SPRING ? system->e + 2 * i
                      : parts == PART_CELL || parts == PART_TRIANGLE
                          ? ((const Triangles *)data)->node[i]
                          : node;
    if (parts == PART_COORDINATE)
        node[0] = i / 2;
    else if (parts == PART_WALL_PAIR) {
        node[0] = i % system->nodes;
        node[1] = get_contact(system)->obstacle[i / system->nodes].ball_node;
    } else if (parts == PART_EDGE_PAIR) {
        node[0] = outline->point_node[i % outline->point_count];
        memcpy(node + 1, outline->edge_nodes[i / outline->point_count],
               2 * sizeof *node);
    }
    int count = parts == PART_SPRING       ? 2
                : parts == PART_COORDINATE ? 1
                : parts != PART_WALL_PAIR  ? 3
                : node[1] < 0              ? 1
                                           : 2;
    memmove(node, from, (size_t)count * sizeof *node);
    return count;
}

/* Raises each negative eigenvalue by `lift_factor` times its amount. */
static void project_block(const Probe *probe, int row, const void *data,
                          int part, int lift_factor, double *p, double *q,
                          EnergyPart *block)
{
    LocalAxes frame;
    Real lift[4], rows[4][6];
    int size = 2 * block->node_count;
    int n = find_projection(probe, row, data, part, p, q, &frame, lift, rows);
    for (int i = 0; i < size * size; i++)
        for (int k = 0; k < n; k++)
            block->H[i] += lift_factor * probe->at->weight * lift[k] *
                           rows[k][i / size] * rows[k][i % size];
}

/* Computes the block of a part, if it has energy. p, q [2n] all 0 */
static bool evaluate_energy_part(Probe *probe, int row, const void *data,
                                 int part, int lift_factor, double *p,
                                 double *q, EnergyPart *block)
{
    long booked = probe->part_count;
    Real w = probe->at->weight;
    Jet W = {0};
    *block = (EnergyPart){0};
    formulas[row].add_energy(probe, &W, data, part);
    if (probe->part_count == booked)
        return false;
    block->node_count = find_part_nodes(probe, formulas[row].part_kind, data,
                                        part, block->node);
    int n = 2 * block->node_count;
    for (int i = 0; i < n * n; i++) {
        double *along = &p[2 * block->node[i / n / 2] + i / n % 2];
        double *across = &q[2 * block->node[i % n / 2] + i % n % 2];
        W = (Jet){0};
        *along = *across = 1;
        formulas[row].add_energy(probe, &W, data, part);
        *along = *across = 0;
        block->H[i] = w * W.pq;
        block->g[i / n] = w * W.p;
    }
    if (lift_factor && formulas[row].kind->rank != RANK_FRICTION)
        project_block(probe, row, data, part, lift_factor, p, q, block);
    return true;
}

/* Passes the inertia of each node and then all parts of all terms to `take`. */
static void visit_parts(const Probe *there, const double *u,
                        const double *u_tilde, int lift_factor,
                        void (*take)(void *to, const EnergyPart *block),
                        void *to)
{
    const System *system = there->at->system;
    Outline outline = find_outline_at_point(there);
    double *p = calloc(4 * (size_t)system->nodes, sizeof *p);
    double *q = p + 2 * system->nodes;
    Probe probe = *there;
    EnergyPart block;
    CHECK(p != NULL);
    probe.p = p;
    probe.q = q;
    probe.outline = &outline;
    for (int i = 0; i < system->nodes; i++) {
        Real m = system->m[i];
        block = (EnergyPart){.node_count = 1, .node = {i}, .H = {m, 0, 0, m}};
        for (int c = 0; c < 2; c++)
            block.g[c] = m * ((Real)u[2 * i + c] - u_tilde[2 * i + c]);
        take(to, &block);
    }
    for (int t = 0; t < system->term_count; t++) {
        int row = find_formula_row(system->term[t].kind);
        const void *data = system->term[t].data;
        int count =
            row < 0 ? 0 : count_parts(&probe, formulas[row].part_kind, data);
        for (int i = 0; i < count; i++)
            if (evaluate_energy_part(&probe, row, data, i, lift_factor, p, q,
                                     &block))
                take(to, &block);
    }
    free(p);
}

void visit_E_parts(const IncrementalPotential *E, const double *u,
                   int lift_factor,
                   void (*take)(void *to, const EnergyPart *block), void *to)
{
    EvalPoint at = make_eval_point(E->system, E->x_n, u, NULL);
    at.weight = E->weight;
    const Probe probe = {.at = &at, .h = sqrtl(E->weight)};
    visit_parts(&probe, u, E->u_tilde, lift_factor, take, to);
}

/* The system of a Newton update: gradient g [2n], the sum of the absolute
 * values of its parts [2n], and H [2n 2n] */
typedef struct DenseSystem {
    const System *system;
    Real *g, *g_abs_sum, *H;
    int n, lift_factor;
} DenseSystem;

static void assemble_part(void *assembly, const EnergyPart *block)
{
    const DenseSystem *to = assembly;
    int n = 2 * block->node_count;
    for (int i = 0; i < n; i++) {
        int r = 2 * block->node[i / 2] + i % 2;
        to->g[r] += block->g[i];
        to->g_abs_sum[r] += fabsl(block->g[i]);
        for (int k = 0; k < n; k++)
            to->H[to->n * r + 2 * block->node[k / 2] + k % 2] +=
                block->H[n * i + k];
    }
}

/* Assembles g, abs_sum and H, with unit rows for pinned nodes. */
static void assemble_system(const Probe *probe, const double *u,
                            const double *u_tilde, const DenseSystem *to)
{
    const System *system = to->system;
    size_t n = (size_t)to->n;
    memset(to->g, 0, n * sizeof *to->g);
    memset(to->g_abs_sum, 0, n * sizeof *to->g_abs_sum);
    memset(to->H, 0, n * n * sizeof *to->H);
    visit_parts(probe, u, u_tilde, to->lift_factor, assemble_part, (void *)to);
    for (size_t r = 0; r < n; r++) {
        if (!system->is_pinned[r / 2])
            continue;
        for (size_t c = 0; c < n; c++)
            to->H[n * r + c] = to->H[n * c + r] = r == c;
        to->g[r] = to->g_abs_sum[r] = 0;
    }
}

void exact_derivatives(const IncrementalPotential *E, const double *u,
                       const double *x, double h, int lift_factor, Real *g,
                       Real *H)
{
    size_t n = 2 * (size_t)E->system->nodes;
    Real *size = calloc(n, sizeof *size);
    CHECK(size != NULL);
    EvalPoint at = make_eval_point(E->system, E->x_n, u, x);
    at.weight = E->weight;
    const Probe probe = {.at = &at, .h = h};
    const DenseSystem to = {E->system, g, size, H, (int)n, lift_factor};
    assemble_system(&probe, u, E->u_tilde, &to);
    free(size);
}

/* Factors H = L D L^T without pivoting; L D replaces H on and below the
 * diagonal. In a projected H (lift_factor > 0) a pivot below the mass is a
 * rounding error; the mass replaces it. Returns false if a pivot is 0. */
static bool factor_densely(const DenseSystem *of)
{
    int n = of->n;
    Real *H = of->H;
    for (int c = 0; c < n; c++) {
        Real m = of->system->is_pinned[c / 2] ? 0 : of->system->m[c / 2];
        if (of->lift_factor && H[n * c + c] < m)
            H[n * c + c] = m;
        if (!(fabsl(H[n * c + c]) > 0))
            return false;
        for (int r = c + 1; r < n; r++) {
            Real factor = H[n * r + c] / H[n * c + c];
            for (int i = c + 1; factor != 0 && i <= r; i++)
                H[n * r + i] -= factor * H[n * i + c];
        }
    }
    return true;
}

/* Returns the largest |p_x| + |p_y| of p = -H^-1 g, or infinity if H is
 * singular. g becomes -p, H its factor. */
static Real solve_densely(const DenseSystem *of)
{
    int n = of->n;
    Real most = 0, *H = of->H, *b = of->g;
    if (!factor_densely(of))
        return INFINITY;
    for (int c = 0; c < n; c++)
        for (int r = c + 1; r < n; r++)
            b[r] -= H[n * r + c] / H[n * c + c] * b[c];
    for (int r = n - 1; r >= 0; r--) {
        b[r] /= H[n * r + r];
        for (int c = 0; c < r; c++)
            b[c] -= H[n * r + c] * b[r];
    }
    for (int i = 0; i < n; i += 2) {
        Real sum = fabsl(b[i]) + fabsl(b[i + 1]);
        most = sum <= most ? most : sum;
    }
    return most;
}

double exact_E_change(const IncrementalPotential *E, const double *from,
                      const double *to, double moved)
{
    Real energy[2];
    for (int i = 0; i < 2; i++) {
        EvalPoint at = make_eval_point(E->system, E->x_n, i ? to : from, NULL);
        at.weight = E->weight;
        Probe probe = {.at = &at, .h = sqrtl(E->weight), .motion_time = moved};
        energy[i] = oracle_step_energy(&probe, E->u_tilde).f;
    }
    return (double)(energy[1] - energy[0]);
}

/* ERROR_ULPS: error of parts of a double gradient and of coordinates, in units
 * of the last place. ERROR_SAMPLES: random errors; the worst is used. */
enum { ERROR_ULPS = 4, ERROR_SAMPLES = 12 };

/* Returns the largest |p_x| + |p_y| after random errors in the last digits of
 * x, x_n and the parts of the gradient. All parts see the same positions, so
 * that forces balance. u is off by half a unit of its last digit, which inertia
 * feels where u is much larger than u - u_tilde. place [4n] workspace */
static Real find_perturbed_residual(const Probe *probe, const double *u,
                                    const double *u_tilde,
                                    const DenseSystem *of, Random *random,
                                    double *place)
{
    const System *system = probe->at->system;
    double *x = place, *x_n = place + of->n;
    EvalPoint at = *probe->at;
    Probe own = *probe;
    own.at = &at;
    at.x = x;
    at.x_n = x_n;
    for (int i = 0; i < of->n; i++) {
        double ulps = ERROR_ULPS * DBL_EPSILON * random_uniform(random, -1, 1);
        x[i] = probe->at->x[i] * (1 + ulps);
        x_n[i] = probe->at->x_n[i] * (1 + ulps);
    }
    assemble_system(&own, u, u_tilde, of);
    for (int i = 0; i < of->n; i++) {
        Real m = system->is_pinned[i / 2] ? 0 : system->m[i / 2];
        of->g[i] += (2 * random_below(random, 2) - 1) * DBL_EPSILON *
                    (ERROR_ULPS * of->g_abs_sum[i] + m * fabsl(u[i]) / 2);
    }
    return solve_densely(of);
}

/* Returns the exact residual for one yield_side of Probe. */
static double find_residual_on_yield_side(const IncrementalPotential *E,
                                          const double *u, const double *x,
                                          double h, double moved,
                                          int lift_factor, int side,
                                          double *noise)
{
    size_t n = 2 * (size_t)E->system->nodes;
    double *place = calloc(2 * n, sizeof *place);
    Real *g = calloc(n * (n + 2), sizeof *g), blur = 0;
    Random random = {1};
    CHECK(place != NULL && g != NULL);
    EvalPoint at = make_eval_point(E->system, E->x_n, u, x);
    at.weight = E->weight;
    const Probe probe = {.at = &at,
                         .h = sqrtl(E->weight),
                         .motion_time = moved,
                         .yield_side = side};
    const DenseSystem to = {E->system, g,      g + n,
                            g + 2 * n, (int)n, lift_factor};
    assemble_system(&probe, u, E->u_tilde, &to);
    Real most = solve_densely(&to);
    for (int round = 0; noise && round < ERROR_SAMPLES; round++)
        blur = fmaxl(blur, fabsl(find_perturbed_residual(&probe, u, E->u_tilde,
                                                         &to, &random, place) -
                                 most));
    if (noise)
        *noise = (double)(blur / h);
    free(place);
    free(g);
    return (double)(most / h);
}

/* Springs that have just flowed may be evaluated on either side of their limit:
 * returns the smaller residual. */
double exact_residual(const IncrementalPotential *E, const double *u,
                      const double *x, double h, double moved, int lift_factor,
                      double *noise)
{
    bool flows = system_find_term(E->system, &plastic_energy) != NULL;
    double least = INFINITY, blur;
    for (int side = flows ? -1 : 0; side <= flows; side++) {
        double residual = find_residual_on_yield_side(
            E, u, x, h, moved, lift_factor, side, noise ? &blur : NULL);
        if (noise && (residual <= least || side <= 0))
            *noise = blur;
        least = fmin(least, residual);
    }
    return least;
}

void exact_eigenvectors(int n, Real *a, Real *v)
{
    for (int i = 0; i < n * n; i++)
        v[i] = i % (n + 1) == 0;
    for (int k = 0; k < 30 * n * n; k++) {
        int r = k / n % n, c = k % n;
        Real size = fabsl(a[n * r + r]) + fabsl(a[n * c + c]);
        if (r >= c || fabsl(a[n * r + c]) <= 1e-25L * size)
            continue;
        Real theta = (a[n * c + c] - a[n * r + r]) / (2 * a[n * r + c]);
        Real t = copysignl(1, theta) / (fabsl(theta) + hypotl(1, theta));
        Real cosine = 1 / hypotl(1, t), sine = t * cosine;
        for (int pass = 0; pass < 3; pass++)
            for (int i = 0; i < n; i++) {
                Real *m = pass == 2 ? v : a;
                int j = pass == 1 ? n * r + i : n * i + r;
                int l = pass == 1 ? n * c + i : n * i + c;
                Real one = m[j], two = m[l];
                m[j] = cosine * one - sine * two;
                m[l] = sine * one + cosine * two;
            }
    }
}

/* ---- boundaries that must not cross ------------------------------------- */

static Real find_twice_area(const double *x, int a, int b, int c)
{
    const double *o = x + 2 * a, *p = x + 2 * b, *q = x + 2 * c;
    return ((Real)p[0] - o[0]) * ((Real)q[1] - o[1]) -
           ((Real)p[1] - o[1]) * ((Real)q[0] - o[0]);
}

long edge_crossings(const System *system, const double *x)
{
    Outline outline = find_outline(system);
    long count = 0;
    for (int k = 0; k < outline.edge_count; k++)
        for (int l = 0; l < k; l++) {
            const int *e = outline.edge_nodes[k], *f = outline.edge_nodes[l];
            count += find_twice_area(x, e[0], e[1], f[0]) *
                             find_twice_area(x, e[0], e[1], f[1]) <
                         0 &&
                     find_twice_area(x, f[0], f[1], e[0]) *
                             find_twice_area(x, f[0], f[1], e[1]) <
                         0;
        }
    return count;
}

/* ---- gaps and areas that must stay positive ----------------------------- */

double exact_gap(const System *system, const double *x, int node, int obstacle)
{
    const Contact *contact = get_contact(system);
    EvalPoint at = make_eval_point(system, x, NULL, x);
    Probe probe = {.at = &at};
    Real n[2];
    return (double)(contact->barrier.d_hat *
                    find_relative_gap(&probe, contact, node, obstacle, n).f);
}

double find_smallest_gap(const System *system, const double *x)
{
    const Contact *contact = get_contact(system);
    double smallest = INFINITY;
    for (int k = 0; contact && k < contact->obstacle_count; k++)
        for (int i = 0; i < system->nodes; i++)
            if (contact_includes_pair(contact, system, i, k))
                smallest = fmin(smallest, exact_gap(system, x, i, k));
    return smallest;
}

double smallest_area_ratio(const System *system, const double *x)
{
    const CellBarriers *cells = system_term_data(system, &cell_energy);
    const NeoHookean *solid = get_neo_hookean(system);
    EvalPoint at = make_eval_point(system, x, NULL, x);
    Probe probe = {.at = &at};
    double smallest = INFINITY;
    Jet J;
    for (int t = 0; cells && t < cells->triangles.count; t++)
        if (find_cell_area(&probe, cells, t, &J))
            smallest = fmin(smallest, (double)J.f);
    for (int t = 0; solid && t < solid->triangles.count; t++) {
        const int *node = solid->triangles.node[t];
        smallest = fmin(smallest,
                        (double)(find_twice_area(x, node[0], node[1], node[2]) /
                                 (2 * solid->triangles.rest_area)));
    }
    return smallest;
}
