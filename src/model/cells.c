#include "model/cells.h"

#include <math.h>
#include <stdlib.h>

#include "base/mathematics.h"
#include "model/barrier.h"
#include "model/contact.h"

static double cross(const double a[2], const double b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

Corner cell_corner(const double *x_a, const double *x_b, const double *x_c,
                   double area, double c)
{
    Corner corner = {{x_b[0] - x_a[0], x_b[1] - x_a[1]},
                     {x_c[0] - x_a[0], x_c[1] - x_a[1]},
                     area,
                     c,
                     0};
    corner.J = cross(corner.e1, corner.e2) / (2 * area);
    return corner;
}

/* W, J. */
static double cell_value(const Corner *corner)
{
    return corner->c * barrier_value(corner->J / CELL_J_HAT);
}

/* grad J in e1 and e2 is (S e2, -S e1)/(2 A0) with S v = (v_y, -v_x). */
static void cell_gradient(const Corner *corner, double g[6])
{
    double factor = corner->c / CELL_J_HAT / (2 * corner->area) *
                    barrier_slope(corner->J / CELL_J_HAT);
    g[2] = factor * corner->e2[1];
    g[3] = -factor * corner->e2[0];
    g[4] = -factor * corner->e1[1];
    g[5] = factor * corner->e1[0];
    g[0] = -(g[2] + g[4]);
    g[1] = -(g[3] + g[5]);
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
static void add_square(double w, const double v[4], double H[16])
{
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            H[4 * r + c] += w * v[r] * v[c];
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
static bool edge_hessian(const Corner *corner, Filter filter, double H[16])
{
    static const double any_plus[4] = {0, 0.7071067811865476,
                                       -0.7071067811865476, 0};
    static const double any_minus[4] = {0, 0.7071067811865476,
                                        0.7071067811865476, 0};
    const double *e1 = corner->e1, *e2 = corner->e2;
    double s = corner->J / CELL_J_HAT, q = 1 / (2 * corner->area);
    double c1 = corner->c / CELL_J_HAT * barrier_slope(s) * q;
    double c2 = corner->c / (CELL_J_HAT * CELL_J_HAT) * barrier_curvature(s);
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
        H[i] = 0;
    add_square(Q[0], a, H);
    add_square(Q[2], b, H);
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            H[4 * r + c] += Q[1] * (a[r] * b[c] + b[r] * a[c]);
    turn(b, across);
    add_square(-c1, across, H);
    if (filter == FILTER_CLAMP)
        return c1 < 0;
    turn(a, across);
    add_square(filter == FILTER_ABS ? -c1 : c1, across, H);
    return filter == FILTER_ABS && c1 < 0;
}

/* H [6][6] in x_a, x_b, x_c.  Rows and columns of a are minus the sums of the
 * others': a common motion changes nothing. */
static bool cell_hessian(const Corner *corner, Filter filter, double H[6][6])
{
    double E[16];
    bool changed = edge_hessian(corner, filter, E);
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            H[2 + r][2 + c] = E[4 * r + c];
    for (int r = 0; r < 2; r++)
        for (int c = 2; c < 6; c++)
            H[r][c] = H[c][r] = -(H[2 + r][c] + H[4 + r][c]);
    for (int r = 0; r < 2; r++)
        for (int c = 0; c < 2; c++)
            H[r][c] = -(H[r][2 + c] + H[r][4 + c]);
    return changed;
}

/* Along a step with the edges P1, P2 J becomes J + J1 + J2. */
static void cell_along(const Corner *corner, const double P1[2],
                       const double P2[2], double *J1, double *J2)
{
    double q = 1 / (2 * corner->area);
    *J1 = q * (cross(P1, corner->e2) + cross(corner->e1, P2));
    *J2 = q * cross(P1, P2);
}

/* J + alpha J1 + alpha^2 J2 = (1-F) J */
static double cell_reach(double J, double J1, double J2)
{
    double c0 = CONTACT_LIMIT * J, discriminant = J1 * J1 - 4 * J2 * c0;
    if (!(discriminant >= 0))
        return INFINITY;
    double denominator = -J1 + sqrt(discriminant);
    return denominator > 0 ? 2 * c0 / denominator : INFINITY;
}

/* W after the step minus W minus grad W.step, J, without cancellation. */
static double cell_remainder(const Corner *corner, double J1, double J2)
{
    double s = corner->J / CELL_J_HAT;
    return corner->c * (barrier_slope(s) * J2 / CELL_J_HAT +
                        barrier_remainder(s, (J1 + J2) / CELL_J_HAT));
}

/* ---- the term -------------------------------------------------------- */

/* Whether a triangle still has its three springs. */
static bool is_whole(const Cells *cells, const System *system, int t)
{
    const int *s = cells->spring + 3 * t;
    return system->k[s[0]] > 0 && system->k[s[1]] > 0 && system->k[s[2]] > 0;
}

static Corner corner_at(const Cells *cells, const double *x, int t)
{
    const int *node = cells->node + 3 * t;
    return cell_corner(x + 2 * node[0], x + 2 * node[1], x + 2 * node[2],
                       cells->area, cells->c);
}

/* The next whole triangle after *t, which starts at -1, below J_hat at x. */
static bool next_squeezed(const Cells *cells, const Place *at, int *t,
                          Corner *corner)
{
    while (++*t < cells->triangles) {
        *corner = corner_at(cells, at->x, *t);
        if (corner->J < CELL_J_HAT && is_whole(cells, at->system, *t))
            return true;
    }
    return false;
}

static bool valid(const Place *at)
{
    const Cells *cells = at->term->data;
    return isfinite(cells->area) && cells->area > 0 && isfinite(cells->c) &&
           cells->c > 0;
}

static double value(const Place *at)
{
    const Cells *cells = at->term->data;
    double sum = 0;
    Corner corner;
    for (int t = -1; next_squeezed(cells, at, &t, &corner);)
        sum += cell_value(&corner);
    return sum;
}

static void gradient(const Place *at, double *g)
{
    const Cells *cells = at->term->data;
    Corner corner;
    for (int t = -1; next_squeezed(cells, at, &t, &corner);) {
        double own[6];
        cell_gradient(&corner, own);
        for (int k = 0; k < 6; k++)
            g[2 * cells->node[3 * t + k / 2] + k % 2] += at->w * own[k];
    }
}

/* The blocks of a triangle that stand in the matrix, by corners: three of three
 * entries, three of four. */
enum { BLOCKS = 6, CELL_ENTRIES = 21 };
static const int block[BLOCKS][2] = {{0, 0}, {1, 1}, {2, 2},
                                     {0, 1}, {0, 2}, {1, 2}};

static long long entries(const Place *at)
{
    const Cells *cells = at->term->data;
    return (long long)CELL_ENTRIES * cells->triangles;
}

static void pattern(const Place *at, Triplets *triplets)
{
    const Cells *cells = at->term->data;
    for (int t = 0; t < cells->triangles; t++)
        for (int b = 0; b < BLOCKS; b++)
            term_add_block(at->system, cells->node[3 * t + block[b][0]],
                           cells->node[3 * t + block[b][1]], triplets);
}

/* w H through the slots of a triangle. */
static void add_entries(double w, double H[6][6], const int *slot, double *out)
{
    for (int b = 0; b < BLOCKS; b++) {
        int i = 2 * block[b][0], j = 2 * block[b][1];
        for (int r = 0; r < 2; r++)
            for (int c = i == j ? r : 0; c < 2; c++)
                out[*slot++] += w * H[i + r][j + c];
    }
}

static int hessian(const Place *at, Filter filter, const int *slot,
                   const double *q, double *out)
{
    const Cells *cells = at->term->data;
    int projected = 0;
    Corner corner;
    for (int t = -1; next_squeezed(cells, at, &t, &corner);) {
        const int *node = cells->node + 3 * t;
        double H[6][6];
        projected += cell_hessian(&corner, filter, H);
        if (!q)
            add_entries(at->w, H, slot + CELL_ENTRIES * t, out);
        for (int k = 0; q && k < 36; k++) {
            int r = k / 6, c = k % 6;
            out[2 * node[r / 2] + r % 2] +=
                at->w * H[r][c] * q[2 * node[c / 2] + c % 2];
        }
    }
    return projected;
}

/* J1 and J2 of a triangle for the step p. */
static void motion(const Cells *cells, const Corner *corner, const double *p,
                   int t, double *J1, double *J2)
{
    const int *node = cells->node + 3 * t;
    const double *a = p + 2 * node[0], *b = p + 2 * node[1];
    const double *c = p + 2 * node[2];
    cell_along(corner, (double[2]){b[0] - a[0], b[1] - a[1]},
               (double[2]){c[0] - a[0], c[1] - a[1]}, J1, J2);
}

static double reach(const Place *at, const double *p)
{
    const Cells *cells = at->term->data;
    double smallest = INFINITY, J1, J2;
    for (int t = 0; t < cells->triangles; t++) {
        Corner corner = corner_at(cells, at->x, t);
        motion(cells, &corner, p, t, &J1, &J2);
        double alpha = cell_reach(corner.J, J1, J2);
        if (alpha < smallest && is_whole(cells, at->system, t))
            smallest = alpha;
    }
    return smallest;
}

static double remainder_along(const Place *at, const double *p, double alpha)
{
    const Cells *cells = at->term->data;
    double sum = 0, J1, J2;
    for (int t = 0; t < cells->triangles; t++) {
        Corner corner = corner_at(cells, at->x, t);
        motion(cells, &corner, p, t, &J1, &J2);
        double rest = cell_remainder(&corner, alpha * J1, alpha * alpha * J2);
        if (rest != 0 && is_whole(cells, at->system, t))
            sum += rest;
    }
    return at->w * sum;
}

static bool allowed(const Place *at)
{
    const Cells *cells = at->term->data;
    for (int t = 0; t < cells->triangles; t++)
        if (!(corner_at(cells, at->x, t).J > 0) &&
            is_whole(cells, at->system, t))
            return false;
    return true;
}

/* The curvature where the barrier begins, and the force there if it went on
 * without bending: both by g = K e with sides of the rest length. */
static void bounds(const Place *at, double *stiffest, double *force)
{
    const Cells *cells = at->term->data;
    double c = 2 * cells->c / CELL_J_HAT;
    *stiffest = fmax(*stiffest, c / CELL_J_HAT / cells->area);
    *force = fmax(*force, c / sqrt(cells->area));
}

/* Along e = (x_b - x_a, x_c - x_a) the lower eigenvalue is c1 q (edge_hessian),
 * and |e|^2 <= 4 |x_a|^2 + 2 |x_b|^2 + 2 |x_c|^2. */
static void concave(const Place *at, double *sum)
{
    const Cells *cells = at->term->data;
    Corner corner;
    for (int t = -1; next_squeezed(cells, at, &t, &corner);) {
        const int *node = cells->node + 3 * t;
        double down = -at->w * cells->c / CELL_J_HAT / cells->area *
                      barrier_slope(corner.J / CELL_J_HAT);
        sum[node[0]] += 2 * down;
        sum[node[1]] += down;
        sum[node[2]] += down;
    }
}

const TermKind cell_energy = {
    .energy = "contact",
    .valid = valid,
    .value = value,
    .gradient = gradient,
    .entries = entries,
    .pattern = pattern,
    .hessian = hessian,
    .remainder = remainder_along,
    .reach = reach,
    .allowed = allowed,
    .bounds = bounds,
    .concave = concave,
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
