#include "model/contact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "model/barrier.h"
#include "model/mass_spring_energy.h"

void motion_velocity(const Motion *motion, double t, double v[2])
{
    v[0] = v[1] = 0;
    for (int i = motion->phases - 1; i >= 0; i--)
        if (t < motion->until[i]) {
            v[0] = motion->v[i][0];
            v[1] = motion->v[i][1];
        }
}

const double *obstacle_point(const Obstacle *obstacle, const double *x)
{
    return obstacle->node < 0 ? obstacle->o : x + 2 * obstacle->node;
}

Gap contact_gap(const Obstacle *obstacle, const double *o, const double *x_i,
                double radius)
{
    double D[2] = {x_i[0] - o[0], x_i[1] - o[1]};
    const double *n = obstacle->n;
    if (obstacle->kind == OBSTACLE_WALL)
        return (Gap){
            n[0] * D[0] + n[1] * D[1] - radius, {n[0], n[1]}, INFINITY};
    double r = math_hypot(D[0], D[1]);
    return (Gap){r - (obstacle->radius + radius), {D[0] / r, D[1] / r}, r};
}

/* W, J. */
static double contact_value(const Barrier *barrier, const Gap *gap)
{
    return barrier->c * barrier_value(gap->d / barrier->d_hat);
}

double contact_force(const Barrier *barrier, const Gap *gap)
{
    return -barrier->c / barrier->d_hat *
           barrier_slope(gap->d / barrier->d_hat);
}

/* H [3] (xx, xy, yy), J/m^2: W's Hessian in x_i, c f''/d_hat^2 n n^T, and where
 * nothing is projected the ball's curvature (c/d_hat) f'/r (I - n n^T), which
 * is negative.  In x_i and a ball's node it is [[H, -H], [-H, H]].
 * Returns whether something negative was changed. */
static bool contact_hessian(const Barrier *barrier, const Gap *gap,
                            Filter filter, double H[3])
{
    const double *n = gap->n;
    double along = barrier->c / (barrier->d_hat * barrier->d_hat) *
                   barrier_curvature(gap->d / barrier->d_hat);
    double across = -contact_force(barrier, gap) / gap->r; /* a wall's is 0 */
    bool changed = across < 0 && filter_projects(filter);
    if (changed)
        across = projected_eigenvalue(filter, across);
    H[0] = along * n[0] * n[0] + across * n[1] * n[1];
    H[1] = (along - across) * n[0] * n[1];
    H[2] = along * n[1] * n[1] + across * n[0] * n[0];
    return changed;
}

/* A ball: |D + alpha P| = r - F d is the quadratic equation
 * a alpha^2 + 2 b alpha + c0 = 0, whose smaller root is written so that nothing
 * cancels. */
static double contact_reach(const Gap *gap, const double P[2])
{
    const double F = CONTACT_LIMIT;
    double pn = gap->n[0] * P[0] + gap->n[1] * P[1];
    if (!(pn < 0))
        return INFINITY;
    if (!isfinite(gap->r))
        return F * gap->d / -pn;
    double b = gap->r * pn, a = P[0] * P[0] + P[1] * P[1];
    double c0 = F * gap->d * (2 * gap->r - F * gap->d);
    double discriminant = b * b - a * c0;
    return discriminant > 0 ? c0 / (-b + sqrt(discriminant)) : INFINITY;
}

/* Along P the distance of a ball's centre changes by pn + k, where k is what
 * the motion across adds: sqrt((r + pn)^2 + pt^2) - (r + pn). */
static double contact_remainder(const Barrier *barrier, const Gap *gap,
                                const double P[2])
{
    const double *n = gap->n;
    double pn = n[0] * P[0] + n[1] * P[1], k = 0;
    double s = gap->d / barrier->d_hat;
    if (isfinite(gap->r)) {
        double pt = n[0] * P[1] - n[1] * P[0], r = gap->r + pn;
        double length = math_hypot(r, pt);
        k = r > 0 ? pt * pt / (length + r) : length - r;
    }
    return barrier->c * (barrier_slope(s) * k / barrier->d_hat +
                         barrier_remainder(s, (pn + k) / barrier->d_hat));
}

/* ---- the term -------------------------------------------------------- */

Contact *contact_of(const System *system)
{
    return system_data(system, &contact_energy);
}

static bool is_pinned(const System *system, int i)
{
    return system->pinned && system->pinned[i];
}

bool contact_has_pair(const Contact *contact, const System *system, int node,
                      int obstacle)
{
    int ball = contact->obstacle[obstacle].node;
    bool held = is_pinned(system, node) && !system->pin_v &&
                contact->obstacle[obstacle].motion.phases == 0;
    return node != ball && !(held && (ball < 0 || is_pinned(system, ball)));
}

double contact_node_radius(const Contact *contact, int node)
{
    if (contact->ball < 0)
        return 0;
    const Obstacle *ball = &contact->obstacle[contact->ball];
    return ball->node == node ? ball->radius : 0;
}

Gap contact_pair_gap(const Contact *contact, const double *x, int node,
                     int obstacle)
{
    const Obstacle *other = &contact->obstacle[obstacle];
    return contact_gap(other, obstacle_point(other, x), x + 2 * node,
                       contact_node_radius(contact, node));
}

/* Node by node. */
static bool next_pair(const Contact *contact, const System *system,
                      ContactPair *pair)
{
    do {
        if (++pair->node == system->nodes) {
            pair->node = 0;
            pair->obstacle++;
        }
        if (pair->obstacle >= contact->obstacles)
            return false;
    } while (!contact_has_pair(contact, system, pair->node, pair->obstacle));
    return true;
}

bool contact_next(const Contact *contact, const System *system, const double *x,
                  ContactPair *pair, Gap *gap)
{
    while (next_pair(contact, system, pair)) {
        *gap = contact_pair_gap(contact, x, pair->node, pair->obstacle);
        if (gap->d < contact->barrier.d_hat)
            return true;
    }
    return false;
}

static bool valid(const Place *at)
{
    const Contact *contact = at->term->data;
    const Barrier *barrier = &contact->barrier;
    bool good = isfinite(barrier->c) && barrier->c > 0 &&
                isfinite(barrier->d_hat) && barrier->d_hat > 0;
    for (int k = 0; k < contact->obstacles; k++) {
        const Obstacle *it = &contact->obstacle[k];
        bool wall = it->kind == OBSTACLE_WALL;
        good = good && isfinite(it->o[0]) && isfinite(it->o[1]) &&
               isfinite(it->v[0]) && isfinite(it->v[1]) &&
               isfinite(it->friction) && it->friction >= 0 &&
               it->node < at->system->nodes &&
               (wall ? fabs(math_hypot(it->n[0], it->n[1]) - 1) < 1e-12
                     : isfinite(it->radius) && it->radius > 0);
    }
    return good;
}

static double value(const Place *at)
{
    const Contact *contact = at->term->data;
    double sum = 0;
    Gap gap;
    for (ContactPair pair = {-1, 0};
         contact_next(contact, at->system, at->x, &pair, &gap);)
        sum += contact_value(&contact->barrier, &gap);
    return sum;
}

/* The force pushes the node along n and a free ball back. */
static void gradient(const Place *at, double *g)
{
    const Contact *contact = at->term->data;
    Gap gap;
    for (ContactPair pair = {-1, 0};
         contact_next(contact, at->system, at->x, &pair, &gap);) {
        const int e[2] = {pair.node, contact->obstacle[pair.obstacle].node};
        spring_add_force(e, -at->w * contact_force(&contact->barrier, &gap),
                         gap.n, g);
    }
}

/* A node has its own diagonal block, and where there is a free ball also the
 * ball's and the block of both.  (The ball itself lists them too, so that all
 * nodes have the same number.) */
static int entries_of_a_node(const Contact *contact)
{
    return contact->ball < 0 ? DIAGONAL_ENTRIES : SPRING_ENTRIES;
}

long long contact_entries(const Place *at)
{
    const Contact *contact = contact_of(at->system);
    return (long long)entries_of_a_node(contact) * at->system->nodes;
}

void contact_pattern(const Place *at, Triplets *triplets)
{
    const System *system = at->system;
    const Contact *contact = contact_of(system);
    int ball = contact->ball < 0 ? -1 : contact->obstacle[contact->ball].node;
    for (int i = 0; i < system->nodes; i++) {
        term_add_block(system, i, i, triplets);
        if (ball < 0)
            continue;
        term_add_block(system, ball, ball, triplets);
        term_add_block(system,
                       i != ball ? i
                       : i > 0   ? i - 1
                                 : i + 1,
                       ball, triplets);
    }
}

void contact_add_block(const Contact *contact, const int e[2],
                       const double H[3], const int *slot, const double *q,
                       double *out)
{
    int i = 2 * e[0];
    if (e[1] >= 0) {
        mass_spring_add(H, e, e[0], slot, q, out);
    } else if (q) {
        out[i] += H[0] * q[i] + H[1] * q[i + 1];
        out[i + 1] += H[1] * q[i] + H[2] * q[i + 1];
    } else {
        slot += entries_of_a_node(contact) * e[0];
        for (int t = 0; t < DIAGONAL_ENTRIES; t++)
            out[slot[t]] += H[t];
    }
}

static int hessian(const Place *at, Filter filter, const int *slot,
                   const double *q, double *out)
{
    const Contact *contact = at->term->data;
    int projected = 0;
    Gap gap;
    for (ContactPair pair = {-1, 0};
         contact_next(contact, at->system, at->x, &pair, &gap);) {
        const int e[2] = {pair.node, contact->obstacle[pair.obstacle].node};
        double H[3];
        projected += contact_hessian(&contact->barrier, &gap, filter, H);
        for (int t = 0; t < 3; t++)
            H[t] *= at->w;
        contact_add_block(contact, e, H, slot, q, out);
    }
    return projected;
}

/* P = scale times p of the node minus p of the free ball. */
static void pair_motion(const Contact *contact, ContactPair pair,
                        const double *p, double scale, double P[2])
{
    int ball = contact->obstacle[pair.obstacle].node;
    for (int c = 0; c < 2; c++)
        P[c] =
            scale * (p[2 * pair.node + c] - (ball < 0 ? 0 : p[2 * ball + c]));
}

static double reach(const Place *at, const double *p)
{
    const Contact *contact = at->term->data;
    double smallest = INFINITY;
    for (ContactPair pair = {-1, 0}; next_pair(contact, at->system, &pair);) {
        double P[2];
        Gap gap = contact_pair_gap(contact, at->x, pair.node, pair.obstacle);
        pair_motion(contact, pair, p, 1, P);
        smallest = fmin(smallest, contact_reach(&gap, P));
    }
    return smallest;
}

static double remainder_along(const Place *at, const double *p, double alpha)
{
    const Contact *contact = at->term->data;
    double sum = 0;
    for (ContactPair pair = {-1, 0}; next_pair(contact, at->system, &pair);) {
        double P[2];
        Gap gap = contact_pair_gap(contact, at->x, pair.node, pair.obstacle);
        pair_motion(contact, pair, p, alpha, P);
        sum += contact_remainder(&contact->barrier, &gap, P);
    }
    return at->w * sum;
}

static bool allowed(const Place *at)
{
    const Contact *contact = at->term->data;
    for (ContactPair pair = {-1, 0}; next_pair(contact, at->system, &pair);)
        if (!(contact_pair_gap(contact, at->x, pair.node, pair.obstacle).d > 0))
            return false;
    return true;
}

/* Where the barrier begins: 2 c/d_hat^2, and the force 2 c/d_hat half way. */
static void bounds(const Place *at, double *stiffest, double *force)
{
    const Barrier *barrier = &((const Contact *)at->term->data)->barrier;
    double half_way = 2 * barrier->c / barrier->d_hat;
    *stiffest = fmax(*stiffest, half_way / barrier->d_hat);
    *force = fmax(*force, half_way);
}

/* A ball's curvature bends down by force/r across the normal. */
static void concave(const Place *at, double *sum)
{
    const Contact *contact = at->term->data;
    Gap gap;
    for (ContactPair pair = {-1, 0};
         contact_next(contact, at->system, at->x, &pair, &gap);) {
        double down = at->w * contact_force(&contact->barrier, &gap) / gap.r;
        int ball = contact->obstacle[pair.obstacle].node;
        sum[pair.node] += ball < 0 ? down : 2 * down;
        if (ball >= 0)
            sum[ball] += 2 * down;
    }
}

const TermKind contact_energy = {
    .energy = "contact",
    .valid = valid,
    .value = value,
    .gradient = gradient,
    .entries = contact_entries,
    .pattern = contact_pattern,
    .hessian = hessian,
    .remainder = remainder_along,
    .reach = reach,
    .allowed = allowed,
    .bounds = bounds,
    .concave = concave,
    .end_of_step = true,
};

Status contact_add(System *system, const Barrier *barrier, int obstacles,
                   const Obstacle *obstacle)
{
    if (obstacles < 0 || obstacles > CONTACT_MAX_OBSTACLES)
        return STATUS_INVALID_INPUT;
    Contact *contact = calloc(1, sizeof *contact);
    if (!contact)
        return STATUS_OUT_OF_MEMORY;
    contact->barrier = *barrier;
    contact->obstacles = obstacles;
    contact->ball = -1;
    Status status = STATUS_OK;
    for (int k = 0; k < obstacles; k++) {
        contact->obstacle[k] = obstacle[k];
        if (obstacle[k].node < 0)
            continue;
        if (contact->ball >= 0)
            status = STATUS_INVALID_INPUT;
        contact->ball = k;
    }
    if (!status)
        return system_add_term(system, &contact_energy, contact);
    free(contact);
    return status;
}
