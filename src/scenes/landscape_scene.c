#include "scenes/landscape_scene.h"

#include <string.h>

#include "model/mass_spring_energy.h"

enum { LANDSCAPE_PINS = 2, LANDSCAPE_NODES = 1 + LANDSCAPE_PINS };

static const double LANDSCAPE_MASS = 1;        /* kg */
static const double LANDSCAPE_STIFFNESS = 100; /* J/m^2 */
static const double LANDSCAPE_LENGTH = 1.5;    /* m, at rest */

/* x_tilde of the free node, m: where inertia alone would take it. */
static const double LANDSCAPE_TARGET[2] = {0.2, 0.3};

void landscape_defaults(Options *options)
{
    options->timestep = 0.2;
    options->tolerance = 1e-6;
    options->start[0] = 0.1;
    options->start[1] = -0.35;
}

/* Pins at (-1, 0) and (1, 0) m, each with a spring to node 0 that is too long
 * to lie flat between them: like a buckling column it gives way up or down. */
static Status fill_landscape(System *system, double x[2 * LANDSCAPE_NODES])
{
    Status status = system_create(LANDSCAPE_NODES, LANDSCAPE_PINS, system);
    if (!status)
        status = system_create_pins(system);
    if (status)
        return status;
    for (int i = 0; i < LANDSCAPE_NODES; i++)
        system->m[i] = LANDSCAPE_MASS;
    for (int s = 0; s < LANDSCAPE_PINS; s++) {
        int pin = s + 1;
        x[2 * pin] = s == 0 ? -1 : 1;
        system->pinned[pin] = 1;
        system->e[2 * s] = 0;
        system->e[2 * s + 1] = pin;
        system->l2[s] = LANDSCAPE_LENGTH * LANDSCAPE_LENGTH;
        system->k[s] = LANDSCAPE_STIFFNESS;
    }
    return STATUS_OK;
}

/* Copies the iterate to where the picture and the states look for it.  Where
 * the search failed its direction stays to be seen. */
static void show_node(Simulation *simulation)
{
    TimeIntegrator *run = &simulation->run[0];
    const Newton *newton = run->newton;
    Descent *descent = &simulation->descent;
    bool ends = simulation->done && newton->record.alpha > 0;
    descent->slope = 0;
    for (int i = 0; i < 2; i++) {
        run->x[i] = descent->point[i] = newton->at.x[i];
        descent->direction[i] = ends ? 0 : newton->at.p[i];
        descent->slope += newton->at.g[i] * descent->direction[i];
    }
    descent->value = landscape_value(simulation, run->x[0], run->x[1]);
}

/* Adds the two positions to the record of an iteration. */
static bool observe_landscape(void *user, const NewtonRecord *iteration)
{
    Simulation *simulation = user;
    NewtonRecord record = *iteration;
    record.step = simulation->steps + 1;
    record.iteration = (int)simulation->steps;
    memcpy(record.from, simulation->descent.point, sizeof record.from);
    memcpy(record.to, simulation->run[0].newton->at.x, sizeof record.to);
    return simulation_record(simulation, &record);
}

/* Newton starts at the present iterate: x_n is moved there, x_tilde stays. */
void aim_landscape(Simulation *simulation)
{
    TimeIntegrator *run = &simulation->run[0];
    size_t size = 2 * LANDSCAPE_NODES * sizeof *run->x;
    for (int i = 0; i < 2; i++)
        run->newton->u_tilde[i] = simulation->exhibit.target[i] - run->x[i];
    memcpy(run->new_x, run->x, size); /* run->x follows the iterates */
    Status status =
        newton_start(run->newton, run->new_x, NULL, run->h * run->h);
    simulation->done = status != STATUS_RUNNING;
    simulation->status = simulation->done ? status : STATUS_OK;
    show_node(simulation);
}

Status create_landscape(Simulation *simulation, const NewtonSettings *settings)
{
    const Options *options = &simulation->options;
    double x[2 * LANDSCAPE_NODES] = {options->start[0], options->start[1]};
    const double v[2 * LANDSCAPE_NODES] = {0};
    NewtonSettings own = *settings;
    own.observer = observe_landscape;
    own.user = simulation;
    Status status = fill_landscape(&simulation->system, x);
    memcpy(simulation->exhibit.target, LANDSCAPE_TARGET,
           sizeof LANDSCAPE_TARGET);
    simulation->exhibit.parts = PART_BOTH;
    if (status)
        return status;
    simulation->runs = 1;
    status = time_integrator_create(integrator_method("backward-euler"),
                                    &simulation->system, &own, x, v,
                                    &simulation->run[0]);
    if (status)
        return status;
    aim_landscape(simulation);
    return status_is_unconverged(simulation->status) ? STATUS_OK
                                                     : simulation->status;
}

Status step_landscape(Simulation *simulation)
{
    Status status = newton_iterate(simulation->run[0].newton);
    simulation->done = status != STATUS_RUNNING;
    show_node(simulation);
    return simulation->done ? status : STATUS_OK;
}

/* The free node at (x, y), the pins where they are.  at [2 nodes] out */
static void place_node(const Simulation *simulation, double x, double y,
                       double *at)
{
    memcpy(at, simulation->run[0].x, 2 * LANDSCAPE_NODES * sizeof *at);
    at[0] = x;
    at[1] = y;
}

double landscape_part_value(const Simulation *simulation, unsigned parts,
                            double x, double y)
{
    const System *system = &simulation->system;
    const double *target = simulation->exhibit.target;
    double at[2 * LANDSCAPE_NODES], value = 0, h = simulation->run[0].h;
    double dx = x - target[0], dy = y - target[1];
    place_node(simulation, x, y, at);
    if (parts & PART_INERTIA)
        value += 0.5 * system->m[0] * (dx * dx + dy * dy);
    if (parts & PART_ELASTICITY)
        value += h * h * system_potential(system, at);
    return value;
}

int landscape_handles(const Simulation *simulation,
                      double at[SCENE_MAX_HANDLES][2])
{
    memcpy(at[0], simulation->exhibit.target, sizeof at[0]);
    memcpy(at[1], simulation->run[0].x, sizeof at[1]);
    return 2;
}

/* x_tilde, or the iterate: Newton then starts from there. */
void landscape_drag(Simulation *simulation, int handle, double x, double y)
{
    double *moved =
        handle == 0 ? simulation->exhibit.target : simulation->run[0].x;
    moved[0] = x;
    moved[1] = y;
    simulation->descent.count = 0;
    simulation->steps = simulation->unconverged = 0;
    simulation->prediction = (Prediction){0};
    aim_landscape(simulation);
}

int landscape_switches(const Simulation *simulation,
                       Switch out[SCENE_MAX_SWITCHES])
{
    unsigned parts = simulation->exhibit.parts;
    out[0] = (Switch){"inertia", (parts & PART_INERTIA) != 0};
    out[1] = (Switch){"elasticity", (parts & PART_ELASTICITY) != 0};
    return 2;
}

/* One part at least stays. */
void landscape_flip(Simulation *simulation, int number)
{
    unsigned parts = simulation->exhibit.parts ^ (1U << number);
    simulation->exhibit.parts = parts ? parts : PART_BOTH ^ (1U << number);
}

double landscape_value(const Simulation *simulation, double x, double y)
{
    const Newton *newton = simulation->run[0].newton;
    double at[2 * LANDSCAPE_NODES], u[2 * LANDSCAPE_NODES] = {0};
    memcpy(at, newton->at.x, sizeof at);
    at[0] = x;
    at[1] = y;
    u[0] = x - newton->at.E.x_n[0];
    u[1] = y - newton->at.E.x_n[1];
    return incremental_potential_value(&newton->at.E, u, at);
}

/* The Hessian of the parts that are on the map, springs filtered: H_xx, H_xy,
 * H_yy. */
static void node_hessian(const Simulation *simulation, Filter filter, double x,
                         double y, double H[3])
{
    const System *system = &simulation->system;
    const double *pins = simulation->run[0].x;
    double weight = simulation->run[0].h * simulation->run[0].h;
    unsigned parts = simulation->exhibit.parts;
    H[0] = H[2] = parts & PART_INERTIA ? system->m[0] : 0;
    H[1] = 0;
    for (int s = 0; s < system->springs && (parts & PART_ELASTICITY); s++) {
        const double *pin = pins + 2 * system->e[2 * s + 1];
        const double d[2] = {x - pin[0], y - pin[1]};
        double own[3];
        spring_hessian(d, system->l2[s], system->k[s], filter, own);
        for (int i = 0; i < 3; i++)
            H[i] += weight * own[i];
    }
}

/* Positive trace and determinant. */
bool landscape_is_convex(const Simulation *simulation, double x, double y)
{
    double H[3];
    node_hessian(simulation, FILTER_NONE, x, y, H);
    return H[0] + H[2] > 0 && H[0] * H[2] - H[1] * H[1] > 0;
}

double landscape_direction(const Simulation *simulation, Filter filter,
                           double p[2])
{
    const System *system = &simulation->system;
    const double *x = simulation->descent.point, *pins = simulation->run[0].x;
    double h = simulation->run[0].h, H[3], g[2] = {0, 0};
    unsigned parts = simulation->exhibit.parts;
    for (int i = 0; i < 2 && (parts & PART_INERTIA); i++)
        g[i] = system->m[0] * (x[i] - simulation->exhibit.target[i]);
    for (int s = 0; s < system->springs && (parts & PART_ELASTICITY); s++) {
        const double *pin = pins + 2 * system->e[2 * s + 1];
        const double d[2] = {x[0] - pin[0], x[1] - pin[1]};
        double l2 = system->l2[s];
        double strain = (d[0] * d[0] + d[1] * d[1] - l2) / l2;
        for (int i = 0; i < 2; i++)
            g[i] += h * h * 2 * system->k[s] * strain * d[i];
    }
    node_hessian(simulation, filter, x[0], x[1], H);
    double determinant = H[0] * H[2] - H[1] * H[1];
    p[0] = (H[1] * g[1] - H[2] * g[0]) / determinant;
    p[1] = (H[1] * g[0] - H[0] * g[1]) / determinant;
    return g[0] * p[0] + g[1] * p[1];
}
