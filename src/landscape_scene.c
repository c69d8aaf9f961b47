#include "landscape_scene.h"

#include <string.h>

enum { LANDSCAPE_PINS = 2, LANDSCAPE_NODES = 1 + LANDSCAPE_PINS };

static const double LANDSCAPE_MASS = 1;        /* kg */
static const double LANDSCAPE_STIFFNESS = 100; /* J/m^2 */
static const double LANDSCAPE_LENGTH = 1.5;    /* m, at rest */

/* x_tilde of the free node, m: where inertia alone would take it. */
static const double LANDSCAPE_TARGET[2] = {0.2, 0.3};

void landscape_defaults(Options *options)
{
    options->timestep = 0.2;
    options->tolerance = 1e-6;
    options->start[0] = 0.1;
    options->start[1] = -0.35;
}

/* Pins at (-1, 0) and (1, 0) m, each with a spring to node 0 that is too long
 * to lie flat between them: like a buckling column it gives way up or down. */
static Status fill_landscape(System *system, double x[2 * LANDSCAPE_NODES])
{
    Status status = system_create(LANDSCAPE_NODES, LANDSCAPE_PINS, system);
    if (!status)
        status = system_create_pins(system);
    if (status)
        return status;
    for (int i = 0; i < LANDSCAPE_NODES; i++)
        system->m[i] = LANDSCAPE_MASS;
    for (int s = 0; s < LANDSCAPE_PINS; s++) {
        int pin = s + 1;
        x[2 * pin] = s == 0 ? -1 : 1;
        system->pinned[pin] = 1;
        system->e[2 * s] = 0;
        system->e[2 * s + 1] = pin;
        system->l2[s] = LANDSCAPE_LENGTH * LANDSCAPE_LENGTH;
        system->k[s] = LANDSCAPE_STIFFNESS;
    }
    return STATUS_OK;
}

/* Copies the iterate to where the picture and the states look for it. */
static void show_node(Simulation *simulation)
{
    TimeIntegrator *run = &simulation->run[0];
    Descent *descent = &simulation->descent;
    for (int i = 0; i < 2; i++) {
        run->x[i] = descent->point[i] = run->newton->x[i];
        descent->direction[i] = simulation->done ? 0 : run->newton->p[i];
    }
}

/* Adds the two positions to the record of an iteration. */
static bool observe_landscape(void *user, const NewtonRecord *iteration)
{
    Simulation *simulation = user;
    NewtonRecord record = *iteration;
    record.step = record.iteration + 1;
    memcpy(record.from, simulation->descent.point, sizeof record.from);
    memcpy(record.to, simulation->run[0].newton->x, sizeof record.to);
    return simulation_record(simulation, &record);
}

Status create_landscape(Simulation *simulation, const NewtonSettings *settings)
{
    const Options *options = &simulation->options;
    double x[2 * LANDSCAPE_NODES] = {options->start[0], options->start[1]};
    const double v[2 * LANDSCAPE_NODES] = {0};
    TimeIntegrator *run = &simulation->run[0];
    NewtonSettings own = *settings;
    own.observer = observe_landscape;
    own.user = simulation;
    Status status = fill_landscape(&simulation->system, x);
    if (status)
        return status;
    simulation->runs = 1;
    status = time_integrator_create(integrator_method("backward-euler"),
                                    &simulation->system, &own, x, v, run);
    if (status)
        return status;
    for (int i = 0; i < 2; i++)
        run->newton->u_tilde[i] = LANDSCAPE_TARGET[i] - x[i];
    memcpy(run->new_x, x, sizeof x); /* run->x follows the iterates */
    status = newton_start(run->newton, run->new_x, own.h * own.h);
    simulation->done = status != STATUS_RUNNING;
    show_node(simulation);
    return status == STATUS_RUNNING ? STATUS_OK : status;
}

Status step_landscape(Simulation *simulation)
{
    if (simulation->done)
        return STATUS_OK;
    Status status = newton_iterate(simulation->run[0].newton);
    simulation->done = status != STATUS_RUNNING;
    show_node(simulation);
    return simulation->done ? status : STATUS_OK;
}

double landscape_value(const Simulation *simulation, double x, double y)
{
    const Newton *newton = simulation->run[0].newton;
    double at[2 * LANDSCAPE_NODES], u[2 * LANDSCAPE_NODES] = {0};
    memcpy(at, newton->x, sizeof at);
    at[0] = x;
    at[1] = y;
    u[0] = x - newton->E.x_n[0];
    u[1] = y - newton->E.x_n[1];
    return incremental_potential_value(&newton->E, u, at);
}
