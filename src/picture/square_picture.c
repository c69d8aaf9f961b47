/* square_picture.c - the picture of the square: bounds, layers, live values. */
#include <math.h>
#include <string.h>

#include "picture/cards.h"
#include "model/fracture.h"
#include "model/spring_law.h"
#include "picture/square_pen.h"

enum {
    ARROW_SPACING = 16,      /* pixels, least distance between two arrows */
    MIN_CELL = 5,            /* pixels; smaller cells are drawn as faces */
    MAX_NUMBERED_NODES = 121 /* largest mesh with node numbers or forces */
};

static const double MIN_ARROW = 1.5; /* ems; shorter directions are enlarged */
static const double MAX_GROWTH = 1e303; /* largest growth factor of the view */
/* Width of the first view / width of the square: with words, and without. */
static const double VIEW_SIZE = 1.14, BARE_VIEW_SIZE = 1.75;
static const double MAGNIFIER_SIDE = 11; /* ems */
/* Distances up to which balls, grounds and the target of a pull are shown, in
 * half widths or heights of the view; the user may ask for all obstacles. */
static const double BALL_REACH = 4, GROUND_REACH = 2, PULL_REACH = 16;

/* ---- how much of the world is seen -------------------------------------- */

static bool scene_sets_view(const Simulation *simulation)
{
    const double *view = simulation->scene->view;
    return view[2] > view[0];
}

/* A rectangle of the world: middle, and half of width and height (m). */
typedef struct Extent {
    double middle[2], half_size[2];
} Extent;

/* Returns the view that the scene sets, or a view that fits the square at the
 * start, up to twice its rest width; compressed squares have room to bulge. */
static Extent find_default_view(const FrameContent *content,
                                const Simulation *simulation)
{
    const Options *options = &simulation->options;
    const double *view = simulation->scene->view;
    double stretch = options->bodies > 0 ? 1 : fmin(fabs(options->stretch), 2);
    double extent = stretch < 1 ? 1 + 1.5 * (1 - stretch) : stretch;
    double half = 0.5 * simulation->mesh.side *
                  (content->is_bare ? BARE_VIEW_SIZE : VIEW_SIZE);
    Extent first = {{0, 0},
                    {half * extent,
                     half * (content->is_bare ? extent : fmin(extent, 1.25))}};
    for (int k = 0; k < 2 && scene_sets_view(simulation); k++) {
        first.middle[k] = 0.5 * (view[2 + k] + view[k]);
        first.half_size[k] = 0.5 * (view[2 + k] - view[k]);
    }
    return first;
}

/* Returns what the stage shows of the world when the view just fits into it. */
static Extent find_seen_extent(const Plot *stage, const Extent *view)
{
    Extent seen = *view;
    const double box[2] = {stage->box.width, stage->box.height};
    double scale =
        fmin(box[0] / view->half_size[0], box[1] / view->half_size[1]);
    for (int k = 0; k < 2 && scale > 0; k++)
        seen.half_size[k] = box[k] / scale;
    return seen;
}

/* Widens the view to show a circle that is partly outside of the seen part.  If
 * the circle is between `reach` and 1.5 `reach` away, widens the view less, so
 * that the camera never jumps.
 *   at, radius  m, circle
 *   reach       distance from the middle up to which the whole circle is shown,
 *               in half widths or heights of the seen part */
static void widen_view_to_circle(const Extent *seen, const double at[2],
                                 double radius, double reach, Extent *view)
{
    double far = 0;
    for (int k = 0; k < 2; k++)
        far = fmax(far, fabs(at[k] - seen->middle[k]) / seen->half_size[k]);
    double part = fmin(3 - 2 * far / reach, 1);
    for (int k = 0; k < 2 && part > 0; k++) {
        double low = seen->middle[k] - seen->half_size[k];
        double high = seen->middle[k] + seen->half_size[k];
        double beyond = at[k] - radius < low    ? at[k] - radius - low
                        : at[k] + radius > high ? at[k] + radius - high
                                                : 0;
        if (beyond == 0)
            continue;
        low = fmin(low + part * fmin(beyond, 0),
                   view->middle[k] - view->half_size[k]);
        high = fmax(high + part * fmax(beyond, 0),
                    view->middle[k] + view->half_size[k]);
        view->middle[k] = 0.5 * (low + high);
        view->half_size[k] = 0.5 * (high - low);
    }
}

/* Widens the view to show each ball in reach, a strip of each ground in reach
 * (wide enough for the mouse), and the place to which a script pulls.  The
 * pushed obstacle is always in reach, and with shows_all_obstacles every
 * obstacle. */
static void widen_view_to_obstacles(const Plot *stage, Extent *view)
{
    const Simulation *simulation = stage->simulation;
    const Options *options = &simulation->options;
    const Contact *contact = get_contact(&simulation->system);
    const HandGrip *hand = &stage->content->hand;
    const Extent seen = find_seen_extent(stage, view);
    double air = 0.04 * fmin(view->half_size[0], view->half_size[1]);
    if (hand->is_held && !stage->content->view->drag_bounds.is_dragging)
        widen_view_to_circle(&seen, hand->target, air, PULL_REACH, view);
    for (int k = 0; contact && k < options->grounds + options->balls; k++) {
        const Obstacle *obstacle = &contact->obstacle[k];
        bool held = contact->push.is_held && contact->push.obstacle_index == k;
        bool seeks_all = held || stage->content->view->lens.shows_all_obstacles;
        NodeGap gap =
            contact_measure_gap(obstacle, obstacle->o, seen.middle, 0);
        const Point foot = point_along(seen.middle, -gap.d, gap.n);
        if (obstacle->kind == OBSTACLE_BALL)
            widen_view_to_circle(&seen, obstacle->o, obstacle->radius + air,
                                 seeks_all ? INFINITY : BALL_REACH, view);
        else
            widen_view_to_circle(&seen, foot.xy, 3 * air,
                                 seeks_all ? INFINITY : GROUND_REACH, view);
    }
}

void find_node_bounds(const Pane *pane, int runs, double bounds[4])
{
    const Simulation *simulation = pane->simulation;
    bounds[0] = bounds[1] = INFINITY;
    bounds[2] = bounds[3] = -INFINITY;
    for (int r = 0; r < runs; r++) {
        const double *x =
            r > 0 ? simulation->run[r].x : pane_get_positions(pane);
        for (int i = 0; i < simulation->run[r].system->nodes; i++, x += 2)
            for (int k = 0; k < 2 && isfinite(x[0] + x[1]); k++) {
                bounds[k] = fmin(bounds[k], x[k]);
                bounds[2 + k] = fmax(bounds[2 + k], x[k]);
            }
    }
}

/* Moves the view just enough for its inner half to hold the body's middle. */
static void move_view_to_body(const Simulation *simulation, const double *x,
                              Extent *view)
{
    int nodes = simulation->system.nodes;
    for (int k = 0; k < 2; k++) {
        double centre = 0, room = 0.5 * view->half_size[k];
        for (int i = 0; i < nodes; i++)
            centre += x[2 * i + k];
        centre = centre / nodes - view->middle[k];
        if (isfinite(centre) && fabs(centre) > room)
            view->middle[k] += centre - copysign(room, centre);
    }
}

/* Moves the view just enough to hold the box; centres a larger box. */
static void pan_view(const double box[4], Extent *view)
{
    for (int k = 0; k < 2; k++) {
        double low = box[2 + k] - view->half_size[k],
               high = box[k] + view->half_size[k];
        if (low > high)
            low = high = 0.5 * (box[k] + box[2 + k]);
        view->middle[k] = fmin(fmax(view->middle[k], low), high);
    }
}

/* Returns the factor by which the view must grow to show the box.
 *   tall  out, the same factor for the height alone */
static double find_view_growth(const double box[4], const Extent *view,
                               double *tall)
{
    double need[2];
    for (int k = 0; k < 2; k++)
        need[k] = fmax(box[2 + k] - view->middle[k], view->middle[k] - box[k]) /
                  view->half_size[k];
    *tall = fmax(need[1], 0);
    return fmax(need[0], need[1]);
}

/* Starts from the first view, which follows a free body.  While nodes are
 * outside, the view grows by factors of 1.5 and moves with the nodes.  At last
 * the view widens to obstacles in reach and to the place of a script's pull. */
void find_square_bounds(const Plot *stage, double bounds[4])
{
    static const double GROWTH = 1.5;
    const Simulation *simulation = stage->simulation;
    const Options *options = &simulation->options;
    bool bare = stage->content->is_bare;
    bool is_free = options->grounds + options->balls == 0 &&
                   !simulation->scene->body.make_obstacle &&
                   options->ceiling[1] == 0 && simulation->runs == 1;
    Extent view = find_default_view(stage->content, simulation);
    double box[4], tall, grown = 1;
    find_node_bounds(stage->pane, simulation->runs, box);
    if (is_free)
        move_view_to_body(simulation, pane_get_positions(stage->pane), &view);
    while (grown < find_view_growth(box, &view, &tall) * (1 - 1e-12) &&
           grown < MAX_GROWTH) {
        Extent larger = view;
        grown *= GROWTH;
        larger.half_size[0] *= grown;
        larger.half_size[1] *= grown;
        pan_view(box, &larger);
        memcpy(view.middle, larger.middle, sizeof view.middle);
    }
    /* In a bare window the view is only as high as the body needs. */
    double low =
        bare && !scene_sets_view(simulation)
            ? fmax(VIEW_SIZE / BARE_VIEW_SIZE, VIEW_SIZE * tall / grown)
            : 1;
    view.half_size[0] *= grown;
    view.half_size[1] *= grown * fmin(low, 1);
    widen_view_to_obstacles(stage, &view);
    for (int k = 0; k < 2; k++) {
        bounds[k] = view.middle[k] - view.half_size[k];
        bounds[2 + k] = view.middle[k] + view.half_size[k];
    }
}

/* ---- what Newton does --------------------------------------------------- */

/* Draws p as arrows at all nodes, in a fine mesh at every few nodes.  If the
 * longest arrow is too short or too long, all arrows are scaled by a power of
 * ten, which the legend names. */
static void draw_direction_arrows(const SquarePen *pen)
{
    Plot *stage = pen->stage;
    const NewtonTrace *trace = pen->stage->pane->trace;
    double scale = stage->camera.scale[0], factor = 1, longest = 0;
    double most = 0.5 * fmin(stage->box.width, stage->box.height);
    double least = fmin(MIN_ARROW * stage->em, 0.1 * most);
    int apart = (int)ceil(ARROW_SPACING * stage->paper->unit / pen->spacing);
    if (!trace || !trace->p || trace->at_line < LINE_SOLVE ||
        trace->at_line > LINE_SEARCH)
        return;
    for (int i = 0; i < pen->system->nodes; i++) {
        double length = vector_length(trace->p + 2 * i) * scale;
        longest = isfinite(length) ? fmax(longest, length) : longest;
    }
    if (longest == 0)
        return;
    if (longest < least)
        factor = pow(10, ceil(log10(least / longest)));
    if (longest > most)
        factor = pow(10, -ceil(log10(longest / most)));
    for (int i = 0; i<pen->system->nodes; i += apart> 1 ? apart : 1)
        if (vector_length(trace->p + 2 * i) * factor * scale > 1.5)
            plot_arrow(stage, pen->x + 2 * i, trace->p + 2 * i, factor, 1.6,
                       COLOUR_P);
    plot_legend(stage, COLOUR_P, "search direction p%s%s",
                factor == 1 ? "" : " \u00d7 ",
                factor == 1 ? "" : format_number(factor).text);
}

/* Marks the node or spring under the mouse.  Draws a line to the mouse from the
 * node or ball that the mouse drags. */
static void mark_part_under_mouse(const SquarePen *pen)
{
    const Plot *stage = pen->stage;
    const FrameContent *content = stage->content;
    const System *system = pen->system;
    const HandGrip *hand = &content->hand;
    bool holds = hand->is_held && stage->pane == active_pane(content);
    const Pick *hover = &content->view->hovered_part;
    bool over = hover->pane_index == plot_pane_index(stage);
    bool writes = pen->simulation->options.next_action == NEXT_ADDS_SPRING;
    int lit = hover->kind == PICK_SPRING ? hover->index
              : writes                   ? find_added_spring(pen->simulation)
                                         : -1;
    if (over && hover->kind == PICK_NODE && hover->index < system->nodes)
        plot_ring(stage, pen->x + 2 * (size_t)hover->index,
                  pen->node_radius + 4, 2, COLOUR_TEXT);
    if (over && lit >= 0 && lit < system->springs)
        square_draw_spring(pen, lit, 4.5,
                           writes ? COLOUR_PROJECT : COLOUR_TEXT);
    for (int k = 0; k < 2 && writes; k++) {
        int node = system->e[2 * lit + k];
        plot_label(stage, 1, pen->x + 2 * (size_t)node, COLOUR_PROJECT, "%d",
                   node);
    }
    const double *from = NULL;
    if (holds && hand->obstacle >= 0 && pen->contact &&
        pen->contact->obstacle[hand->obstacle].kind == OBSTACLE_BALL)
        from = pen->contact->obstacle[hand->obstacle].o;
    if (holds && hand->node >= 0) {
        from = pen->x + 2 * (size_t)hand->node;
        plot_ring(stage, from, pen->node_radius + 4, 2, COLOUR_HAND);
    }
    if (from) {
        plot_dashes(stage, from, hand->target, 2, NULL, COLOUR_HAND);
        plot_disc(stage, hand->target, 4, COLOUR_HAND);
    }
}

/* ---- layers ------------------------------------------------------------- */

/* Draws the layers below the springs: rest shape, cells, ghosts.  Returns the
 * number of folded cells. */
static int draw_lower_layers(const SquarePen *pen)
{
    const Pane *pane = pen->stage->pane;
    const NewtonTrace *trace = pane->trace;
    if (!scene_sets_view(pen->simulation) && !pen->contact &&
        pen->simulation->options.bodies == 0) {
        square_draw_outline(pen, NULL, false, COLOUR_RULE);
        if (plot_pane_index(pen->stage) == 0)
            plot_legend(pen->stage, COLOUR_GREY, "rest shape");
    }
    int folded = square_fill_cells(
        pen, pen->contact || system_term_data(pen->system, &fracture));
    if (pane->ghost_x) {
        square_draw_ghost(pen, pane->ghost_x, COLOUR_GHOST);
        plot_legend(pen->stage, COLOUR_GHOST, "ghost: %.*s",
                    (int)strcspn(pane->ghost_label, ":"), pane->ghost_label);
    }
    size_t bytes = 2 * (size_t)pen->system->nodes * sizeof *pen->x;
    if (trace && trace->x_tilde && trace->at_line &&
        memcmp(trace->x_tilde, pen->x, bytes) != 0) {
        square_draw_ghost(pen, trace->x_tilde, COLOUR_X_TILDE);
        plot_legend(pen->stage, COLOUR_X_TILDE, "{xt}, inertia alone");
    }
    return folded;
}

/* Adds warnings to the legend: nodes that cannot be drawn, folded cells. */
static void add_legend_warnings(const SquarePen *pen, int folded)
{
    Plot *stage = pen->stage;
    int nodes = pen->system->nodes, lost = 0;
    bool seen = !stage->content->lecture.page || pen->simulation->runs > 1;
    double at[2];
    for (int i = 0; i < nodes; i++) {
        const double *x = pen->x + 2 * (size_t)i;
        plot_to_pixel(stage, x, at);
        lost += !isfinite(x[0]) || !isfinite(x[1]);
        seen = seen || box_contains(stage->box, at[0], at[1]);
    }
    if (lost > 0)
        plot_legend(stage, COLOUR_WARNING,
                    "%d of %d nodes are beyond all numbers", lost, nodes);
    else if (!seen)
        plot_legend(stage, COLOUR_WARNING, "all nodes are beyond the picture");
    if (folded > 0)
        plot_legend(stage, COLOUR_WARNING, "%d cell%s folded over", folded,
                    folded == 1 ? "" : "s");
}

/* Marks the place of a square that is too small to be seen. */
static void mark_tiny_square(const Plot *stage)
{
    double far = 4 * stage->em / stage->camera.scale[0];
    const double tail[2] = {0, -far}, up[2] = {0, far};
    plot_arrow(stage, tail, up, 1, 2, COLOUR_TEXT);
    plot_label(stage, 1, tail, COLOUR_TEXT, "rest shape");
}

static void add_colour_legend(const SquarePen *pen)
{
    double percent = 100 * pen->colour_range;
    if (pen->shows_plastic) {
        plot_legend(pen->stage, COLOUR_PLASTIC,
                    "plastic strain; darkest from %s %% on",
                    format_number(percent).text);
        return;
    }
    plot_legend(pen->stage, COLOUR_COMPRESS, "strain \u2212%s %%",
                format_number(fmin(percent, 100)).text);
    plot_legend(pen->stage, COLOUR_STRETCH, "+%s %%",
                format_number(percent).text);
}

static void draw_node_numbers(const SquarePen *pen)
{
    double at[2], em = pen->stage->em, size = pen->spacing < 6 * em ? 1 : 1.3;
    for (int i = 0; i < pen->system->nodes; i++) {
        plot_to_pixel(pen->stage, pen->x + 2 * i, at);
        const Box *box = &pen->stage->box;
        bool low = at[1] + 2.3 * em > box->y + box->height;
        bool right = at[0] + 3.2 * em > box->x + box->width;
        at[0] += (right ? -2 * size : 0.7) * em;
        at[1] += (low ? -2.1 : 0.4) * em;
        if (box_contains(pen->stage->box, at[0], at[1]))
            paper_write_on_panel(pen->stage->paper, FACE_BOLD, size,
                                 COLOUR_TEXT, at[0], at[1], ALIGN_LEFT, "%d",
                                 i);
    }
}

/* Draws an arrow factor * d at each node; arrows longer than 0.9 spacings of
 * the mesh are cut.  With factor 0 the longest arrow is 0.9 spacings long. */
static void draw_node_arrows(const SquarePen *pen, const double *d,
                             double factor, Colour colour, const char *word)
{
    int nodes = pen->system->nodes;
    double longest = 1e-300, most = 0.9 * pen->simulation->mesh.spacing;
    for (int i = 0; i < nodes; i++)
        longest = fmax(longest, vector_length(d + 2 * i));
    factor = factor == 0 ? most / longest : factor;
    for (int k = 0; k < 2 * nodes; k++) { /* white rims of the arrows first */
        const double *di = d + k % nodes * 2;
        plot_arrow(pen->stage, pen->x + k % nodes * 2, di,
                   fmin(factor, most / fmax(vector_length(di), 1e-300)) *
                       (k < nodes ? 1.15 : 1),
                   k < nodes ? 10 : 3, k < nodes ? COLOUR_WHITE : colour);
    }
    plot_legend(pen->stage, colour, "%s%s", word,
                factor * longest > 1.001 * most ? "; some cut" : "");
}

/* Computes the positions at rest, x [2n], out. */
static void compute_rest_positions(const Simulation *simulation, double *x)
{
    for (int i = 0; i < simulation->mesh.nodes; i++)
        square_mesh_rest_position(&simulation->mesh, i, x + 2 * i);
}

/* Draws a page's arrows: forces on the nodes, or displacements from rest. */
static void draw_field_arrows(const SquarePen *pen)
{
    unsigned layers = pen->simulation->options.layers;
    const System *system = pen->system;
    double arrow[2 * MAX_NUMBERED_NODES] = {0};
    if (system->nodes > MAX_NUMBERED_NODES)
        return;
    if (layers & LAYER_MODES) {
        compute_rest_positions(pen->simulation, arrow);
        for (int k = 0; k < 2 * system->nodes; k++)
            arrow[k] = pen->x[k] - arrow[k];
        draw_node_arrows(pen, arrow, 30, COLOUR_VELOCITY,
                         "displacement \u00d7 30");
    }
    if (!(layers & LAYER_FORCES) || !pen->stage->is_answer_shown)
        return;
    system_acceleration(system, pen->x, arrow);
    for (int i = 0; i < 2 * system->nodes; i++)
        arrow[i] *= system->m[i / 2];
    draw_node_arrows(pen, arrow, 0, COLOUR_FORCE, "force on each node");
    if (!(layers &
          LAYER_SPRING_KINDS)) /* pages without kinds mention the node */
        plot_label(pen->stage, 1, pen->x + 2 * system->nodes - 2, COLOUR_TEXT,
                   "node %d", system->nodes - 1);
}

/* Draws springs in the colours of their kinds.  On a page with switches
 * for the kinds, the springs of the kind that was added last are wider. */
static void draw_springs_by_kind(const SquarePen *pen)
{
    const System *system = pen->system;
    int newest = exhibit_find_spring_kind(pen->simulation,
                                          find_added_spring(pen->simulation));
    bool wide = pen->simulation->options.layers & LAYER_SPRING_KINDS;
    for (int s = 0; s < system->springs; s++) {
        int kind = exhibit_find_spring_kind(pen->simulation, s);
        if (system->k[s] > 0)
            square_draw_spring(pen, s, wide && kind == newest ? 3.5 : 2,
                               colour_of_spring_kind(kind));
    }
}

/* Draws a magnifier on the contact whose law the page draws, in the corner of
 * the stage where the magnifier hides least. */
static void draw_magnifier(const SquarePen *pen)
{
    Plot lens = *pen->stage;
    Canvas *canvas = &lens.paper->canvas;
    NodeContact gap;
    double bounds[4], least = INFINITY;
    const Box stage = lens.box;
    int air = (int)lens.em, side = (int)(MAGNIFIER_SIDE * lens.em);
    if (!lens.is_answer_shown || lens.box.width < 2 * side ||
        !law_find_contact(pen->simulation, &gap))
        return;
    for (int i = 0; i < 4; i++) {
        int left = i & 2 ? air : stage.width - side - air;
        int top = i & 1 ? stage.height - side - 2 * air : 2 * air;
        Box box = {stage.x + left, stage.y + top, side, side};
        double cost = plot_find_label_cost(pen->stage, box) + 0.1 * i;
        if (cost < least)
            lens.box = box;
        least = fmin(least, cost);
    }
    double reach = 1.2 * gap.d_hat;
    for (int c = 0; c < 4; c++)
        bounds[c] =
            0.5 * (gap.nearest_point[c % 2] + gap.node_position[c % 2]) +
            (c < 2 ? -reach : reach);
    plot_ring(pen->stage, gap.node_position, 7, 1.5, COLOUR_P);
    canvas_framed_box(canvas, lens.box, COLOUR_WHITE, COLOUR_P);
    Box before = canvas_set_clip(canvas, box_inset(lens.box, 1));
    lens.camera = camera_create(lens.box, bounds, false, &LENS_FITS);
    SquarePen near = square_pen_create(&lens, 0);
    square_fill_cells(&near, true);
    square_draw_obstacles(&near);
    near.node_radius = 4;
    square_draw_springs(&near);
    square_draw_nodes(&near);
    plot_line(&lens, gap.nearest_point, gap.node_position, 3, COLOUR_P);
    paper_write_on_panel(lens.paper, FACE_BOLD, 1, COLOUR_P,
                         lens.box.x + 0.6 * lens.em, lens.box.y + 0.4 * lens.em,
                         ALIGN_LEFT, "\u03b4 = %s mm",
                         format_number(1e3 * gap.d).text);
    canvas_set_clip(canvas, before);
}

/* Draws how far a body has slid, and how far a rigid body would slide. */
static void draw_slid_distance(const Plot *stage, int body)
{
    static const double ABOVE = 0.04; /* m, arrow's height above the body */
    const SquareMesh *mesh = &stage->simulation->mesh;
    const double *x = stage->simulation->run[0].x;
    double gone[2], from[2] = {INFINITY, -INFINITY};
    int nodes = mesh->nodes / mesh->bodies;
    if (!stage->is_answer_shown ||
        !law_find_slip(stage->simulation, body, gone))
        return;
    for (int i = body * nodes; i < (body + 1) * nodes; i++) {
        from[0] = fmin(from[0], x[2 * i] - gone[0]);
        from[1] = fmax(from[1], x[2 * i + 1] + ABOVE);
    }
    const double to[2] = {from[0] + gone[1], from[1]}, up[2] = {0, ABOVE};
    for (int i = 0; i < 2; i++)
        plot_dashes(stage, point_along(i ? to : from, -3, up).xy,
                    point_along(i ? to : from, 2, up).xy, 1.4, NULL,
                    COLOUR_TEXT);
    plot_arrow(stage, from, (double[2]){gone[0], 0}, 1, 2, COLOUR_P);
    plot_label(stage, 1, point_along(to, 2, up).xy, COLOUR_P, "moved %s m",
               format_number(gone[0]).text);
}

/* Draws the obstacles, then the bodies of all runs, the first run last, and
 * then the marks and arrows of the first run. */
void draw_square_picture(Plot *stage)
{
    SquarePen pen[SIMULATION_MAX_RUNS];
    const FrameContent *content = stage->content;
    const Simulation *simulation = stage->simulation;
    const System *system = &simulation->system;
    int runs = simulation->runs, folded = 0;
    unsigned layers = simulation->options.layers;
    for (int r = 0; r < runs; r++) {
        pen[r] = square_pen_create(stage, r);
        square_draw_obstacles(&pen[r]);
    }
    for (int r = 1; r < runs; r++) {
        if (!content->is_bare)
            square_fill_cells(&pen[r], true);
        square_draw_springs(&pen[r]);
        square_draw_nodes(&pen[r]);
    }
    if (!content->is_bare)
        folded = draw_lower_layers(pen);
    bool cuts = layers & LAYER_FILLED_CELLS,
         solid = cuts && content->lecture.hides_answer;
    if (cuts)
        square_fill_cells(pen, true);
    if (solid)
        square_draw_outline(pen, pen->x, false, COLOUR_X);
    else if (stage->is_answer_shown &&
             layers & (LAYER_FILLED_CELLS | LAYER_SPRING_KINDS))
        draw_springs_by_kind(pen);
    else if (pen->spacing >= MIN_CELL || system_term_data(system, &fracture))
        square_draw_springs(pen);
    else
        square_draw_faces(pen);
    if (!content->is_bare)
        draw_field_arrows(pen);
    if (!solid)
        square_draw_nodes(pen);
    if (content->is_bare)
        return;
    square_draw_forces(pen, runs);
    for (int r = 0; r < runs && runs > 1; r++)
        if (pen[r].contact)
            square_draw_mu_label(&pen[r]);
    if (simulation->mesh.side * stage->camera.scale[0] < 4 &&
        !scene_sets_view(simulation))
        mark_tiny_square(stage);
    if (pen->shows_projected)
        plot_legend(stage, COLOUR_PROJECT, "projected spring");
    draw_direction_arrows(pen);
    mark_part_under_mouse(pen);
    add_legend_warnings(pen, folded);
    if (stage->is_answer_shown && layers & LAYER_NODE_NUMBERS &&
        (simulation->steps == 0 ||
         simulation->options.next_action == NEXT_ADDS_SPRING) &&
        system->nodes <= MAX_NUMBERED_NODES)
        draw_node_numbers(pen);
    if (pen->colour_range > 0)
        add_colour_legend(pen);
    for (int body = 1; body < simulation->mesh.bodies; body++)
        draw_slid_distance(stage, body);
    draw_magnifier(pen);
}

/* ---- live values --------------------------------------------------------- */

int find_added_spring(const Simulation *simulation)
{
    int last = simulation->system.springs - 1;
    return simulation->steps < last ? (int)simulation->steps : last;
}

/* Adds values of the spring that the present step puts into the matrix: entries
 * xx, xy, yy of B = h^2 H, kg (H: projected 2x2 Hessian), and the numbers of
 * the four rows of its block [[B, -B], [-B, B]]. */
static void add_hessian_values(const Simulation *simulation, LiveValues *values)
{
    static const char *const names[] = {"Bxx", "Bxy", "Byy"};
    static const char *const rows[] = {"row 1", "row 2", "row 3", "row 4"};
    const System *system = &simulation->system;
    int s = find_added_spring(simulation);
    const int *e = system->e + 2 * s;
    double d[2], H[3], l2 = system->l2[s], h = simulation->options.timestep;
    double k = h * h * system->k[s];
    values_add(values, "newest", s);
    for (int i = 0; i < 4; i++)
        values_add(values, rows[i], 2 * e[i / 2] + i % 2);
    values_add_flag(values, "assembled", true);
    spring_vector(e, simulation->run[0].x, d);
    /* The page shows the projected block. */
    spring_hessian(d, l2, k, PROJECTION_CLAMP, H);
    values_add_matrix(values, names, H, 1e-7 * k);
}

/* Adds force and acceleration of the last node, and the number of nodes whose
 * force is 0 up to rounding. */
static void add_force_values(const Simulation *simulation, const double *x,
                             LiveValues *values)
{
    int last = simulation->system.nodes - 1, balanced = 0;
    double a[2 * MAX_NUMBERED_NODES] = {0}, *at = a + 2 * last;
    system_acceleration(&simulation->system, x, a);
    for (int i = 0; i <= last; i++)
        balanced += vector_length(a + 2 * i) <= 1e-9 * vector_length(at);
    values_add_point(values, "a", at);
    values_add(values, "last", last);
    values_add(values, "balanced", balanced);
    values_add(values, "elastic", system_potential(&simulation->system, x));
}

/* Adds the values of mesh, law, fastest mode and forces, which pages use. */
void list_square_values(const Simulation *simulation, LiveValues *values)
{
    const System *system = &simulation->system;
    const Options *options = &simulation->options;
    double start[2 * MAX_NUMBERED_NODES], mode[2 * SIMULATION_MAX_MODE_NODES];
    int nodes = system->nodes, shorter = 0;
    const double *x = simulation->run[0].x;
    if (!options->page)
        return;
    for (int s = 0; s < system->springs; s++) {
        double d[2], d2 = spring_vector(system->e + 2 * s, x, d);
        shorter += spring_strain(d2, system->l2[s]) < -1e-9;
    }
    values_add(values, "masses", nodes);
    values_add(values, "node mass", system->m[0]);
    values_add(values, "places", 4 * (nodes + 2.0 * system->springs));
    values_add(values, "short", shorter);
    values_add(values, "segments", options->segments);
    values_add(values, "side", simulation->mesh.side);
    values_add(values, "k", options->stiffness);
    values_add(values, "stretch", options->stretch);
    values_add(values, "h", options->timestep);
    if (options->next_action == NEXT_ADDS_SPRING)
        add_hessian_values(simulation, values);
    list_law_values(simulation, values);
    if (options->layers & LAYER_MODES && nodes <= SIMULATION_MAX_MODE_NODES) {
        compute_rest_positions(simulation, start);
        double omega = simulation_find_max_omega(simulation, start, mode);
        values_add(values, "h limit", 2 / omega);
    }
    if (options->layers & LAYER_FORCES && nodes <= MAX_NUMBERED_NODES)
        add_force_values(simulation, x, values);
}

/* Samples all energies of the first run, J. */
int square_sample_energies(const Simulation *simulation, Energy *row)
{
    Energies energies = simulation_get_energies(simulation, 0);
    int n = energies.count < MAX_HISTORY_SERIES ? energies.count
                                                : MAX_HISTORY_SERIES;
    memcpy(row, energies.energy, (size_t)n * sizeof *row);
    return n;
}
