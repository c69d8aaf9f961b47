/* friction.h - Coulomb's law as an energy (slides: friction; lesson "Frictional
 * Contact" of the lecture's author; Li et al. 2020).
 *
 * A contact has the normal force lambda and the tangent t of the step's start.
 * Its energy is
 *
 *   W = mu lambda f0(y)
 *   y = t.u_i - h t.v_wall                 slip at a wall or fixed ball, m
 *   y = t.(u_i - u_b)                      slip at the free ball, m
 *   y = t.(u_p - (1-r) u_0 - r u_1)        slip between bodies, m
 *
 * where y is how far the node has slid in this step, and r is the position on
 * the edge that was nearest to the node at the step's start.  With e = eps_v h
 *   f0 = y^2/e (1 - |y|/(3e)) for |y| < e, else |y| - e/3
 *   f0' = sign(y) a (2 - a),  a = min(|y|/e, 1)
 *   f0'' = 2/e max(0, 1 - |y|/e)
 * Below the speed eps_v the contact sticks, apart from a slow creep.  Above
 * eps_v it slides with the force mu lambda. */
#pragma once

#include "model/contact.h"

/* Returns f0'(y), a number without unit.  e > 0 in metres. */
double friction_slope(double y, double e);

/* A contact with a normal force in this step. */
typedef struct SlidingContact {
    Element element; /* the contact's element with the tangent t in place of the
                        normal n, and r = mu lambda, the largest friction (N) */
    double obstacle_travel; /* h t.v_wall (m), travel of the obstacle along t */
} SlidingContact;

typedef struct Friction {
    double slip_speed; /* m/s, eps_v > 0 */
    double e;          /* m, eps_v h */
    int contact_count; /* number of contacts with a normal force in this step */
    int contact_capacity; /* number of contacts for which `contact` has room */
    SlidingContact contact[]; /* [capacity] contacts of this step */
} Friction;

/* The sum of W over the contacts of the step's start: with obstacles
 * (friction_energy), and between bodies (self_friction_energy).  data:
 * Friction. The system must have the term of these contacts. */
extern const TermKind friction_energy, self_friction_energy;

/* Returns the work (J) that moving obstacles did by friction in this step.
 *   u  [2n] m, in, displacement of the step */
double friction_obstacle_work(const System *system, const double *u);

/* Adds or removes friction_energy or self_friction_energy, or changes eps_v.
 *   wanted      false: remove
 *   slip_speed  m/s, eps_v
 * Returns OK or OUT_OF_MEMORY. */
Status friction_configure(System *system, const TermKind *kind, bool wanted,
                          double slip_speed);
