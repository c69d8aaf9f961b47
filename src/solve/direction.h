/* direction.h - gradient, search direction and the test of Algorithm 3 at each
 * iterate, with as few factorisations as will do.
 */
#ifndef ELASTO_DIRECTION_H
#define ELASTO_DIRECTION_H

#include "solve/newton.h"

/* At the start of a minimisation: fills g, p, residual and, of the record, what
 * concerns them.  Where the test is passed by the gradient alone, a vanishing
 * one may be that of a maximum or a saddle, such as all nodes in one point:
 * that is looked after.
 * Returns OK (the test is passed), RUNNING, NOT_A_MINIMUM, or a failure. */
Status direction_first(Newton *newton);

/* The same after an update.  Returns OK, RUNNING, or a failure. */
Status direction_next(Newton *newton);

#endif
