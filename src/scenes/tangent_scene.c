#include "scenes/tangent_scene.h"

#include <math.h>

#include "scenes/overshoot_scene.h"

static const double TANGENT_MASS = 1;       /* kg */
static const double TANGENT_STIFFNESS = 10; /* J/m^2 */
static const double TANGENT_LENGTH = 1;     /* m, at rest */
static const double TANGENT_TARGET = 2;     /* m, x_tilde */

static ScalarValues line_energy(const void *data, double x)
{
    const LineEnergy *line = data;
    double m = line->m, l2 = line->l2, k = line->k, h = line->h;
    double d = x - line->target, s = x * x / l2 - 1;
    return (ScalarValues){.value =
                              0.5 * m * d * d + h * h * l2 * 0.5 * k * s * s,
                          .first = m * d + 2 * h * h * k * x * s,
                          .second = m + 2 * h * h * k * (3 * x * x / l2 - 1)};
}

void tangent_defaults(Options *options)
{
    options->line_search = LINE_SEARCH_NONE;
    options->timestep = 0.3;
    options->tolerance = 1e-10;
    options->start[0] = 2.5;
}

Status create_tangent(Simulation *simulation, const NewtonSettings *settings)
{
    LineEnergy *line = &simulation->exhibit.line;
    *line = (LineEnergy){.m = TANGENT_MASS,
                         .k = TANGENT_STIFFNESS,
                         .l2 = TANGENT_LENGTH * TANGENT_LENGTH,
                         .h = simulation->options.timestep,
                         .target = TANGENT_TARGET};
    const ScalarFunction E = {line_energy, line};
    return scalar_scene_create(simulation, settings, &E);
}

int tangent_handles(const Simulation *simulation,
                    double at[SCENE_MAX_HANDLES][2])
{
    const LineEnergy *line = &simulation->exhibit.line;
    at[0][0] = simulation->descent.point[0];
    at[0][1] = simulation->descent.value;
    at[1][0] = line->target;
    at[1][1] = 0;
    return 2;
}

void tangent_drag(Simulation *simulation, int handle, double x, double y)
{
    (void)y;
    if (!isfinite(x))
        return;
    if (handle == 1)
        simulation->exhibit.line.target = x;
    scalar_scene_restart(simulation,
                         handle == 0 ? x : simulation->descent.point[0]);
}
