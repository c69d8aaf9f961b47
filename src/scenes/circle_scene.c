#include "scenes/circle_scene.h"

#include "model/pull_energy.h"

static const double CIRCLE_OMEGA = 6.283185307179586; /* 1/s: a turn a second */

void circle_defaults(Options *options)
{
    options->timestep = 0.02;
}

Status create_circle(Simulation *simulation, const NewtonSettings *settings)
{
    static const char *const names[SIMULATION_MAX_RUNS] = {
        "forward-euler", "symplectic-euler", "backward-euler"};
    const IntegratorMethod *chosen = simulation->options.integrator;
    const double x[2] = {1, 0}, v[2] = {0, CIRCLE_OMEGA};
    Status status = system_create(1, 0, &simulation->system);
    if (status)
        return status;
    simulation->system.m[0] = 1;
    status =
        central_field_set(&simulation->system, CIRCLE_OMEGA * CIRCLE_OMEGA);
    simulation->runs = chosen ? 1 : SIMULATION_MAX_RUNS;
    for (int i = 0; i < SIMULATION_MAX_RUNS && i < simulation->runs && !status;
         i++)
        status = time_integrator_create(
            chosen ? chosen : integrator_method(names[i]), &simulation->system,
            settings, x, v, &simulation->run[i]);
    return status;
}
