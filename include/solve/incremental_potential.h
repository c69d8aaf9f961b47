/* incremental_potential.h - E(x) = |x - x_tilde|_M^2 / 2 + w P(x), the
 * function an implicit time step minimises (slides: IP_val, IP_grad, IP_hess).
 *
 * For implicit Euler w = h^2 and x_tilde = x_n + h v_n.  The other integrators
 * have another target and weight.  The unknown is stored as the displacement
 * u = x - x_n, so that v = u/h has full accuracy even where h v is far below
 * the rounding of x. */
#pragma once

#include "base/sparse.h"
#include "model/system.h"

typedef struct IncrementalPotential {
    const System *system;
    double weight;         /* w, s^2 */
    const double *x_n;     /* [2n] m, positions at the start of the step */
    const double *u_tilde; /* [2n] m, x_tilde - x_n */
} IncrementalPotential;

/* E, and the point that a minimisation has reached; arrays of [2n]. */
typedef struct Iterate {
    IncrementalPotential E;
    double *u; /* m, displacement from x_n */
    double *x; /* m, x_n + u */
    double *g; /* grad E(x), kg m; 0 for pinned nodes */
    double *p; /* m, search direction; 0 for pinned nodes */
} Iterate;

/* Returns E(x) >= 0, J s^2, a sum without cancellation: the rounding error of E
 * is a small part of E.  u [2n] m, in: x - x_n; x [2n] m, in: x_n + u. */
double incremental_potential_value(const IncrementalPotential *E,
                                   const double *u, const double *x);

/* Writes grad E(x) to g [2n] kg m.  u [2n] m, in: x - x_n; x [2n] m, in. */
void incremental_potential_gradient(const IncrementalPotential *E,
                                    const double *u, const double *x,
                                    double *g);

/* Makes the Hessian's pattern, in elimination order if the system has one.  The
 * first 2n triplets are the diagonal of the mass matrix, the next ones are the
 * terms' entries.  Entries of terms at pinned nodes are dropped: their slots
 * lead to an additional last value of A, which is unused.
 *   A  out; free it with sparse_free, also after a failure
 * Returns OK, TOO_LARGE, OUT_OF_MEMORY. */
Status incremental_potential_create_hessian(const System *system, Sparse *A);

/* Adds pairs of a node and an edge that are close at u, x to the terms' lists.
 *   grown  out, whether the pattern lacks entries and must be made again
 * Returns OK, OUT_OF_MEMORY. */
Status incremental_potential_extend_pattern(const Iterate *at, bool *grown);

/* Writes the projected Hessian of E at u, x to A, which has the pattern.
 * Returns how many blocks of terms the projection changed. */
int incremental_potential_hessian(const Iterate *at, Projection projection,
                                  Sparse *A);

/* Multiplies the (projected) Hessian of E at u, x by q, without a matrix.
 *   q  [2n] in, 0 for pinned nodes unless H is diagonal
 *   y  [2n] out
 * Returns how many blocks of terms the projection changed. */
int incremental_potential_apply_hessian(const Iterate *at,
                                        Projection projection, const double *q,
                                        double *y);

/* Turns springs of stiffness c from nodes to fixed points o into masses:
 *   m/2 |u - u_tilde|^2 + w c/2 |x - o|^2 = (m + w c)/2 |u - v|^2 + constant.
 * g and p of the iterate serve as workspace.
 *   m        [2n] kg, out, m + w c
 *   u_tilde  [2n] m, out, the target v */
void incremental_potential_absorb_pulls(const Iterate *iterate, double *m,
                                        double *u_tilde);

/* Whether the Hessian is diagonal, as no term couples two coordinates. */
bool incremental_potential_is_diagonal(const IncrementalPotential *E);

/* A polynomial along a line, without constant term:
 * q(alpha) = q[0] alpha + q[1] alpha^2 + q[2] alpha^3 + q[3] alpha^4 */
typedef struct Quartic {
    double q[4]; /* J s^2 */
} Quartic;

/* Returns q(alpha) by Horner's rule. */
static inline double quartic_value(const Quartic *quartic, double alpha)
{
    const double *q = quartic->q;
    return alpha * (q[0] + alpha * (q[1] + alpha * (q[2] + alpha * q[3])));
}

/* E(x + alpha p) - E(x): an exact polynomial, plus the remainders of the terms
 * that are no polynomials. */
typedef struct LineEnergy {
    Quartic polynomial; /* polynomial part of E along p */
    const Iterate *iterate;
    bool has_remainder; /* has terms with a taylor_remainder (term.h) */
} LineEnergy;

/* Prepares E(x + alpha p) - E(x) from u, x, g, p of the iterate. */
LineEnergy make_line_energy(const Iterate *iterate);

/* Returns E(x + alpha p) - E(x), J s^2; an EnergyFunction of the line search.
 *   function  in, the LineEnergy */
double line_energy_difference(const void *function, double alpha);

/* Returns the largest alpha <= 1 up to which all terms allow x + alpha p. */
double incremental_potential_max_alpha(const Iterate *at);

/* Whether every term allows u, x [2n]. */
bool incremental_potential_is_feasible(const IncrementalPotential *E,
                                       const double *u, const double *x);
