#include "model/neo_hookean.h"

#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "model/area.h"
#include "model/barrier.h"
#include "model/elements.h"
#include "model/mass_spring_energy.h"

static int count(const EvalPoint *at)
{
    return ((const NeoHookean *)at->term->data)->triangles;
}

static int nodes(const EvalPoint *at, int t, int node[3])
{
    const NeoHookean *data = at->term->data;
    memcpy(node, data->node[t], 3 * sizeof *node);
    return 3;
}

/* a = f1, b = f2, s = J. */
static bool get(const EvalPoint *at, int t, double way, Element *element)
{
    const NeoHookean *data = at->term->data;
    (void)way; /* each triangle has a force */
    element->vectors = 2;
    element->nodes = nodes(at, t, element->node);
    element->weight = (const double(*)[3])data->weight[t];
    element->block = t;
    element->factor = at->w;
    element_vectors(element, at->x, element->v);
    element->s = cross(element->v, element->v + 2);
    return true;
}

static double square_of(const double f[4])
{
    return f[0] * f[0] + f[1] * f[1] + f[2] * f[2] + f[3] * f[3];
}

/* dW/dJ over A0, of the terms with J. */
static double slope_in_J(const NeoHookean *data, double J)
{
    return (data->lambda * math_log(J) - data->mu) / J;
}

static double value(const EvalPoint *at, const Element *element)
{
    const NeoHookean *data = at->term->data;
    double L = math_log(element->s);
    return data->area * (0.5 * data->mu * (square_of(element->v) - 2) -
                         data->mu * L + 0.5 * data->lambda * L * L);
}

/* mu F + dW/dJ grad J, grad J = (S f2, -S f1) with S v = (v_y, -v_x). */
static void gradient(const EvalPoint *at, const Element *element, double g[4])
{
    const NeoHookean *data = at->term->data;
    const double *f = element->v;
    double c1 = data->area * slope_in_J(data, element->s);
    double mu = data->area * data->mu;
    g[0] = mu * f[0] + c1 * f[3];
    g[1] = mu * f[1] - c1 * f[2];
    g[2] = mu * f[2] - c1 * f[1];
    g[3] = mu * f[3] + c1 * f[0];
}

static bool hessian(const EvalPoint *at, const Element *element, Filter filter,
                    double H[4][4])
{
    const NeoHookean *data = at->term->data;
    double J = element->s, mu = data->mu;
    double bend = (data->lambda * (1 - math_log(J)) + mu) / (J * J);
    return area_hessian(element->v, 1, data->area * mu,
                        data->area * slope_in_J(data, J), data->area * bend,
                        filter, H);
}

/* With J + alpha J1 + alpha^2 J2 = J (1 + z), and ln(1 + z) less its part of
 * degree 1 in alpha, nothing cancels. */
static double remainder_along(const EvalPoint *at, const Element *element,
                              const double P[4], double alpha)
{
    const NeoHookean *data = at->term->data;
    double J1, J2, J = element->s;
    area_along(element->v, 1, P, &J1, &J2);
    double bent = alpha * alpha * J2 / J, z = alpha * J1 / J + bent;
    if (!(z > -1))
        return INFINITY;
    double L = math_log1p(z), t = log1p_minus(z) + bent;
    return data->area *
           (0.5 * data->mu * alpha * alpha * square_of(P) - data->mu * t +
            0.5 * data->lambda * (2 * math_log(J) * t + L * L));
}

static double reach(const EvalPoint *at, const Element *element,
                    const double P[4])
{
    (void)at;
    return area_reach(element->v, 1, ELEMENT_LIMIT * element->s, P);
}

/* At F = I the Hessian is mu (I - K) + (lambda + mu) (K f)(K f)^T; a node has
 * the weights 1/l of a triangle's height l. */
static void bounds(const EvalPoint *at, double *stiffest, double *force)
{
    const NeoHookean *data = at->term->data;
    double size = 4 * data->mu + 2 * data->lambda;
    bound_raise(stiffest, 2 * size);
    bound_raise(force, size * sqrt(data->area));
}

static const ElementKind triangle = {ELEMENT_FUNCTIONS, .blocks = count,
                                     .reach = reach};

/* The triangle's own f1 and f2: [f1 f2] = [x_b - x_a, x_c - x_a] B with the
 * inverse B of the same at rest. */
static void weigh(const SquareMesh *mesh, const int node[3],
                  double weight[2][3])
{
    double a[2], b[2], c[2];
    square_mesh_place(mesh, node[0], a);
    square_mesh_place(mesh, node[1], b);
    square_mesh_place(mesh, node[2], c);
    const double e1[2] = {b[0] - a[0], b[1] - a[1]};
    const double e2[2] = {c[0] - a[0], c[1] - a[1]};
    double twice = cross(e1, e2);
    for (int m = 0; m < 2; m++) {
        weight[m][1] = (m == 0 ? e2[1] : -e2[0]) / twice;
        weight[m][2] = (m == 0 ? -e1[1] : e1[0]) / twice;
        weight[m][0] = -(weight[m][1] + weight[m][2]);
    }
}

/* Cuts each cell into two triangles.  Their sides stay as springs, which are
 * only drawn; the other diagonal gets k = 0. */
static Status set(System *system, const SquareMesh *mesh, const double *number)
{
    static const int corner[2][2][3] = {{{0, 1, 2}, {0, 2, 3}},
                                        {{0, 1, 3}, {1, 2, 3}}};
    size_t triangles = 2 * (size_t)mesh->cells;
    double young = number[1], nu = number[2];
    NeoHookean *data = system_term(
        system, &neo_hookean_energy,
        sizeof *data + triangles * (sizeof *data->weight + sizeof *data->node));
    if (!data)
        return STATUS_OUT_OF_MEMORY;
    data->mu = young / (2 * (1 + nu));
    data->lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
    if (data->triangles > 0)
        return STATUS_OK;
    data->triangles = (int)triangles;
    data->area = 0.5 * mesh->spacing * mesh->spacing;
    data->weight = (double(*)[2][3])(data + 1);
    data->node = (int(*)[3])(data->weight + triangles);
    for (int c = 0; c < mesh->cells; c++) {
        int node[4], spring[6], odd = square_mesh_is_half(mesh, 4 * c);
        square_mesh_cell(mesh, c, node, spring);
        system->k[spring[odd ? 4 : 5]] = 0;
        for (int t = 2 * c; t < 2 * c + 2; t++) {
            for (int k = 0; k < 3; k++)
                data->node[t][k] = node[corner[odd][t % 2][k]];
            weigh(mesh, data->node[t], data->weight[t]);
        }
    }
    system_remove_term(system, &mass_spring_energy);
    return STATUS_OK;
}

const TermKind neo_hookean_energy = {
    ELEMENTS(triangle),  .name = "triangles", .set = set,
    .energy = "elastic", .bounds = bounds,    .internal = true,
    .end_of_step = true,
};
