/* newton_parts.h - the parts of Newton's loop (newton.c), each in a file of its
 * own.
 */
#ifndef ELASTO_NEWTON_PARTS_H
#define ELASTO_NEWTON_PARTS_H

#include "solve/newton.h"

/* The phases of an iteration, each of which may end it.  A phase reads and
 * writes the iterate newton->at and the record newton->record. */
typedef struct NewtonPhases {
    /* g and p at x, the residual of p, and newton->passes: whether it is at
     * most the tolerance, and no turn may follow that turn.c does not make.
     * Returns OK or a failure. */
    Status (*find_direction)(Newton *newton);
    /* alpha, trials, slope and change; u_trial and x_trial.  Returns OK, or why
     * no step lowers E: LINE_SEARCH_LIMIT, NOT_DESCENT, ROUNDING_LIMIT,
     * NOT_FINITE; alpha and change are then 0. */
    Status (*find_step_length)(Newton *newton);
    /* Makes the end of the trial step the iterate (u and x).  Returns OK,
     * NOT_FINITE, ROUNDING_LIMIT. */
    Status (*update)(Newton *newton);
    /* Whether the loop ends.
     *   status  in, of the phases before
     * Returns RUNNING, OK, or how the minimisation failed. */
    Status (*test)(Newton *newton, Status status);
} NewtonPhases;

/* ---- direction.c: gradient, Hessian, search direction (slide: search_dir) */

/* Frees the matrix and its factor, which are made where they are needed. */
void direction_free_matrix(SearchDirection *search);

Status find_direction(Newton *newton);

/* Largest |p_x| + |p_y| of a negligible direction, m, which passes the test and
 * is at most a millionth of the shortest spring. */
double negligible_direction_size(const Newton *newton);

/* Whether the next direction is negligible, by a bound.  Computes g. */
bool next_direction_is_negligible(Newton *newton);

/* ---- line_search.c: how far to go along p (slide: Algorithm 2) */

Status find_step_length(Newton *newton);

/* ---- newton.c */

/* Exchanges the iterate and the trial. */
void swap_iterates(Newton *newton);

/* ---- turn.c: turns of free bodies, which Newton's directions cannot make */

/* Whether the next direction may turn nodes by more than the tolerance although
 * p passes.  Forces g at x resist a turn; at x + p most of them are gone, and
 * the masses alone resist it, against a torque of at most sum |p_i| |g_i|. */
bool turns_may_follow(const Newton *newton);

/* Turns all nodes to the angle at which E is lowest, where P stays the same
 * (system_turns_freely), in stiff scenes or after a last p that needs it.  Then
 * sum m d x (u - u_tilde) = 0, d the arm from the pivot: angular momentum is
 * exact.  Straight directions stretch what they turn, so a stiff body would
 * turn by tiny steps, which pass the test.  Returns the change of E, J s^2. */
double turn_free_body(Newton *newton);

/* ---- multigrid.c: the same phases for large squares, without a factor */

extern const NewtonPhases multigrid_phases;

/* ---- rounding.c: what guards the digits.  Two places lose them.  Near a
 * minimum every further decrease may be smaller than the rounding of E.  And
 * where w k outweighs the masses beyond the 16 digits of a double, the gradient
 * itself may be rounding, and along a far direction its slope anything.  In the
 * second kind of scene, and in every one without a line search, a minimisation
 * is held to what E really is. */

/* Starts the guard at the start of a minimisation. */
void rounding_start(Newton *newton);

/* Whether a change of E, J s^2, is at most a few units in its last place. */
bool is_below_roundoff(const Newton *newton, double change);

/* Whether E at u_trial, as large as it is, agrees that it has changed by
 * record.change or fallen more; true where energy_is_within_limit decides, or
 * nothing has to fall. */
bool rounding_confirms_change(Newton *newton);

/* Whether E at u, x [2n] is as low as at the start; always true where the
 * minimisation is not held to it. */
bool energy_is_within_limit(const Newton *newton, const double *u,
                            const double *x);

/* Judges an iteration whose p did not pass the test.  If the residual has not
 * become smaller for long, returns ROUNDING_LIMIT where E has stopped to fall,
 * and ITERATION_LIMIT where there is no line search.  Otherwise RUNNING. */
Status rounding_test_stagnation(Newton *newton);

#endif
