/* control.c - makes controls, and applies them to a simulation. */
#include "simulation/control.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "model/contact.h"
#include "model/mass_spring_energy.h"
#include "model/neo_hookean.h"
#include "model/pull_energy.h"
#include "simulation/body.h"

UserControl *control_create(const Simulation *simulation)
{
    const System *system = &simulation->system;
    UserControl *control = malloc(sizeof *control + (size_t)system->nodes);
    if (!control)
        return NULL;
    *control = (UserControl){.ref_count = 1,
                             .options = simulation->options,
                             .held_node = -1,
                             .held_obstacle = -1,
                             .nodes = system->nodes};
    memcpy(control->is_pinned, system->is_pinned, (size_t)system->nodes);
    return control;
}

UserControl *control_copy(const UserControl *from)
{
    size_t size = sizeof *from + (size_t)from->nodes;
    UserControl *control = malloc(size);
    if (!control)
        return NULL;
    memcpy(control, from, size);
    control->ref_count = 1;
    return control;
}

bool control_is_holding(const UserControl *control)
{
    return control->held_node >= 0 || control->held_obstacle >= 0;
}

/* Returns the height (m) that a run adds to an obstacle; 0 for balls. */
static double get_obstacle_added_height(const Simulation *simulation, int run,
                                        const Obstacle *obstacle)
{
    return obstacle->kind == OBSTACLE_WALL
               ? body_find_added_height(&simulation->options, run)
               : 0;
}

void simulation_locate_obstacle(const Simulation *simulation, int run,
                                int number, double at[2])
{
    const Contact *contact = get_contact(simulation->run[run].system);
    const Obstacle *obstacle = &contact->obstacle[number];
    at[0] = obstacle->o[0];
    at[1] =
        obstacle->o[1] - get_obstacle_added_height(simulation, run, obstacle);
}

void control_store_obstacle(UserControl *control, int number,
                            const Simulation *simulation)
{
    static const double SAME = 1e-9; /* largest distance divided by the side */
    double place[2], other[2];
    simulation_locate_obstacle(simulation, 0, number, place);
    for (int r = 1; r < simulation->runs; r++) {
        simulation_locate_obstacle(simulation, r, number, other);
        double away = math_hypot(other[0] - place[0], other[1] - place[1]);
        if (!(away < SAME * simulation->options.side))
            return;
    }
    memcpy(options_get_obstacle_point(&control->options, number), place,
           sizeof place);
}

const UserControl *control_retain(const UserControl *control)
{
    if (control)
        ((UserControl *)control)->ref_count++;
    return control;
}

void control_release(const UserControl *control)
{
    UserControl *own = (UserControl *)control;
    if (own && --own->ref_count == 0)
        free(own);
}

/* Stores the energy that each run has dissipated so far.
 *   out  [runs] J */
static void store_dissipated_energy(const Simulation *simulation, double *out)
{
    for (int r = 0; r < simulation->runs; r++)
        out[r] = simulation_get_energies(simulation, r).dissipated;
}

/* Books the energy that a changed stiffness or pin has added as work, so that
 * the dissipated energy does not jump.
 *   before  [runs] J, dissipated before the change */
static void add_external_work(Simulation *simulation, const double *before)
{
    for (int r = 0; r < simulation->runs; r++)
        simulation->ledger[r].user_work +=
            before[r] - simulation_get_energies(simulation, r).dissipated;
}

/* Gives a run the changed options.  With another method a new integrator takes
 * over the state of the run. */
static Status update_run_options(Simulation *simulation, int r,
                                 const Options *before)
{
    const Options *options = &simulation->options;
    TimeIntegrator *run = &simulation->run[r], old = *run;
    Status status = STATUS_OK;
    if (simulation->scene->traits & HAS_BODY)
        status = body_apply_options(simulation, r);
    if (!status && options->integrator != before->integrator) {
        status =
            simulation_start_run(simulation, r, options_get_method(options),
                                 old.system, old.x, old.v);
        run->steps = old.steps;
        run->clock = old.clock;
        run->moved_fraction = old.moved_fraction;
        run->external_work = old.external_work;
        if (old.newton)
            newton_counters_add(&old.newton->counters,
                                &simulation->replaced_counters);
        time_integrator_free(&old);
        return status;
    }
    run->h = options->timestep;
    if (run->newton)
        options_fill_newton_settings(options, &run->newton->settings);
    return status;
}

/* Gives all runs the options. */
static Status apply_options(Simulation *simulation, const Options *options)
{
    const Options before = simulation->options;
    Status status = STATUS_OK;
    simulation->options = *options;
    for (int r = 0; r < simulation->runs && !status; r++)
        status = update_run_options(simulation, r, &before);
    if (simulation->scene->update_direction && !simulation->is_over &&
        (options->projection != before.projection ||
         options->line_search != before.line_search))
        simulation->scene->update_direction(simulation);
    return status;
}

static void stop_node(TimeIntegrator *run, int node)
{
    run->v[2 * node] = run->v[2 * node + 1] = 0;
    run->history_h = 0;
}

/* Pulls the node of the control to the mouse, by a spring far stiffer than the
 * body's springs: the node follows the mouse, and the body gives way. */
static Status apply_pull(Simulation *simulation, const UserControl *control)
{
    static const double STIFFER = 1000; /* stiffness ratio of hand and body */
    System *system = &simulation->system;
    const SquareMesh *mesh = &simulation->mesh;
    EvalPoint at = make_eval_point(system, NULL, NULL, NULL);
    int node = control->held_node;
    if (node < 0) {
        system_remove_term(system, &hand_energy);
        return STATUS_OK;
    }
    const double *x = simulation->run[0].x + 2 * node;
    double k = get_neo_hookean(system) ? simulation->options.young
                                       : mass_spring_max_stiffness(&at);
    return pull_configure(
        system, &hand_energy,
        &(NodePull){.node = node,
                    .cell_size = mesh->nodes > 0 ? mesh->spacing : INFINITY,
                    .body_side = mesh->side,
                    .mouse_xy = {control->target[0], control->target[1]},
                    .target = {x[0], x[1]},
                    .mouse_k = k > 0 ? STIFFER * k : 1e5 * system->m[node]});
}

/* Pushes the obstacle that the mouse holds, if there is one, in each run. */
static void apply_push(Simulation *simulation, const UserControl *control)
{
    for (int r = 0; r < simulation->runs; r++) {
        Contact *contact = get_contact(simulation->run[r].system);
        if (!contact)
            continue;
        int held = control->held_obstacle;
        contact->push = (ObstaclePush){
            .is_held = 0 <= held && held < contact->obstacle_count,
            .obstacle_index = held,
            .target = {control->target[0], control->target[1]},
            .mesh = simulation->mesh};
        if (contact->push.is_held)
            contact->push.target[1] += get_obstacle_added_height(
                simulation, r, &contact->obstacle[held]);
    }
}

Status control_apply(Simulation *simulation, const UserControl *control)
{
    System *system = &simulation->system;
    double dissipated[SIMULATION_MAX_RUNS];
    store_dissipated_energy(simulation, dissipated);
    Status status = apply_options(simulation, &control->options);
    /* A node stops when it is pinned and when its pin is taken away. */
    for (int i = 0; i < system->nodes; i++) {
        if (system->is_pinned[i] == control->is_pinned[i])
            continue;
        system_mark_changed(system, true);
        for (int r = 0; r < simulation->runs; r++)
            if (simulation->run[r].system == system)
                stop_node(&simulation->run[r], i);
    }
    memcpy(system->is_pinned, control->is_pinned, (size_t)system->nodes);
    for (int r = 0; r < simulation->runs; r++)
        if (!simulation->run[r].newton)
            simulation->run[r].history_h = 0; /* stored acceleration is wrong */
    if (!status)
        status = apply_pull(simulation, control);
    apply_push(simulation, control);
    if (!status)
        add_external_work(simulation, dissipated);
    return status;
}

Status simulation_move_node(Simulation *simulation, int node, double x,
                            double y, bool moves)
{
    TimeIntegrator *run = &simulation->run[0];
    double *before = run->new_x, *p = run->new_v; /* scratch arrays */
    if (node < 0 || node >= simulation->system.nodes || !isfinite(x) ||
        !isfinite(y))
        return STATUS_INVALID_INPUT;
    double dissipated[SIMULATION_MAX_RUNS];
    store_dissipated_energy(simulation, dissipated);
    memcpy(before, run->x, run->x_length * sizeof *before);
    run->x[2 * node] = x;
    run->x[2 * node + 1] = y;
    bool allowed =
        system_is_feasible(make_eval_point(run->system, NULL, NULL, run->x));
    for (size_t i = 0; i < run->x_length; i++)
        p[i] = run->x[i] - before[i];
    allowed = allowed && system_path_is_free(run->system, before, p);
    if (!allowed || !moves) {
        memcpy(run->x, before, run->x_length * sizeof *before);
        return allowed ? STATUS_OK : STATUS_INVALID_INPUT;
    }
    stop_node(run, node);
    add_external_work(simulation, dissipated);
    return STATUS_OK;
}
