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

/* Along P J becomes J + alpha J1 + alpha^2 J2, both out. */
static inline void area_along(const double f[4], const double P[4], double *J1,
                              double *J2)
{
    *J1 = cross(P, f + 2) + cross(f, P + 2);
    *J2 = cross(P, P + 2);
}

/* The alpha > 0 at which c0 + alpha J1 + alpha^2 J2 = 0, c0 > 0; infinite where
 * there is none. */
static inline double area_reach(double c0, double J1, double J2)
{
    double discriminant = J1 * J1 - 4 * J2 * c0;
    if (!(discriminant >= 0))
        return INFINITY;
    double denominator = -J1 + sqrt(discriminant);
    return denominator > 0 ? 2 * c0 / denominator : INFINITY;
}

/* A Hessian all I + slope K + second (unit K f)(unit K f)^T. */
typedef struct AreaCurvature {
    double all, slope, second, unit;
} AreaCurvature;

/* H [4][4] out, filtered.  Returns whether an eigenvalue was changed. */
bool area_hessian(const double f[4], const AreaCurvature *curvature,
                  Filter filter, double H[4][4]);

#endif
