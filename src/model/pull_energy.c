/* pull_energy.c - pull of one node to a point: central field and hand. */
#include "model/pull_energy.h"

#include <math.h>

/* k/2 |x - o|^2 */
static double pull_potential(const EvalPoint *at)
{
    const NodePull *pull = at->term->data;
    double sum = 0;
    for (int i = 0; i < 2; i++) {
        double d = at->x[2 * pull->node + i] - pull->target[i];
        sum += 0.5 * pull->k * (d * d);
    }
    return sum;
}

/* The factor weight k comes first, so that a huge k does not overflow. */
static void pull_gradient(const EvalPoint *at, double *g)
{
    const NodePull *pull = at->term->data;
    for (int i = 0; i < 2; i++)
        g[2 * pull->node + i] += at->weight * pull->k *
                                 (at->x[2 * pull->node + i] - pull->target[i]);
}

static void pull_add_triplets(const EvalPoint *at, Triplets *triplets)
{
    const NodePull *pull = at->term->data;
    add_diagonal_triplets(at->system, pull->node, triplets);
}

/* The Hessian k I has no negative eigenvalue. */
static int pull_hessian(const EvalPoint *at, Projection projection,
                        const int **slot, const double *q, double *out)
{
    const NodePull *pull = at->term->data;
    double k = at->weight * pull->k;
    (void)projection;
    for (int i = 0; i < 2; i++)
        if (q)
            out[2 * pull->node + i] += k * q[2 * pull->node + i];
        else
            out[*(*slot)++] += k;
    return 0;
}

static void pull_line_polynomial(const EvalPoint *at, const double *p,
                                 double q[3])
{
    const NodePull *pull = at->term->data;
    for (int i = 2 * pull->node; i < 2 * pull->node + 2; i++)
        q[0] += 0.5 * at->weight * pull->k * p[i] * p[i];
}

static double pull_max_stiffness(const EvalPoint *at)
{
    const NodePull *pull = at->term->data;
    return fabs(pull->k);
}

/* First members in the initialisers of central_field and hand_energy. */
#define PULL                                                                   \
    .potential = pull_potential, .gradient = pull_gradient,                    \
    .hessian = pull_hessian, .add_triplets = pull_add_triplets,                \
    .is_diagonal = true, .line_polynomial = pull_line_polynomial,              \
    .is_external = true, .max_stiffness = pull_max_stiffness,                  \
    .supports_all_integrators = true

const TermKind central_field = {PULL, .energy_name = "elastic"};
const TermKind hand_energy = {PULL, .rank = RANK_HAND};

Status pull_configure(System *system, const TermKind *kind,
                      const NodePull *pull)
{
    NodePull *own = system_add_term(system, kind, sizeof *own);
    if (!own)
        return STATUS_OUT_OF_MEMORY;
    *own = *pull;
    system_mark_changed(system, true);
    return STATUS_OK;
}

void hand_begin_step(NodePull *hand, const double *x, const double *v, double m,
                     double h, const double *free)
{
    static const double TIME = 0.06, MOST = 0.5, INERTIA = 10, LIMIT = 1e8;
    static const double CELL = 0.5, SPEED = 0.5, SIDE = 1.0 / 64;
    double reach =
        fmax(CELL * hand->cell_size, fmin(SPEED * h, SIDE) * hand->body_side);
    double d[2] = {hand->mouse_xy[0] - x[0], hand->mouse_xy[1] - x[1]};
    double away = sqrt(d[0] * d[0] + d[1] * d[1]);
    double slow = fmin(MOST, h / TIME), part = slow;
    if (part * away > reach)
        part = reach / away;
    /* Within the limits, the pull at x is mouse_k times the distance `away`. */
    hand->k = fmin(fmax(hand->mouse_k / slow, INERTIA * m / (h * h)),
                   LIMIT * hand->mouse_k);
    if (free)
        hand->k = m / (h * h);
    for (int i = 0; i < 2; i++)
        hand->target[i] =
            x[i] + part * d[i] - (free ? h * v[i] + h * h * free[i] : 0);
}

double hand_work(const NodePull *hand, const double *x, const double *y)
{
    double sum = 0;
    for (int i = 0; i < 2; i++) {
        double before = x[i] - hand->target[i], now = y[i] - hand->target[i];
        sum += 0.5 * hand->k * (before * before - now * now);
    }
    return sum;
}
