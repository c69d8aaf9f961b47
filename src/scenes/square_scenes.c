#include "scenes/square_scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/pins.h"

/* Masses, springs and rest lengths of the square (slide simulator.py):
 * m = density side^2 / nodes, l2 = |d|^2 in the rest positions. */
static Status fill_square(Simulation *simulation)
{
    const Options *options = &simulation->options;
    SquareMesh *mesh = &simulation->mesh;
    System *system = &simulation->system;
    Status status = square_mesh_create(options->segments, options->side, mesh);
    if (!status)
        status = system_create(mesh->nodes, mesh->springs, system);
    if (status)
        return status;
    double m = options->density * mesh->side * mesh->side / mesh->nodes;
    for (int i = 0; i < mesh->nodes; i++)
        system->m[i] = m;
    memcpy(system->e, mesh->e, 2 * (size_t)mesh->springs * sizeof(int));
    for (int s = 0; s < mesh->springs; s++) {
        const double *xi = mesh->x + 2 * mesh->e[2 * s];
        const double *xj = mesh->x + 2 * mesh->e[2 * s + 1];
        double dx = xi[0] - xj[0], dy = xi[1] - xj[1];
        system->l2[s] = dx * dx + dy * dy;
        system->k[s] = options->stiffness;
    }
    system->order = mesh->order; /* the system owns it now */
    mesh->order = NULL;
    system->gravity[1] = -options->gravity;
    if (!options->pin)
        return STATUS_OK;
    status = system_create_pins(system);
    return status ? status
                  : pins_read(options->pin, options->segments, system->pinned);
}

/* Stretched, turned, moved; 0 degrees leave every bit. */
static void place_square(const Simulation *simulation, double *x, double *v)
{
    const Options *options = &simulation->options;
    const System *system = &simulation->system;
    double angle = options->turn * 0.017453292519943295; /* pi/180 */
    double c = cos(angle), s = sin(angle);
    for (int i = 0; i < system->nodes; i++) {
        double x0 = options->stretch * simulation->mesh.x[2 * i];
        double x1 = simulation->mesh.x[2 * i + 1];
        x[2 * i] = c * x0 - s * x1 + options->at[0];
        x[2 * i + 1] = s * x0 + c * x1 + options->at[1];
        for (int axis = 0; axis < 2; axis++)
            if (!system->pinned || !system->pinned[i])
                v[2 * i + axis] = options->velocity[axis];
    }
}

Status create_square(Simulation *simulation, const NewtonSettings *settings)
{
    const Options *options = &simulation->options;
    Status status = fill_square(simulation);
    if (status)
        return status;
    size_t size = 2 * (size_t)simulation->mesh.nodes;
    double *x = malloc(size * sizeof *x), *v = calloc(size, sizeof *v);
    if (!x || !v) {
        free(x);
        free(v);
        return STATUS_OUT_OF_MEMORY;
    }
    place_square(simulation, x, v);
    simulation->runs = 1;
    status = time_integrator_create(
        options->integrator ? options->integrator : &integrator_methods[0],
        &simulation->system, settings, x, v, &simulation->run[0]);
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
