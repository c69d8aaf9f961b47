/* mass_spring_energy.h - energy of all springs (slide MassSpringEnergy.py). */
#pragma once

#include "model/spring_law.h"
#include "model/system.h"

/* The sum of spring_energy over all springs; the term has no data. */
extern const TermKind mass_spring_energy;

/* TermKind's functions for a term with one block for each spring.  The
 * estimate max_stiffness is the largest k. */
void mass_spring_add_triplets(const EvalPoint *at, Triplets *triplets);
double mass_spring_max_stiffness(const EvalPoint *at);

/* Adds factor * d to g [2n] at node e[0], and -factor * d at node e[1]. */
static inline void spring_add_gradient(const int e[2], double factor,
                                       const double d[2], double *g)
{
    for (int c = 0; c < 2; c++) {
        g[2 * e[0] + c] += factor * d[c];
        g[2 * e[1] + c] -= factor * d[c];
    }
}

/* Adds the block B = [[H, -H], [-H, H]] of a spring with the nodes e[0], e[1]:
 *   q = NULL   triplets ii: xx xy yy, jj: xx xy yy, ij: xx xy yx yy of B to
 *              out[(*slot)[0 ... 9]]; *slot is advanced by 10
 *   otherwise  out += B q; q, out [2n] */
static inline void mass_spring_add_hessian(const double H[3], const int e[2],
                                           const int **slot, const double *q,
                                           double *out)
{
    if (q) {
        int i = 2 * e[0], j = 2 * e[1];
        double q0 = q[i] - q[j], q1 = q[i + 1] - q[j + 1];
        double t0 = H[0] * q0 + H[1] * q1, t1 = H[1] * q0 + H[2] * q1;
        out[i] += t0;
        out[i + 1] += t1;
        out[j] -= t0;
        out[j + 1] -= t1;
        return;
    }
    const int *s = *slot;
    out[s[0]] += H[0];
    out[s[1]] += H[1];
    out[s[2]] += H[2];
    out[s[3]] += H[0];
    out[s[4]] += H[1];
    out[s[5]] += H[2];
    out[s[6]] -= H[0];
    out[s[7]] -= H[1];
    out[s[8]] -= H[1];
    out[s[9]] -= H[2];
    *slot += 10;
}
