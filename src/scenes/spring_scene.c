#include "scenes/spring_scene.h"

#include <math.h>
#include <string.h>

static const double SPRING_MASS = 1;        /* kg */
static const double SPRING_STIFFNESS = 100; /* J/m^2 */
static const double SPRING_LENGTH = 1;      /* m, at rest */

/* Ascending by insertion. */
static void sort_four(double value[4])
{
    for (int i = 1; i < 4; i++)
        for (int j = i; j > 0 && value[j] < value[j - 1]; j--) {
            double swap = value[j];
            value[j] = value[j - 1];
            value[j - 1] = swap;
        }
}

void spring_facts(const double d[2], double l2, double k, SpringFacts *facts)
{
    double d2 = d[0] * d[0] + d[1] * d[1], l = sqrt(l2), r = sqrt(d2);
    double s = (d2 - l2) / l2;
    *facts = (SpringFacts){
        .length = r,
        .strain = s,
        .energy = 0.5 * l2 * k * s * s,
        .force = {-2 * k * s * d[0], -2 * k * s * d[1]},
        .along = 2 * k / l2 * (3 * d2 - l2),
        .across = 2 * k / l2 * (d2 - l2),
        .root_energy = 2 * k * (r - l) * (r - l),
        .root_force = -4 * k * (r - l),
        .root_along = 4 * k,
        .root_across = 4 * k * (1 - l / r),
    };
    const double block[4] = {0, 0, 2 * facts->along, 2 * facts->across};
    memcpy(facts->block, block, sizeof block);
    sort_four(facts->block);
    for (int i = 0; i < 4; i++)
        facts->projected[i] = fmax(facts->block[i], 0);
    sort_four(facts->projected);
}

void spring_defaults(Options *options)
{
    options->timestep = 0.02;
    options->start[0] = 0.6;
    options->start[1] = 0.3;
    options->tolerance = 1e-6; /* or a light pull would count as rest */
}

Status create_spring(Simulation *simulation, const NewtonSettings *settings)
{
    const Options *options = &simulation->options;
    System *system = &simulation->system;
    const double x[4] = {options->start[0], options->start[1], 0, 0};
    const double v[4] = {0};
    Status status = system_create(2, 1, system);
    if (!status)
        status = system_create_pins(system);
    if (status)
        return status;
    system->m[0] = system->m[1] = SPRING_MASS;
    system->pinned[1] = 1;
    system->e[0] = 0;
    system->e[1] = 1;
    system->l2[0] = SPRING_LENGTH * SPRING_LENGTH;
    system->k[0] = SPRING_STIFFNESS;
    simulation->runs = 1;
    return time_integrator_create(options->integrator ? options->integrator
                                                      : &integrator_methods[0],
                                  system, settings, x, v, &simulation->run[0]);
}

int spring_handles(const Simulation *simulation,
                   double at[SCENE_MAX_HANDLES][2])
{
    memcpy(at[0], simulation->run[0].x, sizeof at[0]);
    return 1;
}

void spring_drag(Simulation *simulation, int handle, double x, double y)
{
    TimeIntegrator *run = &simulation->run[0];
    if (handle != 0 || !isfinite(x) || !isfinite(y))
        return;
    run->x[0] = x;
    run->x[1] = y;
    run->v[0] = run->v[1] = 0;
    run->remembers = false;
}

int spring_switches(const Simulation *simulation,
                    Switch out[SCENE_MAX_SWITCHES])
{
    out[0] = (Switch){"with the square root", simulation->exhibit.root};
    return 1;
}

void spring_flip(Simulation *simulation, int number)
{
    if (number == 0)
        simulation->exhibit.root = !simulation->exhibit.root;
}
