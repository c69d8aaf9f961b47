#include "model/cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "model/barrier.h"
#include "model/elements.h"

static double cross(const double a[2], const double b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

static const Cells *cells_of(const Place *at)
{
    return at->term->data;
}

static int count(const Place *at)
{
    return cells_of(at)->triangles;
}

static int nodes(const Place *at, int t, int node[3])
{
    for (int k = 0; k < 3; k++)
        node[k] = cells_of(at)->node[3 * t + k];
    return 3;
}

/* Whether a triangle still has its three springs. */
static bool is_whole(const Place *at, int t)
{
    const int *s = cells_of(at)->spring + 3 * t;
    const double *k = at->system->k;
    return !at->system->breaks || (k[s[0]] > 0 && k[s[1]] > 0 && k[s[2]] > 0);
}

/* a = e1, b = e2, s = J, which a way changes by q way (|e1| + |e2| + way) at
 * most, q = 1/(2 A0). */
static bool get(const Place *at, int t, double way, Element *element)
{
    static const double edges[2][3] = {{-1, 1, 0}, {-1, 0, 1}};
    const Cells *cells = cells_of(at);
    const double *x_a = at->x + 2 * cells->node[3 * t];
    const double *x_b = at->x + 2 * cells->node[3 * t + 1];
    const double *x_c = at->x + 2 * cells->node[3 * t + 2];
    const double e[4] = {x_b[0] - x_a[0], x_b[1] - x_a[1], x_c[0] - x_a[0],
                         x_c[1] - x_a[1]};
    double sides = fabs(e[0]) + fabs(e[1]) + fabs(e[2]) + fabs(e[3]);
    double q = 1 / (2 * cells->area), J = cross(e, e + 2) / (2 * cells->area);
    if (J >= CELL_J_HAT + q * way * (sides + way) || !is_whole(at, t))
        return false;
    element->vectors = 2;
    element->nodes = nodes(at, t, element->node);
    element->weight = edges;
    element->block = t;
    element->factor = at->w;
    element->s = J;
    memcpy(element->v, e, sizeof e);
    return true;
}

static double cell_value(const Place *at, const Element *element)
{
    return cells_of(at)->c * barrier_value(element->s / CELL_J_HAT);
}

/* grad J in e1 and e2 is (S e2, -S e1)/(2 A0) with S v = (v_y, -v_x). */
static void cell_gradient(const Place *at, const Element *element, double g[4])
{
    const double *e1 = element->v, *e2 = element->v + 2;
    double factor = cells_of(at)->c / CELL_J_HAT / (2 * cells_of(at)->area) *
                    barrier_slope(element->s / CELL_J_HAT);
    g[0] = factor * e2[1];
    g[1] = -factor * e2[0];
    g[2] = -factor * e1[1];
    g[3] = factor * e1[0];
}

/* v [4] made a unit vector; `instead` where it is 0.  Returns its length. */
static double make_unit(double v[4], const double instead[4])
{
    double length = math_hypot(math_hypot(v[0], v[1]), math_hypot(v[2], v[3]));
    for (int i = 0; i < 4; i++)
        v[i] = length > 0 ? v[i] / length : instead[i];
    return length;
}

/* H += w v v^T, all of it. */
static void add_square(double w, const double v[4], double H[4][4])
{
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            H[r][c] += w * v[r] * v[c];
}

/* (S v_1, S v_2): turned by a quarter, in the same eigenspace of K. */
static void turn(const double v[4], double turned[4])
{
    turned[0] = v[1];
    turned[1] = -v[0];
    turned[2] = v[3];
    turned[3] = -v[2];
}

/* The Hessian in e = (e1, e2): c2 g g^T + c1 K, where K = q [[0, S], [-S, 0]]
 * is the Hessian of J, q = 1/(2 A0) and g = K e.  K has the eigenvalues q and
 * -q, twice each; e+ and e- are e's parts in their spaces and
 * g = q (e+ - e-).  So H maps the plane of a = e+/|e+| and b = e-/|e-| to
 * itself, and what lies across, a' and b', are eigenvectors with c1 q < 0 and
 * -c1 q > 0.  Only the 2x2 matrix Q in that plane has to be projected. */
static bool edge_hessian(const Place *at, const Element *element, Filter filter,
                         double H[4][4])
{
    static const double any_plus[4] = {0, 0.7071067811865476,
                                       -0.7071067811865476, 0};
    static const double any_minus[4] = {0, 0.7071067811865476,
                                        0.7071067811865476, 0};
    const double *e1 = element->v, *e2 = element->v + 2;
    double s = element->s / CELL_J_HAT, q = 1 / (2 * cells_of(at)->area);
    double c1 = cells_of(at)->c / CELL_J_HAT * barrier_slope(s) * q;
    double c2 =
        cells_of(at)->c / (CELL_J_HAT * CELL_J_HAT) * barrier_curvature(s);
    double a[4] = {0.5 * (e1[0] + e2[1]), 0.5 * (e1[1] - e2[0]),
                   0.5 * (e2[0] - e1[1]), 0.5 * (e2[1] + e1[0])};
    double b[4] = {0.5 * (e1[0] - e2[1]), 0.5 * (e1[1] + e2[0]),
                   0.5 * (e2[0] + e1[1]), 0.5 * (e2[1] - e1[0])};
    double plus = q * make_unit(a, any_plus);
    double minus = q * make_unit(b, any_minus), across[4];
    double Q[3] = {c2 * plus * plus + c1, -c2 * plus * minus,
                   c2 * minus * minus - c1};
    filter_2x2(filter, Q);
    for (int i = 0; i < 16; i++)
        H[i / 4][i % 4] = 0;
    add_square(Q[0], a, H);
    add_square(Q[2], b, H);
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            H[r][c] += Q[1] * (a[r] * b[c] + b[r] * a[c]);
    turn(b, across);
    add_square(-c1, across, H);
    if (filter == FILTER_CLAMP)
        return c1 < 0;
    turn(a, across);
    add_square(filter == FILTER_ABS ? -c1 : c1, across, H);
    return filter == FILTER_ABS && c1 < 0;
}

/* Along P J becomes J + alpha J1 + alpha^2 J2. */
static void cell_along(const Place *at, const Element *element,
                       const double P[4], double *J1, double *J2)
{
    double q = 1 / (2 * cells_of(at)->area);
    *J1 = q * (cross(P, element->v + 2) + cross(element->v, P + 2));
    *J2 = q * cross(P, P + 2);
}

/* J + alpha J1 + alpha^2 J2 = (1-F) J */
static double cell_reach(const Place *at, const Element *element,
                         const double P[4])
{
    double J1, J2, c0 = ELEMENT_LIMIT * element->s;
    cell_along(at, element, P, &J1, &J2);
    double discriminant = J1 * J1 - 4 * J2 * c0;
    if (!(discriminant >= 0))
        return INFINITY;
    double denominator = -J1 + sqrt(discriminant);
    return denominator > 0 ? 2 * c0 / denominator : INFINITY;
}

static double remainder_along(const Place *at, const Element *element,
                              const double P[4], double alpha)
{
    double J1, J2, s = element->s / CELL_J_HAT;
    cell_along(at, element, P, &J1, &J2);
    J1 *= alpha;
    J2 *= alpha * alpha;
    return cells_of(at)->c * (barrier_slope(s) * J2 / CELL_J_HAT +
                              barrier_remainder(s, (J1 + J2) / CELL_J_HAT));
}

/* The lower eigenvalue across is c1 q (edge_hessian). */
static double concave(const Place *at, const Element *element)
{
    const Cells *cells = cells_of(at);
    return -at->w * cells->c / CELL_J_HAT / (2 * cells->area) *
           barrier_slope(element->s / CELL_J_HAT);
}

/* The curvature where the barrier begins, and the force there if it went on
 * without bending: both by g = K e with sides of the rest length. */
static void bounds(const Place *at, double *stiffest, double *force)
{
    const Cells *cells = cells_of(at);
    double c = 2 * cells->c / CELL_J_HAT;
    bound_raise(stiffest, c / CELL_J_HAT / cells->area);
    bound_raise(force, c / sqrt(cells->area));
}

static const ElementKind triangle = {.count = count,
                                     .get = get,
                                     .blocks = count,
                                     .nodes = nodes,
                                     .value = cell_value,
                                     .gradient = cell_gradient,
                                     .hessian = edge_hessian,
                                     .remainder = remainder_along,
                                     .reach = cell_reach,
                                     .concave = concave};

const TermKind cell_energy = {
    .name = "cells that cannot turn over",
    ELEMENTS(triangle),
    .energy = "contact",
    .place = PLACE_CELLS,
    .bounds = bounds,
    .internal = true,
    .end_of_step = true,
};

Status cells_add(System *system, const SquareMesh *shape, double stiffness)
{
    size_t numbers = 3 * 4 * (size_t)shape->cells;
    Cells *cells = calloc(1, sizeof *cells + 2 * numbers * sizeof(int));
    if (!cells)
        return STATUS_OUT_OF_MEMORY;
    cells->triangles = 4 * shape->cells;
    cells->area = 0.5 * shape->spacing * shape->spacing;
    cells->c = cells->area * stiffness;
    cells->node = (int *)(cells + 1);
    cells->spring = cells->node + numbers;
    for (int t = 0; t < cells->triangles; t++)
        square_mesh_triangle(shape, t, cells->node + 3 * t,
                             cells->spring + 3 * t);
    return system_add_term(system, &cell_energy, cells);
}
