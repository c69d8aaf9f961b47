/* body.c - creates and checks bodies, obstacles and terms of the options. */
#include "simulation/body.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/cells.h"
#include "model/contact.h"
#include "model/elements.h"
#include "model/friction.h"
#include "model/self_contact.h"
#include "base/mathematics.h"

/* ---- pins --------------------------------------------------------------- */

/* A word of --pin, and where its nodes are. */
static const struct PinWord {
    const char *word;
    int needed_sides;  /* bits: a node must be on each of these sides */
    int allowed_sides; /* bits: a node must be on one of these, if any */
} pin_words[] = {{"top-corners", MESH_TOP, MESH_LEFT | MESH_RIGHT},
                 {"top", MESH_TOP, 0},
                 {"bottom", MESH_BOTTOM, 0},
                 {"left", MESH_LEFT, 0},
                 {"right", MESH_RIGHT, 0},
                 {"all", 0, 0},
                 {NULL, 0, 0}};

NameTable pins_get_words(void)
{
    return NAMES_OF(pin_words);
}

const char *pins_parse(const char *text, const SquareMesh *shape,
                       unsigned char *pinned)
{
    for (;; text++) {
        char name[16] = "", digits[10] = ""; /* "top" and "2" of "top:2" */
        int end = 0;
        const struct PinWord *word = pin_words;
        if (!sscanf(text, "%15[a-z-]%n:%9[0-9]%n", name, &end, digits, &end))
            sscanf(text, "%9[0-9]%n", digits, &end);
        while (word->word && strcmp(word->word, name) != 0)
            word++;
        int number = atoi(digits); /* number of a body, from 1, or of a node */
        int most = name[0] ? shape->bodies : shape->nodes - 1;
        bool is_pin =
            name[0] ? word->word && (!digits[0] || number > 0) : digits[0];
        if (!is_pin || number > most || (text[end] && text[end] != ','))
            return text;
        for (int i = 0; pinned && i < shape->nodes; i++) {
            int sides = square_mesh_get_node_sides(shape, i);
            bool in_body =
                !digits[0] || square_mesh_find_body(shape, i) + 1 == number;
            bool on_side =
                (sides & word->needed_sides) == word->needed_sides &&
                (!word->allowed_sides || (sides & word->allowed_sides));
            pinned[i] |= name[0] ? in_body && on_side : i == number;
        }
        text += end;
        if (*text == '\0')
            return NULL;
    }
}

/* ---- the body ------------------------------------------------------------ */

SquareMesh body_make_mesh(const Options *options)
{
    double aspect = options->scene->body.aspect;
    double rows =
        aspect > 0 ? round(options->segments * aspect) : options->segments;
    return square_mesh_create((int)options->segments, (int)fmax(rows, 1),
                              options->side, (int)fmax(options->bodies, 1));
}

/* Returns the node at the centre of the scene's ball, or -1 without a ball. */
static int find_ball_node(const Options *options)
{
    return options->scene->body.make_obstacle
               ? options->scene->body.make_obstacle(options).ball_node
               : -1;
}

/* Creates masses, springs, gravity and pins (slide simulator.py).  The nodes of
 * a body share its mass equally, and the scene's ball has the mass of a node.
 * l2 is the squared length of each spring at rest. */
static Status create_body_system(const Options *options, System *system)
{
    const SquareMesh shape = body_make_mesh(options);
    int nodes = shape.nodes / shape.bodies, ball = find_ball_node(options);
    if ((double)shape.columns * shape.rows * shape.bodies >
        SQUARE_MESH_MAX_CELLS)
        return STATUS_TOO_LARGE;
    Status status =
        system_create(shape.nodes + (ball >= 0), shape.springs, system);
    if (status)
        return status;
    double pin_speed = options->scene->body.pin_speed * shape.side;
    size_t numbers = pin_speed > 0 ? 2 * (size_t)system->nodes : 0;
    if (numbers && !(system->pin_v = calloc(numbers, sizeof(double))))
        return STATUS_OUT_OF_MEMORY;
    double m = options->density * shape.side * shape.side / nodes;
    m *= (double)shape.rows / shape.columns;
    for (int i = 0; i < system->nodes; i++)
        system->m[i] = m;
    square_mesh_list_springs(&shape, system->e);
    for (int s = 0; s < shape.springs; s++) {
        double xi[2], xj[2];
        square_mesh_rest_position(&shape, system->e[2 * s], xi);
        square_mesh_rest_position(&shape, system->e[2 * s + 1], xj);
        double dx = xi[0] - xj[0], dy = xi[1] - xj[1];
        system->l2[s] = dx * dx + dy * dy;
        system->k[s] = options->stiffness;
    }
    if (shape.rows == shape.columns && ball < 0 && shape.bodies == 1)
        system->segments = shape.columns;
    system->gravity[1] = -options->gravity;
    square_mesh_order_nodes(&shape, system->elimination_index);
    if (options->pin && pins_parse(options->pin, &shape, system->is_pinned))
        return STATUS_INVALID_INPUT;
    for (int i = 0; i < shape.nodes && numbers; i++) {
        double rest[2];
        square_mesh_rest_position(&shape, i, rest);
        if (system->is_pinned[i]) /* nodes that are pinned later do not move */
            system->pin_v[2 * i] = copysign(pin_speed, rest[0]);
    }
    return STATUS_OK;
}

_Static_assert(OPTIONS_MAX_GROUNDS + OPTIONS_MAX_BALLS + 2 <=
                   CONTACT_MAX_OBSTACLES,
               "the ceiling and the scene's obstacle fit in");

/* Lists the obstacles of the options, with unit normals, and then the obstacle
 * of the scene.  Returns how many there are. */
static int list_obstacles(const Options *options,
                          Obstacle list[CONTACT_MAX_OBSTACLES])
{
    int count = 0;
    for (int i = 0; i < options->grounds; i++) {
        const double *ground = options->ground[i];
        double length = math_hypot(ground[0], ground[1]);
        list[count++] =
            (Obstacle){.kind = OBSTACLE_WALL,
                       .n = {ground[0] / length, ground[1] / length},
                       .o = {ground[2], ground[3]},
                       .mu = options->friction,
                       .ball_node = -1};
    }
    for (int i = 0; i < options->balls; i++) {
        const double *ball = options->ball[i];
        list[count++] = (Obstacle){.kind = OBSTACLE_BALL,
                                   .o = {ball[0], ball[1]},
                                   .radius = ball[2],
                                   .mu = options->friction,
                                   .ball_node = -1};
    }
    if (options->ceiling[1] != 0) {
        const double *ceiling = options->ceiling;
        /* The ceiling stops at time `end` (s), even if a body delayed it. */
        double end = (ceiling[2] - ceiling[0]) / ceiling[1];
        list[count++] = (Obstacle){.kind = OBSTACLE_WALL,
                                   .n = {0, -1},
                                   .o = {0, ceiling[0]},
                                   .ball_node = -1,
                                   .motion = {1, {end}, {{0, ceiling[1]}}}};
    }
    if (options->scene->body.make_obstacle)
        list[count++] = options->scene->body.make_obstacle(options);
    for (int k = 0; k < count; k++)
        memcpy(list[k].configured_o, list[k].o, sizeof list->o);
    return count;
}

/* Returns the barrier of the options; by default kappa = 4 k and d_hat =
 * side/100.  Each node stands for a boundary of length side/segments. */
static Barrier make_barrier(const Options *options)
{
    double d_hat = options->barrier[0], kappa = options->barrier[1];
    if (!(d_hat > 0))
        d_hat = 0.01 * options->side;
    if (!(kappa > 0))
        kappa = 4 * options->stiffness;
    double area = options->side / options->segments;
    return (Barrier){d_hat, 0.5 * area * d_hat * kappa};
}

/* Sets contact and friction.  An obstacle that the system has stays where it
 * has moved, unless the options give it a new place. */
static Status set_obstacles(const Options *options, System *system)
{
    const Barrier barrier = make_barrier(options);
    const Contact *contact = get_contact(system);
    Obstacle list[CONTACT_MAX_OBSTACLES];
    int count = list_obstacles(options, list);
    for (int i = 0; contact && i < contact->obstacle_count; i++) {
        const Obstacle *old = &contact->obstacle[i];
        for (int k = 0; k < count; k++)
            if (memcmp(old->configured_o, list[k].configured_o,
                       sizeof old->configured_o) == 0 &&
                memcmp(old->n, list[k].n, sizeof old->n) == 0)
                memcpy(list[k].o, old->o, sizeof old->o);
    }
    Status status = contact_configure(system, &barrier, count, list);
    return status ? status
                  : friction_configure(system, &friction_energy,
                                       count > 0 && options->friction > 0,
                                       options->slip_speed);
}

/* Sets contact between bodies and its friction.  A barrier wider than a quarter
 * of an edge would repel neighbouring edges at rest. */
static Status set_self_contact(const Options *options, const SquareMesh *mesh,
                               System *system)
{
    Barrier barrier = make_barrier(options);
    double mu =
        options->self_friction < 0 ? options->friction : options->self_friction;
    double width = fmin(barrier.d_hat, 0.25 * mesh->spacing);
    barrier.c *= width / barrier.d_hat;
    barrier.d_hat = width;
    Status status = self_contact_configure(system, mesh, &barrier, mu);
    return status ? status
                  : friction_configure(system, &self_friction_energy, mu > 0,
                                       options->slip_speed);
}

/* Adds, changes and removes terms as the options say.  Obstacles, self-contact
 * and cells depend on several options; other terms have a row each (with the
 * fields that follow). */
static Status set_energy_terms(const Options *options, System *system)
{
    const SquareMesh shape = body_make_mesh(options);
    double part = options->scene->body.cell_stiffness;
    double k_c = (part > 0 ? part : 0.5) * options->stiffness;
    Status status = set_obstacles(options, system);
    if (!status && options->has_self_contact)
        status = set_self_contact(options, &shape, system);
    if (!status && options->has_cell_energy)
        status = cells_configure(system, &shape, k_c);
    for (const OptionRow *row = option_rows; row->name && !status; row++) {
        const double *number = options->number + row->slot;
        if (row->term && row->term->configure && !option_is_on(row, options))
            system_remove_term(system, row->term);
        else if (row->term && row->term->configure)
            status = row->term->configure(system, &shape, number);
    }
    return status;
}

/* Computes the start of a run: a step of a table, or the rest shape stretched,
 * turned and moved.  The scene's ball starts at its place in the scene.
 *   x, v  [2 nodes] out, m, m/s */
static Status set_start_state(const Options *options, int run, double *x,
                              double *v, Message message)
{
    const SquareMesh shape = body_make_mesh(options);
    const double *at = options->at, *speed = options->velocity;
    const double single[BODY_OPTION_NUMBERS] = {
        at[0], at[1], options->turn, speed[0], speed[1], options->stretch, 1};
    int ball = find_ball_node(options);
    if (options->state)
        return start_table_read(options, run, shape.nodes + (ball >= 0), x, v,
                                message);
    for (int i = 0; i < shape.nodes; i++) {
        double rest[2];
        int body = square_mesh_find_body(&shape, i);
        const double *start =
            options->bodies > 0 ? options->body[body] : single;
        double angle = start[2] * DEGREE, c = cos(angle), s = sin(angle);
        square_mesh_rest_position(&shape, i, rest);
        rest[0] *= start[5];
        rest[1] *= start[6];
        x[2 * i] = c * rest[0] - s * rest[1] + start[0];
        x[2 * i + 1] = s * rest[0] + c * rest[1] + start[1];
        memcpy(v + 2 * i, start + 3, sizeof rest);
    }
    if (ball >= 0) {
        memcpy(x + 2 * ball, options->scene->body.make_obstacle(options).o,
               2 * sizeof *x);
        v[2 * ball] = v[2 * ball + 1] = 0;
    }
    return STATUS_OK;
}

double body_find_added_height(const Options *options, int run)
{
    return options->scene->body.run_distance * options->side * (1 - run);
}

/* Returns the options of one run: with its own friction and height. */
static Options make_run_options(const Options *options, int run)
{
    const double factor = options->scene->body.friction_factor[run];
    Options own = *options;
    own.friction *= factor > 0 ? factor : 1;
    own.at[1] += body_find_added_height(options, run);
    for (int i = 0; i < own.grounds; i++)
        own.ground[i][3] += body_find_added_height(options, run);
    return own;
}

/* Creates the system of the options with all its terms, and its start.
 *   system  out; free it in any case
 *   x       out, [2 nodes] m, followed by v [2 nodes] m/s; NULL: no memory */
static Status build_run_system(const Options *options, int run, System *system,
                               double **x, Message message)
{
    Status status = create_body_system(options, system);
    size_t size = 2 * (size_t)system->nodes;
    if (!status)
        status = set_energy_terms(options, system);
    *x = status ? NULL : malloc(2 * size * sizeof **x);
    if (status || !*x)
        return status ? status : STATUS_OUT_OF_MEMORY;
    status = set_start_state(options, run, *x, *x + size, message);
    return status || !options->state_springs
               ? status
               : start_table_read_springs(options, run, system, message);
}

/* Cuts the scene's notch beside the middle line, if springs can break. */
static void cut_notch(const Options *options, const SquareMesh *mesh,
                      System *system)
{
    const double *notch = options->scene->body.notch_ends,
                 x = 0.5 * mesh->spacing;
    for (int s = 0; s < system->springs && options->tear > 0; s++) {
        double a[2], b[2];
        square_mesh_rest_position(mesh, system->e[2 * s], a);
        square_mesh_rest_position(mesh, system->e[2 * s + 1], b);
        double height = 0.5 * (a[1] + b[1]) / (mesh->rows * mesh->spacing);
        if ((a[0] < x) != (b[0] < x) && height > notch[0] && height < notch[1])
            system->k[s] = 0;
    }
    system_mark_changed(system, false);
}

/* Creates one run.  Pinned nodes start with velocity 0. */
static Status create_body_run(Simulation *simulation, int run)
{
    const Options options = make_run_options(&simulation->options, run);
    System *system = run ? &simulation->run_system[run] : &simulation->system;
    double *x;
    Status status = build_run_system(&options, run, system, &x, (Message){0});
    simulation->mesh = body_make_mesh(&options);
    if (!status) {
        double *v = x + 2 * (size_t)system->nodes;
        cut_notch(&options, &simulation->mesh, system);
        for (int i = 0; i < 2 * system->nodes; i++)
            v[i] = system->is_pinned[i / 2] ? 0 : v[i];
        status = simulation_start_run(
            simulation, run, options_get_method(&options), system, x, v);
    }
    free(x);
    return status;
}

Status body_apply_options(Simulation *simulation, int run)
{
    System *system = simulation->run[run].system;
    Options options = make_run_options(&simulation->options, run);
    system->gravity[1] = -options.gravity;
    for (int s = 0; s < system->springs; s++)
        if (!spring_is_broken(system, s))
            system->k[s] = options.stiffness;
    system_mark_changed(system, false);
    return set_energy_terms(&options, system);
}

Status create_square_scene(Simulation *simulation)
{
    Status status = STATUS_OK;
    simulation->runs = (int)fmax(simulation->scene->body.runs, 1);
    for (int run = 0; run < simulation->runs && !status; run++)
        status = create_body_run(simulation, run);
    return status;
}

Status body_check_method(const Options *options, Message message)
{
    const IntegratorMethod *method = options_get_method(options);
    const char *term =
        options->scene->body.pin_speed > 0 ? "moving pins" : NULL;
    for (const OptionRow *row = option_rows; row->name; row++)
        if (!term && row->term && !row->term->supports_all_integrators &&
            option_is_on(row, options))
            term = row->term->name;
    return !term || method->supports_all_terms
               ? STATUS_OK
               : refuse(message,
                        "--integrator: '%s' has no %s; only backward-euler has",
                        method->name, term);
}

/* Writes the name of an obstacle: "the ball", or "ball 2" of several. */
static void write_obstacle_name(const Options *options, int number, char *name,
                                size_t size)
{
    int ball = number - (int)options->grounds,
        other = ball - (int)options->balls;
    const char *kind =
        ball < 0    ? "ground"
        : other < 0 ? "ball"
        : other < (options->ceiling[1] != 0) || find_ball_node(options) < 0
            ? "ceiling"
            : "falling ball";
    if (ball < 0 ? options->grounds > 1
                 : ball < options->balls && options->balls > 1)
        snprintf(name, size, "%s %d", kind, (ball < 0 ? number : ball) + 1);
    else
        snprintf(name, size, "the %s", kind);
}

/* Refuses an obstacle whose gap to a body (m) is not above 0.  A gap of NaN
 * means that a ball is inside the body. */
static Status refuse_obstacle_position(const Options *options, int number,
                                       double gap, Message message)
{
    bool square = options->bodies <= 1 && options->scene->body.aspect == 0;
    const char *body = square ? "the square" : "a body";
    char name[32];
    write_obstacle_name(options, number, name, sizeof name);
    if (gap < 0)
        return refuse(message,
                      "%s would overlap %s by %.3g m; move one of them", name,
                      body, -gap);
    return refuse(message, "%s would %s %s; move one of them", name,
                  gap == 0 ? "touch" : "be inside", body);
}

/* Checks that no node touches an obstacle, no cell is turned over, and no ball
 * is inside a cell.  Contact tests nodes, which may all be far from a small
 * ball.
 *   x        [2n] m
 *   min_gap  m, least gap to the obstacle `number`; the gap to other obstacles
 *            must be above 0 */
static Status check_gaps_and_cells(const Options *options, const System *system,
                                   const double *x, double min_gap, int number,
                                   Message message)
{
    const SquareMesh shape = body_make_mesh(options);
    EvalPoint at = make_eval_point(system, NULL, NULL, x);
    for (const TermKind *kind; (kind = eval_point_next_term(&at));) {
        if (!kind->element || !kind->element->max_alpha)
            continue;
        ElementIterator walk = elements_begin(&at, NULL, 0);
        const Element *element = &walk.element;
        while (elements_next(&walk)) {
            bool own =
                kind == &contact_energy && element->partner_index == number;
            if (element->s > (own ? min_gap : 0))
                continue;
            return kind == &contact_energy
                       ? refuse_obstacle_position(options,
                                                  element->partner_index,
                                                  element->s, message)
                       : refuse(message,
                                "the cell at node %d would be turned over at "
                                "the start: its area would be %.3g of that at "
                                "rest; %s",
                                element->node[0], element->s,
                                options->state
                                    ? "--state-springs FILE has its springs"
                                    : "choose another --stretch");
        }
    }
    for (int k = 0; k < options->balls; k++)
        if (square_mesh_find_cell(&shape, x, options->ball[k], 0,
                                  shape.cells) >= 0)
            return refuse_obstacle_position(options, (int)options->grounds + k,
                                            NAN, message);
    return STATUS_OK;
}

static Status check_obstacles(const Options *options, Message message)
{
    const double *ceiling = options->ceiling;
    for (int i = 0; i < options->grounds; i++)
        if (options->ground[i][0] == 0 && options->ground[i][1] == 0)
            return refuse(message,
                          "--ground: the normal NX,NY is 0,0; 0,1 points "
                          "upwards");
    if (ceiling[1] > 0 || (ceiling[1] == 0 && (ceiling[0] || ceiling[2])))
        return refuse(message,
                      "--ceiling: V is %g; the ceiling moves down, so V must "
                      "be below 0",
                      ceiling[1]);
    if (ceiling[2] > ceiling[0])
        return refuse(message,
                      "--ceiling: STOP is %g; the ceiling moves down, so STOP "
                      "must be at most Y",
                      ceiling[2]);
    for (int i = 0; i < options->balls; i++)
        if (!(options->ball[i][2] > 0))
            return refuse(message,
                          "--ball: the radius R is %g; it must be above 0",
                          options->ball[i][2]);
    return STATUS_OK;
}

/* Checks that obstacles of the options overlap no body at its present place.
 *   min_gap  least gap to the obstacle `number`, as a multiple of the barrier's
 *            width d_hat; the gap to other obstacles must be above 0 */
static Status check_clearance(const Simulation *simulation,
                              const Options *options, double min_gap,
                              int number, Message message)
{
    Status status = check_obstacles(options, message);
    for (int run = 0; run < simulation->runs && !status; run++) {
        const Options own = make_run_options(options, run);
        System system = *simulation->run[run].system;
        Contact contact = {.barrier = make_barrier(&own),
                           .free_ball_index = -1};
        int count = list_obstacles(&own, contact.obstacle);
        contact.obstacle_count = (int)(own.grounds + own.balls);
        if (count > 0 && contact.obstacle[count - 1].ball_node >= 0)
            contact.free_ball_index = count - 1;
        system.term_count = 1;
        system.term[0] = (EnergyTerm){&contact_energy, &contact};
        status = check_gaps_and_cells(&own, &system, simulation->run[run].x,
                                      min_gap * contact.barrier.d_hat, number,
                                      message);
    }
    return status;
}

Status simulation_check_clearance(const Simulation *simulation,
                                  const Options *options, Message message)
{
    return check_clearance(simulation, options, 0, -1, message);
}

double simulation_find_free_fraction(const Simulation *simulation,
                                     const Options *options, int number,
                                     const double to[2])
{
    enum { MAX_MOTION_HALVINGS = 20 };
    static const double MIN_GAP = 0.999;     /* least gap divided by d_hat */
    static const double MIN_PART = 1.0 / 64; /* least fraction tried first */
    Options moved = *options;
    double *at = options_get_obstacle_point(&moved, number), free = 0, from[2];
    memcpy(from, at, sizeof from);
    memcpy(at, to, sizeof from);
    if (!check_clearance(simulation, &moved, 0, -1, (Message){0}))
        return 1;
    double step = 0.5, length = math_hypot(to[0] - from[0], to[1] - from[1]);
    if (number >= options->grounds) /* a ball must not jump over a body */
        step = fmin(fmax(0.5 * at[2] / length, MIN_PART), step);
    for (int i = 0; i < MAX_MOTION_HALVINGS;) {
        for (int c = 0; c < 2; c++)
            at[c] = from[c] + (free + step) * (to[c] - from[c]);
        if (free + step < 1 && !check_clearance(simulation, &moved, MIN_GAP,
                                                number, (Message){0})) {
            free += step;
        } else {
            step /= 2;
            i++;
        }
    }
    return free;
}

/* Whether two edges, a pair of nodes each, have a common point. */
static bool edges_cross(const double *x, const int one[2], const int other[2])
{
    const double *a = x + 2 * one[0], *b = x + 2 * one[1];
    const double *c = x + 2 * other[0], *d = x + 2 * other[1];
    for (int k = 0; k < 2; k++) /* do the bounding boxes touch? */
        if (fmax(a[k], b[k]) < fmin(c[k], d[k]) ||
            fmax(c[k], d[k]) < fmin(a[k], b[k]))
            return false;
    return twice_signed_area(a, b, c) * twice_signed_area(a, b, d) <= 0 &&
           twice_signed_area(c, d, a) * twice_signed_area(c, d, b) <= 0;
}

/* Checks that no body is inside another one.  The outlines do not cross, so one
 * node of each body is enough. */
static Status check_nested_bodies(const Options *options,
                                  const SquareMesh *shape, const double *x,
                                  Message message)
{
    int cells = shape->cells / shape->bodies;
    int nodes = shape->nodes / shape->bodies;
    for (int inner = 0; inner < shape->bodies && options->has_self_contact;
         inner++)
        for (int outer = 0; outer < shape->bodies; outer++)
            if (inner != outer &&
                square_mesh_find_cell(shape, x, x + 2 * inner * nodes,
                                      outer * cells, (outer + 1) * cells) >= 0)
                return refuse(message,
                              "--body: body %d would be inside body %d; move "
                              "one of them, or --self-contact off",
                              inner + 1, outer + 1);
    return STATUS_OK;
}

/* Checks that the outlines of bodies do not cross each other or themselves. */
static Status check_crossing_outlines(const Options *options, const double *x,
                                      Message message)
{
    const SquareMesh shape = body_make_mesh(options);
    int edge[2], other[2];
    for (int k = 0; k < shape.outline_edge_count && options->has_self_contact;
         k++) {
        square_mesh_get_outline_edge(&shape, k, edge);
        for (int l = 0; l < k; l++) {
            square_mesh_get_outline_edge(&shape, l, other);
            bool neighbours = other[1] == edge[0] || other[0] == edge[1];
            if (neighbours || !edges_cross(x, edge, other))
                continue;
            int a = square_mesh_find_body(&shape, other[0]) + 1;
            int b = square_mesh_find_body(&shape, edge[0]) + 1;
            return a == b ? refuse(message,
                                   "--self-contact: body %d would cross itself "
                                   "at the start; --self-contact off allows it",
                                   a)
                          : refuse(message,
                                   "--body: bodies %d and %d would overlap at "
                                   "the start; move one of them, or "
                                   "--self-contact off",
                                   a, b);
        }
    }
    return check_nested_bodies(options, &shape, x, message);
}

Status body_check_start(const Options *options, Message message)
{
    Obstacle list[CONTACT_MAX_OBSTACLES];
    Status status = check_obstacles(options, message);
    if (status || (list_obstacles(options, list) == 0 &&
                   !options->has_cell_energy && !options->state &&
                   options->material == 0 && !options->has_self_contact))
        return status;
    System system = {0};
    double *x = NULL;
    status = build_run_system(options, 0, &system, &x, message);
    if (!status)
        status = check_crossing_outlines(options, x, message);
    if (!status)
        status = check_gaps_and_cells(options, &system, x, 0, -1, message);
    free(x);
    system_free(&system);
    return status;
}
