#include "scenes/square_scenes.h"

#include <stdlib.h>

#include "scenes/body.h"

Status create_square(Simulation *simulation, const NewtonSettings *settings)
{
    const Options *options = &simulation->options;
    System *system = &simulation->system;
    Status status = body_create(options, 0, &simulation->mesh, system);
    if (!status)
        status = body_add_terms(options, &simulation->mesh, 0, NULL, system);
    if (status)
        return status;
    size_t size = 2 * (size_t)system->nodes;
    double *x = malloc(size * sizeof *x), *v = calloc(size, sizeof *v);
    if (!x || !v) {
        free(x);
        free(v);
        return STATUS_OUT_OF_MEMORY;
    }
    body_place(options, &simulation->mesh, system, x, v);
    simulation->runs = 1;
    status = time_integrator_create(
        options->integrator ? options->integrator : &integrator_methods[0],
        system, settings, x, v, &simulation->run[0]);
    free(x);
    free(v);
    return status;
}

void hang_defaults(Options *options)
{
    options->segments = 12;
    options->stiffness = 1e4;
    options->stretch = 1;
    options->timestep = 0.01;
    options->tolerance = 1e-3;
    options->gravity = 9.81;
    options->pin = "top-corners";
}

void unprojected_defaults(Options *options)
{
    options->timestep = 0.02;
    options->stretch = 0.5;
    options->filter = FILTER_NONE;
}
