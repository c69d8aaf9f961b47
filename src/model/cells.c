/* cells.c - barrier energy that keeps the cells from turning over. */
#include "model/cells.h"

#include <math.h>

#include "model/area.h"
#include "model/barrier.h"

/* Whether triangle t can have an energy: no spring of it is broken, and its
 * area ratio J may fall below CELL_J_HAT.  The element's vectors are the edges
 * e1, e2 from the first node to the others; s = J = cross(e1, e2)/(2 A0).
 *   way  m, largest change of an edge.  J then changes by at most
 *        way (|e1| + |e2| + way)/(2 A0) */
static bool cell_get_element(const EvalPoint *at, int t, double way,
                             Element *element)
{
    const CellBarriers *cells = at->term->data;
    const double *k = at->system->k;
    const int *node = cells->triangles.node[t], *side = cells->side_springs[t];
    double e[4], unit = cells->triangles.inverse_J0;
    compute_node_differences(at->x, node[1], node[2], node[0], e);
    double sides = fabs(e[0]) + fabs(e[1]) + fabs(e[2]) + fabs(e[3]);
    double J = cross(e, e + 2) / (2 * cells->triangles.rest_area);
    if (J >= CELL_J_HAT + unit * way * (sides + way) ||
        !(k[side[0]] > 0 && k[side[1]] > 0 && k[side[2]] > 0))
        return false;
    fill_triangle_element(at, t, element);
    element->s = J;
    return true;
}

static double cell_potential(const EvalPoint *at, const Element *element)
{
    const CellBarriers *cells = at->term->data;
    return cells->c * barrier_value(element->s / CELL_J_HAT);
}

/* grad J = (S e2, -S e1)/(2 A0) for J = e1 x e2/(2 A0); S v = (v_y, -v_x). */
static void cell_gradient(const EvalPoint *at, const Element *element,
                          double g[4])
{
    const CellBarriers *cells = at->term->data;
    const double *e1 = element->v, *e2 = element->v + 2;
    double factor = cells->c / CELL_J_HAT / (2 * cells->triangles.rest_area) *
                    barrier_slope(element->s / CELL_J_HAT);
    g[0] = factor * e2[1];
    g[1] = -factor * e2[0];
    g[2] = -factor * e1[1];
    g[3] = factor * e1[0];
}

static bool cell_hessian(const EvalPoint *at, const Element *element,
                         Projection projection, double H[4][4])
{
    const CellBarriers *cells = at->term->data;
    double s = element->s / CELL_J_HAT, q = cells->triangles.inverse_J0;
    double slope = cells->c / CELL_J_HAT * barrier_slope(s) * q;
    double bend = cells->c / (CELL_J_HAT * CELL_J_HAT) * barrier_curvature(s);
    AreaHessian area;
    bool changed = area_project_hessian(element->v, q, slope, -slope, bend,
                                        projection, &area);
    area_assemble_hessian(&area, H);
    return changed;
}

static double cell_taylor_remainder(const EvalPoint *at, const Element *element,
                                    const double P[4], double alpha)
{
    const CellBarriers *cells = at->term->data;
    double J1, J2, s = element->s / CELL_J_HAT;
    area_line_polynomial(element->v, cells->triangles.inverse_J0, P, &J1, &J2);
    J1 *= alpha;
    J2 *= alpha * alpha;
    return cells->c * (barrier_slope(s) * J2 / CELL_J_HAT +
                       barrier_taylor_remainder(s, (J1 + J2) / CELL_J_HAT));
}

/* Returns the curvature of W at J = J_hat if e1 and e2 have rest length. */
static double cell_max_stiffness(const EvalPoint *at)
{
    const CellBarriers *cells = at->term->data;
    return 2 * cells->c / CELL_J_HAT / CELL_J_HAT / cells->triangles.rest_area;
}

static const ElementKind triangle = {
    .count_elements = count_triangles,
    .get_element = cell_get_element,
    .get_block_nodes = get_triangle_block_nodes,
    .potential = cell_potential,
    .gradient = cell_gradient,
    .hessian = cell_hessian,
    .taylor_remainder = cell_taylor_remainder,
    .count_blocks = count_triangles,
    .max_alpha = triangle_max_alpha,
};

const TermKind cell_energy = {
    .name = "cells that cannot turn over",
    ELEMENTS(triangle),
    .energy_name = "contact",
    .rank = RANK_CELLS,
    .max_stiffness = cell_max_stiffness,
};

Status cells_configure(System *system, const SquareMesh *shape,
                       double stiffness)
{
    int count = 4 * shape->cells;
    CellBarriers *cells = system_add_term(
        system, &cell_energy,
        sizeof *cells + 2 * (size_t)count * sizeof *cells->side_springs);
    if (!cells)
        return STATUS_OUT_OF_MEMORY;
    Triangles *triangles = &cells->triangles;
    *triangles = make_right_triangles(count, shape->spacing, cells + 1);
    cells->c = triangles->rest_area * stiffness;
    cells->side_springs = triangles->node + count;
    for (int t = 0; t < count; t++)
        square_mesh_get_triangle(shape, t, triangles->node[t],
                                 cells->side_springs[t]);
    return STATUS_OK;
}
