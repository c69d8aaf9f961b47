/* simulation.c - creates a scene, makes its steps, tests whether it rests. */
#include "simulation/simulation.h"

#include <math.h>

#include "model/cells.h"
#include "model/contact.h"
#include "model/neo_hookean.h"
#include "model/self_contact.h"

/* Limit of a minimisation's iterations; large squares have a lower limit. */
enum { MAX_NEWTON_ITERATIONS = 10000 };

void options_fill_newton_settings(const Options *options,
                                  NewtonSettings *settings)
{
    settings->h = options->timestep;
    settings->tolerance = options->tolerance;
    settings->solver = options->solver;
    settings->projection = options->projection;
    settings->line_search = options->line_search;
    settings->max_iterations = MAX_NEWTON_ITERATIONS;
}

Status simulation_start_run(Simulation *simulation, int run,
                            const IntegratorMethod *method, System *system,
                            const double *x, const double *v)
{
    NewtonSettings settings = {.observer = simulation->observer,
                               .user_data = simulation->observer_data};
    options_fill_newton_settings(&simulation->options, &settings);
    return time_integrator_create(method, system, &settings, x, v,
                                  &simulation->run[run]);
}

Status simulation_create(const Options *options, NewtonObserver observer,
                         void *user, Simulation *simulation)
{
    *simulation = (Simulation){.scene = options->scene,
                               .options = *options,
                               .observer = observer,
                               .observer_data = user};
    Status status = options->scene->create(simulation);
    for (int i = 0; i < SCENE_MAX_SWITCHES && !status; i++)
        if ((unsigned)options->flips >> i & 1)
            exhibit_flip_switch(simulation, i);
    for (int r = 0; r < simulation->runs && !status; r++)
        simulation->ledger[r].start_energy =
            simulation->ledger[r].latest_balance =
                -simulation_get_energies(simulation, r).dissipated;
    return status;
}

void simulation_free(Simulation *simulation)
{
    for (int i = 0; i < SIMULATION_MAX_RUNS; i++) {
        time_integrator_free(&simulation->run[i]);
        system_free(&simulation->run_system[i]);
    }
    system_free(&simulation->system);
    *simulation = (Simulation){0};
}

int simulation_find_shown_point(const Simulation *simulation, double at[2])
{
    const TimeIntegrator *run = &simulation->run[0];
    bool single =
        simulation->system.nodes == 1 || simulation->scene->update_direction;
    if (!single || !run->x)
        return 0;
    at[0] = run->x[0];
    at[1] = run->x[1];
    return simulation->descent.scalar ? 1 : 2;
}

/* Counts a step that was made.  A failed step is not counted. */
static Status finish_simulation_step(Simulation *simulation, Status status)
{
    UserPrediction *guess = &simulation->prediction;
    simulation->status = status;
    if (status_is_failure(status))
        return status;
    simulation->steps++;
    if (simulation->steps > guess->guess_step + 1) /* the guess is outdated */
        *guess = (UserPrediction){0};
    if (status) {
        simulation->unconverged_steps++;
        simulation->status_counts[status]++;
    }
    return status;
}

/* Adds the energy that backward Euler gained in a run's step to the ledger.
 * A gain below 1e-8 of all energies is due to rounding and the tolerance. */
static void record_energy_gain(Simulation *simulation)
{
    int run = simulation->current_run;
    EnergyLedger *ledger = &simulation->ledger[run];
    const Energies now = simulation_get_energies(simulation, run);
    double kept = now.total - now.work, gained = kept - ledger->latest_balance;
    double abs_sum = fabs(now.work);
    bool backward_euler = simulation->run[run].method->supports_all_terms;
    ledger->latest_balance = kept;
    for (int i = 1; i < now.count; i++)
        abs_sum += fabs(now.energy[i].value);
    if (!backward_euler || !(gained > 1e-8 * abs_sum))
        return;
    ledger->gain_steps++;
    ledger->gained_energy += gained;
}

/* Continues the step of each run to a pause (RUNNING) or to the end; then
 * returns the last status other than OK. */
Status simulation_advance(Simulation *simulation)
{
    while (simulation->current_run < simulation->runs) {
        TimeIntegrator *run = &simulation->run[simulation->current_run];
        Status status = run->status;
        if (status != STATUS_RUNNING)
            status = time_integrator_begin_step(run);
        if (status == STATUS_RUNNING)
            status = time_integrator_continue(run);
        if (status == STATUS_RUNNING)
            return status;
        simulation->bad_status = status ? status : simulation->bad_status;
        if (status_is_failure(status))
            break;
        record_energy_gain(simulation);
        simulation->current_run++;
    }
    return finish_simulation_step(simulation, simulation->bad_status);
}

Status simulation_begin_step(Simulation *simulation)
{
    const struct Scene *scene = simulation->scene;
    if (simulation->is_over)
        return STATUS_OK;
    if (scene->step)
        return finish_simulation_step(simulation, scene->step(simulation));
    simulation->current_run = 0;
    simulation->bad_status = STATUS_OK;
    for (int r = 0; r < simulation->runs; r++)
        simulation->run[r].status = STATUS_OK;
    return STATUS_RUNNING;
}

Status simulation_step(Simulation *simulation)
{
    Status status = simulation_begin_step(simulation);
    while (status == STATUS_RUNNING)
        status = simulation_advance(simulation);
    return status;
}

double simulation_get_time(const Simulation *simulation)
{
    if (!(simulation->scene->traits & HAS_TIME))
        return 0;
    return simulation->run[0].clock.time;
}

bool simulation_is_draggable(const Simulation *simulation)
{
    const Scene *scene = simulation->scene;
    return (scene->traits & HAS_TIME) && !scene->step && !scene->handle_kinds;
}

EffectTime simulation_find_option_effect(const Simulation *simulation,
                                         const OptionRow *row)
{
    unsigned traits = simulation->scene->traits;
    bool update = (traits & HAS_START) && row->effect == EFFECT_REPEATED_STEP;
    bool other_methods =
        simulation->runs > 1 && row->slot == OPTION_SLOT(integrator);
    if (!(traits & HAS_TIME) ? !update : other_methods)
        return EFFECT_NEW_RUN;
    return row->effect;
}

/* A body is at rest if no node moves by more than STILL in a frame or a step,
 * whichever is longer, and if the forces vanish at places at most BALANCED
 * away.  The unit is the shortest spring. */
static const double STILL = 1e-6, BALANCED = 1e-3, FRAME = 1.0 / 60;

/* Whether the forces f vanish close to the nodes' positions.  The distance is
 * p = (M/T^2 + H_P)^-1 f, with H_P the projected Hessian of P: the direction of
 * Algorithm 3 for a time step T from rest, so long that masses hardly matter.
 * For T^2 above 1e10 (smallest mass / curvature of P) p would be inaccurate.
 * A separate Newton object computes p, so that the run is not changed.
 *   l  m, length of the shortest spring */
static bool forces_are_balanced(const Simulation *simulation, double l)
{
    const System *system = &simulation->system;
    double lightest = INFINITY;
    for (int i = 0; i < system->nodes; i++)
        lightest = fmin(lightest, system->m[i]);
    const double stiffest = system_max_stiffness(system);
    double T2 = stiffest > 0 ? 0.99e10 * lightest / stiffest : 1;
    NewtonSettings settings = {.h = sqrt(T2),
                               .solver = SOLVER_NEWTON,
                               .projection = PROJECTION_CLAMP,
                               .line_search = LINE_SEARCH_BACKTRACK,
                               .max_iterations = 1};
    Newton newton;
    Status status = newton_create(system, &settings, &newton);
    for (int i = 0; i < 2 * system->nodes && !status; i++)
        newton.u_tilde[i] = T2 * system->gravity[i % 2];
    if (!status) {
        newton_start(&newton, simulation->run[0].x, NULL, T2,
                     BALANCED * l / sqrt(T2));
        newton_minimise(&newton);
    }
    bool balances = newton.meets_tolerance;
    newton_free(&newton);
    return balances;
}

bool simulation_is_at_rest(const Simulation *simulation)
{
    const System *system = &simulation->system;
    const TimeIntegrator *run = &simulation->run[0];
    /* the first spring of a square is one of the shortest */
    double l = system->springs ? sqrt(system->l2[0]) : 1;
    if (simulation->steps == 0)
        return false;
    for (int i = 0; i < 2 * system->nodes; i++)
        if (!(fabs(run->v[i]) * fmax(run->h, FRAME) <= STILL * l))
            return false;
    return forces_are_balanced(simulation, l);
}

NewtonCounters simulation_sum_newton_counters(const Simulation *simulation)
{
    NewtonCounters sum = simulation->replaced_counters;
    for (int i = 0; i < simulation->runs; i++)
        if (simulation->run[i].newton)
            newton_counters_add(&simulation->run[i].newton->counters, &sum);
    return sum;
}

bool simulation_has_newton_updates(const Simulation *simulation)
{
    return simulation->run[0].newton && (simulation->scene->traits & HAS_TIME);
}

/* A projection needs springs, a Newton object, and a scene with HAS_SPRINGS. */
bool simulation_has_projection(const Simulation *simulation)
{
    return simulation->system.springs > 0 && simulation->run[0].newton &&
           (simulation->scene->traits & HAS_SPRINGS);
}

/* Scenes of springs and minimisations in one variable have a line search. */
bool simulation_has_line_search(const Simulation *simulation)
{
    return simulation_has_projection(simulation) || simulation->descent.scalar;
}

bool simulation_projects_only_springs(const Simulation *simulation)
{
    const System *system = &simulation->system;
    return !system_find_term(system, &contact_energy) &&
           !system_find_term(system, &cell_energy) &&
           !get_neo_hookean(system) && !get_self_contact(system);
}

/* ---- the fastest small oscillation: M q'' = -H q ------------------------ */

enum {
    POWER_ITERATIONS = 1200, /* iterations of the power method */
    MAX_MODE_COORDINATES = 2 * SIMULATION_MAX_MODE_NODES
};

double simulation_find_max_omega(const Simulation *simulation, const double *x,
                                 double *mode)
{
    const System *system = &simulation->system;
    EvalPoint at = make_eval_point(system, NULL, NULL, x);
    double omega2 = NAN;
    int n = 2 * system->nodes;
    if (n > MAX_MODE_COORDINATES)
        return NAN;
    /* A vector without symmetry contains every mode. */
    for (int i = 0; i < n; i++)
        mode[i] = sin(1 + i + 0.1 * i * i);
    for (int k = 0; k < POWER_ITERATIONS; k++) {
        double length2 = 0;
        for (int i = 0; i < n; i++)
            length2 += mode[i] * mode[i];
        for (int i = 0; i < n; i++)
            mode[i] /= sqrt(length2);
        double image[MAX_MODE_COORDINATES] = {0}; /* M^-1 H mode, 1/s^2 */
        for (const TermKind *kind; (kind = eval_point_next_term(&at));)
            if (kind->hessian)
                kind->hessian(&at, PROJECTION_NONE, NULL, mode, image);
        for (int i = 0; i < n; i++)
            image[i] /= system->m[i / 2];
        system_zero_pinned_entries(system, image);
        omega2 = 0;
        for (int i = 0; i < n; i++)
            omega2 += mode[i] * image[i];
        for (int i = 0; i < n && k + 1 < POWER_ITERATIONS; i++)
            mode[i] = image[i];
    }
    return omega2 > 0 ? sqrt(omega2) : NAN;
}
