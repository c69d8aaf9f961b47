/* plasticity.h - springs that flow (slides: inelasticity), in Green strain.
 *
 * A spring has E = |d|^2/l2 - 1, of which ep stays when it is unloaded.  It
 * stores k l2 (E - ep)^2/2; beyond the yield strain Y it flows instead.  How
 * far it will flow in this step is minimised out (Ortiz, Stainier 1999: the
 * condensed incremental potential), so that the step stays one minimisation:
 *
 *   W = k l2 V(e),  e = E - ep_n
 *   V = e^2/2 - (|e| - Y_n)_+^2 flow/2,  flow = 1/(1 + H)
 *   tau = V' = e - sign(e) flow (|e| - Y_n)_+,  tau' = 1 or 1 - flow
 *
 * with Y_n = Y + H kappa_n, the yield strain after the hardening so far.  With
 * H = 0 V is Huber's function; below Y_n it is the elastic spring.
 */
#ifndef ELASTO_PLASTICITY_H
#define ELASTO_PLASTICITY_H

#include "model/system.h"

/* How a spring answers in this step; with damping (damping.h) V has
 * theta (e - e_n)^2/2 more. */
typedef struct FlowLaw {
    double ep;    /* plastic strain, e = E - ep */
    double yield; /* Y_n > 0 */
    double flow;  /* 1/(1 + H), 0 < flow <= 1 */
    double hard;  /* 1 - flow */
    double theta; /* eta/h; 0: no damping */
    double e_n;   /* e at the step's start */
} FlowLaw;

double flow_law_slope(FlowLaw law, double e);

/* The block H of the spring (spring_law.h) is c (l2 tau I + 2 tau' d d^T).
 * Returns its eigenvalue along d, divided by c, m^2.
 *   across  l2 tau, the eigenvalue across d, divided by c */
double flow_law_eigenvalue_along(FlowLaw law, double e, double d2,
                                 double across);

/* ---- the term -------------------------------------------------------- */

/* The term's data. */
typedef struct Plasticity {
    double yield;     /* Y > 0 */
    double hardening; /* H >= 0 */
    double *ep;       /* [springs] plastic strain */
    double *kappa;    /* [springs] sum of its changes' sizes */
} Plasticity;

/* sum of W over the springs, in the place of mass_spring_energy; data:
 * Plasticity; its numbers are Y and H.  Its value has what hardening stores, k
 * l2 H kappa^2/2; what flowing costs, k l2 Y gamma, is booked as lost. */
extern const TermKind plastic_energy;

/* The law of spring s without damping, elastic where nothing flows. */
FlowLaw plasticity_get_law(const System *system, int s);

#endif
