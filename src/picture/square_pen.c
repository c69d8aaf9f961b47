#include "picture/square_pen.h"

#include <math.h>
#include <string.h>

#include "model/fracture.h"
#include "model/plasticity.h"
#include "picture/colour_map.h"
#include "picture/plot.h"
#include "scenes/scene.h"

enum { GHOST_SPRINGS = 700 }; /* of more only the outline is drawn as a ghost */

static const double FLOWN = 10; /* times its side, what explodes fills */
static const double NODE = 0.1; /* of the distance of two nodes */

/* Half of the largest plastic strain, or 5 %. */
static double plastic_range(const System *system, const double *ep)
{
    double largest = 0.1;
    for (int s = 0; s < system->springs; s++)
        largest = fmax(largest, fabs(ep[s]));
    return plot_round_up(0.5 * largest);
}

/* Pixels between two nodes: at rest, or where nodes have flown so far that the
 * rest shape is nothing beside it, of as many over what they fill. */
static double seen_spacing(const SpringPen *pen)
{
    const SquareMesh *mesh = &pen->simulation->mesh;
    double spacing = pen->stage->camera.scale[0] * mesh->spacing;
    double cells = mesh->side / mesh->spacing, reach = 0;
    for (int k = 0; k < 2; k++) {
        double low = INFINITY, high = -INFINITY;
        for (int i = 0; i < pen->system->nodes; i++) {
            double at = pen->at[2 * (size_t)i + k];
            low = isfinite(at) && at < low ? at : low;
            high = isfinite(at) && at > high ? at : high;
        }
        reach = fmax(reach, high - low);
    }
    return reach > FLOWN * spacing * cells ? reach / cells : spacing;
}

/* Sizes and colours, where simulation, run and places are known. */
static void set_looks(SpringPen *pen)
{
    const Show *show = pen->show;
    const Trace *trace = pen->pane->trace;
    double unit = pen->paper->unit;
    pen->spacing = seen_spacing(pen);
    pen->width = fmin(fmax(0.06 * pen->spacing / unit, 1.1), 1.9);
    pen->width = fmax(1, pen->width * unit);
    pen->radius = NODE * pen->spacing;
    if (!show->bare)
        pen->radius = fmin(pen->radius, 6.5 * unit);
    const Plasticity *plasticity = plasticity_of(pen->system);
    pen->contact = contact_of(pen->system);
    pen->ep = plasticity ? plasticity->ep : NULL;
    pen->plastic = !show->strain && !show->bare && pen->ep;
    pen->strain = square_strain_range(pen->simulation);
    pen->range = show->strain   ? pen->strain
                 : pen->plastic ? plastic_range(pen->system, pen->ep)
                                : 0;
    if (pen->range > 0)
        pen->width *= 1.4;
    pen->projected = trace && trace->line >= LINE_PROJECT &&
                     trace->line <= LINE_SEARCH && !show->strain &&
                     pen->simulation->options.filter != FILTER_NONE &&
                     trace->projected != 0;
}

bool square_pens(Plot *stage, const Show *show, SpringPen *pen)
{
    Paper *paper = stage->paper;
    const Pane *pane = &show->pane[stage->pane];
    const Simulation *simulation = pane->simulation;
    int nodes = simulation->system.nodes;
    double *places =
        paper_places(paper, 2 * (size_t)nodes * (size_t)simulation->runs);
    for (int r = 0; r < simulation->runs && places; r++) {
        double *at = places + 2 * (size_t)nodes * (size_t)r;
        pen[r] = (SpringPen){.paper = paper,
                             .stage = stage,
                             .show = show,
                             .pane = pane,
                             .simulation = simulation,
                             .run = r,
                             .system = simulation->run[r].system,
                             .x = r ? simulation->run[r].x : pane_x(pane),
                             .at = at};
        camera_pixels(&stage->camera, nodes, pen[r].x, at);
        set_looks(&pen[r]);
    }
    return places != NULL;
}

/* What springs and faces tell alike: plastic flow, strain, or whether their
 * block is projected, where they are shorter than at rest.  False: nothing. */
static bool told_colour(const SpringPen *pen, double plastic, double strain,
                        bool shorter, Colour *colour)
{
    if (pen->plastic)
        *colour = colour_map_plastic(plastic, pen->range);
    else if (pen->range > 0)
        *colour = colour_map_strain(strain, pen->range);
    else if (pen->projected && shorter)
        *colour = COLOUR_PROJECT;
    else
        return false;
    return true;
}

void square_pen_springs(const SpringPen *pen)
{
    const System *system = pen->system;
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * (size_t)s;
        const double *p = pen->at + 2 * (size_t)e[0];
        const double *q = pen->at + 2 * (size_t)e[1];
        double l2 = system->l2[s], width = pen->width;
        double dx = pen->x[2 * e[0]] - pen->x[2 * e[1]];
        double dy = pen->x[2 * e[0] + 1] - pen->x[2 * e[1] + 1];
        double d2 = dx * dx + dy * dy;
        double strain = pen->range > 0 ? sqrt(d2 / l2) - 1 : 0;
        Colour colour = COLOUR_X;
        if (spring_is_broken(system, s))
            continue;
        if (told_colour(pen, pen->ep ? pen->ep[s] : 0, strain, d2 < l2,
                        &colour) &&
            pen->range == 0)
            width *= 1.15;
        canvas_line(&pen->paper->canvas, p[0], p[1], q[0], q[1], width, colour);
    }
}

/* ---- cells -------------------------------------------------------------- */

/* > 0 if the triangle a b c was not turned over: twice its area, in units in
 * which no product overflows. */
static double turn(const double *x, int a, int b, int c)
{
    const double *p = x + 2 * (size_t)a, *q = x + 2 * (size_t)b,
                 *r = x + 2 * (size_t)c;
    double one[2] = {q[0] - p[0], q[1] - p[1]};
    double other[2] = {r[0] - p[0], r[1] - p[1]};
    double unit = fmax(fabs(one[0]), fabs(one[1]));
    unit = unit > 1e100 ? 1 / unit : 1;
    return unit * one[0] * other[1] - unit * one[1] * other[0];
}

/* A face of four nodes, anticlockwise at rest. */
static bool is_folded(const double *x, const int node[4])
{
    return turn(x, node[0], node[1], node[2]) < 0 ||
           turn(x, node[0], node[2], node[3]) < 0;
}

/* Whether one of a cell's triangles has turned over and all of its springs are
 * there; node [4] out. */
static bool cell_folded(const Simulation *simulation, const double *x, int cell,
                        int node[4])
{
    int spring[6];
    square_mesh_cell(&simulation->mesh, cell, node, spring);
    return is_folded(x, node) &&
           !square_torn(&simulation->system, &simulation->mesh, cell);
}

bool square_torn(const System *system, const SquareMesh *mesh, int cell)
{
    int node[4], spring[6];
    square_mesh_cell(mesh, cell, node, spring);
    for (int k = 0; system->breaks && k < 6; k++)
        if (spring_is_broken(system, spring[k]))
            return true;
    return false;
}

int pane_folded(const Pane *pane)
{
    int folded = 0, node[4];
    for (int c = 0; c < pane->simulation->mesh.cells; c++)
        folded += cell_folded(pane->simulation, pane_x(pane), c, node);
    return folded;
}

static void fill_face(const SpringPen *pen, const int node[4], Colour colour)
{
    double p[8];
    for (int k = 0; k < 8; k++)
        p[k] = pen->at[2 * (size_t)node[k / 2] + k % 2];
    const double half[6] = {p[0], p[1], p[4], p[5], p[6], p[7]};
    canvas_triangle(&pen->paper->canvas, p, false, colour);
    canvas_triangle(&pen->paper->canvas, half, false, colour);
}

int square_pen_cells(const SpringPen *pen, bool all)
{
    const SquareMesh *mesh = &pen->simulation->mesh;
    int count = 0, node[4];
    for (int c = 0; c < mesh->cells; c++) {
        bool folded = cell_folded(pen->simulation, pen->x, c, node);
        count += folded;
        if (folded || (all && !square_torn(pen->system, mesh, c)))
            fill_face(pen, node, folded ? 0x38d00000u : 0x180000ffu);
    }
    return count;
}

/* From dark at 0 over the springs' blue at 1/2 to light at 1. */
static Colour shade(double part)
{
    double dark = fmin(fmax(1 - 2 * part, 0), 1);
    double light = fmin(fmax(2 * part - 1, 0), 1);
    return canvas_mix(canvas_mix(COLOUR_X, COLOUR_FOLDED, 0.75 * dark),
                      COLOUR_WHITE, 0.7 * light);
}

/* A face says what its springs would; else how far it is stretched and turned.
 *   side   m, of the face at rest
 *   cell   in its lower left corner, whose plastic strain counts */
static Colour face_colour(const SpringPen *pen, const int node[4], double side,
                          int cell)
{
    int corner[4], spring[6];
    const double *x = pen->x;
    double l2 = 2 * side * side, plastic = 0, d2[2], turned = 0;
    Colour colour;
    for (int k = 0; k < 2; k++) { /* both diagonals */
        const double *a = x + 2 * (size_t)node[k];
        const double *c = x + 2 * (size_t)node[k + 2];
        double d[2] = {c[0] - a[0], c[1] - a[1]};
        d2[k] = d[0] * d[0] + d[1] * d[1];
        if (k == 0) /* 0 at rest */
            turned = (d[1] - d[0]) / sqrt(d2[k]);
    }
    double strain = (sqrt(d2[0]) + sqrt(d2[1])) / (2 * sqrt(l2)) - 1;
    if (pen->ep)
        square_mesh_cell(&pen->simulation->mesh, cell, corner, spring);
    for (int k = 0; pen->ep && k < 6; k++)
        if (fabs(pen->ep[spring[k]]) > fabs(plastic))
            plastic = pen->ep[spring[k]];
    if (told_colour(pen, plastic, strain, d2[0] < l2 || d2[1] < l2, &colour))
        return colour;
    double seen = copysign(sqrt(fabs(strain) / pen->strain), strain);
    return shade(0.55 + 0.9 * seen + 0.3 * turned);
}

/* The faces that have folded over, or the others; stride: cells in one.
 * Returns how many it has left out. */
static int draw_faces(const SpringPen *pen, int stride, bool folded)
{
    const SquareMesh *mesh = &pen->simulation->mesh;
    int left_out = 0, node[4];
    double side = stride * mesh->spacing;
    for (int cell = 0; cell < mesh->cells; cell++) {
        if (!square_mesh_patch(mesh, cell, stride, node))
            continue;
        if (is_folded(pen->x, node) != folded)
            left_out++;
        else
            fill_face(pen, node,
                      folded ? COLOUR_FOLDED
                             : face_colour(pen, node, side, cell));
    }
    return left_out;
}

void square_pen_faces(const SpringPen *pen)
{
    int cells = pen->simulation->mesh.cells;
    int stride = (int)fmin(fmax(1 / pen->spacing, 1), cells);
    if (draw_faces(pen, stride, false) > 0)
        draw_faces(pen, stride, true);
    square_outline(pen, pen->x, false, COLOUR_X);
}

/* ---- nodes, outlines, ghosts -------------------------------------------- */

void square_pen_nodes(const SpringPen *pen)
{
    const System *system = pen->system;
    double radius = pen->radius;
    Colour colour = pen->range > 0 ? COLOUR_FAINT : COLOUR_X;
    if (pen->range > 0) /* they would hide the colours of a fine mesh */
        radius *= 0.75;
    if (radius >= 0.5 * pen->width)
        for (int i = 0; i < system->nodes; i++)
            canvas_disc(&pen->paper->canvas, pen->at[2 * (size_t)i],
                        pen->at[2 * (size_t)i + 1], radius, colour);
    for (int i = 0; system->pinned && i < system->nodes; i++)
        if (system->pinned[i])
            plot_pin(pen->stage, pen->x + 2 * (size_t)i,
                     radius / pen->paper->unit);
}

void square_outline(const SpringPen *pen, const double *x, bool dashed,
                    Colour colour)
{
    const SquareMesh *mesh = &pen->simulation->mesh;
    double unit = pen->paper->unit, width = fmax(1, 1.4 * unit), phase = 0;
    double p[2], q[2];
    plot_place(pen->stage, x, p);
    for (int k = 1; k <= mesh->outline; k++) {
        plot_place(pen->stage, x + 2 * (size_t)square_mesh_outline(mesh, k), q);
        if (dashed)
            canvas_dashes(&pen->paper->canvas, p[0], p[1], q[0], q[1], width,
                          6 * unit, 4 * unit, &phase, colour);
        else
            canvas_line(&pen->paper->canvas, p[0], p[1], q[0], q[1], width,
                        colour);
        memcpy(p, q, sizeof p);
    }
}

void square_ghost(const SpringPen *pen, const double *x, Colour colour)
{
    const System *system = pen->system;
    Colour faint = (colour & 0xffffff) | 0x50000000u;
    for (int s = 0; system->springs <= GHOST_SPRINGS && s < system->springs;
         s++)
        plot_line(pen->stage, x + 2 * (size_t)system->e[2 * s],
                  x + 2 * (size_t)system->e[2 * s + 1], 1, faint);
    square_outline(pen, x, true, colour);
}
