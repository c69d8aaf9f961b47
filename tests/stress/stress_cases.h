/* stress_cases.h - what the named cases share: one watched simulation.
 */
#ifndef ELASTO_STRESS_CASES_H
#define ELASTO_STRESS_CASES_H

#include "stress.h"

typedef struct Case {
    Tally *tally;
    char *reason; /* [512] */
    bool wrong;
    Simulation simulation;
    TimeIntegrator *run;
    Watch watch;
} Case;

/* The first complaint is kept; returns false. */
bool case_wrong(Case *c, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Sets this command line up; close it in any case. */
bool case_open(Case *c, const char *line);

/* After a change of the system: the integrator made anew, with x, v and h of
 * the old one, its tolerance times `finer`. */
bool case_restart(Case *c, double finer);

/* Steps that must not be WRONG; that must converge. */
bool case_steps(Case *c, int steps);
bool case_converges(Case *c, int steps);

/* Frees all but the verdict, which it returns. */
bool case_close(Case *c);

/* Coordinates of all nodes. */
int case_size(const Case *c);

/* Cases of stress_answers.c. */
bool at_rest(Tally *tally, char *reason);
bool free_flight(Tally *tally, char *reason);
bool two_masses(Tally *tally, char *reason);
bool nodes_in_one_point(Tally *tally, char *reason);
bool mirrored(Tally *tally, char *reason);
bool refused_input(Tally *tally, char *reason);
bool translated(Tally *tally, char *reason);
bool rotated(Tally *tally, char *reason);
bool other_units(Tally *tally, char *reason);
bool interrupted(Tally *tally, char *reason);

#endif
