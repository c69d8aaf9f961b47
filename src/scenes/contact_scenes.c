/* contact_scenes.c - the scenes slope, squeeze, tear and bend. */
#include "scenes/contact_scenes.h"

#include <math.h>

/* ---- slope ------------------------------------------------------------- */

/* Each run has a lower block than the run before, and its own friction. */
Status create_slope(Simulation *simulation)
{
    static const double factor[SIMULATION_MAX_RUNS] = {0.5, 0.9, 1.1};
    Status status = STATUS_OK;
    simulation->runs = SIMULATION_MAX_RUNS;
    for (int run = 0; run < SIMULATION_MAX_RUNS && !status; run++) {
        simulation->variant[run].friction_factor = factor[run];
        simulation->variant[run].lift =
            1.3 * simulation->options.side / 0.5 * (1 - run);
        status = body_create(simulation, run);
    }
    return status;
}

/* ---- squeeze ----------------------------------------------------------- */

/* The ceiling starts as far above the square as the floor is below, presses the
 * square by 0.55 of the height, and goes back at twice the speed. */
Obstacle make_squeeze_ceiling(const Options *options)
{
    double down = 0.55 / 0.4, back = down + 0.7;
    double speed = 0.4 * options->side;
    return (Obstacle){
        .kind = OBSTACLE_WALL,
        .n = {0, -1},
        .o = {0, 0.51 * options->side + options->at[1]},
        .friction = options->friction,
        .node = -1,
        .motion = {2, {down, back}, {{0, -speed}, {0, 2 * speed}}}};
}

/* Small random velocities to the side let the square buckle. */
Status create_squeeze(Simulation *simulation)
{
    Status status = create_square(simulation);
    unsigned state = 1;
    for (int i = 0; i < simulation->mesh.nodes && !status; i++) {
        state = state * 1664525u + 1013904223u; /* Numerical Recipes, 7.1 */
        simulation->run[0].v[2 * i] +=
            1e-3 * ((double)(state >> 8) / 8388608 - 1);
    }
    return status;
}

/* ---- tear -------------------------------------------------------------- */

/* Cuts the springs across a vertical line at x between two heights, in the rest
 * positions, if springs can break. */
static void cut_springs(Simulation *simulation, double x, double low,
                        double high)
{
    System *system = &simulation->system;
    for (int s = 0; s < system->springs && simulation->options.tear > 0; s++) {
        double a[2], b[2];
        square_mesh_rest_position(&simulation->mesh, system->e[2 * s], a);
        square_mesh_rest_position(&simulation->mesh, system->e[2 * s + 1], b);
        double middle = 0.5 * (a[1] + b[1]);
        if ((a[0] < x) != (b[0] < x) && middle > low && middle < high)
            system->k[s] = 0;
    }
    system_mark_changed(system, false);
}

/* Pins of the left half move left, others right, by 0.2 sides a second. */
Status create_tear(Simulation *simulation)
{
    const SquareMesh *mesh = &simulation->mesh;
    System *system = &simulation->system;
    Status status = create_square(simulation);
    double rest[2];
    for (int i = 0; i < mesh->nodes && !status; i++) {
        square_mesh_rest_position(mesh, i, rest);
        if (system->pinned[i]) /* pins that a user sets later stand still */
            system->pin_v[2 * i] = copysign(0.2 * mesh->side, rest[0]);
    }
    if (!status)
        cut_springs(simulation, 0.5 * mesh->spacing, -0.12 * mesh->side,
                    0.12 * mesh->side);
    return status;
}

/* ---- bend -------------------------------------------------------------- */

/* The ball starts 0.05 m above the beam. */
Obstacle make_bend_ball(const Options *options)
{
    const SquareMesh shape = body_make_mesh(options);
    double half = 0.5 * shape.rows * shape.spacing;
    return (Obstacle){.kind = OBSTACLE_BALL,
                      .o = {0, half + 0.18 + 0.05},
                      .radius = 0.18,
                      .friction = options->friction,
                      .node = shape.nodes};
}

Status create_bend(Simulation *simulation)
{
    const SquareMesh *mesh = &simulation->mesh;
    Status status = create_square(simulation);
    if (status)
        return status;
    double a = mesh->spacing, half = 0.5 * mesh->rows * a;
    simulation->system.m[mesh->nodes] = 60;
    if (!simulation->options.state) /* --state has velocities */
        simulation->run[0].v[2 * mesh->nodes + 1] = -3;
    cut_springs(simulation, 0.5 * a, -2 * half, -half + 0.6 * a);
    return STATUS_OK;
}
