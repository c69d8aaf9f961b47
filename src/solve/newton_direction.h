/* newton_direction.h - what newton.c does at each iterate: gradient, search
 * direction and the test of Algorithm 3, with as few factorisations as will do.
 */
#ifndef ELASTO_NEWTON_DIRECTION_H
#define ELASTO_NEWTON_DIRECTION_H

#include "solve/newton.h"

/* Fills g, p, residual and, of the record, what concerns them, for the present
 * x.
 * Returns OK (the test is passed), RUNNING, or a failure. */
Status newton_direction(Newton *newton);

/* Where the test was passed by the gradient alone: whether the gradient
 * vanishes at a maximum or a saddle, such as all nodes in one point.
 * Returns OK, NOT_A_MINIMUM, or a failure. */
Status newton_check_minimum(Newton *newton);

/* Wall-clock time, s; only differences mean something. */
double newton_clock(void);

#endif
