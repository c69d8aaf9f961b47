#include "scenes/overshoot_scene.h"

#include <math.h>

/* ln(e^x + e^-x) = |x| + ln(1 + e^(-2|x|)), which cannot overflow; its
 * derivatives are tanh and 1/cosh^2. */
static ScalarValues log_two_cosh(const void *unused, double x)
{
    (void)unused;
    double c = cosh(x);
    return (ScalarValues){.value = fabs(x) + log1p(exp(-2 * fabs(x))),
                          .first = tanh(x),
                          .second = 1 / (c * c)};
}

const ScalarFunction overshoot_function = {log_two_cosh, NULL};

void overshoot_defaults(Options *options)
{
    options->line_search = LINE_SEARCH_NONE;
    options->tolerance = 1e-10;
    options->start[0] = 2;
}

/* Copies the iterate to where the picture and the states look for it. */
static void show_iterate(Simulation *simulation)
{
    Descent *descent = &simulation->descent;
    double x = descent->scalar.x, p = descent->scalar.p;
    bool ends = simulation->done || !isfinite(p);
    ScalarValues f = scalar_at(&descent->scalar.f, x);
    descent->value = f.value;
    descent->point[0] = simulation->run[0].x[0] = x;
    descent->point[1] = simulation->run[0].x[1] = descent->value;
    descent->direction[0] = ends ? 0 : p;
    descent->slope = f.first * descent->direction[0];
    descent->by_gradient = true;
    descent->residual = fabs(f.first);
}

void scalar_scene_restart(Simulation *simulation, double x)
{
    ScalarNewton *scalar = &simulation->descent.scalar;
    scalar->x = x;
    scalar->iterations = 0;
    Status status = scalar_newton_start(scalar);
    simulation->done = status != STATUS_RUNNING;
    simulation->status = simulation->done ? status : STATUS_OK;
    simulation->steps = simulation->unconverged = 0;
    simulation->descent.count = 0;
    simulation->prediction = (Prediction){0};
    show_iterate(simulation);
}

Status scalar_scene_create(Simulation *simulation,
                           const NewtonSettings *settings,
                           const ScalarFunction *f)
{
    const double v[2] = {0, 0};
    double x[2] = {simulation->options.start[0], 0};
    Status status = system_create(1, 0, &simulation->system);
    if (status)
        return status;
    simulation->system.m[0] = 1;
    simulation->runs = 1;
    status = time_integrator_create(integrator_method("forward-euler"),
                                    &simulation->system, settings, x, v,
                                    &simulation->run[0]);
    if (status)
        return status;
    simulation->descent.scalar = (ScalarNewton){
        .f = *f, .tolerance = settings->tolerance, .search = settings->search};
    scalar_scene_restart(simulation, x[0]);
    return STATUS_OK;
}

Status create_overshoot(Simulation *simulation, const NewtonSettings *settings)
{
    return scalar_scene_create(simulation, settings, &overshoot_function);
}

Status step_overshoot(Simulation *simulation)
{
    Descent *descent = &simulation->descent;
    NewtonRecord record;
    descent->scalar.search = simulation->options.line_search;
    Status status = scalar_newton_iterate(&descent->scalar, &record);
    simulation->done = status != STATUS_RUNNING;
    show_iterate(simulation);
    if (!simulation_record(simulation, &record))
        return STATUS_INTERRUPTED;
    return simulation->done ? status : STATUS_OK;
}

int overshoot_handles(const Simulation *simulation,
                      double at[SCENE_MAX_HANDLES][2])
{
    at[0][0] = simulation->descent.point[0];
    at[0][1] = simulation->descent.value;
    return 1;
}

void overshoot_drag(Simulation *simulation, int handle, double x, double y)
{
    (void)handle;
    (void)y;
    if (isfinite(x))
        scalar_scene_restart(simulation, x);
}
