/* spring_law.h - energy, gradient and Hessian of one spring (slide
 * MassSpringEnergy.py).  grid_spring.h has the same law for loops over the
 * grid, and plasticity.h has another one for springs that flow.
 *
 *   d = x_i - x_j             m; |d|^2 is d2
 *   s = |d|^2/l2 - 1          strain; l2, m^2, is |d|^2 at rest
 *   P = l2 k/2 s^2            energy, J; k, J/m^2, is the stiffness
 *   grad_i P = 2 k s d        gradient at node i; at node j it is -2 k s d
 *   H = c (2 d d^T + (|d|^2 - l2) I),  c = 2k/l2
 *   [[H, -H], [-H, H]]        Hessian of the nodes i and j
 *
 * The eigenvectors of H are d and the vector across d.  The Hessian of both
 * nodes has the eigenvalues 0, 0 and twice those of H, so projecting H is the
 * slide's make_PSD without an eigenvalue routine.  A stretched spring has no
 * negative eigenvalue, a compressed spring has one, and a spring shorter than
 * its rest length over sqrt(3) has two. */
#pragma once

#include "model/psd.h"

/* Writes d = x_i - x_j, i = e[0], j = e[1], and returns |d|^2; x [2n] m. */
static inline double spring_vector(const int e[2], const double *x, double d[2])
{
    const double *xi = x + 2 * e[0], *xj = x + 2 * e[1];
    d[0] = xi[0] - xj[0];
    d[1] = xi[1] - xj[1];
    return d[0] * d[0] + d[1] * d[1];
}

/* Returns the strain s; spring_eigenvalue_across/l2 has more digits near 0. */
static inline double spring_strain(double d2, double l2)
{
    return d2 / l2 - 1;
}

/* Returns the energy P (J). */
static inline double spring_energy(double l2, double k, double s)
{
    return 0.5 * l2 * k * s * s;
}

/* Returns 2 k s (J/m^2): the gradient at node i is this number times d. */
static inline double spring_gradient_factor(double k, double s)
{
    return 2 * k * s;
}

/* Returns c = 2k/l2 (J/m^4). */
static inline double spring_hessian_factor(double l2, double k)
{
    return 2 * k / l2;
}

/* Returns the eigenvalue of H/c for the eigenvector d (m^2): H is the spring's
 * Hessian, c = spring_hessian_factor and d = x_i - x_j. */
static inline double spring_eigenvalue_along(double d2, double l2)
{
    return 3 * d2 - l2;
}

/* Returns the eigenvalue of H/c across d (m^2). */
static inline double spring_eigenvalue_across(double d2, double l2)
{
    return d2 - l2;
}

/* Projects both eigenvalues, in/out.  `across` is the smaller one.  Returns
 * whether an eigenvalue was changed. */
static inline bool spring_project_eigenvalues(Projection projection,
                                              double *along, double *across)
{
    if (*across >= 0 || !projects_blocks(projection))
        return false;
    *along = project_eigenvalue(projection, *along);
    *across = project_eigenvalue(projection, *across);
    return true;
}

/* Writes the projected H.
 *   H  [3] out: H_xx, H_xy, H_yy
 * Returns whether an eigenvalue was changed; never for a broken spring. */
static inline bool spring_hessian(const double d[2], double l2, double k,
                                  Projection projection, double H[3])
{
    double c = spring_hessian_factor(l2, k), d2 = d[0] * d[0] + d[1] * d[1];
    double along = spring_eigenvalue_along(d2, l2);
    double across = spring_eigenvalue_across(d2, l2);
    if (!spring_project_eigenvalues(projection, &along, &across)) {
        H[0] = c * (2 * d[0] * d[0] + across);
        H[1] = c * (2 * d[0] * d[1]);
        H[2] = c * (2 * d[1] * d[1] + across);
        return false;
    }
    double slope = d2 > 0 ? c * ((along - across) / d2) : 0;
    H[0] = c * across + slope * d[0] * d[0];
    H[1] = slope * d[0] * d[1];
    H[2] = c * across + slope * d[1] * d[1];
    return k > 0;
}
