/* damping.h - Kelvin-Voigt damping: springs resist the rate of their strain.
 *
 * The elastic energy of a spring is k l2 E^2/2 with the strain
 * E = |d|^2/l2 - 1.  Damping adds the stress k l2 eta dE/dt.  A rotation does
 * not change E, so it is not damped.  The forces act along the springs, so they
 * conserve momentum and angular momentum.  In a step of backward Euler dE/dt is
 * (E - E_n)/h.  With theta = eta/h the energy of the spring becomes
 *
 *   k l2 [E^2 + theta (E - E_n)^2]/2
 *       = k' l2' (|d|^2/l2' - 1)^2/2 + constant,
 *   l2' = (l2 + theta |d_n|^2)/(1 + theta),  k' = k (1 + theta) l2'/l2
 *
 * by completing the square: a spring of the slides with other numbers for this
 * step.  Springs that flow (plasticity.h) have theta and E_n in their law. */
#pragma once

#include "model/system.h"

typedef struct Damping {
    double eta;   /* s, damping time >= 0 */
    double theta; /* eta/h in this step */
    double *E_n;  /* [springs] strain at the start of this step */
    double *k;    /* [springs] J/m^2, stiffness k' in this step */
    double *l2;   /* [springs] m^2, squared rest length l2' in this step */
} Damping;

/* Damping as a term; data: Damping.  The option's number is eta.  The term adds
 * no energy of its own: the term of the springs takes k' and l2' for k and l2.
 * After a step it books the dissipated energy k l2 theta (E - E_n)^2, which is
 * the power k l2 eta (dE/dt)^2 times h. */
extern const TermKind damping;
