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
 */
#ifndef ELASTO_AVF_ENERGY_H
#define ELASTO_AVF_ENERGY_H

#include "model/term.h"

/* The averaged twin of the springs (mass_spring_energy). */
extern const TermKind avf_energy;

#endif
