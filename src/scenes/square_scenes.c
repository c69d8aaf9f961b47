#include "scenes/square_scenes.h"

#include <stdlib.h>
#include <string.h>

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
    return STATUS_OK;
}

/* The square at rest but for a horizontal stretch, without velocity. */
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
    for (size_t i = 0; i < size; i += 2) {
        x[i] = options->stretch * simulation->mesh.x[i];
        x[i + 1] = simulation->mesh.x[i + 1];
    }
    simulation->runs = 1;
    status = time_integrator_create(
        options->integrator ? options->integrator : &integrator_methods[0],
        &simulation->system, settings, x, v, &simulation->run[0]);
    free(x);
    free(v);
    return status;
}

void unprojected_defaults(Options *options)
{
    options->timestep = 0.02;
    options->stretch = 0.5;
    options->filter = FILTER_NONE;
}
