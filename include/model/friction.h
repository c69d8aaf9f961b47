/* friction.h - Coulomb's law as an energy (slides: friction; lesson "Frictional
 * Contact" of the lecture's author; Li et al. 2020): at a contact with the
 * normal force lambda of the step's start and the tangent t,
 *
 *   W = mu lambda f0(y),  y = t.(u_i - u_b) or t.u_i - h t.v_wall,
 *                         y = t.(u_p - (1-r) u_0 - r u_1) between bodies,
 *
 * y being how far the node has slid in this step, and r the place on the edge
 * that it is nearest to at the step's start.  With e = eps_v h
 *   f0 = y^2/e (1 - |y|/(3e)) for |y| < e, else |y| - e/3
 *   f0' = sign(y) a (2 - a),  a = min(|y|/e, 1)
 *   f0'' = 2/e max(0, 1 - |y|/e)
 * so below the speed eps_v the contact sticks (it creeps), above it slides with
 * the force mu lambda.
 */
#ifndef ELASTO_FRICTION_H
#define ELASTO_FRICTION_H

#include "model/contact.h"

/* f0'.  e > 0, m */
double friction_slope(double y, double e);

/* ---- the term -------------------------------------------------------- */

/* One contact in this step: whatever pushes with a normal force. */
typedef struct Slide {
    Element row;  /* its nodes at x_n; t in a and b is v, mu lambda is r, N */
    double carry; /* h t.v_wall, m: how far the obstacle goes along t */
} Slide;

/* The term's data. */
typedef struct Friction {
    double slip_speed; /* eps_v, m/s > 0 */
    double e;          /* m, eps_v h */
    int slides, room;  /* contacts of this step */
    Slide slide[];     /* [room] */
} Friction;

/* sum of W over the contacts at x_n, with obstacles and between bodies; data:
 * Friction.  The system must have these contacts. */
extern const TermKind friction_energy, self_friction_energy;

/* J, what obstacles that move have done by friction in the step u [2n] m. */
double friction_work_of_obstacles(const System *system, const double *u);

/* Adds one of the two, gives it this number, or takes it out.  Returns OK,
 * OUT_OF_MEMORY. */
Status friction_set(System *system, const TermKind *kind, bool wanted,
                    double slip_speed);

#endif
