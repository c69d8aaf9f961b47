#include "scenes/small_scenes.h"
#include "base/mathematics.h"

#include <math.h>
#include <string.h>

/* h from 1e-3 to 10 s, ten to a power of ten. */
static const double DIAL_FIRST = 1e-3, DIAL_LAST = 10, DIAL_PER_TEN = 10;

/* m: a shorter p changes E by less than E's rounding, and is taken whole. */
static const double DIAL_NEAR = 1e-6;

static const double DIAL_BESIDE = 1e-9; /* m, from the line of the pins */

enum { DIAL_UPDATES = 100, DIAL_HALVINGS = 40 };

/* Algorithm 3 for two unknowns; it ends at the size of rounding.  On the line
 * of the pins there may be a saddle, where the gradient is 0, too: it begins
 * beside it. */
void dial_minimise(const Simulation *simulation, double h, double point[2])
{
    if (fabs(point[1]) < DIAL_BESIDE)
        point[1] = copysign(DIAL_BESIDE, point[1]);
    for (int update = 0; update < DIAL_UPDATES; update++) {
        Local E = landscape_at(simulation, PART_BOTH, h, FILTER_CLAMP, point);
        const double *g = E.g, *H = E.H;
        double determinant = H[0] * H[2] - H[1] * H[1], alpha = 1;
        const double p[2] = {(H[1] * g[1] - H[2] * g[0]) / determinant,
                             (H[1] * g[0] - H[0] * g[1]) / determinant};
        bool near = math_hypot(p[0], p[1]) <= DIAL_NEAR;
        for (int i = 0; i < DIAL_HALVINGS && !near; i++, alpha /= 2) {
            const double to[2] = {point[0] + alpha * p[0],
                                  point[1] + alpha * p[1]};
            if (landscape_at(simulation, PART_BOTH, h, FILTER_NONE, to).value <=
                E.value)
                break;
        }
        for (int i = 0; i < 2; i++)
            point[i] += alpha * p[i];
        if (math_hypot(p[0], p[1]) <= 1e-14)
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

void dial_restart(Simulation *simulation)
{
    fill_walk(simulation);
    show_minimiser(simulation);
}

Status create_dial(Simulation *simulation)
{
    Status status = create_landscape(simulation);
    if (status)
        return status;
    dial_restart(simulation);
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
