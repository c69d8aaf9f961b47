#include "scenes/mass_scene.h"

#include <math.h>
#include <string.h>

#include "model/pull_energy.h"

void mass_defaults(Options *options)
{
    options->timestep = 0.5;
    options->start[0] = 1;
    options->start[1] = 0;
}

Status create_mass(Simulation *simulation, const NewtonSettings *settings)
{
    static const char *const names[SIMULATION_MAX_RUNS] = {
        "forward-euler", "symplectic-euler", "backward-euler"};
    const Options *options = &simulation->options;
    const IntegratorMethod *chosen = options->integrator;
    const double v[2] = {0, 1};
    Status status = system_create(1, 0, &simulation->system);
    if (status)
        return status;
    simulation->system.m[0] = 1;
    status = central_field_set(&simulation->system, MASS_OMEGA2);
    simulation->runs = chosen ? 1 : SIMULATION_MAX_RUNS;
    memcpy(simulation->exhibit.began, options->start, sizeof v);
    memcpy(simulation->exhibit.began + 2, v, sizeof v);
    for (int i = 0; i < simulation->runs && !status; i++)
        status = time_integrator_create(
            chosen ? chosen : integrator_method(names[i]), &simulation->system,
            settings, options->start, v, &simulation->run[i]);
    return status;
}

bool mass_next_step(const Simulation *simulation, int run, MassStep *step)
{
    const TimeIntegrator *integrator = &simulation->run[run];
    const char *name = integrator->method->name;
    bool forward = strcmp(name, "forward-euler") == 0;
    bool symplectic = strcmp(name, "symplectic-euler") == 0;
    bool backward = strcmp(name, "backward-euler") == 0;
    double h = integrator->h;
    step->by_old_v = forward;
    for (int i = 0; i < 2; i++) {
        double x = integrator->x[i], v = integrator->v[i];
        double a = -MASS_OMEGA2 * x, new_v = v + h * a;
        if (backward) /* v' = v - h omega2 (x + h v'), solved for v' */
            new_v = new_v / (1 + h * h * MASS_OMEGA2);
        step->x[i] = x;
        step->v[i] = v;
        step->a[i] = a;
        step->new_v[i] = new_v;
        step->new_x[i] = x + h * (forward ? v : new_v);
        step->new_a[i] = -MASS_OMEGA2 * step->new_x[i];
    }
    return forward || symplectic || backward;
}

void mass_exact(const Simulation *simulation, double t, double x[2])
{
    const double *began = simulation->exhibit.began, omega = sqrt(MASS_OMEGA2);
    for (int i = 0; i < 2; i++)
        x[i] =
            began[i] * cos(omega * t) + began[i + 2] * sin(omega * t) / omega;
}

int mass_handles(const Simulation *simulation, double at[SCENE_MAX_HANDLES][2])
{
    const TimeIntegrator *run = &simulation->run[0];
    for (int i = 0; i < 2; i++) {
        at[0][i] = run->x[i];
        at[1][i] = run->x[i] + run->v[i];
    }
    return 2;
}

void mass_drag(Simulation *simulation, int handle, double x, double y)
{
    const double point[2] = {x, y};
    const double *first = simulation->run[0].x;
    double new_x[2], new_v[2];
    for (int i = 0; i < 2; i++) {
        new_x[i] = handle == 0 ? point[i] : first[i];
        new_v[i] = handle == 0 ? simulation->run[0].v[i] : point[i] - first[i];
    }
    for (int i = 0; i < simulation->runs; i++) {
        TimeIntegrator *run = &simulation->run[i];
        memcpy(run->x, new_x, sizeof new_x);
        memcpy(run->v, new_v, sizeof new_v);
        run->remembers = false;
    }
    memcpy(simulation->exhibit.began, new_x, sizeof new_x);
    memcpy(simulation->exhibit.began + 2, new_v, sizeof new_v);
    simulation->prediction = (Prediction){0};
}
