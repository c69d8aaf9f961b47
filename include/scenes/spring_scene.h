/* spring_scene.h - one spring, its end in the hand (slides: spring energy, its
 * gradient and Hessian, SPD projection).
 *
 * P(d) = l2 k/2 (|d|^2/l2 - 1)^2, d from the held end to the free one, and
 * beside it the energy with a square root that is as stiff at rest,
 * P_root(d) = 2k (|d| - l)^2.  Both bend alike at |d| = l (4k along d); but the
 * curvature of P_root across, 4k (1 - l/|d|), has no lower bound, that of P is
 * at least -2k.
 */
#ifndef ELASTO_SPRING_SCENE_H
#define ELASTO_SPRING_SCENE_H

#include "scenes/scene.h"

typedef struct SpringFacts {
    double length;       /* |d|, m */
    double strain;       /* |d|^2/l2 - 1 */
    double energy;       /* P, J */
    double force[2];     /* -grad P on the free end, N */
    double along;        /* eigenvalue of its 2x2 Hessian along d, J/m^2 */
    double across;       /* and across */
    double block[4];     /* eigenvalues of the 4x4 block, ascending */
    double projected[4]; /* the same after projection, ascending */
    double root_energy;  /* P_root, J */
    double root_force;   /* -dP_root/d|d|, N: > 0 pushes apart */
    double root_along, root_across; /* -infinity across at |d| = 0 */
} SpringFacts;

/* d [2] m, in; l2 m^2; k J/m^2; facts out */
void spring_facts(const double d[2], double l2, double k, SpringFacts *facts);

/* h = 0.02 s, start at (0.6, 0.3) m. */
void spring_defaults(Options *options);

/* Node 0 is free, node 1 held at the origin; l = 1 m, k = 100 J/m^2, 1 kg. */
Status create_spring(Simulation *simulation, const NewtonSettings *settings);

/* Handle 0 is the free end; it starts at rest from where it is put. */
int spring_handles(const Simulation *simulation,
                   double at[SCENE_MAX_HANDLES][2]);
void spring_drag(Simulation *simulation, int handle, double x, double y);

/* Switch 0: the energy with the square root beside the other. */
int spring_switches(const Simulation *simulation,
                    Switch out[SCENE_MAX_SWITCHES]);
void spring_flip(Simulation *simulation, int number);

#endif
