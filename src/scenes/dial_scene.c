#include "scenes/dial_scene.h"

#include <math.h>
#include <string.h>

#include "model/mass_spring_energy.h"

/* h from 1e-3 to 10 s, ten to a power of ten. */
static const double DIAL_FIRST = 1e-3, DIAL_LAST = 10, DIAL_PER_TEN = 10;

/* m: a shorter p changes E by less than E's rounding, and is taken whole. */
static const double DIAL_NEAR = 1e-6;

static const double DIAL_BESIDE = 1e-9; /* m, from the line of the pins */

enum { DIAL_UPDATES = 100, DIAL_HALVINGS = 40 };

void dial_defaults(Options *options)
{
    landscape_defaults(options);
    options->timestep = 0.005;
}

/* E of the free node at (x, y), J s^2 */
static double dial_value(const Simulation *simulation, double h, double x,
                         double y)
{
    double own = simulation->run[0].h;
    double elastic =
        landscape_part_value(simulation, PART_ELASTICITY, x, y) / (own * own);
    return landscape_part_value(simulation, PART_INERTIA, x, y) +
           h * h * elastic;
}

/* g = grad E, H = its Hessian with projected springs: H_xx, H_xy, H_yy. */
static void dial_derivatives(const Simulation *simulation, double h,
                             const double at[2], double g[2], double H[3])
{
    const System *system = &simulation->system;
    const double *pins = simulation->run[0].x;
    const double *target = simulation->exhibit.target;
    double m = system->m[0], w = h * h;
    for (int i = 0; i < 2; i++)
        g[i] = m * (at[i] - target[i]);
    H[0] = H[2] = m;
    H[1] = 0;
    for (int s = 0; s < system->springs; s++) {
        const double *pin = pins + 2 * system->e[2 * s + 1];
        const double d[2] = {at[0] - pin[0], at[1] - pin[1]};
        double l2 = system->l2[s], k = system->k[s], own[3];
        double strain = (d[0] * d[0] + d[1] * d[1] - l2) / l2;
        spring_hessian(d, l2, k, FILTER_CLAMP, own);
        for (int i = 0; i < 2; i++)
            g[i] += w * 2 * k * strain * d[i];
        for (int i = 0; i < 3; i++)
            H[i] += w * own[i];
    }
}

/* Algorithm 3 for two unknowns; it ends at the size of rounding.  On the line
 * of the pins there may be a saddle, where the gradient is 0, too: it begins
 * beside it. */
void dial_minimise(const Simulation *simulation, double h, double point[2])
{
    if (fabs(point[1]) < DIAL_BESIDE)
        point[1] = copysign(DIAL_BESIDE, point[1]);
    for (int update = 0; update < DIAL_UPDATES; update++) {
        double g[2], H[3], alpha = 1;
        dial_derivatives(simulation, h, point, g, H);
        double determinant = H[0] * H[2] - H[1] * H[1];
        const double p[2] = {(H[1] * g[1] - H[2] * g[0]) / determinant,
                             (H[1] * g[0] - H[0] * g[1]) / determinant};
        double E = dial_value(simulation, h, point[0], point[1]);
        bool near = hypot(p[0], p[1]) <= DIAL_NEAR;
        for (int i = 0; i < DIAL_HALVINGS && !near; i++, alpha /= 2)
            if (dial_value(simulation, h, point[0] + alpha * p[0],
                           point[1] + alpha * p[1]) <= E)
                break;
        for (int i = 0; i < 2; i++)
            point[i] += alpha * p[i];
        if (hypot(p[0], p[1]) <= 1e-14)
            return;
    }
}

/* Each minimiser begins where the one before was: the path is continuous. */
static void fill_walk(Simulation *simulation)
{
    Walk *walk = &simulation->exhibit.walk;
    double point[2];
    memcpy(point, simulation->exhibit.target, sizeof point);
    for (int i = 0; i < WALK_POINTS; i++) {
        walk->h[i] = DIAL_FIRST * pow(10, i / DIAL_PER_TEN);
        dial_minimise(simulation, walk->h[i], point);
        memcpy(walk->point[i], point, sizeof point);
    }
}

/* Node 0 is put to the minimiser for the present h. */
static void show_minimiser(Simulation *simulation)
{
    const Walk *walk = &simulation->exhibit.walk;
    double h = simulation->options.timestep, point[2];
    int i = 0;
    memcpy(point, simulation->exhibit.target, sizeof point);
    while (i < WALK_POINTS && walk->h[i] <= h)
        i++;
    if (i > 0)
        memcpy(point, walk->point[i - 1], sizeof point);
    dial_minimise(simulation, h, point);
    memcpy(simulation->run[0].x, point, sizeof point);
    memcpy(simulation->descent.point, point, sizeof point);
    simulation->descent.value =
        landscape_part_value(simulation, PART_BOTH, point[0], point[1]);
}

Status create_dial(Simulation *simulation, const NewtonSettings *settings)
{
    Status status = create_landscape(simulation, settings);
    if (status)
        return status;
    fill_walk(simulation);
    show_minimiser(simulation);
    simulation->done = simulation->options.timestep >= DIAL_LAST;
    simulation->status = STATUS_OK;
    return STATUS_OK;
}

Status step_dial(Simulation *simulation)
{
    double h = simulation->options.timestep * pow(10, 1 / DIAL_PER_TEN);
    h = fmin(h, DIAL_LAST);
    simulation->options.timestep = simulation->run[0].h = h;
    simulation->done = h >= DIAL_LAST;
    show_minimiser(simulation);
    return STATUS_OK;
}

int dial_handles(const Simulation *simulation, double at[SCENE_MAX_HANDLES][2])
{
    memcpy(at[0], simulation->exhibit.target, sizeof at[0]);
    return 1;
}

void dial_drag(Simulation *simulation, int handle, double x, double y)
{
    if (handle != 0 || !isfinite(x) || !isfinite(y))
        return;
    simulation->exhibit.target[0] = x;
    simulation->exhibit.target[1] = y;
    fill_walk(simulation);
    show_minimiser(simulation);
}
