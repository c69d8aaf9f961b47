#include "picture/square_pen.h"

#include <math.h>
#include <string.h>

#include "model/fracture.h"
#include "model/plasticity.h"
#include "picture/colour_map.h"
#include "picture/plot.h"
#include "picture/square_picture.h"
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
static double seen_spacing(const SpringPen *pen, int nodes,
                           const SquareMesh *mesh)
{
    double cells = mesh->side / mesh->spacing, reach = 0;
    for (int k = 0; pen->at && k < 2; k++) {
        double low = INFINITY, high = -INFINITY;
        for (int i = 0; i < nodes; i++) {
            double at = pen->at[2 * (size_t)i + k];
            low = isfinite(at) && at < low ? at : low;
            high = isfinite(at) && at > high ? at : high;
        }
        reach = fmax(reach, high - low);
    }
    double rest = pen->spacing * cells;
    return reach > FLOWN * rest ? reach / cells : pen->spacing;
}

SpringPen square_pen(Paper *paper, const Stage *stage, const Show *show,
                     int run)
{
    const Pane *pane = &show->pane[stage->pane];
    const Simulation *simulation = pane->simulation;
    const SquareMesh *mesh = &simulation->mesh;
    const Trace *trace = pane->trace;
    SpringPen pen = {.paper = paper, .stage = stage, .pane = pane};
    const System *system = simulation->run[run].system;
    pen.x = run == 0 ? pane_x(pane) : simulation->run[run].x;
    pen.at = paper_places(paper, 2 * (size_t)simulation->system.nodes);
    if (pen.at)
        camera_pixels(&stage->camera, simulation->system.nodes, pen.x, pen.at);
    pen.spacing = stage->camera.scale[0] * mesh->spacing;
    pen.spacing = seen_spacing(&pen, simulation->system.nodes, mesh);
    pen.width = fmin(fmax(0.06 * pen.spacing / paper->unit, 1.1), 1.9);
    pen.width = fmax(1, pen.width * paper->unit);
    const Plasticity *plasticity = plasticity_of(system);
    pen.contact = contact_of(system);
    pen.ep = plasticity ? plasticity->ep : NULL;
    pen.plastic = !show->strain && !show->bare && pen.ep;
    pen.range = show->strain ? square_picture_strain_range(simulation) : 0;
    if (pen.plastic)
        pen.range = plastic_range(system, pen.ep);
    if (pen.range > 0)
        pen.width *= 1.4;
    pen.strain = square_picture_strain_range(simulation);
    pen.projected = trace && trace->line >= LINE_PROJECT &&
                    trace->line <= LINE_SEARCH && !show->strain &&
                    simulation->options.filter != FILTER_NONE &&
                    trace->projected != 0;
    return pen;
}

/* Whether the block of this spring has a negative eigenvalue: it is shorter
 * than at rest. */
static bool spring_projected(const double *a, const double *b, double l2)
{
    double dx = a[0] - b[0], dy = a[1] - b[1];
    return dx * dx + dy * dy < l2;
}

/* The line from node i to node j, l2 their squared distance at rest. */
static void draw_spring(const SpringPen *pen, int i, int j, double l2,
                        double plastic)
{
    const double *a = pen->x + 2 * (size_t)i, *b = pen->x + 2 * (size_t)j;
    Colour colour = COLOUR_X;
    double width = pen->width;
    if (pen->plastic) {
        colour = colour_map_plastic(plastic, pen->range);
    } else if (pen->range > 0) {
        double dx = a[0] - b[0], dy = a[1] - b[1];
        double strain = sqrt((dx * dx + dy * dy) / l2) - 1;
        colour = colour_map_strain(strain, pen->range);
    } else if (pen->projected && spring_projected(a, b, l2)) {
        colour = COLOUR_PROJECT;
        width *= 1.15;
    }
    const double *p = pen->at + 2 * (size_t)i, *q = pen->at + 2 * (size_t)j;
    canvas_line(&pen->paper->canvas, p[0], p[1], q[0], q[1], width, colour);
}

void square_pen_springs(const SpringPen *pen, const System *system)
{
    for (int s = 0; s < system->springs; s++)
        if (!spring_is_broken(system, s))
            draw_spring(pen, system->e[2 * (size_t)s],
                        system->e[2 * (size_t)s + 1], system->l2[s],
                        pen->ep ? pen->ep[s] : 0);
}

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

/* From dark at 0 over the springs' blue at 1/2 to light at 1. */
static Colour shade(double part)
{
    double dark = fmin(fmax(1 - 2 * part, 0), 1);
    double light = fmin(fmax(2 * part - 1, 0), 1);
    return canvas_mix(canvas_mix(COLOUR_X, COLOUR_FOLDED, 0.75 * dark),
                      COLOUR_WHITE, 0.7 * light);
}

/* A face says what its springs would: plastic flow, strain, or which of them
 * are projected; else how far it is stretched and turned.  node [4]
 * anticlockwise, from the lower left. */
static Colour face_colour(const SpringPen *pen, const int node[4], double side,
                          double plastic)
{
    const double *a = pen->x + 2 * (size_t)node[0];
    const double *b = pen->x + 2 * (size_t)node[1];
    const double *c = pen->x + 2 * (size_t)node[2];
    const double *d = pen->x + 2 * (size_t)node[3];
    double one[2] = {c[0] - a[0], c[1] - a[1]};
    double other[2] = {d[0] - b[0], d[1] - b[1]};
    double l2 = 2 * side * side;
    double length = sqrt(one[0] * one[0] + one[1] * one[1]);
    double width = sqrt(other[0] * other[0] + other[1] * other[1]);
    double strain = (length + width) / (2 * sqrt(l2)) - 1;
    if (pen->plastic)
        return colour_map_plastic(plastic, pen->range);
    if (pen->range > 0)
        return colour_map_strain(strain, pen->range);
    if (pen->projected &&
        (spring_projected(a, c, l2) || spring_projected(b, d, l2)))
        return COLOUR_PROJECT;
    double seen = copysign(sqrt(fabs(strain) / pen->strain), strain);
    double turned = (one[1] - one[0]) / length; /* 0 at rest */
    return shade(0.55 + 0.9 * seen + 0.3 * turned);
}

/* The largest plastic strain of a cell's springs; 0 where none flows. */
static double cell_plastic(const SpringPen *pen, const SquareMesh *mesh,
                           int cell)
{
    int node[4], spring[6];
    double most = 0;
    square_mesh_cell(mesh, cell, node, spring);
    for (int k = 0; pen->ep && k < 6; k++)
        if (fabs(pen->ep[spring[k]]) > fabs(most))
            most = pen->ep[spring[k]];
    return most;
}

/* The faces that have folded over, or the others; stride: cells in one.
 * Returns how many it has left out. */
static int draw_faces(const SpringPen *pen, const SquareMesh *mesh, int stride,
                      bool folded)
{
    int left_out = 0;
    double side = stride * mesh->spacing;
    for (int cell = 0; cell < mesh->cells; cell++) {
        int node[4];
        double p[8];
        if (!square_mesh_patch(mesh, cell, stride, node))
            continue;
        if (is_folded(pen->x, node) != folded) {
            left_out++;
            continue;
        }
        Colour colour = COLOUR_FOLDED;
        if (!folded)
            colour =
                face_colour(pen, node, side, cell_plastic(pen, mesh, cell));
        for (int k = 0; k < 8; k++)
            p[k] = pen->at[2 * (size_t)node[k / 2] + k % 2];
        const double half[6] = {p[0], p[1], p[4], p[5], p[6], p[7]};
        canvas_triangle(&pen->paper->canvas, p, false, colour);
        canvas_triangle(&pen->paper->canvas, half, false, colour);
    }
    return left_out;
}

void square_pen_faces(const SpringPen *pen, const SquareMesh *mesh)
{
    int stride = (int)fmin(fmax(1 / pen->spacing, 1), mesh->cells);
    if (draw_faces(pen, mesh, stride, false) > 0)
        draw_faces(pen, mesh, stride, true);
    square_outline(pen->paper, pen->stage, mesh, pen->x, false, COLOUR_X);
}

double square_pen_radius(const SpringPen *pen, bool bare)
{
    double radius = NODE * pen->spacing;
    return bare ? radius : fmin(radius, 6.5 * pen->paper->unit);
}

void square_pen_nodes(const SpringPen *pen, const System *system, bool bare)
{
    double radius = square_pen_radius(pen, bare);
    Colour colour = pen->range > 0 ? COLOUR_FAINT : COLOUR_X;
    if (pen->range > 0) /* they would hide the colours of a fine mesh */
        radius *= 0.75;
    if (radius >= 0.5 * pen->width)
        for (int i = 0; i < system->nodes; i++)
            canvas_disc(&pen->paper->canvas, pen->at[2 * (size_t)i],
                        pen->at[2 * (size_t)i + 1], radius, colour);
    for (int i = 0; system->pinned && i < system->nodes; i++)
        if (system->pinned[i])
            stage_pin(pen->paper, pen->stage, pen->x + 2 * (size_t)i, radius);
}

/* ---- outlines, ghosts, cells -------------------------------------------- */

void square_outline(Paper *paper, const Stage *stage, const SquareMesh *mesh,
                    const double *x, bool dashed, Colour colour)
{
    double phase = 0, unit = paper->unit;
    for (int k = 0; k < mesh->outline; k++) {
        const double *a = x + 2 * (size_t)square_mesh_outline(mesh, k);
        const double *b = x + 2 * (size_t)square_mesh_outline(mesh, k + 1);
        double p[2], q[2];
        stage_pixel(stage, a, p);
        stage_pixel(stage, b, q);
        if (dashed)
            canvas_dashes(&paper->canvas, p[0], p[1], q[0], q[1],
                          fmax(1, 1.4 * unit), 6 * unit, 4 * unit, &phase,
                          colour);
        else
            canvas_line(&paper->canvas, p[0], p[1], q[0], q[1],
                        fmax(1, 1.4 * unit), colour);
    }
}

void square_ghost(Paper *paper, const Stage *stage,
                  const Simulation *simulation, const double *x, Colour colour)
{
    const System *system = &simulation->system;
    Colour faint = (colour & 0xffffff) | 0x50000000u;
    for (int s = 0; system->springs <= GHOST_SPRINGS && s < system->springs;
         s++)
        stage_line(paper, stage, x + 2 * (size_t)system->e[2 * s],
                   x + 2 * (size_t)system->e[2 * s + 1], 1, faint);
    square_outline(paper, stage, &simulation->mesh, x, true, colour);
}

bool square_picture_torn(const System *system, const SquareMesh *mesh, int cell)
{
    int node[4], spring[6];
    square_mesh_cell(mesh, cell, node, spring);
    for (int k = 0; system->breaks && k < 6; k++)
        if (spring_is_broken(system, spring[k]))
            return true;
    return false;
}

bool square_picture_folded(const SquareMesh *mesh, const double *x, int cell)
{
    int node[4], spring[6];
    square_mesh_cell(mesh, cell, node, spring);
    return is_folded(x, node);
}

int square_pen_cells(const SpringPen *pen, const Simulation *simulation,
                     bool all)
{
    int count = 0;
    const SquareMesh *mesh = &simulation->mesh;
    for (int cell = 0; cell < mesh->cells; cell++) {
        int node[4], spring[6];
        square_mesh_cell(mesh, cell, node, spring);
        bool folded = square_picture_folded(mesh, pen->x, cell);
        double p[4][2];
        if ((!folded && !all) ||
            square_picture_torn(&simulation->system, mesh, cell))
            continue;
        count += folded;
        for (int k = 0; k < 4; k++)
            stage_pixel(pen->stage, pen->x + 2 * (size_t)node[k], p[k]);
        for (int k = 0; k < 2; k++) {
            const double corners[6] = {p[0][0],     p[0][1],     p[1 + k][0],
                                       p[1 + k][1], p[2 + k][0], p[2 + k][1]};
            canvas_triangle(&pen->paper->canvas, corners, false,
                            folded ? 0x38d00000u : 0x180000ffu);
        }
    }
    return count;
}
