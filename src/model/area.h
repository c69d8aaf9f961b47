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

/* Along P unit J becomes unit J + alpha J1 + alpha^2 J2, both out. */
void area_along(const double f[4], double unit, const double P[4], double *J1,
                double *J2);

/* The alpha > 0 that uses up `most` of unit J along P; infinite: none does. */
double area_reach(const double f[4], double unit, double most,
                  const double P[4]);

/* H = all I + slope K + second (unit K f)(unit K f)^T, [4][4] out, filtered.
 * Returns whether an eigenvalue was changed. */
bool area_hessian(const double f[4], double unit, double all, double slope,
                  double second, Filter filter, double H[4][4]);

#endif
