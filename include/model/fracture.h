/* fracture.h - springs that break (slides: fracture).
 *
 * After a step the springs whose strain E = |d|^2/l2 - 1 exceeds their strength
 * are candidates.  The most overstretched goes first, and at most one a node a
 * step: its neighbours get its load and the next step to carry it; else whole
 * rows would shatter at once.  A broken spring has k = 0; it stays in all lists
 * and in the pattern of the Hessian.
 *
 * Strengths differ by up to a tenth, by a hash of the spring's number: in a
 * symmetric scene rounding would choose otherwise.
 */
#ifndef ELASTO_FRACTURE_H
#define ELASTO_FRACTURE_H

#include "model/system.h"

/* A spring that may break. */
typedef struct Candidate {
    double load; /* strain over strength, > 1 */
    int spring;
} Candidate;

typedef struct Fracture {
    double strength;      /* s_c > 0, a strain */
    Candidate *candidate; /* [springs] room */
    unsigned char *taken; /* [nodes] one of its springs broke in this step */
} Fracture;

/* No energy of its own; at a step's end it breaks springs and books the energy
 * that goes with them.  data: Fracture; its number is s_c.  It must stand last
 * in the list. */
extern const TermKind fracture;

/* The strain at which spring s breaks. */
double fracture_strength(const Fracture *fracture, int s);

#endif
