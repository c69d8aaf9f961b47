#include "scenes/contact_scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/contact.h"
#include "model/fracture.h"
#include "scenes/body.h"
#include "scenes/square_scenes.h"

static const double SLOPE = 20; /* degrees */

/* What all of these scenes have but tear. */
static void fall(Options *options, int segments, double stiffness,
                 double timestep)
{
    options->segments = segments;
    options->stiffness = stiffness;
    options->stretch = 1;
    options->timestep = timestep;
    options->tolerance = 1e-4;
    options->gravity = 9.81;
    options->cells = 1;
}

static void add_ground(Options *options, double nx, double ny, double ox,
                       double oy)
{
    double *ground = options->ground[(int)options->grounds++];
    ground[0] = nx;
    ground[1] = ny;
    ground[2] = ox;
    ground[3] = oy;
}

static void add_ball(Options *options, double x, double y, double radius)
{
    double *ball = options->ball[(int)options->balls++];
    ball[0] = x;
    ball[1] = y;
    ball[2] = radius;
}

/* ---- drop -------------------------------------------------------------- */

void drop_defaults(Options *options)
{
    fall(options, 16, 1e5, 0.005);
    options->turn = 25;
    options->at[0] = -0.3;
    options->at[1] = 0.75;
    options->velocity[0] = 0.9;
    options->velocity[1] = -1;
    options->friction = 0.3;
    add_ground(options, 0, 1, 0, -0.5);
    add_ground(options, 1, 0, -1.1, 0);
    add_ground(options, -1, 0, 1.1, 0);
}

/* ---- slope ------------------------------------------------------------- */

void slope_defaults(Options *options)
{
    double c = cos(SLOPE * DEGREE), s = sin(SLOPE * DEGREE);
    fall(options, 6, 5e4, 0.01);
    options->tolerance = 1e-5;
    options->side = 0.5;
    options->turn = SLOPE;
    options->at[0] = -s * 0.2525;
    options->at[1] = c * 0.2525;
    options->friction = tan(SLOPE * DEGREE);
    add_ground(options, -s, c, 0, 0);
}

/* One run, lower than the one before, with its own friction. */
static Status create_slope_run(Simulation *simulation,
                               const NewtonSettings *settings, int run)
{
    static const double part[SIMULATION_MAX_RUNS] = {0.5, 0.9, 1.1};
    System *system = run == 0 ? &simulation->system : &simulation->more[run];
    SquareMesh mesh = {0};
    Options options = simulation->options;
    simulation->grip[run] = part[run];
    options.friction *= part[run];
    options.at[1] += 1.3 * options.side / 0.5 * (1 - run);
    for (int i = 0; i < options.grounds; i++)
        options.ground[i][3] += 1.3 * options.side / 0.5 * (1 - run);
    Status status = body_create(&options, 0, &mesh, system);
    if (!status)
        status = body_add_terms(&options, &mesh, 0, NULL, system);
    if (!status)
        status = body_start(&options, &mesh, system, settings, NULL,
                            &simulation->run[run]);
    if (run == 0)
        simulation->mesh = mesh;
    else
        square_mesh_free(&mesh);
    return status;
}

Status create_slope(Simulation *simulation, const NewtonSettings *settings)
{
    Status status = STATUS_OK;
    simulation->runs = SIMULATION_MAX_RUNS;
    for (int run = 0; run < SIMULATION_MAX_RUNS && !status; run++)
        status = create_slope_run(simulation, settings, run);
    return status;
}

/* ---- squeeze ----------------------------------------------------------- */

void squeeze_defaults(Options *options)
{
    fall(options, 16, 1e5, 0.01);
    options->friction = 0.8;
    add_ground(options, 0, 1, 0, -0.51);
}

/* Small velocities to the side, so that it may buckle. */
static void disturb(const SquareMesh *mesh, double size, double *v)
{
    unsigned state = 1;
    for (int i = 0; i < mesh->nodes; i++) {
        state = state * 1664525u + 1013904223u; /* Numerical Recipes, 7.1 */
        v[2 * i] += size * ((double)(state >> 8) / 8388608 - 1);
    }
}

/* The ceiling begins as far above the square as the floor is below it, takes
 * 0.55 of its height, and goes back at twice the speed. */
Obstacle squeeze_ceiling(const Options *options)
{
    double down = 0.55 / 0.4, back = down + 0.7;
    double speed = 0.4 * options->side;
    return (Obstacle){
        .kind = OBSTACLE_WALL,
        .n = {0, -1},
        .o = {0, 0.51 * options->side + options->at[1]},
        .friction = options->friction,
        .motion = {2, {down, back}, {{0, -speed}, {0, 2 * speed}}},
        .node = -1};
}

Status create_squeeze(Simulation *simulation, const NewtonSettings *settings)
{
    const Options *options = &simulation->options;
    System *system = &simulation->system;
    const Obstacle ceiling = squeeze_ceiling(options);
    Status status = body_create(options, 0, &simulation->mesh, system);
    if (!status)
        status =
            body_add_terms(options, &simulation->mesh, 1, &ceiling, system);
    if (!status)
        status = body_start(options, &simulation->mesh, system, settings, NULL,
                            &simulation->run[0]);
    simulation->runs = 1;
    if (!status)
        disturb(&simulation->mesh, 1e-3, simulation->run[0].v);
    return status;
}

/* ---- dent -------------------------------------------------------------- */

void dent_defaults(Options *options)
{
    fall(options, 16, 2e5, 0.004);
    options->at[1] = 0.62;
    options->velocity[0] = 0.02;
    options->velocity[1] = -2;
    options->friction = 0.3;
    options->yield = 0.04;
    options->hardening = 0.1;
    add_ball(options, 0, -0.75, 0.35);
    add_ground(options, 0, 1, 0, -1.15);
}

/* ---- tear -------------------------------------------------------------- */

/* Cuts the springs across the line x between two heights, all in the rest
 * positions. */
static void cut(const SquareMesh *mesh, double x, double low, double high,
                System *system)
{
    for (int s = 0; s < mesh->springs; s++) {
        const double *a = mesh->x + 2 * mesh->e[2 * s];
        const double *b = mesh->x + 2 * mesh->e[2 * s + 1];
        double middle = 0.5 * (a[1] + b[1]);
        if ((a[0] < x) != (b[0] < x) && middle > low && middle < high)
            system->k[s] = 0;
    }
}

void tear_defaults(Options *options)
{
    fall(options, 24, 1e5, 0.002);
    options->gravity = 0;
    options->pin = "left,right";
    options->moving_pins = true;
    options->tear = 0.12;
    options->cell_stiffness = 0.3;
}

/* The pins of the left half go left, the others right, at 0.2 sides a
 * second. */
Status create_tear(Simulation *simulation, const NewtonSettings *settings)
{
    const Options *options = &simulation->options;
    SquareMesh *mesh = &simulation->mesh;
    System *system = &simulation->system;
    Status status = body_create(options, 0, mesh, system);
    if (!status)
        status = body_add_terms(options, mesh, 0, NULL, system);
    if (status)
        return status;
    system->pin_v = calloc(2 * (size_t)system->nodes, sizeof *system->pin_v);
    if (!system->pin_v)
        return STATUS_OUT_OF_MEMORY;
    for (int i = 0; i < mesh->nodes; i++) /* a pin set later stays */
        if (system->pinned && system->pinned[i])
            system->pin_v[2 * i] =
                copysign(0.2 * options->side, mesh->x[2 * i]);
    if (system->breaks)
        cut(mesh, 0.5 * mesh->spacing, -0.12 * options->side,
            0.12 * options->side, system);
    simulation->runs = 1;
    return body_start(options, mesh, system, settings, NULL,
                      &simulation->run[0]);
}

/* ---- bend -------------------------------------------------------------- */

void bend_defaults(Options *options)
{
    fall(options, 32, 2e5, 0.002);
    options->side = 2;
    options->aspect = 0.1875;
    options->tear = 0.1;
    options->cell_stiffness = 0.3;
    options->friction = 0.3;
    options->barrier[0] = 0.008;
    options->barrier[1] = 8e5;
    add_ball(options, -0.8, -0.3325, 0.14);
    add_ball(options, 0.8, -0.3325, 0.14);
    add_ground(options, 0, 1, 0, -1);
}

/* It begins 0.05 m above the beam. */
Obstacle bend_ball(const Options *options)
{
    const SquareMesh shape = body_shape(options);
    double half = 0.5 * shape.rows * options->side / options->segments;
    return (Obstacle){.kind = OBSTACLE_BALL,
                      .o = {0, half + 0.18 + 0.05},
                      .radius = 0.18,
                      .friction = options->friction,
                      .node = -1};
}

Status create_bend(Simulation *simulation, const NewtonSettings *settings)
{
    const Options *options = &simulation->options;
    SquareMesh *mesh = &simulation->mesh;
    System *system = &simulation->system;
    Status status = body_create(options, 1, mesh, system);
    if (status)
        return status;
    double a = mesh->spacing, half = 0.5 * mesh->rows * a;
    Obstacle ball = bend_ball(options);
    const double start[4] = {ball.o[0], ball.o[1], 0, -3};
    ball.node = mesh->nodes;
    system->m[mesh->nodes] = 60;
    status = body_add_terms(options, mesh, 1, &ball, system);
    if (status)
        return status;
    if (system->breaks)
        cut(mesh, 0.5 * a, -2 * half, -half + 0.6 * a, system);
    simulation->runs = 1;
    return body_start(options, mesh, system, settings, start,
                      &simulation->run[0]);
}
