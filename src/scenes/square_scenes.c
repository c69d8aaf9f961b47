#include "scenes/square_scenes.h"

#include "scenes/body.h"

Status create_square(Simulation *simulation, const NewtonSettings *settings)
{
    const Options *options = &simulation->options;
    System *system = &simulation->system;
    Status status = body_create(options, 0, &simulation->mesh, system);
    if (!status)
        status = body_add_terms(options, &simulation->mesh, 0, NULL, system);
    simulation->runs = 1;
    return status ? status
                  : body_start(options, &simulation->mesh, system, settings,
                               NULL, &simulation->run[0]);
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

void explosion_defaults(Options *options)
{
    options->segments = 3;
    options->timestep = 0.02;
    options->stretch = 0.485;
    options->filter = FILTER_NONE;
    options->line_search = LINE_SEARCH_NONE;
}
