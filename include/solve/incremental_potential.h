/* incremental_potential.h - E(x) = |x - x_tilde|_M^2 / 2 + w P(x), the
 * function an implicit time step minimises (slides: IP_val, IP_grad, IP_hess).
 *
 * For implicit Euler w = h^2 and x_tilde = x_n + h v_n; other integrators only
 * choose another target and weight.  The unknown is kept as the displacement
 * u = x - x_n: v = u/h then has full accuracy even where h v is far below the
 * rounding of x.
 */
#ifndef ELASTO_INCREMENTAL_POTENTIAL_H
#define ELASTO_INCREMENTAL_POTENTIAL_H

#include "base/quartic.h"
#include "base/sparse.h"
#include "model/system.h"

typedef struct IncrementalPotential {
    const System *system;
    double weight;         /* w, s^2 */
    const double *x_n;     /* [2n] m, positions at the start of the step */
    const double *u_tilde; /* [2n] m, x_tilde - x_n */
    bool averaged;         /* Phi (avf_energy.h) in the place of P */
} IncrementalPotential;

/* E(x), J s^2.  u [2n] m, in: x - x_n; x [2n] m, in: x_n + u. */
double incremental_potential_value(const IncrementalPotential *E,
                                   const double *u, const double *x);

/* g = grad E(x).  u, x as above; g [2n] kg m, out. */
void incremental_potential_gradient(const IncrementalPotential *E,
                                    const double *u, const double *x,
                                    double *g);

/* A number that E's rounding errors are in proportion to: inertia plus
 * w P(x), J s^2. */
double incremental_potential_scale(const IncrementalPotential *E,
                                   const double *u, const double *x);

/* The triplets of the Hessian: 2n diagonal entries of the mass matrix (and of
 * the central field), then 10 for each spring.  Rows in elimination order if
 * the system has one.  Returns OK, TOO_LARGE, OUT_OF_MEMORY. */
Status incremental_potential_pattern(const System *system, Triplets *triplets);

/* slot [count] in/out: entries of pinned nodes go to the last value of A,
 * which nobody reads; only their mass stays, on the diagonal. */
void incremental_potential_drop_pinned(const System *system, const Sparse *A,
                                       int *slot);

/* A = Hessian of E, filtered.  u, x as above; slot [count] in, A in/out.
 * Returns how many springs were projected. */
int incremental_potential_hessian(const IncrementalPotential *E,
                                  const double *u, const double *x,
                                  Filter filter, const int *slot, Sparse *A);

/* y = (filtered) Hessian of E times q, without a matrix.
 *   u, x  [2n] in, as above; q [2n] in, 0 for pinned nodes; y [2n] out */
void incremental_potential_product(const IncrementalPotential *E,
                                   const double *u, const double *x,
                                   Filter filter, const double *q, double *y);

/* E(x + alpha p) - E(x) as an exact polynomial in alpha.
 *   u, x, g  [2n] in, as above; g = grad E(x)
 *   p        [2n] m, in, 0 for pinned nodes */
Quartic incremental_potential_along(const IncrementalPotential *E,
                                    const double *u, const double *x,
                                    const double *g, const double *p);

/* E(x + a p + b r) - E(x) as an exact polynomial in a and b; p, r [2n] m in. */
PlaneQuartic incremental_potential_in_plane(const IncrementalPotential *E,
                                            const double *u, const double *x,
                                            const double *g, const double *p,
                                            const double *r);

#endif
