/* neo_hookean.c - the neo-Hookean energy of a solid of triangles. */
#include "model/neo_hookean.h"

#include <math.h>

#include "base/mathematics.h"
#include "model/area.h"
#include "model/barrier.h"
#include "model/mass_spring_energy.h"

/* Every triangle is an element, with a = e1, b = e2, s = J. */
static bool neo_hookean_get_element(const EvalPoint *at, int t, double way,
                                    Element *element)
{
    const NeoHookean *data = at->term->data;
    (void)way;
    fill_triangle_element(at, t, element);
    element->s = data->triangles.inverse_J0 * cross(element->v, element->v + 2);
    return true;
}

static double squared_length(const double a[2])
{
    return a[0] * a[0] + a[1] * a[1];
}

/* Returns J - 1 - ln J >= 0, without cancellation near 1. */
static double compute_volume_energy(double J)
{
    return J > 0.5 ? -log1p_minus_z(J - 1) : J - 1 - math_log(J);
}

/* W = A0 (mu (|F-|^2 + J - 1 - ln J) + lambda/2 (ln J)^2) follows from
 * |F|^2 = 2 J + 2 |F-|^2.  Every summand is positive, so none cancel. */
static double neo_hookean_potential(const EvalPoint *at, const Element *element)
{
    const NeoHookean *data = at->term->data;
    double plus[2], minus[2], L = math_log(element->s);
    area_split_edges(element->v, plus, minus);
    double shear = 2 * data->triangles.inverse_J0 * squared_length(minus);
    return data->triangles.rest_area *
           (data->mu * (shear + compute_volume_energy(element->s)) +
            0.5 * data->lambda * L * L);
}

/* Writes the factors of F+ and F- in the stress dW/dF/A0. */
static void compute_stress_factors(const NeoHookean *data, double J,
                                   double *on_plus, double *on_minus)
{
    *on_plus = (data->mu * (J - 1) + data->lambda * math_log(J)) / J;
    *on_minus = 2 * data->mu - *on_plus;
}

/* Writes the gradient by dW/dF/A0 = on_plus F+ + on_minus F-
 * (compute_stress_factors), a form with small rounding (neo_hookean.h). */
static void neo_hookean_gradient(const EvalPoint *at, const Element *element,
                                 double g[4])
{
    double plus[2], minus[2], p, q;
    area_split_edges(element->v, plus, minus);
    compute_stress_factors(at->term->data, element->s, &p, &q);
    g[0] = 0.5 * (p * plus[0] + q * minus[0]);
    g[1] = 0.5 * (p * plus[1] + q * minus[1]);
    g[2] = 0.5 * (q * minus[1] - p * plus[1]);
    g[3] = 0.5 * (p * plus[0] - q * minus[0]);
}

/* Writes the projected Hessian of W in (e1, e2), by its eigenvectors. */
static bool project_hessian(const EvalPoint *at, const Element *element,
                            Projection projection, AreaHessian *area)
{
    const NeoHookean *data = at->term->data;
    double J = element->s, p, q;
    double bend = (data->lambda * (1 - math_log(J)) + data->mu) / (J * J);
    compute_stress_factors(data, J, &p, &q);
    return area_project_hessian(element->v, data->triangles.inverse_J0, 0.5 * p,
                                0.5 * q, data->triangles.rest_area * bend,
                                projection, area);
}

static bool neo_hookean_hessian(const EvalPoint *at, const Element *element,
                                Projection projection, double H[4][4])
{
    AreaHessian area;
    bool changed = project_hessian(at, element, projection, &area);
    area_assemble_hessian(&area, H);
    return changed;
}

static bool neo_hookean_apply_hessian(const EvalPoint *at,
                                      const Element *element,
                                      Projection projection, const double v[4],
                                      double Hv[4])
{
    AreaHessian area;
    bool changed = project_hessian(at, element, projection, &area);
    area_apply_hessian(&area, v, Hv);
    return changed;
}

/* J + alpha J1 + alpha^2 J2 = J (1 + z).  Subtracting the part of degree 1 from
 * ln(1 + z) by log1p_minus_z avoids cancellation. */
static double neo_hookean_taylor_remainder(const EvalPoint *at,
                                           const Element *element,
                                           const double P[4], double alpha)
{
    const NeoHookean *data = at->term->data;
    double J1, J2, plus[2], minus[2], J = element->s,
                                      unit = data->triangles.inverse_J0;
    area_line_polynomial(element->v, unit, P, &J1, &J2);
    area_split_edges(P, plus, minus);
    double bent = alpha * alpha * J2 / J, z = alpha * J1 / J + bent;
    if (!(z > -1))
        return INFINITY;
    double L = math_log1p(z), curved = log1p_minus_z(z), t = curved + bent;
    double straight =
        alpha * alpha * unit / J *
        ((J - 1) * squared_length(plus) + (J + 1) * squared_length(minus));
    return data->triangles.rest_area *
           (data->mu * (straight - curved) +
            0.5 * data->lambda * (2 * math_log(J) * t + L * L));
}

/* Returns a bound of the curvature at rest, F = I, where W/A0 has the Hessian
 * mu (I - K) + (lambda + mu) f f^T in F; K and f are those of area.h. */
static double neo_hookean_max_stiffness(const EvalPoint *at)
{
    const NeoHookean *data = at->term->data;
    return 8 * data->mu + 4 * data->lambda;
}

static const ElementKind triangle = {
    .count_elements = count_triangles,
    .get_element = neo_hookean_get_element,
    .get_block_nodes = get_triangle_block_nodes,
    .potential = neo_hookean_potential,
    .gradient = neo_hookean_gradient,
    .hessian = neo_hookean_hessian,
    .taylor_remainder = neo_hookean_taylor_remainder,
    .count_blocks = count_triangles,
    .max_alpha = triangle_max_alpha,
    .apply_hessian = neo_hookean_apply_hessian,
};

/* Cuts each cell into two triangles, along bd if column + row is odd, else
 * along ac.  Their sides stay springs, which are drawn
 * but have no energy; the diagonal that is no side gets k = 0. */
static Status neo_hookean_configure(System *system, const SquareMesh *mesh,
                                    const double *number)
{
    static const int corner[2][2][3] = {{{1, 2, 0}, {3, 0, 2}},
                                        {{0, 1, 3}, {2, 3, 1}}};
    size_t count = 2 * (size_t)mesh->cells;
    double young = number[1], nu = number[2];
    NeoHookean *data =
        system_add_term(system, &neo_hookean_energy,
                        sizeof *data + count * sizeof *data->triangles.node);
    if (!data)
        return STATUS_OUT_OF_MEMORY;
    data->mu = young / (2 * (1 + nu));
    data->lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
    data->triangles = make_right_triangles((int)count, mesh->spacing, data + 1);
    for (int c = 0; c < mesh->cells; c++) {
        int node[4], spring[6];
        int i = c % (mesh->cells / mesh->bodies);
        int cut_bd = (i / mesh->rows + i % mesh->rows) % 2;
        square_mesh_get_cell(mesh, c, node, spring);
        system->k[spring[cut_bd ? 4 : 5]] = 0;
        for (int t = 2 * c; t < 2 * c + 2; t++)
            for (int k = 0; k < 3; k++)
                data->triangles.node[t][k] = node[corner[cut_bd][t % 2][k]];
    }
    system_remove_term(system, &mass_spring_energy);
    return STATUS_OK;
}

const TermKind neo_hookean_energy = {
    ELEMENTS(triangle),
    .name = "triangles",
    .configure = neo_hookean_configure,
    .energy_name = "elastic",
    .max_stiffness = neo_hookean_max_stiffness,
};
