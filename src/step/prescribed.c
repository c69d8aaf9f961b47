/* prescribed.c - motion of walls, of pins, and of an obstacle that a hand
 * pushes, within a step.
 *
 * Walls and pins get their final position before E is minimised.  No stiff
 * spring draws them there, so the position is exact and E has no stiff term.
 * If the motion would close a gap or turn a cell over, half of the motion is
 * made first, then E is minimised, then the rest follows: each minimisation
 * begins at a point that all terms allow. */
#include "step/prescribed.h"

#include <math.h>
#include <string.h>

#include "model/contact.h"
#include "model/friction.h"
#include "model/inertia_energy.h"

/* Limits of the fractions that are tried for a part of the way, each half the
 * one before, and of the parts of a step.  A wall at 50 m/s in steps of 0.01 s
 * onto cells of 1/8 m needs 19 parts.  Where a body leaves room for less than
 * 1/512 of the rest of the way, the motion ends, because each further part
 * would take more updates than the one before. */
enum { MAX_MOTION_TRIALS = 10, MAX_MOTION_PARTS = 100 };

/* An obstacle that would touch nodes carries them along, with this fraction of
 * the barrier's width as their gap, or with their gap before if it is less. */
#define CARRIED_GAP 0.3

/* Limits like MAX_MOTION_TRIALS and MAX_MOTION_PARTS for an obstacle that a
 * hand moves: lower, as the rest of its way can wait for the next step. */
enum { MAX_HAND_TRIALS = 6, MAX_HAND_PARTS = 8 };

/* Whether obstacle k moves in the rest of this step. */
static bool obstacle_moves(const Contact *contact, int k)
{
    const double *v = contact->obstacle[k].v;
    bool stopped =
        contact->push.is_blocked && k == contact->push.obstacle_index;
    return !stopped && (v[0] != 0 || v[1] != 0);
}

bool prescribed_begin_motion(TimeIntegrator *run)
{
    Contact *contact = get_contact(run->system);
    bool any = run->system->pin_v != NULL;
    run->moved_fraction = 0;
    run->remaining_fraction = 1;
    run->motion_parts_made = 0;
    run->is_blocked = false;
    run->updates_before_step = run->newton ? run->newton->counters.updates : 0;
    for (int k = 0; contact && k < contact->obstacle_count; k++) {
        Obstacle *obstacle = &contact->obstacle[k];
        const ObstacleMotion *motion = &obstacle->motion;
        double from = 0; /* start of a phase, as a fraction of the step */
        obstacle->v[0] = obstacle->v[1] = 0;
        for (int i = 0; i < motion->phase_count; i++) {
            double left = motion->phase_end[i] - run->clock.time;
            double to = fmin(fmax(left / run->h, from), 1);
            for (int c = 0; c < 2; c++)
                obstacle->v[c] += (to - from) * motion->v[i][c];
            from = to;
        }
    }
    if (contact)
        push_begin_step(contact, run->system, run->x, run->h);
    for (int k = 0; contact && k < contact->obstacle_count; k++)
        any = any || obstacle_moves(contact, k);
    return any;
}

/* Moves all obstacles by their velocity times `way` seconds: o += way v. */
static void move_obstacles(Contact *contact, double way)
{
    for (int k = 0; contact && k < contact->obstacle_count; k++)
        for (int c = 0; c < 2 && obstacle_moves(contact, k); c++)
            contact->obstacle[k].o[c] += way * contact->obstacle[k].v[c];
}

/* Carries along the nodes in front of obstacles that come nearer.
 *   way     s, duration of the motion that the obstacles have made
 *   before  [2n] m, positions of the nodes before this motion
 *   u       [2n] m, in/out, displacements of the nodes */
static void move_carried_nodes(const System *system, const Contact *contact,
                               double way, const double *x_n,
                               const double *before, double *u)
{
    for (int k = 0; contact && k < contact->obstacle_count; k++) {
        const Obstacle *obstacle = &contact->obstacle[k];
        double back[2] = {obstacle->o[0] - way * obstacle->v[0],
                          obstacle->o[1] - way * obstacle->v[1]};
        if (!obstacle_moves(contact, k))
            continue;
        for (int i = 0; i < system->nodes; i++) {
            if (!contact_includes_pair(contact, system, i, k) ||
                system->is_pinned[i]) /* a pinned node stays */
                continue;
            double now[2] = {x_n[2 * i] + u[2 * i],
                             x_n[2 * i + 1] + u[2 * i + 1]};
            double radius = contact_node_radius(contact, i);
            NodeGap after =
                contact_measure_gap(obstacle, obstacle->o, now, radius);
            double gap =
                contact_measure_gap(obstacle, back, before + 2 * i, radius).d;
            double keep = fmin(gap, CARRIED_GAP * contact->barrier.d_hat);
            for (int c = 0; c < 2; c++)
                u[2 * i + c] += fmax(0, keep - after.d) * after.n[c];
        }
    }
}

/* Moves obstacles, pins and carried nodes by the fraction `part` of the step.
 * Writes u, Newton's displacement plus this motion, to new_x.  Returns false,
 * with the obstacles moved back, if a term forbids u or bodies would cross. */
static bool try_prescribed_motion(TimeIntegrator *run, double part)
{
    const System *system = run->system;
    Contact *contact = get_contact(run->system);
    const double *x_n = run->x;
    double *u = run->new_x, *x = run->new_v, way = part * run->h;
    double *before = run->newton->x_trial, *p = run->newton->u_trial;
    for (int i = 0; i < 2 * system->nodes; i++) {
        u[i] = p[i] =
            run->motion_parts_made == 0 ? 0 : run->newton->iterate.u[i];
        before[i] = x_n[i] + u[i];
        if (system->pin_v && system->is_pinned[i / 2])
            u[i] += way * system->pin_v[i];
    }
    move_obstacles(contact, way);
    move_carried_nodes(system, contact, way, x_n, before, u);
    for (int i = 0; i < 2 * system->nodes; i++) {
        x[i] = x_n[i] + u[i];
        p[i] = u[i] - p[i];
    }
    IncrementalPotential E = {
        .system = system, .weight = run->h * run->h, .x_n = x_n};
    if (incremental_potential_is_feasible(&E, u, x) &&
        system_path_is_free(system, before, p))
        return true;
    move_obstacles(contact, -way);
    return false;
}

/* Moves obstacles and pins by the largest fraction of the step for which there
 * is room.
 *   part      in, the first fraction that is tried
 *   trials    in, number of fractions that are tried, each half the one before
 *   parts     in, limit of the parts of a step so far
 * Returns the fraction, or 0 if there was no room. */
static double make_longest_motion(TimeIntegrator *run, double part, int trials,
                                  int parts)
{
    for (int i = 0; i < trials && run->motion_parts_made < parts;
         i++, part /= 2)
        if (try_prescribed_motion(run, part))
            return part;
    return 0;
}

void prescribed_begin_motion_part(TimeIntegrator *run)
{
    Contact *contact = get_contact(run->system);
    double part = 0;
    if (contact && contact->push.is_held &&
        obstacle_moves(contact, contact->push.obstacle_index)) {
        part =
            make_longest_motion(run,
                                fmin(run->remaining_fraction,
                                     push_max_move_fraction(contact, run->h)),
                                MAX_HAND_TRIALS, MAX_HAND_PARTS);
        contact->push.is_blocked = part == 0;
        contact->push.moving_fraction = run->moved_fraction;
    }
    bool others = run->system->pin_v != NULL;
    for (int k = 0; contact && k < contact->obstacle_count; k++)
        others = others || obstacle_moves(contact, k);
    if (part == 0 && others)
        part = make_longest_motion(run, run->remaining_fraction,
                                   MAX_MOTION_TRIALS, MAX_MOTION_PARTS);
    run->is_blocked = part == 0 && others;
    if (part == 0) /* no further motion in this step */
        try_prescribed_motion(run, 0);
    else
        run->moved_fraction += part;
    run->remaining_fraction = part == 0 ? 0 : run->remaining_fraction - part;
    run->motion_parts_made++;
    bool guess = run->remaining_fraction > 0;
    double tolerance = run->newton->settings.tolerance;
    newton_start(run->newton, run->x, run->new_x, run->weight,
                 guess ? 10 * tolerance + 0.01 : tolerance);
}

/* Tells the observer that the motion ended the step: a record, iteration -1. */
static void report_motion_end(const Newton *newton, Status status)
{
    const NewtonSettings *settings = &newton->settings;
    const NewtonRecord end = {.step_number = newton->step_number,
                              .iteration = -1,
                              .residual = newton->record.residual,
                              .residual_kind = newton->record.residual_kind,
                              .status = status,
                              .solver = newton->record.solver};
    if (settings->observer)
        settings->observer(settings->user_data, &end);
}

bool prescribed_end_motion_part(TimeIntegrator *run, Status *status)
{
    const Newton *newton = run->newton;
    long updates = newton->counters.updates - run->updates_before_step;
    if (status_is_failure(*status))
        return false;
    if (run->is_blocked && !*status)
        *status = STATUS_BLOCKED;
    if (run->remaining_fraction > 0 && updates < newton_iteration_limit(newton))
        return true;
    /* The parts of a step share one limit of iterations. */
    if (run->remaining_fraction > 0)
        *status = STATUS_ITERATION_LIMIT;
    if (*status != newton->status)
        report_motion_end(newton, *status);
    return false;
}

double prescribed_compute_work(const TimeIntegrator *run)
{
    const System *system = run->system;
    const Contact *contact = get_contact(system);
    const Newton *newton = run->newton;
    const double *u = newton->iterate.u, *x = newton->iterate.x;
    EvalPoint at = make_eval_point(system, newton->iterate.E.x_n, u, x);
    double *g = run->new_x, pins = 0, sum = 0;
    at.weight = newton->iterate.E.weight;
    if (system->pin_v) {
        memset(g, 0, run->x_length * sizeof *g);
        inertia_energy_gradient(system->nodes, u, newton->u_tilde, system->m,
                                g);
        for (const TermKind *kind; (kind = eval_point_next_term(&at));)
            if (kind->gradient)
                kind->gradient(&at, g);
        for (int i = 0; i < 2 * system->nodes; i++)
            if (system->is_pinned[i / 2])
                pins += g[i] * u[i] / at.weight;
    }
    at.term = system_find_term(system, &contact_energy);
    if (at.term)
        for (ElementIterator walk = elements_begin(&at, NULL, 0);
             elements_next(&walk);) {
            int k = walk.element.partner_index;
            const double *v = contact->obstacle[k].v, *n = walk.element.n;
            bool stopped =
                contact->push.is_blocked && k == contact->push.obstacle_index;
            sum += (stopped ? contact->push.moving_fraction
                            : run->moved_fraction) *
                   contact_normal_force(&contact->barrier, walk.element.s) *
                   (n[0] * v[0] + n[1] * v[1]);
        }
    return pins + (run->h * sum + friction_obstacle_work(system, u));
}
