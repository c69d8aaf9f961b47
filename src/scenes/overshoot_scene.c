#include "scenes/overshoot_scene.h"

#include <math.h>

/* ln(e^x + e^-x) = |x| + ln(1 + e^(-2|x|)), which cannot overflow */
static double log_two_cosh(double x)
{
    return fabs(x) + log1p(exp(-2 * fabs(x)));
}

/* tanh' = 1/cosh^2 */
static double inverse_cosh_squared(double x)
{
    double c = cosh(x);
    return 1 / (c * c);
}

const ScalarFunction overshoot_function = {log_two_cosh, tanh,
                                           inverse_cosh_squared};

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
    descent->value = overshoot_function.value(x);
    descent->point[0] = simulation->run[0].x[0] = x;
    descent->point[1] = simulation->run[0].x[1] = descent->value;
    descent->direction[0] = ends ? 0 : p;
    descent->slope = overshoot_function.first(x) * descent->direction[0];
}

Status create_overshoot(Simulation *simulation, const NewtonSettings *settings)
{
    const double v[2] = {0, 0};
    double x[2] = {simulation->options.start[0], 0};
    ScalarNewton *scalar = &simulation->descent.scalar;
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
    *scalar = (ScalarNewton){.f = overshoot_function,
                             .tolerance = settings->tolerance,
                             .search = settings->search,
                             .x = x[0]};
    status = scalar_newton_start(scalar);
    simulation->done = status != STATUS_RUNNING;
    simulation->status = simulation->done ? status : STATUS_OK;
    show_iterate(simulation);
    return STATUS_OK;
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
