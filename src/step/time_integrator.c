#include "step/time_integrator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/contact.h"
#include "model/friction.h"
#include "model/inertia_energy.h"
#include "model/pull_energy.h"

const IntegratorMethod *integrator_method(const char *name)
{
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        if (strcmp(row->name, name) == 0)
            return row;
    return NULL;
}

bool integrator_method_refuses(const IntegratorMethod *method,
                               const System *system)
{
    for (int t = 0; t < system->terms; t++) {
        const TermKind *kind = system->term[t].kind;
        if (kind->end_of_step && !method->at_end)
            return true;
    }
    return false;
}

Status time_integrator_create(const IntegratorMethod *method, System *system,
                              const NewtonSettings *settings, const double *x,
                              const double *v, TimeIntegrator *run)
{
    size_t size = 2 * (size_t)system->nodes;
    *run = (TimeIntegrator){
        .method = method, .system = system, .size = size, .h = settings->h};
    if (system_check(system, x) || !all_finite(v, size) ||
        !isfinite(settings->h) || !(settings->h > 0) ||
        !(settings->tolerance > 0) ||
        integrator_method_refuses(method, system) ||
        (system->pin_v && !method->at_end))
        return STATUS_INVALID_INPUT;
    run->x = calloc((4 + (size_t)method->memory) * size, sizeof *x);
    if (!run->x)
        return STATUS_OUT_OF_MEMORY;
    run->v = run->x + size;
    run->new_x = run->v + size;
    run->new_v = run->new_x + size;
    run->memory = run->new_v + size;
    memcpy(run->x, x, size * sizeof *x);
    memcpy(run->v, v, size * sizeof *v);
    if (!method->implicit)
        return STATUS_OK;
    run->newton = calloc(1, sizeof *run->newton);
    return run->newton ? newton_create(system, settings, run->newton)
                       : STATUS_OUT_OF_MEMORY;
}

void time_integrator_free(TimeIntegrator *run)
{
    newton_free(run->newton);
    free(run->newton);
    free(run->x);
    *run = (TimeIntegrator){0};
}

/* ---- walls and pinned nodes that move as they are told ------------------
 *
 * Within a step they are put where they belong before E is minimised, not drawn
 * there by a stiff spring: their position is exact, and E has nothing stiff in
 * it.  Where the way would leave no room (a gap or a cell would end), half of
 * it is made first, then E is minimised, then the rest: each round begins at a
 * place that all terms allow. */

/* Halvings of a part of the way, and parts of it; a wall at 50 m/s in steps of
 * 0.01 s onto cells of 1/8 m needs 19 parts.  What has room for less than a
 * thousandth of the way is pressed flat: there a step ends, for each further
 * part takes more updates than the one before. */
enum { MAX_HALVINGS = 10, MAX_PARTS = 100 };

/* Nodes that a wall would touch are carried along and keep this much of the
 * barrier's width. */
#define CARRIED_GAP 0.3

/* Halvings of a part of the way of an obstacle that a hand moves, and parts of
 * it; the hand goes on in the next step. */
enum { HAND_HALVINGS = 6, HAND_PARTS = 8 };

/* Whether obstacle k moves in the rest of this step. */
static bool moves(const Contact *contact, int k)
{
    const double *v = contact->obstacle[k].v;
    bool stopped = contact->push.stopped && k == contact->push.obstacle;
    return !stopped && (v[0] != 0 || v[1] != 0);
}

/* Whether a hand moves an obstacle in the rest of this step. */
static bool hand_moves(const Contact *contact)
{
    return contact && contact->push.on &&
           moves(contact, contact->push.obstacle);
}

/* An obstacle that would pass the place at which it stops goes just there. */
static void stop_obstacle(Obstacle *obstacle, double h)
{
    double *v = obstacle->v, square = v[0] * v[0] + v[1] * v[1], left = 0;
    double way[2];
    for (int c = 0; c < 2; c++) {
        way[c] = obstacle->motion.stop[c] - obstacle->o[c];
        left += way[c] * v[c]; /* times |v|^2, s */
    }
    bool here = left <= 1e-9 * h * square; /* but for rounding */
    for (int c = 0; c < 2; c++)
        v[c] = here ? 0 : left < h * square ? way[c] / h : v[c];
}

/* Before a step: each obstacle's v is what its motion has for this step.
 * Returns whether anything moves. */
static bool prescribed_begin(TimeIntegrator *run)
{
    Contact *contact = contact_of(run->system);
    bool any = run->system->pin_v != NULL;
    double half_way = run->clock.now + 0.5 * run->h;
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
        if (motion->stops)
            stop_obstacle(obstacle, run->h);
    }
    if (contact)
        push_begin(contact, run->system, run->x, run->h);
    for (int k = 0; contact && k < contact->obstacles; k++)
        any = any || moves(contact, k);
    return any;
}

/* o += way v of all obstacles. */
static void move_obstacles(Contact *contact, double way)
{
    for (int k = 0; contact && k < contact->obstacles; k++)
        for (int c = 0; c < 2 && moves(contact, k); c++)
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
        if (!moves(contact, k))
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
    const double *x_n = run->x;
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

/* Makes the largest part of the rest of the way that there is room for, which
 * is halved so often at most, in so many parts at most.  Returns the part; 0:
 * there was no room. */
static double make_most(TimeIntegrator *run, double part, int halvings,
                        int parts)
{
    for (int i = 0; i < halvings && run->part < parts; i++, part /= 2)
        if (make_part(run, part))
            return part;
    return 0;
}

/* Puts things on their way, as far as there is room, and starts to minimise E
 * with u_tilde as target from there.  Where another part follows, the minimiser
 * is only a guess, and the tolerance is loose.  What a hand moves stops where
 * there is no room, and all else goes on. */
static void prescribed_start(TimeIntegrator *run)
{
    Contact *contact = contact_of(run->system);
    double part = 0;
    if (hand_moves(contact)) {
        part = make_most(run, fmin(run->left, push_most(contact, run->h)),
                         HAND_HALVINGS, HAND_PARTS);
        contact->push.stopped = part == 0;
        contact->push.moved = run->moved;
    }
    bool others = run->system->pin_v != NULL;
    for (int k = 0; contact && k < contact->obstacles; k++)
        others = others || moves(contact, k);
    if (part == 0 && others)
        part = make_most(run, run->left, MAX_HALVINGS, MAX_PARTS);
    run->blocked = part == 0 && others;
    if (part == 0) /* nothing moves any more in this step */
        make_part(run, 0);
    else
        run->moved += part;
    run->left = part == 0 ? 0 : run->left - part;
    run->part++;
    bool guess = run->left > 0;
    double tolerance = run->newton->settings.tolerance;
    newton_start(run->newton, run->x, run->new_x, run->weight,
                 guess ? 10 * tolerance + 0.01 : tolerance);
}

/* After one of its minimisations: whether another one follows.
 *   status  in: how it ended; out: how all of them did, BLOCKED where things
 *           could not be put where they belong */
static bool prescribed_goes_on(TimeIntegrator *run, Status *status)
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

/* Reports the end of a step that the prescribed motion has ended: the record is
 * of no iteration. */
static void report_end(const Newton *newton, Status status)
{
    const NewtonSettings *settings = &newton->settings;
    const NewtonRecord end = {.step = newton->step,
                              .iteration = -1,
                              .residual = newton->record.residual,
                              .kind = newton->record.kind,
                              .status = status,
                              .solver = newton->record.solver};
    if (settings->observer)
        settings->observer(settings->user, &end);
}

/* J, what those who moved things have done in a step.  Of the pins: their
 * reaction, which is what E's gradient has in their places, times their way. Of
 * the obstacles: the forces on the nodes, normal and of friction, times the
 * obstacle's way. */
static double prescribed_work(const TimeIntegrator *run, double weight)
{
    const System *system = run->system;
    const Contact *contact = contact_of(system);
    const Newton *newton = run->newton;
    const double *u = newton->at.u, *x = newton->at.x;
    EvalPoint at = eval_point_at(system, newton->at.E.x_n, u, x);
    double *g = run->new_x, pins = 0, sum = 0;
    at.w = weight;
    if (system->pin_v) {
        memset(g, 0, run->size * sizeof *g);
        inertia_energy_gradient(system->nodes, u, newton->u_tilde, system->m,
                                g);
        for (int t = 0; t < system->terms; t++) {
            const TermKind *kind = eval_point_term(&at, t);
            if (kind->gradient)
                kind->gradient(&at, g);
        }
        for (int i = 0; i < 2 * system->nodes; i++)
            if (system->pinned[i / 2])
                pins += g[i] * u[i] / weight;
    }
    at.term = system_find_term(system, &contact_energy);
    if (at.term)
        for (ElementWalk walk = elements_from(&at, NULL, 0);
             elements_next(&walk);) {
            int k = walk.element.from;
            const double *v = contact->obstacle[k].v, *n = walk.element.n;
            bool stopped = contact->push.stopped && k == contact->push.obstacle;
            sum += (stopped ? contact->push.moved : run->moved) *
                   contact_force(&contact->barrier, walk.element.s) *
                   (n[0] * v[0] + n[1] * v[1]);
        }
    return pins + (run->h * sum + friction_work_of_obstacles(system, u));
}

/* ---- a step ------------------------------------------------------------- */

/* One more step of h. */
static void tick(StepClock *clock, double h)
{
    if (h != clock->h)
        *clock = (StepClock){.since = clock->now, .h = h};
    clock->steps++;
    clock->now = clock->since + (double)clock->steps * h;
}

/* The step ends: made, if its status is OK or an unconverged one; else x and v
 * stay. */
static Status end_step(TimeIntegrator *run, Status status)
{
    size_t both = 2 * run->size; /* v is behind x, new_v behind new_x */
    run->status = status;
    if (status && !status_is_unconverged(status))
        return status;
    if (!all_finite(run->new_x, both)) {
        run->memory_h = 0;
        return run->status = STATUS_NOT_FINITE;
    }
    const Pull *hand = system_data(run->system, &hand_energy);
    if (hand)
        run->work += hand_work(hand, run->x + 2 * hand->node,
                               run->new_x + 2 * hand->node);
    memcpy(run->x, run->new_x, both * sizeof(double));
    run->steps++;
    tick(&run->clock, run->h);
    if (run->moves)
        run->work += prescribed_work(run, run->newton->at.E.weight);
    System *system = run->system;
    for (int t = 0; t < system->terms; t++)
        if (system->term[t].kind->end)
            system->term[t].kind->end(
                &(TermStep){system, &system->term[t], run->x, run->v, run->h});
    return run->status;
}

/* The minimisation of the present stage begins. */
static void begin_stage(TimeIntegrator *run)
{
    const System *system = run->system;
    Newton *newton = run->newton;
    run->method->aim(run);
    if (system_has_gravity(system))
        for (size_t i = 0; i < run->size; i++)
            newton->u_tilde[i] += run->weight * system->gravity[i % 2];
    newton->step = run->steps + 1;
    if (run->moves)
        prescribed_start(run);
    else
        newton_start(newton, run->x, NULL, run->weight,
                     newton->settings.tolerance);
}

/* Where the hand pulls in this step. */
static void begin_hand(TimeIntegrator *run)
{
    System *system = run->system;
    Pull *hand = system_data(system, &hand_energy);
    if (!hand)
        return;
    size_t i = 2 * (size_t)hand->node;
    if (!run->newton) {
        hand->k = 0;
        system_acceleration(system, run->x, run->new_x);
        run->memory_h = 0; /* it was another force */
    }
    hand_follow(hand, run->x + i, run->v + i, system->m[hand->node], run->h,
                run->newton ? NULL : run->new_x + i);
    system_changed(system, false);
}

Status time_integrator_begin(TimeIntegrator *run)
{
    System *system = run->system;
    Status status = STATUS_OK;
    run->worst = STATUS_OK;
    run->stage = 0;
    if (run->newton)
        run->newton->change = 0;
    run->moves = prescribed_begin(run);
    for (int t = 0; t < system->terms && !status; t++)
        if (system->term[t].kind->begin)
            status = system->term[t].kind->begin(
                &(TermStep){system, &system->term[t], run->x, run->v, run->h});
    if (status)
        return end_step(run, status);
    begin_hand(run);
    if (run->newton)
        begin_stage(run);
    return run->status = STATUS_RUNNING;
}

Status time_integrator_advance(TimeIntegrator *run)
{
    const IntegratorMethod *method = run->method;
    while (run->stage < method->stages) {
        Status status = newton_minimise(run->newton);
        if (status == STATUS_RUNNING)
            return status;
        if (run->moves && prescribed_goes_on(run, &status)) {
            prescribed_start(run);
            continue;
        }
        if (status != run->newton->status)
            report_end(run->newton, status);
        if (status && !status_is_unconverged(status))
            return end_step(run, status);
        run->worst = status ? status : run->worst;
        method->land(run);
        if (++run->stage < method->stages)
            begin_stage(run);
    }
    if (method->stages == 0)
        method->land(run);
    return end_step(run, run->worst);
}

Status time_integrator_step(TimeIntegrator *run)
{
    Status status = time_integrator_begin(run);
    while (status == STATUS_RUNNING)
        status = time_integrator_advance(run);
    return status;
}
