/* mass_spring_energy.h - P(x) = sum l2 k/2 s^2, s = |d|^2/l2 - 1,
 * d = x_i - x_j (slide MassSpringEnergy.py), and what other energies of springs
 * share with it.
 */
#ifndef ELASTO_MASS_SPRING_ENERGY_H
#define ELASTO_MASS_SPRING_ENERGY_H

#include "model/system.h"

/* The springs of the system as a term; they need no data. */
extern const TermKind mass_spring_energy;

/* The strain |d|^2/l2 - 1 of a spring between the nodes e[0] and e[1] in
 * positions x [2n] m; d [2] m out. */
static inline double spring_strain(const int e[2], double l2, const double *x,
                                   double d[2])
{
    const double *xi = x + 2 * e[0], *xj = x + 2 * e[1];
    d[0] = xi[0] - xj[0];
    d[1] = xi[1] - xj[1];
    return (d[0] * d[0] + d[1] * d[1]) / l2 - 1;
}

/* H [3] J/m^2 out (xx, xy, yy), H = (2k/l2) (2 d d^T + (|d|^2 - l2) I), with
 * its negative eigenvalues treated as the filter says.  The spring's 4x4 block
 * is [[H, -H], [-H, H]], with the eigenvalues 0, 0 and twice those of H: so
 * this is the slide's make_PSD without any eigenvalue routine.  Returns whether
 * there was a negative one that was changed; a broken spring, k = 0, has none.
 *
 * The eigenvectors of H are d, with the eigenvalue (2k/l2) (3|d|^2 - l2), and
 * the one across, with (2k/l2) (|d|^2 - l2).  A stretched spring has none that
 * is negative; one that is shorter than its rest length over sqrt(3) has two,
 * also where |d| = 0. */
static inline bool spring_hessian(const double d[2], double l2, double k,
                                  Filter filter, double H[3])
{
    double factor = 2 * k / l2, d2 = d[0] * d[0] + d[1] * d[1];
    double along = 3 * d2 - l2, across = d2 - l2;
    if (across >= 0 || !filter_projects(filter)) {
        H[0] = factor * (2 * d[0] * d[0] + across);
        H[1] = factor * (2 * d[0] * d[1]);
        H[2] = factor * (2 * d[1] * d[1] + across);
        return false;
    }
    across = projected_eigenvalue(filter, across);
    along = projected_eigenvalue(filter, along);
    double slope = d2 > 0 ? factor * ((along - across) / d2) : 0;
    H[0] = factor * across + slope * d[0] * d[0];
    H[1] = slope * d[0] * d[1];
    H[2] = factor * across + slope * d[1] * d[1];
    return k > 0;
}

/* Entries of a spring in one triangle of the Hessian: ii: xx xy yy,
 * jj: xx xy yy, ij: xx xy yx yy. */
enum { SPRING_ENTRIES = 10 };

/* The functions entries, pattern and curvature_bound (max k) of a term with a
 * block for each spring. */
long long mass_spring_entries(const EvalPoint *at);
void mass_spring_pattern(const EvalPoint *at, Triplets *triplets);
double mass_spring_curvature_bound(const EvalPoint *at);

/* g += factor d at node e[0] and minus that at node e[1]. */
static inline void spring_add_force(const int e[2], double factor,
                                    const double d[2], double *g)
{
    for (int c = 0; c < 2; c++) {
        g[2 * e[0] + c] += factor * d[c];
        g[2 * e[1] + c] -= factor * d[c];
    }
}

/* The block [[H, -H], [-H, H]] of the nodes e[0] and e[1], number `spring` of
 * such blocks: added to a matrix through its slots, or, where q is given,
 * out += block q (TermKind's hessian). */
static inline void mass_spring_add(const double H[3], const int e[2],
                                   int spring, const int *slot, const double *q,
                                   double *out)
{
    if (q) {
        int i = 2 * e[0], j = 2 * e[1];
        double q0 = q[i] - q[j], q1 = q[i + 1] - q[j + 1];
        double t0 = H[0] * q0 + H[1] * q1, t1 = H[1] * q0 + H[2] * q1;
        out[i] += t0;
        out[i + 1] += t1;
        out[j] -= t0;
        out[j + 1] -= t1;
        return;
    }
    slot += SPRING_ENTRIES * spring;
    out[slot[0]] += H[0];
    out[slot[1]] += H[1];
    out[slot[2]] += H[2];
    out[slot[3]] += H[0];
    out[slot[4]] += H[1];
    out[slot[5]] += H[2];
    out[slot[6]] -= H[0];
    out[slot[7]] -= H[1];
    out[slot[8]] -= H[1];
    out[slot[9]] -= H[2];
}

#endif
