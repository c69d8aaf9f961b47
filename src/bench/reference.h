/* reference.h - where the masses really are, from a program of its own:
 * own forces, extended precision, and a kind of method that the demo has not.
 *
 * Each interval H is crossed by leapfrog with 1, 2, ... 6 steps; the six
 * results are extrapolated to steps of length 0.  Leapfrog is symmetric, so its
 * error has even powers of the step only, and what is left is O(H^12) (Gragg
 * 1965; Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I,
 * II.9).  Springs only: no pins, no central field.
 */
#ifndef ELASTO_REFERENCE_H
#define ELASTO_REFERENCE_H

#include "model/system.h"

typedef struct Reference {
    const System *system; /* not owned */
    long double *x, *v;   /* [2n] m, m/s at the end */
} Reference;

/* The state after `time` from x [2n] m, v [2n] m/s.
 *   intervals  so many that H times the angular frequency of the fastest
 *              oscillation is 1 at most
 *   out        free it with reference_free in any case
 * Returns OK, OUT_OF_MEMORY. */
Status reference_create(const System *system, const double *x, const double *v,
                        double time, long intervals, Reference *out);
void reference_free(Reference *reference);

/* sqrt(sum m |x - reference|^2 / sum m), m.  x [2n] in. */
double reference_distance(const Reference *reference, const double *x);

#endif
