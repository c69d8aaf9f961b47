/* push.c - how far an obstacle held by a hand moves in a step. */
#include <math.h>

#include "base/mathematics.h"
#include "model/contact.h"

/* The distance to the hand falls by the factor e in TIME (s), in one step by at
 * most the fraction MOST.  Limits of the speed: SLOW, FAST, in body sides/s. */
static const double TIME = 0.06, MOST = 0.5, SLOW = 0.1, FAST = 5;

/* In one time step the obstacle moves by at most FAST h sides of the body, but
 * this limit is never below SHORTEST nor above LONGEST sides. */
static const double LONGEST = 0.25, SHORTEST = 0.005;

/* The hand pushes with the force that the barrier has at this fraction of its
 * width, which is enough to press springs flat. */
static const double STRENGTH = 0.1;

/* Least gap to pinned nodes, as a fraction of the barrier's width. */
static const double KEPT = 0.3;

/* Largest numbers of halvings and of unhalved steps in free_path_fraction. */
enum { MAX_MOTION_HALVINGS = 8, MAX_PATH_STEPS = 16 };

/* Writes the displacement in a step of h seconds if nothing is in the way. */
static void compute_desired_motion(const ObstaclePush *push, const double *o,
                                   double h, double way[2])
{
    double side = push->mesh.side;
    double d[2] = {push->target[0] - o[0], push->target[1] - o[1]};
    double away = math_hypot(d[0], d[1]);
    double most = side * fmin(fmax(FAST * h, SHORTEST), LONGEST);
    double go = fmax(fmin(h / TIME, MOST) * away, SLOW * side * h);
    go = fmin(go, fmin(most, away));
    for (int c = 0; c < 2; c++)
        way[c] = away > 0 ? go / away * d[c] : 0;
}

/* Whether a node in front of the obstacle feels the hand's full force. */
static bool obstacle_is_pressed(const Contact *contact, const System *system,
                                const double *x, const double way[2])
{
    int k = contact->push.obstacle_index;
    const Obstacle *obstacle = &contact->obstacle[k];
    for (int i = 0; i < system->nodes; i++) {
        NodeGap gap = contact_measure_gap(obstacle, obstacle->o, x + 2 * i,
                                          contact_node_radius(contact, i));
        if (gap.d < STRENGTH * contact->barrier.d_hat &&
            gap.n[0] * way[0] + gap.n[1] * way[1] > 0 &&
            contact_includes_pair(contact, system, i, k))
            return true;
    }
    return false;
}

/* Whether the obstacle may move to o [2].  The distance from a pinned node that
 * has no contact may not fall below KEPT d_hat or, if it is smaller, the
 * present distance.  The centre of a ball may not enter a cell. */
static bool obstacle_has_room(const Contact *contact, const System *system,
                              const double *x, const double o[2])
{
    int k = contact->push.obstacle_index;
    const Obstacle *obstacle = &contact->obstacle[k];
    const double keep = KEPT * contact->barrier.d_hat;
    for (int i = 0; i < system->nodes; i++) {
        if (!system->is_pinned[i] ||
            contact_includes_pair(contact, system, i, k))
            continue;
        double before =
            contact_measure_gap(obstacle, obstacle->o, x + 2 * i, 0).d;
        double after = contact_measure_gap(obstacle, o, x + 2 * i, 0).d;
        if (after < fmin(before, keep))
            return false;
    }
    const SquareMesh *shape = &contact->push.mesh;
    return obstacle->kind == OBSTACLE_WALL ||
           square_mesh_find_cell(shape, x, o, 0, shape->cells) < 0 ||
           square_mesh_find_cell(shape, x, obstacle->o, 0, shape->cells) >= 0;
}

/* Returns the fraction of the way before the first place without room.  A trial
 * step to a place without room is halved and repeated. */
static double free_path_fraction(const Contact *contact, const System *system,
                                 const double *x, const double way[2])
{
    const Obstacle *obstacle = &contact->obstacle[contact->push.obstacle_index];
    double length = math_hypot(way[0], way[1]), free = 0, step = 1;
    if (obstacle->kind == OBSTACLE_BALL)
        step = fmin(fmax(0.5 * obstacle->radius / length, 1.0 / MAX_PATH_STEPS),
                    1);
    for (int i = 0; i < MAX_MOTION_HALVINGS && free < 1;) {
        double part = fmin(free + step, 1);
        const double o[2] = {obstacle->o[0] + part * way[0],
                             obstacle->o[1] + part * way[1]};
        if (obstacle_has_room(contact, system, x, o)) {
            free = part;
        } else {
            step /= 2;
            i++;
        }
    }
    return free;
}

void push_begin_step(Contact *contact, const System *system, const double *x,
                     double h)
{
    ObstaclePush *push = &contact->push;
    double way[2];
    push->is_blocked = false;
    push->moving_fraction = 0;
    push->is_held =
        push->is_held && push->obstacle_index < contact->obstacle_count;
    if (!push->is_held)
        return;
    Obstacle *obstacle = &contact->obstacle[push->obstacle_index];
    compute_desired_motion(push, obstacle->o, h, way);
    double part = obstacle_is_pressed(contact, system, x, way)
                      ? 0
                      : free_path_fraction(contact, system, x, way);
    for (int c = 0; c < 2; c++)
        obstacle->v[c] = part * way[c] / h;
}

double push_max_move_fraction(const Contact *contact, double h)
{
    const Obstacle *obstacle = &contact->obstacle[contact->push.obstacle_index];
    double length = h * math_hypot(obstacle->v[0], obstacle->v[1]);
    return obstacle->kind == OBSTACLE_BALL && length > 0
               ? 0.5 * obstacle->radius / length
               : 1;
}
