/* square_pen.c - springs, nodes, faces and outlines of the square's picture. */
#include "picture/square_pen.h"

#include <math.h>
#include <string.h>

#include "model/fracture.h"
#include "model/neo_hookean.h"
#include "model/plasticity.h"
#include "model/spring_law.h"
#include "picture/cards.h"

enum { MAX_GHOST_SPRINGS = 700 }; /* most springs that a ghost shows */

static const double FLOWN_VIEW = 30;   /* widest usual view / square's side */
static const double NODE_RADIUS = 0.1; /* radius of a node / node spacing */
static const double MIN_FACE = 4;      /* pixels, least side of a face */

/* ---- sizes and colours -------------------------------------------------- */

/* Returns the strain at the ends of the colour scale: the scene's choice, or
 * half of the strain at the start, at least 5 %.
 *   ep  [springs] in; not NULL: half of the largest plastic strain instead */
static double find_strain_range(const Simulation *simulation, const double *ep)
{
    double most = ep ? 0 : fabs(fabs(simulation->options.stretch) - 1);
    for (int s = 0; ep && s < simulation->system.springs; s++)
        most = fmax(most, fabs(ep[s]));
    if (!ep && simulation->scene->strain_colour_max > 0)
        return simulation->scene->strain_colour_max;
    return plot_nice_number(fmax(0.5 * most, 0.05));
}

static bool node_is_fixed(const SquarePen *pen, int node)
{
    const SquareMesh *mesh = &pen->simulation->mesh;
    return pen->fixed_body_mask && node < mesh->nodes &&
           pen->fixed_body_mask >> square_mesh_find_body(mesh, node) & 1;
}

SquarePen square_pen_create(Plot *stage, int run)
{
    const FrameContent *content = stage->content;
    const Simulation *simulation = stage->simulation;
    const NewtonTrace *trace = stage->pane->trace;
    const System *system = simulation->run[run].system;
    const Plasticity *plasticity = system_term_data(system, &plastic_energy);
    const SquareMesh *mesh = &simulation->mesh;
    SquarePen pen = {
        .stage = stage,
        .simulation = simulation,
        .system = system,
        .x = run ? simulation->run[run].x : pane_get_positions(stage->pane),
        .v = simulation->run[run].v,
        .spacing = stage->camera.scale[0] * mesh->spacing,
        .shade_strain = find_strain_range(simulation, NULL),
        .ep = plasticity ? plasticity->ep : NULL,
        .contact = get_contact(system),
        .fixed_body_mask = mesh->bodies > 1 ? (1u << mesh->bodies) - 1 : 0};
    double unit = stage->paper->unit;
    double seen =
        content->view->lens.zoom * stage->box.width / stage->camera.scale[0];
    if (seen > FLOWN_VIEW * mesh->side) /* the nodes have flown apart */
        pen.spacing *= seen / mesh->side;
    for (int i = 0; pen.fixed_body_mask && i < mesh->nodes; i++)
        if (!system->is_pinned[i])
            pen.fixed_body_mask &= ~(1u << square_mesh_find_body(mesh, i));
    pen.width = fmax(fmin(fmax(0.06 * pen.spacing / unit, 1.1), 1.9), 1 / unit);
    pen.node_radius = NODE_RADIUS * pen.spacing / unit;
    if (!content->is_bare)
        pen.node_radius = fmin(pen.node_radius, 6.5);
    pen.shows_plastic = !content->shows_strain && !content->is_bare && pen.ep;
    if (pen.shows_plastic || content->shows_strain)
        pen.colour_range = pen.shows_plastic
                               ? find_strain_range(simulation, pen.ep)
                               : pen.shade_strain;
    if (pen.colour_range > 0)
        pen.width *= 1.4;
    bool ended = trace && trace->at_line == LINE_NONE &&
                 stage->is_answer_shown && frame_has_card(content, "prints");
    pen.shows_projected =
        trace &&
        (ended ||
         (trace->at_line >= LINE_PROJECT && trace->at_line <= LINE_SEARCH)) &&
        !content->shows_strain &&
        simulation->options.projection != PROJECTION_NONE &&
        trace->projected_blocks != 0 && !get_neo_hookean(system);
    return pen;
}

/* Returns the colour of a spring or face by strain or plastic strain; without a
 * scale COLOUR_PROJECT if compressed and projections are shown, 0 if not. */
static Colour choose_spring_colour(const SquarePen *pen, double plastic,
                                   double strain, bool shorter)
{
    double value = pen->shows_plastic ? plastic : strain;
    double part = fmin(fabs(value) / pen->colour_range, 1);
    Colour end = pen->shows_plastic ? COLOUR_PLASTIC
                 : value < 0        ? COLOUR_COMPRESS
                                    : COLOUR_STRETCH;
    if (pen->colour_range > 0)
        return colour_mix(COLOUR_REST, end, isnan(value) ? 0 : part);
    return pen->shows_projected && shorter ? COLOUR_PROJECT : 0;
}

void square_draw_spring(const SquarePen *pen, int s, double width,
                        Colour colour)
{
    const int *e = pen->system->e + 2 * (size_t)s;
    double p[2], q[2], unit = pen->stage->paper->unit;
    bool fixed = node_is_fixed(pen, e[0]);
    if (spring_is_broken(pen->system, s))
        return;
    camera_to_pixel(&pen->stage->camera, pen->x + 2 * e[0], p);
    camera_to_pixel(&pen->stage->camera, pen->x + 2 * e[1], q);
    canvas_line(&pen->stage->paper->canvas, p[0], p[1], q[0], q[1],
                (fixed ? 0.7 : 1) * width * unit, fixed ? COLOUR_EDGE : colour);
}

void square_draw_springs(const SquarePen *pen)
{
    const System *system = pen->system;
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * (size_t)s;
        double l2 = system->l2[s], d[2], d2 = spring_vector(e, pen->x, d);
        double strain = pen->colour_range > 0 ? sqrt(d2 / l2) - 1 : 0;
        Colour colour = choose_spring_colour(pen, pen->ep ? pen->ep[s] : 0,
                                             strain, d2 < l2);
        square_draw_spring(pen, s,
                           (colour == COLOUR_PROJECT ? 1.15 : 1) * pen->width,
                           colour ? colour : COLOUR_X);
    }
}

/* ---- cells -------------------------------------------------------------- */

/* Whether a triangle of the face, anticlockwise at rest, has turned over. */
static bool face_is_folded(const double *x, const int node[4])
{
    return twice_signed_area(x + 2 * node[0], x + 2 * node[1],
                             x + 2 * node[2]) < 0 ||
           twice_signed_area(x + 2 * node[0], x + 2 * node[2],
                             x + 2 * node[3]) < 0;
}

/* Whether all springs of a cell are unbroken.
 *   node  [4] out, nodes of the cell */
static bool cell_is_intact(const Simulation *simulation, int cell, int node[4])
{
    int spring[6], broken = 0;
    square_mesh_get_cell(&simulation->mesh, cell, node, spring);
    for (int k = 0; k < 6; k++)
        broken += spring_is_broken(&simulation->system, spring[k]);
    return broken == 0;
}

int pane_count_folded_cells(const Pane *pane)
{
    int folded = 0, node[4];
    for (int c = 0; c < pane->simulation->mesh.cells; c++)
        folded += cell_is_intact(pane->simulation, c, node) &&
                  face_is_folded(pane_get_positions(pane), node);
    return folded;
}

static void fill_face(const SquarePen *pen, const int node[4], Colour colour)
{
    const double *corner[4];
    for (int k = 0; k < 4; k++)
        corner[k] = pen->x + 2 * node[k];
    plot_quad(pen->stage, corner, colour);
}

/* Returns a shade: dark at 0, the blue of springs at 1/2, light at 1. */
static Colour shade_of_blue(double part)
{
    double dark = fmin(fmax(1 - 2 * part, 0), 1);
    double light = fmin(fmax(2 * part - 1, 0), 1);
    return colour_mix(colour_mix(COLOUR_X, COLOUR_FOLDED, 0.75 * dark),
                      COLOUR_WHITE, 0.7 * light);
}

int square_fill_cells(const SquarePen *pen, bool all)
{
    const NeoHookean *solid = get_neo_hookean(pen->system);
    int folded = 0, node[4];
    for (int t = 0; solid && t < solid->triangles.count; t++) {
        const int *n = solid->triangles.node[t];
        const int face[4] = {n[0], n[1], n[2], n[2]};
        double J = fabs(twice_signed_area(pen->x + 2 * n[0], pen->x + 2 * n[1],
                                          pen->x + 2 * n[2])) /
                   (2 * solid->triangles.rest_area);
        Colour shade = shade_of_blue(fmin(fmax(0.6 + 0.5 * log(J), 0), 1));
        Colour colour = colour_mix(shade, COLOUR_WHITE, 0.6);
        fill_face(pen, face, node_is_fixed(pen, n[0]) ? COLOUR_SOLID : colour);
    }
    for (int c = 0; !solid && c < pen->simulation->mesh.cells; c++) {
        if (!cell_is_intact(pen->simulation, c, node))
            continue;
        bool over = face_is_folded(pen->x, node);
        folded += over;
        if (over || all)
            fill_face(pen, node, over ? 0x38d00000u : 0x180000ffu);
    }
    return folded;
}

/* Returns the colour of a face by its state, else a shade by stretch and
 * rotation.
 *   side  m, side of the face at rest
 *   cell  number of the lower left cell, which has the face's plastic strain */
static Colour choose_face_colour(const SquarePen *pen, const int node[4],
                                 double side, int cell)
{
    int corner[4], spring[6];
    /* Diagonals: l2 is the squared rest length, d the vector of the second. */
    double l2 = 2 * side * side, plastic = 0, d[2];
    double other2 = spring_vector((int[2]){node[3], node[1]}, pen->x, d);
    double d2 = spring_vector((int[2]){node[2], node[0]}, pen->x, d);
    double strain = (sqrt(d2) + sqrt(other2)) / (2 * sqrt(l2)) - 1;
    if (pen->ep)
        square_mesh_get_cell(&pen->simulation->mesh, cell, corner, spring);
    for (int k = 0; pen->ep && k < 6; k++)
        if (fabs(pen->ep[spring[k]]) > fabs(plastic))
            plastic = pen->ep[spring[k]];
    Colour colour =
        choose_spring_colour(pen, plastic, strain, d2 < l2 || other2 < l2);
    double seen = copysign(sqrt(fabs(strain) / pen->shade_strain), strain);
    double turned = (d[1] - d[0]) / sqrt(d2); /* 0 in a face without rotation */
    return colour ? colour : shade_of_blue(0.55 + 0.9 * seen + 0.3 * turned);
}

void square_draw_faces(const SquarePen *pen)
{
    const SquareMesh *mesh = &pen->simulation->mesh;
    int wide = (int)fmin(fmax(MIN_FACE / pen->spacing, 1), mesh->cells);
    double side = wide * mesh->spacing;
    int node[4];
    for (int cell = 0; cell < mesh->cells; cell++)
        if (square_mesh_get_cell_patch(mesh, cell, wide, node))
            fill_face(pen, node, choose_face_colour(pen, node, side, cell));
    for (int cell = 0; cell < mesh->cells; cell++)
        if (square_mesh_get_cell_patch(mesh, cell, 1, node) &&
            face_is_folded(pen->x, node))
            fill_face(pen, node, COLOUR_FOLDED);
    square_draw_outline(pen, pen->x, false, COLOUR_X);
}

/* ---- nodes, outlines, ghosts -------------------------------------------- */

void square_draw_nodes(const SquarePen *pen)
{
    const System *system = pen->system;
    double radius = pen->node_radius;
    Colour colour = pen->colour_range > 0 ? COLOUR_FAINT : COLOUR_X;
    if (pen->colour_range > 0) /* larger nodes would hide the colours */
        radius *= 0.75;
    for (int i = 0; i < system->nodes; i++) {
        if (radius >= 0.5 * pen->width && !node_is_fixed(pen, i))
            plot_disc(pen->stage, pen->x + 2 * i, radius, colour);
        if (system->is_pinned[i] && !node_is_fixed(pen, i))
            plot_draw_pin(pen->stage, pen->x + 2 * i, radius);
    }
    for (int k = 0;
         pen->fixed_body_mask && k < pen->simulation->mesh.outline_edge_count;
         k++) {
        int node[2];
        square_mesh_get_outline_edge(&pen->simulation->mesh, k, node);
        if (node_is_fixed(pen, node[0]))
            plot_line(pen->stage, pen->x + 2 * node[0], pen->x + 2 * node[1],
                      1.5, COLOUR_EDGE);
    }
}

void square_draw_outline(const SquarePen *pen, const double *x, bool dashed,
                         Colour colour)
{
    const SquareMesh *mesh = &pen->simulation->mesh;
    double phase = 0, end[2][2];
    for (int k = 0; k < mesh->outline_edge_count; k++) {
        int node[2];
        square_mesh_get_outline_edge(mesh, k, node);
        for (int i = 0; i < 2; i++)
            if (x)
                memcpy(end[i], x + 2 * (size_t)node[i], sizeof end[i]);
            else
                square_mesh_rest_position(mesh, node[i], end[i]);
        if (dashed)
            plot_dashes(pen->stage, end[0], end[1], 1.4, &phase, colour);
        else
            plot_line(pen->stage, end[0], end[1], 1.4, colour);
    }
}

void square_draw_ghost(const SquarePen *pen, const double *x, Colour colour)
{
    bool torn = system_term_data(pen->system, &fracture);
    if (torn || pen->system->springs <= MAX_GHOST_SPRINGS)
        plot_springs(pen->stage, pen->system, x, 1,
                     (colour & 0xffffff) | 0x50000000u);
    if (!torn)
        square_draw_outline(pen, x, true, colour);
}
