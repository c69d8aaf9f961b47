/* plasticity.h - springs that flow plastically (slides: inelasticity).
 *
 * A spring has the Green strain E = |d|^2/l2 - 1.  The plastic strain ep is the
 * part of E that remains after unloading.  The elastic energy is
 * k l2 (E - ep)^2/2; beyond the yield strain Y the spring flows.  W is the
 * condensed incremental potential of Ortiz and Stainier (1999): the flow is
 * minimised out, so that a step is one minimisation:
 *
 *   W = k l2 V(e),  e = E - ep_n
 *   V = e^2/2 - (|e| - Y_n)_+^2 flow/2,  flow = 1/(1 + H)
 *   tau = V' = e - sign(e) flow (|e| - Y_n)_+,  tau' = 1 or 1 - flow
 *
 * with Y_n = Y + H kappa_n, the yield strain after the hardening so far.  For
 * |e| < Y_n the spring is elastic.  For H = 0 V is Huber's function. */
#pragma once

#include "model/system.h"

/* Numbers of the function V(e) of one spring in this step, as above.  With
 * damping (damping.h) V has the further summand theta (e - e_n)^2/2. */
typedef struct FlowLaw {
    double ep_n;          /* plastic strain at the step's start */
    double yield_strain;  /* Y_n > 0, yield strain in this step */
    double flow_fraction; /* 1/(1 + H), fraction of (|e| - Y_n) that flows */
    double plastic_slope; /* 1 - flow_fraction, slope of V' beyond Y_n */
    double theta;         /* damping eta/h; 0: none */
    double e_n;           /* elastic strain e = E - ep at the step's start */
} FlowLaw;

/* Returns tau = V'(e). */
double flow_law_slope(FlowLaw law, double e);

/* Returns the eigenvalue along d of H/c, m^2.  H = c (l2 tau I + 2 tau' d d^T)
 * is the spring's block of the Hessian (spring_law.h).
 *   d2      m^2, |d|^2
 *   across  m^2, l2 tau, the eigenvalue of H/c across d */
double flow_law_eigenvalue_along(FlowLaw law, double e, double d2,
                                 double across);

typedef struct Plasticity {
    double initial_yield_strain; /* yield strain Y > 0 */
    double hardening;            /* hardening modulus H >= 0, relative to k */
    double *ep;                  /* [springs] plastic strain */
    double *kappa;               /* [springs] accumulated |change of ep| */
} Plasticity;

/* The sum of W over the springs; data: Plasticity.  configure reads two
 * options, Y and H.  The term replaces mass_spring_energy.  The value includes
 * the energy of hardening, k l2 H kappa^2/2.  After a step in which ep changes
 * by gamma, the term books the dissipated energy k l2 Y |gamma|. */
extern const TermKind plastic_energy;

/* Returns the law V of spring s without damping; elastic without the term. */
FlowLaw plasticity_get_flow_law(const System *system, int s);
