/* newton_parts.h - the parts of Newton's loop (newton.c), one in each file. */
#pragma once

#include "solve/newton.h"

/* The phases of an iteration, each of which may end it.  A phase reads and
 * writes newton->record and the iterate: Newton's phases newton->iterate, those
 * of multigrid their copy on the grid. */
typedef struct NewtonPhases {
    /* Computes g and p at x, and the residual of p.  Sets
     * newton->meets_tolerance if the residual plus a bound of its error is at
     * most the tolerance.  Newton's phase also requires that the next direction
     * turns no body (next_direction_may_turn), unless turn_free_body does this;
     * multigrid also accepts a p that its bound announced as the last one.
     * Returns OK, or why there is no p. */
    Status (*find_direction)(Newton *newton);
    /* Computes alpha, trials, slope, energy_change.  For Newton's method also
     * stores the end of the step in u_trial and x_trial.  Returns OK, or why no
     * step lowers E: LINE_SEARCH_LIMIT, NOT_DESCENT, ROUNDING_LIMIT,
     * NOT_FINITE; alpha and energy_change are then 0. */
    Status (*find_step_length)(Newton *newton);
    /* Adds alpha p to the iterate (u and x); multigrid may also relax tiles.
     * Returns OK, NOT_FINITE, ROUNDING_LIMIT. */
    Status (*update_iterate)(Newton *newton);
    /* Turns a free body (turn_free_body), and decides whether the loop ends.
     *   status  in, result of the phases before
     * Returns RUNNING, OK, or how the minimisation failed. */
    Status (*test_convergence)(Newton *newton, Status status);
} NewtonPhases;

/* Exchanges the iterate and the trial. */
static inline void swap_iterates(Newton *newton)
{
    Iterate *at = &newton->iterate;
    double *u = at->u, *x = at->x;
    at->u = newton->u_trial;
    at->x = newton->x_trial;
    newton->u_trial = u;
    newton->x_trial = x;
}

/* ---- direction.c: gradient, Hessian, search direction (slide: search_dir) */

/* Frees the Hessian and its factor.  The next factorisation makes new ones. */
void direction_free_matrix(FactoredHessian *direction);

Status find_direction(Newton *newton);

/* Returns the largest |p_x| + |p_y| (m) of a node if |p|_M is `norm`. */
double bound_largest_movement(const Newton *newton, double norm);

/* Returns the largest |p_x| + |p_y| (m) of a negligible direction, which passes
 * the test and is at most a millionth of the shortest spring. */
double negligible_direction_size(const Newton *newton);

/* Computes g, and tells whether a bound from g shows that the next direction is
 * negligible.  Without projection: false, and g is not computed. */
bool next_direction_is_negligible(Newton *newton);

/* ---- line_search.c: how far to go along p (slide: Algorithm 2) */

Status find_step_length(Newton *newton);

/* ---- turn.c: turns of free bodies, which Newton's directions cannot make */

/* Whether the next direction may turn the nodes by more than the tolerance,
 * although p passes the test.  At x the forces g resist a turn.  At x + p most
 * of these forces are gone, and only the masses resist the remaining torque,
 * which is at most sum |p_i| |g_i| over the nodes i. */
bool next_direction_may_turn(const Newton *newton);

/* Turns all nodes to the angle at which E is lowest, where P is the same at all
 * angles (system_turns_freely).  The turn is made in stiff scenes; by Newton's
 * method in others, too, if p passes the test although next_direction_may_turn
 * is true.  Then angular momentum is exact: the sum of m cross(d, u - u_tilde)
 * is 0, with d from the pivot to a node.  Newton's straight directions stretch
 * a body that turns, so a stiff body would turn by tiny steps, which pass the
 * test.  Returns the change of E, J s^2. */
double turn_free_body(Newton *newton);

/* ---- multigrid.c: the same phases for large squares, without a factor */

extern const NewtonPhases multigrid_phases;

/* ---- rounding.c: tests of whether rounding hides a decrease of E.  Near a
 * minimum every further decrease may be smaller than the rounding of E.  Where
 * w k outweighs the masses beyond the 16 digits of a double, the gradient and
 * the slope along p may be rounding errors.  In such a scene, and without a
 * line search, E itself is compared with its start. */

void rounding_prepare(Newton *newton);

/* Whether a change of E, J s^2, is at most a few units in E's last place. */
bool is_below_roundoff(const Newton *newton, double change);

/* Whether E at u_trial confirms record.energy_change: E is not higher than
 * predicted by more than rounding explains.  True without a test if the scene
 * is not stiff, if there is no line search, or if rounding.energy_limit is
 * finite. */
bool energy_confirms_change(Newton *newton);

/* Whether E at u, x [2n] is at most rounding.energy_limit. */
bool energy_is_within_limit(const Newton *newton, const double *u,
                            const double *x);

/* Decides whether rounding ends the minimisation after a p that did not pass
 * the test.  After many iterations without a smaller residual, returns
 * ROUNDING_LIMIT if the last change of E is below roundoff, and ITERATION_LIMIT
 * if there is no line search.  Otherwise RUNNING. */
Status rounding_test_stagnation(Newton *newton);
