#include "model/area.h"

#include "base/mathematics.h"

void area_along(const double f[4], double unit, const double P[4], double *J1,
                double *J2)
{
    *J1 = unit * (cross(P, f + 2) + cross(f, P + 2));
    *J2 = unit * cross(P, P + 2);
}

/* most + alpha J1 + alpha^2 J2 = 0 */
double area_reach(const double f[4], double unit, double most,
                  const double P[4])
{
    double J1, J2;
    area_along(f, unit, P, &J1, &J2);
    double discriminant = J1 * J1 - 4 * J2 * most;
    if (!(discriminant >= 0))
        return INFINITY;
    double denominator = -J1 + sqrt(discriminant);
    return denominator > 0 ? 2 * most / denominator : INFINITY;
}

/* v [4] made a unit vector; `instead` where it is 0.  Returns its length. */
static double make_unit(double v[4], const double instead[4])
{
    double length = math_hypot(math_hypot(v[0], v[1]), math_hypot(v[2], v[3]));
    for (int i = 0; i < 4; i++)
        v[i] = length > 0 ? v[i] / length : instead[i];
    return length;
}

/* With g = unit K f: f+ and f- are f's parts in the eigenspaces of K, so the
 * Hessian maps the plane of a = f+/|f+| and b = f-/|f-| to itself, and what
 * lies across, S of their halves, are eigenvectors with on_plus and on_minus.
 * In that plane a 2x2 matrix Q is projected. */
bool area_hessian(const double f[4], double unit, double on_plus,
                  double on_minus, double second, Filter filter, double H[4][4])
{
    static const double any_plus[4] = {0, 0.7071067811865476,
                                       -0.7071067811865476, 0};
    static const double any_minus[4] = {0, 0.7071067811865476,
                                        0.7071067811865476, 0};
    double p[2], m[2];
    area_parts(f, p, m);
    double a[4] = {p[0], p[1], -p[1], p[0]}, b[4] = {m[0], m[1], m[1], -m[0]};
    double plus = unit * make_unit(a, any_plus);
    double minus = unit * make_unit(b, any_minus);
    double Q[3] = {second * plus * plus + on_plus, -second * plus * minus,
                   second * minus * minus + on_minus};
    const double across_a[4] = {a[1], -a[0], a[3], -a[2]};
    const double across_b[4] = {b[1], -b[0], b[3], -b[2]};
    bool changed = filter_2x2(filter, Q);
    if (filter_projects(filter)) {
        changed = changed || on_plus < 0 || on_minus < 0;
        on_plus = projected_eigenvalue(filter, on_plus);
        on_minus = projected_eigenvalue(filter, on_minus);
    }
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            H[r][c] = Q[0] * a[r] * a[c] + Q[2] * b[r] * b[c] +
                      Q[1] * (a[r] * b[c] + b[r] * a[c]) +
                      on_minus * across_b[r] * across_b[c] +
                      on_plus * across_a[r] * across_a[c];
    return changed;
}
