/* area.h - energies of a triangle's area: what cells.c and neo_hookean.c share.
 *
 * The area of two vectors f = (f1, f2) is J = f1 x f2; its Hessian is
 * K = [[0, S], [-S, 0]] with S v = (v_y, -v_x), and grad J = K f.  K has the
 * eigenvalues 1 and -1, twice each (Smith et al.: Stable Neo-Hookean Flesh
 * Simulation, 2018).
 */
#ifndef ELASTO_AREA_H
#define ELASTO_AREA_H

#include "model/psd.h"

static inline double cross(const double a[2], const double b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

/* f = f+ + f-, the parts in the eigenspaces of K for 1 and -1:
 *   f+ = (a0, a1, -a1, a0), a rotation times a number; a = plus [2], out
 *   f- = (b0, b1, b1, -b0), a reflection times a number; b = minus [2], out
 * J is |a|^2 - |b|^2. */
static inline void area_split(const double f[4], double plus[2],
                              double minus[2])
{
    plus[0] = 0.5 * (f[0] + f[3]);
    plus[1] = 0.5 * (f[1] - f[2]);
    minus[0] = 0.5 * (f[0] - f[3]);
    minus[1] = 0.5 * (f[1] + f[2]);
}

/* Along P unit J becomes unit J + alpha J1 + alpha^2 J2, both out. */
void area_expand_along(const double f[4], double unit, const double P[4],
                       double *J1, double *J2);

/* The alpha > 0 that uses up `most` of unit J along P; infinite: none does. */
double area_max_step(const double f[4], double unit, double most,
                     const double P[4]);

/* H = on_plus on the space of f+, on_minus on that of f-, plus
 * second (unit K f)(unit K f)^T, by its eigenvectors: Q in the plane of a and
 * b, on_plus and on_minus across.  All have length 1. */
typedef struct AreaHessian {
    double a[4], b[4], across_a[4], across_b[4];
    double Q[3]; /* aa, ab, bb */
    double on_plus, on_minus;
} AreaHessian;

/* The same, projected.  Returns whether an eigenvalue was changed. */
bool area_project_hessian(const double f[4], double unit, double on_plus,
                          double on_minus, double second, Projection projection,
                          AreaHessian *area);

/* H [4][4], out; and Hv [4] = H v, out.  A turn v = S f has only the curvature
 * across a in the product, however small that is; in the numbers of H it is
 * lost in the last digits of the larger ones. */
void area_assemble_hessian(const AreaHessian *area, double H[4][4]);
void area_multiply_hessian(const AreaHessian *area, const double v[4],
                           double Hv[4]);

#endif
