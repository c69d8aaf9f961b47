/* avf_energy.h - Phi(u), whose gradient is the spring force averaged along the
 * straight way from x_n to x_n + u:
 *   grad Phi(u) = integral over t = 0 ... 1 of grad P(x_n + t u).
 * A step that minimises with Phi instead of P conserves energy exactly (Rojas,
 * Liu, Kavan: Average Vector Field Integration for St. Venant-Kirchhoff
 * Deformable Models, 2018).
 *
 * With d = x_n,i - x_n,j, delta = u_i - u_j, s = |d|^2/l2 - 1,
 * B = 2 d.delta/l2 and C = |delta|^2/l2 the strain on the way is
 * s + t B + t^2 C, and the integrals are polynomials.
 *   springs, e, l2, k, scale  as in mass_spring_energy.h
 *   x_n  [2n] m, in
 *   u    [2n] m, in
 */
#ifndef ELASTO_AVF_ENERGY_H
#define ELASTO_AVF_ENERGY_H

#include "base/quartic.h"
#include "model/term.h"

/* The averaged twin of the springs (mass_spring_energy). */
extern const TermKind avf_energy;

/* Phi(u), J; 0 for u = 0. */
double avf_energy_value(int springs, const double *x_n, const double *u,
                        const int *e, const double *l2, const double *k);

/* g += scale * grad Phi(u).  g [2n] in/out. */
void avf_energy_gradient(int springs, const double *x_n, const double *u,
                         const int *e, const double *l2, const double *k,
                         double scale, double *g);

/* values[slot[t]] += scale * entry t of the (projected) Hessian of Phi, as
 * mass_spring_energy_hessian.  Returns how many springs were projected. */
int avf_energy_hessian(int springs, const double *x_n, const double *u,
                       const int *e, const double *l2, const double *k,
                       double scale, Filter filter, const int *slot,
                       double *values);

/* y += scale * (projected) Hessian of Phi times q.  q [2n] in, y [2n] in/out */
void avf_energy_product(int springs, const double *x_n, const double *u,
                        const int *e, const double *l2, const double *k,
                        double scale, Filter filter, const double *q,
                        double *y);

/* Coefficients of alpha^2, alpha^3, alpha^4 in Phi(u + alpha p), times scale,
 * added to q.  p [2n] m, in; q [3] in/out. */
void avf_energy_along(int springs, const double *x_n, const double *u,
                      const double *p, const int *e, const double *l2,
                      const double *k, double scale, double q[3]);

#endif
