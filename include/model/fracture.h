/* fracture.h - springs that break (slides: fracture).
 *
 * After a step, a spring is a candidate if its strain E = |d|^2/l2 - 1 exceeds
 * its strength.  The candidate with the largest load breaks first, and at most
 * one spring at each node breaks in a step.  The springs beside it then take
 * over its load in the next step; otherwise whole rows would break at once.  A
 * broken spring stays in all lists, with k = 0.
 *
 * The strengths differ by up to a tenth, by a hash of the spring's number.
 * Without this, rounding would choose the springs of a symmetric scene. */
#pragma once

#include "model/system.h"

/* A spring that is stretched beyond its strength. */
typedef struct SpringLoad {
    double load;      /* strain divided by strength, > 1 */
    int spring_index; /* number of the spring */
} SpringLoad;

typedef struct Fracture {
    double mean_strength;  /* s_c > 0, mean strain at which springs break */
    SpringLoad *candidate; /* [springs] workspace, largest load first */
    unsigned char *has_new_break; /* [nodes] 1: a spring broke there */
} Fracture;

/* Fracture as a term; data: Fracture.  The option's number is s_c.  The term
 * has no energy.  The function end_step breaks springs and books the energy
 * that the springs and their cells had.  Fracture stands behind the terms that
 * lose energy when springs break, since their end_step must run before the
 * break. */
extern const TermKind fracture;

/* Returns the strain at which spring s breaks. */
double fracture_strength(const Fracture *fracture, int s);
