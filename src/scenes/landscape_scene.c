#include "scenes/landscape_scene.h"

#include <math.h>
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

/* The gradient of the parts that are on the map. */
static void part_gradient(const Simulation *simulation, const double at[2],
                          double g[2])
{
    const System *system = &simulation->system;
    const double *pins = simulation->run[0].x, h = simulation->run[0].h;
    unsigned parts = simulation->exhibit.parts;
    g[0] = g[1] = 0;
    for (int i = 0; i < 2 && (parts & PART_INERTIA); i++)
        g[i] = system->m[0] * (at[i] - simulation->exhibit.target[i]);
    for (int s = 0; s < system->springs && (parts & PART_ELASTICITY); s++) {
        const double *pin = pins + 2 * system->e[2 * s + 1];
        const double d[2] = {at[0] - pin[0], at[1] - pin[1]};
        double l2 = system->l2[s];
        double strain = (d[0] * d[0] + d[1] * d[1] - l2) / l2;
        for (int i = 0; i < 2; i++)
            g[i] += h * h * 2 * system->k[s] * strain * d[i];
    }
}

/* Whether the parts on the map are all of E: then Newton is the one of the
 * time integrators. */
static bool is_whole(const Simulation *simulation)
{
    return simulation->exhibit.parts == PART_BOTH;
}

/* The Hessian of the parts that are on the map, springs filtered: H_xx, H_xy,
 * H_yy.  Returns how many springs the filter changed. */
static int node_hessian(const Simulation *simulation, Filter filter, double x,
                        double y, double H[3])
{
    const System *system = &simulation->system;
    const double *pins = simulation->run[0].x;
    double weight = simulation->run[0].h * simulation->run[0].h;
    unsigned parts = simulation->exhibit.parts;
    int projected = 0;
    H[0] = H[2] = parts & PART_INERTIA ? system->m[0] : 0;
    H[1] = 0;
    for (int s = 0; s < system->springs && (parts & PART_ELASTICITY); s++) {
        const double *pin = pins + 2 * system->e[2 * s + 1];
        const double d[2] = {x - pin[0], y - pin[1]};
        double own[3];
        projected +=
            spring_hessian(d, system->l2[s], system->k[s], filter, own);
        for (int i = 0; i < 3; i++)
            H[i] += weight * own[i];
    }
    return projected;
}

/* On demand: two unknowns are projected at once. */
static Filter own_filter(const Simulation *simulation)
{
    Filter filter = simulation->options.filter;
    return filter == FILTER_ON_DEMAND ? FILTER_CLAMP : filter;
}

/* p, and what the loop tests there: of Algorithm 1 |g|, else |p|/h. */
static void find_direction(Simulation *simulation, double p[2])
{
    Descent *descent = &simulation->descent;
    const Newton *newton = simulation->run[0].newton;
    double g[2];
    descent->slope = landscape_direction(simulation, own_filter(simulation), p);
    part_gradient(simulation, descent->point, g);
    descent->residual = descent->by_gradient
                            ? hypot(g[0], g[1])
                            : (fabs(p[0]) + fabs(p[1])) / simulation->run[0].h;
    if (!is_whole(simulation))
        return;
    memcpy(p, newton->at.p, 2 * sizeof *p);
    descent->slope = newton->at.g[0] * p[0] + newton->at.g[1] * p[1];
}

/* Without a line search an end above the start is no success. */
static bool is_above(const Descent *descent)
{
    return descent->value > descent->began + 1e-12 * fabs(descent->began);
}

/* Shows the iterate where the picture and the states look for it, and what the
 * loop's test says of it if Newton (status) goes on.  Where the search failed
 * its direction stays to be seen. */
static Status show_node(Simulation *simulation, Status status)
{
    TimeIntegrator *run = &simulation->run[0];
    Descent *descent = &simulation->descent;
    double p[2];
    if (is_whole(simulation))
        memcpy(run->x, run->newton->at.x, 2 * sizeof *run->x);
    memcpy(descent->point, run->x, sizeof descent->point);
    descent->value = landscape_value(simulation, run->x[0], run->x[1]);
    find_direction(simulation, p);
    bool own = descent->by_gradient || !is_whole(simulation);
    if (own && status == STATUS_RUNNING)
        status = descent->residual <= simulation->options.tolerance ? STATUS_OK
                 : isfinite(descent->slope) ? STATUS_RUNNING
                                            : STATUS_SINGULAR;
    if (own && status == STATUS_OK && is_above(descent))
        status = STATUS_DIVERGED;
    simulation->done = status != STATUS_RUNNING;
    bool none = status == STATUS_OK || !isfinite(descent->slope);
    for (int i = 0; i < 2; i++)
        descent->direction[i] = none ? 0 : p[i];
    descent->slope = none ? 0 : descent->slope;
    return status;
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
    if (simulation->descent.by_gradient)
        record.residual = simulation->descent.residual;
    return simulation_record(simulation, &record);
}

/* Algorithm 1 has a test of its own: Newton goes on until that is passed. */
static void choose_test(Simulation *simulation)
{
    const Options *options = &simulation->options;
    Descent *descent = &simulation->descent;
    bool plain = options->filter == FILTER_NONE &&
                 options->line_search == LINE_SEARCH_NONE;
    if (plain != descent->by_gradient)
        descent->count = 0; /* residuals of another kind */
    descent->by_gradient = plain;
    simulation->run[0].newton->settings.tolerance =
        plain ? 0 : options->tolerance;
}

/* Newton starts at the present iterate: x_n is moved there, x_tilde stays. */
void aim_landscape(Simulation *simulation)
{
    TimeIntegrator *run = &simulation->run[0];
    size_t size = 2 * LANDSCAPE_NODES * sizeof *run->x;
    for (int i = 0; i < 2; i++)
        run->newton->u_tilde[i] = simulation->exhibit.target[i] - run->x[i];
    memcpy(run->new_x, run->x, size); /* run->x follows the iterates */
    choose_test(simulation);
    simulation->descent.began = INFINITY; /* until it is known */
    Status status =
        newton_start(run->newton, run->new_x, NULL, run->h * run->h);
    status =
        show_node(simulation, is_whole(simulation) ? status : STATUS_RUNNING);
    simulation->status = simulation->done ? status : STATUS_OK;
    simulation->descent.began = simulation->descent.value;
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

/* E(x + alpha p) - E(x) of the parts on the map, as line_search calls it */
static double part_difference(const void *function, double alpha)
{
    const Simulation *simulation = function;
    const Descent *descent = &simulation->descent;
    return landscape_value(simulation,
                           descent->point[0] + alpha * descent->direction[0],
                           descent->point[1] + alpha * descent->direction[1]) -
           descent->value;
}

/* One iteration where a part of E is alone on the map. */
static Status step_part(Simulation *simulation)
{
    Descent *descent = &simulation->descent;
    double *x = simulation->run[0].x, H[3];
    NewtonRecord record = {
        .step = simulation->steps + 1,
        .iteration = (int)simulation->steps,
        .residual = descent->residual,
        .alpha = 1,
        .slope = descent->slope,
        .projected =
            node_hessian(simulation, own_filter(simulation), x[0], x[1], H),
        .factorised = true,
        .from = {x[0], x[1]}};
    Status status = STATUS_RUNNING;
    if (simulation->options.line_search == LINE_SEARCH_BACKTRACK &&
        line_search_backtrack(part_difference, simulation, &record.alpha,
                              &record.trials))
        status =
            record.slope > 0 ? STATUS_NOT_DESCENT : STATUS_LINE_SEARCH_LIMIT;
    record.change = part_difference(simulation, record.alpha);
    for (int i = 0; i < 2; i++)
        record.to[i] = x[i] += record.alpha * descent->direction[i];
    record.status = show_node(simulation, status);
    return simulation_record(simulation, &record) ? record.status
                                                  : STATUS_INTERRUPTED;
}

Status step_landscape(Simulation *simulation)
{
    choose_test(simulation);
    Status status =
        is_whole(simulation)
            ? show_node(simulation, newton_iterate(simulation->run[0].newton))
            : step_part(simulation);
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

/* One part at least stays.  What was minimised before is another function: its
 * updates are no longer shown. */
void landscape_flip(Simulation *simulation, int number)
{
    unsigned parts = simulation->exhibit.parts ^ (1U << number);
    simulation->exhibit.parts = parts ? parts : PART_BOTH ^ (1U << number);
    simulation->descent.count = 0;
    simulation->prediction = (Prediction){0};
    if (simulation->scene->aim)
        simulation->scene->aim(simulation);
}

double landscape_value(const Simulation *simulation, double x, double y)
{
    const Newton *newton = simulation->run[0].newton;
    double at[2 * LANDSCAPE_NODES], u[2 * LANDSCAPE_NODES] = {0};
    if (!is_whole(simulation))
        return landscape_part_value(simulation, simulation->exhibit.parts, x,
                                    y);
    memcpy(at, newton->at.x, sizeof at);
    at[0] = x;
    at[1] = y;
    u[0] = x - newton->at.E.x_n[0];
    u[1] = y - newton->at.E.x_n[1];
    return incremental_potential_value(&newton->at.E, u, at);
}

int landscape_bends_down(const Simulation *simulation, double x, double y)
{
    double H[3];
    node_hessian(simulation, FILTER_NONE, x, y, H);
    bool same = H[0] * H[2] - H[1] * H[1] > 0;
    return same ? (H[0] > 0 ? 0 : 2) : 1;
}

double landscape_direction(const Simulation *simulation, Filter filter,
                           double p[2])
{
    const double *x = simulation->descent.point;
    double H[3], g[2];
    part_gradient(simulation, x, g);
    node_hessian(simulation, filter, x[0], x[1], H);
    double determinant = H[0] * H[2] - H[1] * H[1];
    if (fabs(determinant) <= 1e-14 * (H[0] + H[2]) * (H[0] + H[2]))
        determinant = NAN; /* no inverse in the digits of a double */
    p[0] = (H[1] * g[1] - H[2] * g[0]) / determinant;
    p[1] = (H[1] * g[0] - H[0] * g[1]) / determinant;
    return g[0] * p[0] + g[1] * p[1];
}
