/* damping.h - springs that resist the rate of their strain (Kelvin-Voigt).
 *
 * A spring with the strain E = |d|^2/l2 - 1 has beside its k l2 E^2/2 the force
 * of k l2 eta dE/dt on E.  Turning changes no E, so it costs nothing; the
 * forces act along the springs, so they keep momentum and angular momentum.  In
 * a step of backward Euler dE/dt = (E - E_n)/h, and with theta = eta/h the
 * spring's energy becomes
 *
 *   k l2 [E^2 + theta (E - E_n)^2]/2
 *       = k' l2' (|d|^2/l2' - 1)^2/2 + constant,
 *   l2' = (l2 + theta |d_n|^2)/(1 + theta),  k' = k (1 + theta) l2'/l2
 *
 * by completing the square: the slides' spring with other numbers, which stand
 * for one step.  Springs that flow have their own law (plasticity.h) and take
 * theta and E_n instead.
 */
#ifndef ELASTO_DAMPING_H
#define ELASTO_DAMPING_H

#include "model/system.h"

/* The term's data. */
typedef struct Damping {
    double eta;   /* s, >= 0 */
    double theta; /* eta/h in this step */
    double *E_n;  /* [springs] strain at its start */
    double *k;    /* [springs] J/m^2, k' */
    double *l2;   /* [springs] m^2, l2' > 0 */
} Damping;

/* No energy of its own: what damping does to the springs' energy is in their
 * term.  It books k l2 theta (E - E_n)^2 as lost: the power k l2 eta (dE/dt)^2
 * over the step.  data: Damping; its number is eta. */
extern const TermKind damping;

#endif
