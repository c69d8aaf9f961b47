/* stress_large.h - large squares by multigrid, judged in extended precision.
 */
#ifndef ELASTO_STRESS_LARGE_H
#define ELASTO_STRESS_LARGE_H

#include "stress.h"

typedef enum LargeVerdict {
    LARGE_PASSED,
    LARGE_FAILED,
    LARGE_UNDECIDED /* too close to the tolerance, or too slow */
} LargeVerdict;

/* The test of Algorithm 3 at the iterate of a minimisation by springs alone,
 * not averaged. */
LargeVerdict large_judge(const Newton *newton);

/* So many steps of this command line by multigrid; false and a reason [512]
 * where one that is called converged is not. */
bool large_steps(const char *line, int steps, Tally *tally, char *reason);

/* For the list of cases. */
bool large_squares(Tally *tally, char *reason);
bool random_large_squares(Tally *tally, char *reason);

#endif
