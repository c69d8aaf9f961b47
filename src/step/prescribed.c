#include "step/prescribed.h"

#include <math.h>
#include <string.h>

#include "model/contact.h"
#include "model/damping.h"
#include "model/friction.h"
#include "model/inertia_energy.h"

/* Halvings of a part of the way, and parts of it; a wall at 50 m/s in steps of
 * 0.01 s onto cells of 1/8 m needs 19 parts.  What has room for less than a
 * thousandth of the way is pressed flat: there a step ends, for each further
 * part takes more updates than the one before. */
enum { MAX_HALVINGS = 10, MAX_PARTS = 100 };

/* Nodes that a wall would touch are carried along and keep this much of the
 * barrier's width. */
#define CARRIED_GAP 0.3

static bool moves(const Obstacle *obstacle)
{
    return obstacle->v[0] != 0 || obstacle->v[1] != 0;
}

bool prescribed_begin(TimeIntegrator *run)
{
    Contact *contact = contact_of(run->system);
    bool any = run->system->pin_v != NULL;
    double half_way = run->clock + 0.5 * run->h;
    run->moved = 0;
    run->left = 1;
    run->part = 0;
    run->blocked = false;
    run->before = run->newton ? run->newton->counters.iterations : 0;
    for (int k = 0; contact && k < contact->obstacles; k++) {
        Obstacle *obstacle = &contact->obstacle[k];
        const Motion *motion = &obstacle->motion;
        obstacle->v[0] = obstacle->v[1] = 0;
        for (int i = motion->phases - 1; i >= 0; i--)
            if (half_way < motion->until[i])
                memcpy(obstacle->v, motion->v[i], sizeof obstacle->v);
        any = any || moves(obstacle);
    }
    return any;
}

/* o += way v of all obstacles. */
static void move_obstacles(Contact *contact, double way)
{
    for (int k = 0; contact && k < contact->obstacles; k++)
        for (int c = 0; c < 2; c++)
            contact->obstacle[k].o[c] += way * contact->obstacle[k].v[c];
}

/* u += what keeps a node in front of the obstacles that have come nearer.
 *   before  [2n] m, where the nodes were while the obstacles were `way` back */
static void carry(const System *system, const Contact *contact, double way,
                  const double *x_n, const double *before, double *u)
{
    for (int k = 0; contact && k < contact->obstacles; k++) {
        const Obstacle *obstacle = &contact->obstacle[k];
        double back[2] = {obstacle->o[0] - way * obstacle->v[0],
                          obstacle->o[1] - way * obstacle->v[1]};
        if (!moves(obstacle))
            continue;
        for (int i = 0; i < system->nodes; i++) {
            if (!contact_has_pair(contact, system, i, k) ||
                system->pinned[i]) /* it gives no way */
                continue;
            double now[2] = {x_n[2 * i] + u[2 * i],
                             x_n[2 * i + 1] + u[2 * i + 1]};
            double radius = contact_node_radius(contact, i);
            Gap after = contact_gap(obstacle, obstacle->o, now, radius);
            double gap = contact_gap(obstacle, back, before + 2 * i, radius).d;
            double keep = fmin(gap, CARRIED_GAP * contact->barrier.d_hat);
            for (int c = 0; c < 2; c++)
                u[2 * i + c] += fmax(0, keep - after.d) * after.n[c];
        }
    }
}

/* u, in new_x, is newton's displacement with a part of the way made; obstacles
 * too.  Returns whether all terms allow that, and no body passes another on the
 * way; if not, obstacles are put back. */
static bool make_part(TimeIntegrator *run, double part)
{
    const System *system = run->system;
    Contact *contact = contact_of(run->system);
    const double *x_n = run->x_n;
    double *u = run->new_x, *x = run->new_v, way = part * run->h;
    double *before = run->newton->x_trial, *p = run->newton->u_trial;
    for (int i = 0; i < 2 * system->nodes; i++) {
        u[i] = p[i] = run->part == 0 ? 0 : run->newton->at.u[i];
        before[i] = x_n[i] + u[i];
        if (system->pin_v && system->pinned[i / 2])
            u[i] += way * system->pin_v[i];
    }
    move_obstacles(contact, way);
    carry(system, contact, way, x_n, before, u);
    for (int i = 0; i < 2 * system->nodes; i++) {
        x[i] = x_n[i] + u[i];
        p[i] = u[i] - p[i];
    }
    IncrementalPotential E = {
        .system = system, .weight = run->h * run->h, .x_n = x_n};
    if (incremental_potential_allowed(&E, u, x) &&
        system_lets_pass(system, before, p))
        return true;
    move_obstacles(contact, -way);
    return false;
}

Status prescribed_start(TimeIntegrator *run)
{
    double part = run->left;
    int halvings = 0;
    while (halvings < MAX_HALVINGS && run->part < MAX_PARTS &&
           !make_part(run, part)) {
        part /= 2;
        halvings++;
    }
    run->blocked = halvings == MAX_HALVINGS || run->part == MAX_PARTS;
    if (run->blocked) /* nothing moves any more in this step */
        make_part(run, 0);
    else
        run->moved += part;
    run->left = run->blocked ? 0 : run->left - part;
    run->part++;
    run->newton->rough = run->left > 0;
    return newton_start(run->newton, run->x_n, run->new_x, run->weight);
}

bool prescribed_goes_on(TimeIntegrator *run, Status *status)
{
    const Newton *newton = run->newton;
    long updates = newton->counters.iterations - run->before;
    if (*status && !status_is_unconverged(*status))
        return false;
    if (run->blocked && !*status)
        *status = STATUS_BLOCKED;
    if (run->left <= 0)
        return false;
    if (updates < newton_most_iterations(newton))
        return true;
    *status = STATUS_ITERATION_LIMIT; /* all parts get no more than one */
    return false;
}

/* Of the pins: their reaction, which is what E's gradient has in their places,
 * times their way.  Of the obstacles: the forces on the nodes, normal and of
 * friction, times the obstacle's way. */
double prescribed_work(const TimeIntegrator *run, double weight)
{
    const System *system = run->system;
    const Contact *contact = contact_of(system);
    const Newton *newton = run->newton;
    const double *u = newton->at.u, *x = newton->at.x;
    Place at = place_at(system, newton->at.E.x_n, u, x);
    double *g = run->new_x, pins = 0, sum = 0;
    at.w = weight;
    if (system->pin_v) {
        memset(g, 0, run->size * sizeof *g);
        inertia_energy_gradient(system->nodes, u, newton->u_tilde, system->m,
                                g);
        for (const TermKind *kind; (kind = next_energy(&at));)
            kind->gradient(&at, g);
        for (int i = 0; i < 2 * system->nodes; i++)
            if (system->pinned[i / 2])
                pins += g[i] * u[i] / weight;
    }
    for (int k = 0; contact && k < contact->obstacles; k++) {
        const double *v = contact->obstacle[k].v;
        for (int i = 0; moves(&contact->obstacle[k]) && i < system->nodes;
             i++) {
            if (!contact_has_pair(contact, system, i, k))
                continue;
            Gap gap = contact_pair_gap(contact, x, i, k);
            sum += contact_force(&contact->barrier, gap.d) *
                   (gap.n[0] * v[0] + gap.n[1] * v[1]);
        }
    }
    return pins +
           (run->moved * run->h * sum + friction_work_of_obstacles(system, u));
}
