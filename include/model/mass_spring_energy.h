/* mass_spring_energy.h - P(x) = sum l2 k/2 s^2, s = |d|^2/l2 - 1,
 * d = x_i - x_j (slide MassSpringEnergy.py).
 *
 *   springs  number of springs
 *   x        [2n] m, in
 *   e        [2 springs] nodes i, j of each spring, in
 *   l2       [springs] m^2, squared rest lengths, in
 *   k        [springs] J/m^2, stiffness, in
 *   scale    factor on everything that is added (h^2 for implicit Euler)
 */
#ifndef ELASTO_MASS_SPRING_ENERGY_H
#define ELASTO_MASS_SPRING_ENERGY_H

#include "model/term.h"

/* The springs of the system as a term; it needs no data. */
extern const TermKind mass_spring_energy;

/* P(x), J. */
double mass_spring_energy_value(int springs, const double *x, const int *e,
                                const double *l2, const double *k);

/* g += scale * grad P; the share of node i is 2 k s d, node j gets its
 * opposite.  g [2n] in/out. */
void mass_spring_energy_gradient(int springs, const double *x, const int *e,
                                 const double *l2, const double *k,
                                 double scale, double *g);

/* Entries a spring has in one triangle of the Hessian: its 4x4 block is
 * [[H, -H], [-H, H]], so ii: xx xy yy, jj: xx xy yy, ij: xx xy yx yy. */
enum { SPRING_ENTRIES = 10 };

/* values[slot[t]] += scale * entry t of the (projected) Hessian, entries
 * counted spring by spring; slot NULL: t itself, the plain triplets.
 *   slot    [10 springs] in
 *   values  in/out
 * Returns how many springs were projected. */
int mass_spring_energy_hessian(int springs, const double *x, const int *e,
                               const double *l2, const double *k, double scale,
                               Filter filter, const int *slot, double *values);

/* y += scale * (projected) Hessian of P at x times q, spring by spring.
 *   q  [2n] in; y [2n] in/out */
void mass_spring_energy_product(int springs, const double *x, const int *e,
                                const double *l2, const double *k, double scale,
                                Filter filter, const double *q, double *y);

/* Coefficients of alpha^2, alpha^3, alpha^4 in P(x + alpha p), times scale,
 * added to q.  p [2n] m, in; q [3] in/out. */
void mass_spring_energy_along(int springs, const double *x, const double *p,
                              const int *e, const double *l2, const double *k,
                              double scale, double q[3]);

/* Number and triplets of the Hessian's entries: 10 for each spring. */
long long mass_spring_entries(const Term *term, const System *system);
void mass_spring_pattern(const Term *term, const System *system,
                         Triplets *triplets);

/* max k, J/m^2, and max k sqrt(l2), J/m: of a spring compressed to nothing. */
double mass_spring_stiffest(const Term *term, const System *system);
double mass_spring_force(const Term *term, const System *system);

/* y += [[H, -H], [-H, H]] q for the spring between nodes e[0] and e[1]: with
 * t = H (q_i - q_j), y_i += t and y_j -= t. */
static inline void mass_spring_multiply(const double H[3], const int e[2],
                                        const double *q, double *y)
{
    const double *qi = q + 2 * e[0], *qj = q + 2 * e[1];
    double *yi = y + 2 * e[0], *yj = y + 2 * e[1];
    double q0 = qi[0] - qj[0], q1 = qi[1] - qj[1];
    double t0 = H[0] * q0 + H[1] * q1, t1 = H[1] * q0 + H[2] * q1;
    yi[0] += t0;
    yi[1] += t1;
    yj[0] -= t0;
    yj[1] -= t1;
}

/* Adds the block [[H, -H], [-H, H]] of spring i through its ten slots.
 *   H  [3] in: H_xx, H_xy, H_yy; slot, values as above */
static inline void mass_spring_scatter(const double H[3], int i,
                                       const int *slot, double *values)
{
    static const int plain[SPRING_ENTRIES] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    if (slot) {
        slot += SPRING_ENTRIES * i;
    } else {
        values += SPRING_ENTRIES * i;
        slot = plain;
    }
    for (int t = 0; t < 3; t++) {
        values[slot[t]] += H[t];
        values[slot[3 + t]] += H[t];
    }
    values[slot[6]] -= H[0];
    values[slot[7]] -= H[1];
    values[slot[8]] -= H[1];
    values[slot[9]] -= H[2];
}

#endif
