#include "scenes/body.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/cells.h"
#include "model/contact.h"
#include "model/damping.h"
#include "model/fracture.h"
#include "model/friction.h"
#include "model/plasticity.h"
#include "scenes/pins.h"
#include "scenes/scene.h"

/* Part by which the strengths of springs differ. */
#define TEAR_SCATTER 0.1

SquareMesh body_shape(const Options *options)
{
    double rows = round(options->segments * options->aspect);
    if (!(options->aspect > 0))
        rows = options->segments;
    return square_mesh_shape(options->segments, rows < 1 ? 1 : (int)rows,
                             options->side);
}

/* The order of elimination, with the nodes that are not in the mesh last. */
static Status take_order(SquareMesh *mesh, System *system)
{
    system->order = mesh->order; /* the system owns it now */
    mesh->order = NULL;
    if (system->nodes == mesh->nodes)
        return STATUS_OK;
    int *longer =
        realloc(system->order, (size_t)system->nodes * sizeof *system->order);
    if (!longer)
        return STATUS_OUT_OF_MEMORY;
    system->order = longer;
    for (int i = mesh->nodes; i < system->nodes; i++)
        longer[i] = i;
    return STATUS_OK;
}

Status body_create(const Options *options, int more, SquareMesh *mesh,
                   System *system)
{
    const SquareMesh shape = body_shape(options);
    Status status =
        square_mesh_create(shape.segments, shape.rows, shape.side, mesh);
    if (!status)
        status = system_create(mesh->nodes + more, mesh->springs, system);
    if (status)
        return status;
    double m = options->density * mesh->side * mesh->side / mesh->nodes;
    if (mesh->rows != mesh->segments)
        m *= (double)mesh->rows / mesh->segments;
    for (int i = 0; i < system->nodes; i++)
        system->m[i] = m;
    memcpy(system->e, mesh->e, 2 * (size_t)mesh->springs * sizeof(int));
    for (int s = 0; s < mesh->springs; s++) {
        const double *xi = mesh->x + 2 * mesh->e[2 * s];
        const double *xj = mesh->x + 2 * mesh->e[2 * s + 1];
        double dx = xi[0] - xj[0], dy = xi[1] - xj[1];
        system->l2[s] = dx * dx + dy * dy;
        system->k[s] = options->stiffness;
    }
    if (mesh->rows == mesh->segments && more == 0)
        system->segments = mesh->segments;
    system->gravity[1] = -options->gravity;
    status = take_order(mesh, system);
    if (status || !options->pin)
        return status;
    status = system_create_pins(system);
    return status ? status : pins_read(options->pin, mesh, system->pinned);
}

/* Stretched, turned, moved; 0 degrees leave every bit. */
static void place_node(const Options *options, const double rest[2],
                       double x[2])
{
    double angle = options->turn * DEGREE;
    double c = cos(angle), s = sin(angle);
    double x0 = options->stretch * rest[0], x1 = rest[1];
    x[0] = c * x0 - s * x1 + options->at[0];
    x[1] = s * x0 + c * x1 + options->at[1];
}

Status body_start(const Options *options, const SquareMesh *mesh,
                  System *system, const NewtonSettings *settings,
                  const double *more, TimeIntegrator *run)
{
    size_t size = 2 * (size_t)system->nodes;
    double *x = malloc(size * sizeof *x), *v = calloc(size, sizeof *v);
    Status status = x && v ? STATUS_OK : STATUS_OUT_OF_MEMORY;
    for (int i = 0; !status && i < mesh->nodes; i++) {
        place_node(options, mesh->x + 2 * i, x + 2 * i);
        for (int axis = 0; axis < 2; axis++)
            if (!system->pinned || !system->pinned[i])
                v[2 * i + axis] = options->velocity[axis];
    }
    for (int i = mesh->nodes; !status && i < system->nodes; i++, more += 4) {
        memcpy(x + 2 * i, more, 2 * sizeof *x);
        memcpy(v + 2 * i, more + 2, 2 * sizeof *v);
    }
    if (!status)
        status = time_integrator_create(options_integrator(options)
                                            ? options_integrator(options)
                                            : &integrator_methods[0],
                                        system, settings, x, v, run);
    free(x);
    free(v);
    return status;
}

/* The obstacles of the options, normals made units; returns how many. */
static int list_obstacles(const Options *options,
                          Obstacle list[CONTACT_MAX_OBSTACLES])
{
    int count = 0;
    for (int i = 0; i < options->grounds; i++) {
        const double *ground = options->ground[i];
        double length = hypot(ground[0], ground[1]);
        list[count++] =
            (Obstacle){.kind = OBSTACLE_WALL,
                       .n = {ground[0] / length, ground[1] / length},
                       .o = {ground[2], ground[3]},
                       .friction = options->friction,
                       .node = -1};
    }
    for (int i = 0; i < options->balls; i++) {
        const double *ball = options->ball[i];
        list[count++] = (Obstacle){.kind = OBSTACLE_BALL,
                                   .o = {ball[0], ball[1]},
                                   .radius = ball[2],
                                   .friction = options->friction,
                                   .node = -1};
    }
    return count;
}

/* kappa = 4 k and d_hat = side/100 unless they were chosen; a node stands for
 * one segment of the boundary. */
static Barrier barrier_of(const Options *options)
{
    double d_hat = options->barrier[0], kappa = options->barrier[1];
    if (!(d_hat > 0))
        d_hat = 0.01 * options->side;
    if (!(kappa > 0))
        kappa = 4 * options->stiffness;
    double area = options->side / options->segments;
    return (Barrier){d_hat, 0.5 * area * d_hat * kappa};
}

static Status add_obstacles(const Options *options, int more,
                            const Obstacle *obstacle, System *system)
{
    Obstacle list[CONTACT_MAX_OBSTACLES];
    Barrier barrier = barrier_of(options);
    int count = list_obstacles(options, list);
    if (count + more > CONTACT_MAX_OBSTACLES)
        return STATUS_TOO_LARGE;
    for (int i = 0; i < more; i++)
        list[count++] = obstacle[i];
    if (count == 0)
        return STATUS_OK;
    Status status = contact_add(system, &barrier, count, list);
    bool rough = false;
    for (int i = 0; i < count; i++)
        rough = rough || list[i].friction > 0;
    return status || !rough ? status
                            : friction_add(system, options->slip_speed);
}

Status body_add_terms(const Options *options, const SquareMesh *mesh, int more,
                      const Obstacle *obstacle, System *system)
{
    Status status = add_obstacles(options, more, obstacle, system);
    if (!status && options->yield > 0)
        status = plasticity_set(system, options->yield, options->hardening);
    if (!status && options->cells)
        status = cells_add(system, mesh,
                           options->cell_stiffness * options->stiffness);
    if (!status && options->damping > 0)
        status = damping_add(system, options->damping);
    if (!status && options->tear > 0)
        status = fracture_add(system, options->tear, TEAR_SCATTER);
    return status;
}

const char *body_needs_end_of_step(const Options *options)
{
    if (options->grounds > 0 || options->balls > 0)
        return "contact";
    if (options->cells)
        return "cells that cannot turn over";
    if (options->yield > 0)
        return "plastic springs";
    if (options->damping > 0)
        return "damping";
    return options->moving_pins ? "moving pins" : NULL;
}

/* "--ground 2", for messages */
static void name_obstacle(const Options *options, int i, char *text,
                          size_t size)
{
    bool ball = i >= options->grounds;
    int number = ball ? i - (int)options->grounds : i;
    const double *value =
        ball ? options->ball[number] : options->ground[number];
    if (ball)
        snprintf(text, size, "--ball %g,%g,%g", value[0], value[1], value[2]);
    else
        snprintf(text, size, "--ground %g,%g,%g,%g", value[0], value[1],
                 value[2], value[3]);
}

/* A normal has a length, a ball a radius. */
static bool obstacle_is_sound(const Options *options, int i)
{
    if (i >= options->grounds)
        return options->ball[i - (int)options->grounds][2] > 0;
    const double *ground = options->ground[i];
    return hypot(ground[0], ground[1]) > 0;
}

/* The node that begins nearest to an obstacle, of those that are not pinned,
 * and its gap; infinite where all are. */
static double nearest_node(const Options *options, const unsigned char *pinned,
                           const Obstacle *obstacle, int *node)
{
    const SquareMesh shape = body_shape(options);
    double nearest = INFINITY;
    for (int i = 0; i < shape.nodes; i++) {
        double rest[2], x[2];
        square_mesh_place(&shape, i, rest);
        place_node(options, rest, x);
        double d = contact_gap(obstacle, obstacle->o, x, 0).d;
        if (d < nearest && !(pinned && pinned[i])) {
            nearest = d;
            *node = i;
        }
    }
    return nearest;
}

/* Whether one obstacle leaves room for the body; a message if not. */
static bool check_obstacle(const Options *options, const unsigned char *pinned,
                           const Obstacle *obstacle, const char *name,
                           char *message, size_t size)
{
    int node = 0;
    bool moves = options->moving_pins || obstacle->motion.phases > 0;
    double d = nearest_node(options, moves ? NULL : pinned, obstacle, &node);
    if (d > 0)
        return true;
    snprintf(message, size,
             "%s: node %d would begin at a distance of %g m; it must be above "
             "0",
             name, node, d);
    return false;
}

/* The scene's own obstacle: the body must not touch it, nor a ball that is free
 * what the options put in its way. */
static bool check_own(const Options *options, const unsigned char *pinned,
                      const Obstacle list[], int count, char *message,
                      size_t size)
{
    const Scene *scene = options->scene;
    if (!scene || !scene->own)
        return true;
    const Obstacle own = scene->own(options);
    for (int i = 0; i < count && own.kind == OBSTACLE_BALL; i++) {
        double d = contact_gap(&list[i], list[i].o, own.o, own.radius).d;
        char name[128];
        if (d > 0)
            continue;
        name_obstacle(options, i, name, sizeof name);
        snprintf(message, size,
                 "%s: %s would begin at a distance of %g m; it must be above "
                 "0",
                 name, scene->own_name, d);
        return false;
    }
    return check_obstacle(options, pinned, &own, scene->own_name, message,
                          size);
}

/* The first obstacle that the body touches. */
static Status check_obstacles(const Options *options,
                              const unsigned char *pinned, char *message,
                              size_t size)
{
    Obstacle list[CONTACT_MAX_OBSTACLES];
    char name[128];
    int count = list_obstacles(options, list);
    for (int i = 0; i < count; i++) {
        name_obstacle(options, i, name, sizeof name);
        if (!obstacle_is_sound(options, i)) {
            snprintf(message, size, "%s: %s", name,
                     i < options->grounds
                         ? "the normal is 0,0; it must point somewhere"
                         : "the radius must be above 0");
            return STATUS_INVALID_INPUT;
        }
        if (!check_obstacle(options, pinned, &list[i], name, message, size))
            return STATUS_INVALID_INPUT;
    }
    return check_own(options, pinned, list, count, message, size)
               ? STATUS_OK
               : STATUS_INVALID_INPUT;
}

Status body_check(const Options *options, char *message, size_t size)
{
    if (options->cells && !(options->stretch > 0)) {
        snprintf(message, size,
                 "--stretch: %g turns cell 0 over (%g of its area), and all "
                 "others; above 0, or --cells off",
                 options->stretch, options->stretch);
        return STATUS_INVALID_INPUT;
    }
    const SquareMesh shape = body_shape(options);
    bool own = options->scene && options->scene->own;
    unsigned char *pinned = NULL;
    Status status = STATUS_OK;
    if (options->grounds == 0 && options->balls == 0 && !own)
        return STATUS_OK;
    if (options->pin) {
        pinned = calloc((size_t)shape.nodes, 1);
        status = pinned ? pins_read(options->pin, &shape, pinned)
                        : STATUS_OUT_OF_MEMORY;
    }
    if (!status)
        status = check_obstacles(options, pinned, message, size);
    free(pinned);
    return status;
}
