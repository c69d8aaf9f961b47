/* area.h - energies that depend on the area of a triangle.
 *
 * The edges f1 and f2 of a triangle span a parallelogram of area J = f1 x f2.
 * With f = (f1, f2), a vector of four numbers, the gradient of J is K f.  The
 * matrix K = [[0, S], [-S, 0]], where S v = (v_y, -v_x), is the Hessian of J.
 * K has the eigenvalues 1 and -1, twice each (Smith et al.: Stable Neo-Hookean
 * Flesh Simulation, 2018).
 *
 * `unit` below is a factor that makes J relative: unit J is 1 at rest. */
#pragma once

#include "model/elements.h"

static inline double cross(const double a[2], const double b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

/* Splits f = f+ + f- into its parts in the eigenspaces of K for 1 and -1:
 *   f+ = (a0, a1, -a1, a0), a rotation times a number; a = plus [2], out
 *   f- = (b0, b1, b1, -b0), a reflection times a number; b = minus [2], out
 * J = |a|^2 - |b|^2. */
static inline void area_split_edges(const double f[4], double plus[2],
                                    double minus[2])
{
    plus[0] = 0.5 * (f[0] + f[3]);
    plus[1] = 0.5 * (f[1] - f[2]);
    minus[0] = 0.5 * (f[0] - f[3]);
    minus[1] = 0.5 * (f[1] + f[2]);
}

/* Writes J1 and J2 such that unit J at f + alpha P is unit J + alpha J1 +
 * alpha^2 J2.  f, P [4] in. */
void area_line_polynomial(const double f[4], double unit, const double P[4],
                          double *J1, double *J2);

/* Returns Triangles with a right angle between legs of this length (m).
 *   node  [3 count] int, memory for the nodes */
static inline Triangles make_right_triangles(int count, double leg, void *node)
{
    double area = 0.5 * leg * leg;
    return (Triangles){count, area, 1 / (2 * area), node};
}

/* Writes the vectors x_i - x_0 and x_j - x_0 of three nodes.  e [4] out. */
static inline void compute_node_differences(const double *x, int i, int j,
                                            int node_0, double e[4])
{
    const double *x_0 = x + 2 * node_0;
    for (int c = 0; c < 2; c++) {
        e[c] = x[2 * i + c] - x_0[c];
        e[2 + c] = x[2 * j + c] - x_0[c];
    }
}

/* ElementKind's functions for terms with Triangles. */
int count_triangles(const EvalPoint *at);
int get_triangle_block_nodes(const EvalPoint *at, int t, int node[3]);
double triangle_max_alpha(const EvalPoint *at, const Element *element,
                          const double P[4]);

/* Makes triangle t an element with a = x_b - x_a, b = x_c - x_a; leaves
 * Element.s as it is. */
void fill_triangle_element(const EvalPoint *at, int t, Element *element);

/* A Hessian H by its eigenvectors.  H is on_plus and on_minus times the
 * projections on the spaces of f+ and f- (area_split_edges), plus second
 * (unit K f)(unit K f)^T.  Q is H in the plane of a = f+/|f+| and b = f-/|f-|.
 * The eigenvectors across_a and across_b are in the spaces of f+ and f-. */
typedef struct AreaHessian {
    double a[4], b[4], across_a[4], across_b[4]; /* unit vectors */
    double Q[3];                                 /* Q_aa, Q_ab, Q_bb */
    double lambda_a, lambda_b; /* eigenvalues of across_a and across_b */
} AreaHessian;

/* Writes H at f [4], projected.  Returns whether an eigenvalue was changed. */
bool area_project_hessian(const double f[4], double unit, double on_plus,
                          double on_minus, double second, Projection projection,
                          AreaHessian *area);

/* Writes the entries of H.  H [4][4] out. */
void area_assemble_hessian(const AreaHessian *area, double H[4][4]);

/* Writes Hv = H v, computed from eigenvectors.  Where H v is small, as for a
 * rotation v of a triangle at rest, a product with the rounded entries of H
 * would have no right digit.
 *   v, Hv  [4] in, out */
void area_apply_hessian(const AreaHessian *area, const double v[4],
                        double Hv[4]);
