/* area.c - energies that depend on the area of a triangle. */
#include "model/area.h"

#include <string.h>

#include "base/mathematics.h"

void area_line_polynomial(const double f[4], double unit, const double P[4],
                          double *J1, double *J2)
{
    *J1 = unit * (cross(P, f + 2) + cross(f, P + 2));
    *J2 = unit * cross(P, P + 2);
}

int count_triangles(const EvalPoint *at)
{
    return ((const Triangles *)at->term->data)->count;
}

int get_triangle_block_nodes(const EvalPoint *at, int t, int node[3])
{
    const Triangles *triangles = at->term->data;
    memcpy(node, triangles->node[t], 3 * sizeof *node);
    return 3;
}

void fill_triangle_element(const EvalPoint *at, int t, Element *element)
{
    static const double edges[2][3] = {{-1, 1, 0}, {-1, 0, 1}};
    element->vector_count = 2;
    element->node_count = get_triangle_block_nodes(at, t, element->node);
    element->node_weight = edges;
    element->block_index = t;
    element->derivative_factor = at->weight;
    const int *node = element->node;
    compute_node_differences(at->x, node[1], node[2], node[0], element->v);
}

/* Solves s + alpha J1 + alpha^2 J2 = (1 - ELEMENT_LIMIT) s for alpha > 0. */
double triangle_max_alpha(const EvalPoint *at, const Element *element,
                          const double P[4])
{
    const Triangles *triangles = at->term->data;
    double J1, J2, most = ELEMENT_LIMIT * element->s;
    area_line_polynomial(element->v, triangles->inverse_J0, P, &J1, &J2);
    double discriminant = J1 * J1 - 4 * J2 * most;
    if (!(discriminant >= 0))
        return INFINITY;
    double denominator = -J1 + sqrt(discriminant);
    return denominator > 0 ? 2 * most / denominator : INFINITY;
}

/* Divides v [4] by its length, which is returned; v = 0 becomes `instead`. */
static double normalise(double v[4], const double instead[4])
{
    double length = math_hypot(math_hypot(v[0], v[1]), math_hypot(v[2], v[3]));
    for (int i = 0; i < 4; i++)
        v[i] = length > 0 ? v[i] / length : instead[i];
    return length;
}

/* a and b are the unit vectors of the parts f+ and f- of f (area_split_edges).
 * K f lies in their plane, so H maps this plane to itself, and its 2x2 matrix Q
 * is projected.  The other two eigenvectors are a and b with each pair (v_x,
 * v_y) replaced by (v_y, -v_x); their eigenvalues are on_plus and on_minus. */
bool area_project_hessian(const double f[4], double unit, double on_plus,
                          double on_minus, double second, Projection projection,
                          AreaHessian *area)
{
    static const double any_plus[4] = {0, 0.7071067811865476,
                                       -0.7071067811865476, 0};
    static const double any_minus[4] = {0, 0.7071067811865476,
                                        0.7071067811865476, 0};
    double p[2], m[2], *a = area->a, *b = area->b, *Q = area->Q;
    area_split_edges(f, p, m);
    for (int i = 0; i < 4; i++) {
        a[i] = (i == 2 ? -1 : 1) * p[i == 1 || i == 2];
        b[i] = (i == 3 ? -1 : 1) * m[i == 1 || i == 2];
    }
    double plus = unit * normalise(a, any_plus);
    double minus = unit * normalise(b, any_minus);
    Q[0] = second * plus * plus + on_plus;
    Q[1] = -second * plus * minus;
    Q[2] = second * minus * minus + on_minus;
    for (int i = 0; i < 4; i++) {
        area->across_a[i] = i % 2 ? -a[i - 1] : a[i + 1];
        area->across_b[i] = i % 2 ? -b[i - 1] : b[i + 1];
    }
    area->lambda_a = on_plus;
    area->lambda_b = on_minus;
    bool changed = project_psd_2x2(projection, Q);
    if (!projects_blocks(projection))
        return changed;
    area->lambda_a = project_eigenvalue(projection, on_plus);
    area->lambda_b = project_eigenvalue(projection, on_minus);
    return changed || on_plus < 0 || on_minus < 0;
}

void area_assemble_hessian(const AreaHessian *area, double H[4][4])
{
    const double *a = area->a, *b = area->b, *Q = area->Q;
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            H[r][c] = Q[0] * a[r] * a[c] + Q[2] * b[r] * b[c] +
                      Q[1] * (a[r] * b[c] + b[r] * a[c]) +
                      area->lambda_b * area->across_b[r] * area->across_b[c] +
                      area->lambda_a * area->across_a[r] * area->across_a[c];
}

static double dot4(const double a[4], const double b[4])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

void area_apply_hessian(const AreaHessian *area, const double v[4],
                        double Hv[4])
{
    const double *Q = area->Q;
    double on_a = dot4(area->a, v), on_b = dot4(area->b, v);
    double along_a = Q[0] * on_a + Q[1] * on_b;
    double along_b = Q[1] * on_a + Q[2] * on_b;
    double across_a = area->lambda_a * dot4(area->across_a, v);
    double across_b = area->lambda_b * dot4(area->across_b, v);
    for (int i = 0; i < 4; i++)
        Hv[i] = along_a * area->a[i] + along_b * area->b[i] +
                across_a * area->across_a[i] + across_b * area->across_b[i];
}
