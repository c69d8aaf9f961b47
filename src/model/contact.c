/* contact.c - barrier energy of nodes near walls and balls. */
#include "model/contact.h"

#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "model/barrier.h"
#include "model/elements.h"

const double *obstacle_get_position(const Obstacle *obstacle, const double *x)
{
    return obstacle->ball_node < 0 ? obstacle->o : x + 2 * obstacle->ball_node;
}

NodeGap contact_measure_gap(const Obstacle *obstacle, const double *o,
                            const double *x_i, double radius)
{
    double D[2] = {x_i[0] - o[0], x_i[1] - o[1]};
    const double *n = obstacle->n;
    if (obstacle->kind == OBSTACLE_WALL)
        return (NodeGap){
            n[0] * D[0] + n[1] * D[1] - radius, {n[0], n[1]}, INFINITY};
    double r = math_hypot(D[0], D[1]);
    return (NodeGap){r - (obstacle->radius + radius), {D[0] / r, D[1] / r}, r};
}

double contact_normal_force(const Barrier *barrier, double d)
{
    return -barrier->c / barrier->d_hat * barrier_slope(d / barrier->d_hat);
}

/* ---- pairs of a node and an obstacle ------------------------------------ */

Contact *get_contact(const System *system)
{
    return system_term_data(system, &contact_energy);
}

bool contact_includes_pair(const Contact *contact, const System *system,
                           int node, int obstacle)
{
    int ball = contact->obstacle[obstacle].ball_node;
    bool held = system->is_pinned[node] && !system->pin_v &&
                contact->obstacle[obstacle].motion.phase_count == 0;
    return node != ball && !(held && (ball < 0 || system->is_pinned[ball]));
}

double contact_node_radius(const Contact *contact, int node)
{
    if (contact->free_ball_index < 0)
        return 0;
    const Obstacle *ball = &contact->obstacle[contact->free_ball_index];
    return ball->ball_node == node ? ball->radius : 0;
}

static const Barrier *get_contact_barrier(const EvalPoint *at)
{
    return &((const Contact *)at->term->data)->barrier;
}

/* Pairs are numbered by obstacle, and for each obstacle by node. */
static int count_contact_pairs(const EvalPoint *at)
{
    const Contact *contact = at->term->data;
    return contact->obstacle_count * at->system->nodes;
}

static bool contact_get_element(const EvalPoint *at, int i, double way,
                                Element *element)
{
    static const double difference[1][3] = {{1, -1}};
    const Contact *contact = at->term->data;
    int nodes = at->system->nodes, obstacle = i < nodes ? 0 : i / nodes;
    int node = i - obstacle * nodes;
    if (!contact_includes_pair(contact, at->system, node, obstacle))
        return false;
    const Obstacle *other = &contact->obstacle[obstacle];
    NodeGap gap = contact_measure_gap(
        other, obstacle_get_position(other, at->x), at->x + 2 * node,
        contact_node_radius(contact, node));
    if (gap.d >= contact->barrier.d_hat + way)
        return false;
    element->vector_count = 1;
    element->node_count = other->ball_node < 0 ? 1 : 2;
    element->node[0] = element->block_index = node;
    element->node[1] = other->ball_node;
    element->partner_index = obstacle;
    element->node_weight = difference;
    element->derivative_factor = 1;
    element->s = gap.d;
    element->n[0] = gap.n[0];
    element->n[1] = gap.n[1];
    element->r = gap.r;
    return true;
}

/* Each node has one block.  With a free ball the block has two nodes, the node
 * and the ball's.  The ball's own block has a neighbour as its second node, so
 * that all blocks have equally many entries. */
static int count_contact_blocks(const EvalPoint *at)
{
    return at->system->nodes;
}

static int get_contact_block_nodes(const EvalPoint *at, int block, int node[3])
{
    const Contact *contact = get_contact(at->system);
    node[0] = block;
    if (contact->free_ball_index < 0)
        return 1;
    node[1] = contact->obstacle[contact->free_ball_index].ball_node;
    if (node[1] == block)
        node[1] += block > 0 ? -1 : 1;
    return 2;
}

static double contact_potential(const EvalPoint *at, const Element *element)
{
    const Barrier *barrier = get_contact_barrier(at);
    return barrier->c * barrier_value(element->s / barrier->d_hat);
}

/* The force pushes the node along n, and the free ball along -n. */
static void contact_gradient(const EvalPoint *at, const Element *element,
                             double g[4])
{
    double factor =
        -at->weight * contact_normal_force(get_contact_barrier(at), element->s);
    g[0] = factor * element->n[0];
    g[1] = factor * element->n[1];
}

/* H = (c/d_hat^2) f'' n n^T + (c/d_hat) f'/r (I - n n^T).  The second summand
 * is 0 for a wall, and negative for a ball. */
static bool contact_hessian(const EvalPoint *at, const Element *element,
                            Projection projection, double H[4][4])
{
    const Barrier *barrier = get_contact_barrier(at);
    const double *n = element->n;
    double along = barrier->c / (barrier->d_hat * barrier->d_hat) *
                   barrier_curvature(element->s / barrier->d_hat);
    double across = -contact_normal_force(barrier, element->s) / element->r;
    bool changed = across < 0 && projects_blocks(projection); /* at balls */
    if (changed)
        across = project_eigenvalue(projection, across);
    H[0][0] = at->weight * (along * n[0] * n[0] + across * n[1] * n[1]);
    H[0][1] = H[1][0] = at->weight * ((along - across) * n[0] * n[1]);
    H[1][1] = at->weight * (along * n[1] * n[1] + across * n[0] * n[0]);
    return changed;
}

/* Returns the alpha at which the gap d has shrunk by F d, F = ELEMENT_LIMIT.
 * With D from a ball's centre to the node, |D + alpha P| = |D| - F d becomes
 * a alpha^2 + 2 b alpha + c0 = 0; the smaller root is exact to rounding. */
static double contact_max_alpha(const EvalPoint *at, const Element *element,
                                const double P[4])
{
    double d = element->s, F = ELEMENT_LIMIT;
    double pn = element->n[0] * P[0] + element->n[1] * P[1];
    (void)at;
    if (!(pn < 0))
        return INFINITY;
    if (!isfinite(element->r))
        return F * d / -pn;
    double b = element->r * pn, a = P[0] * P[0] + P[1] * P[1];
    double c0 = F * d * (2 * element->r - F * d);
    double discriminant = b * b - a * c0;
    return discriminant > 0 ? c0 / (-b + sqrt(discriminant)) : INFINITY;
}

/* Along P the distance to the centre of a ball changes by pn + k: pn is the
 * part of P along n, and the part pt across n contributes
 * k = sqrt((r + pn)^2 + pt^2) - (r + pn). */
static double contact_taylor_remainder(const EvalPoint *at,
                                       const Element *element,
                                       const double P[4], double alpha)
{
    const Barrier *barrier = get_contact_barrier(at);
    const double *n = element->n, p0 = alpha * P[0], p1 = alpha * P[1];
    double pn = n[0] * p0 + n[1] * p1, k = 0;
    double s = element->s / barrier->d_hat;
    if (isfinite(element->r)) {
        double pt = n[0] * p1 - n[1] * p0, r = element->r + pn;
        double length = math_hypot(r, pt);
        k = r > 0 ? pt * pt / (length + r) : length - r;
    }
    return barrier->c *
           (barrier_slope(s) * k / barrier->d_hat +
            barrier_taylor_remainder(s, (pn + k) / barrier->d_hat));
}

/* Returns the curvature at the start of the barrier, 2 c/d_hat^2. */
static double contact_max_stiffness(const EvalPoint *at)
{
    const Barrier *barrier = get_contact_barrier(at);
    return 2 * barrier->c / barrier->d_hat / barrier->d_hat;
}

static double contact_friction_limit(const EvalPoint *at,
                                     const Element *element, double t[4],
                                     double *speed)
{
    const Contact *contact = at->term->data;
    const Obstacle *obstacle = &contact->obstacle[element->partner_index];
    t[0] = -element->n[1];
    t[1] = element->n[0];
    *speed = t[0] * obstacle->v[0] + t[1] * obstacle->v[1];
    return obstacle->mu * contact_normal_force(&contact->barrier, element->s);
}

static const ElementKind pairs = {
    .count_elements = count_contact_pairs,
    .get_element = contact_get_element,
    .get_block_nodes = get_contact_block_nodes,
    .potential = contact_potential,
    .gradient = contact_gradient,
    .hessian = contact_hessian,
    .taylor_remainder = contact_taylor_remainder,
    .count_blocks = count_contact_blocks,
    .max_alpha = contact_max_alpha,
    .friction_limit = contact_friction_limit,
};

const TermKind contact_energy = {
    .name = "contact",
    ELEMENTS(pairs),
    .energy_name = "contact",
    .rank = RANK_CONTACT,
    .max_stiffness = contact_max_stiffness,
    .is_external = true,
};

Status contact_configure(System *system, const Barrier *barrier, int obstacles,
                         const Obstacle *obstacle)
{
    if (obstacles == 0) {
        system_remove_term(system, &contact_energy);
        return STATUS_OK;
    }
    Contact *contact =
        system_add_term(system, &contact_energy, sizeof *contact);
    if (!contact)
        return STATUS_OUT_OF_MEMORY;
    contact->barrier = *barrier;
    contact->obstacle_count = obstacles;
    contact->free_ball_index = -1;
    memcpy(contact->obstacle, obstacle, (size_t)obstacles * sizeof *obstacle);
    for (int k = 0; k < obstacles; k++)
        if (obstacle[k].ball_node >= 0)
            contact->free_ball_index = k;
    return STATUS_OK;
}
