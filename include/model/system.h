/* system.h - what is simulated: masses, springs, a central field, pins.
 *
 * Its potential is P(x) = sum of the terms it has; a term that a scene lacks
 * costs nothing.  All arrays are constant while time runs.
 */
#ifndef ELASTO_SYSTEM_H
#define ELASTO_SYSTEM_H

#include "model/psd.h"
#include "base/status.h"

typedef struct System {
    int nodes;             /* n */
    int springs;           /* 0: no springs */
    int *e;                /* [2 springs] nodes of each spring */
    double *m;             /* [n] kg, > 0 */
    double *l2;            /* [springs] m^2, rest length squared, > 0 */
    double *k;             /* [springs] J/m^2, stiffness, > 0 */
    double omega2;         /* 1/s^2, central field a = -omega2 x; 0: none */
    unsigned char *pinned; /* [n] 1: the node never moves; NULL: no pins */
    int *order;            /* [n] elimination order, or NULL */
} System;

/* Allocates the arrays (pinned and order stay NULL), all zero.
 * Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
Status system_create(int nodes, int springs, System *system);

/* Allocates system->pinned, all 0.  Returns OK, OUT_OF_MEMORY. */
Status system_create_pins(System *system);

/* Accepts NULL and a zeroed struct. */
void system_free(System *system);

/* Checks what the struct promises: every number finite and in its range, every
 * spring between two different nodes.  x [2n] m, in: must be finite.
 * Returns OK or INVALID_INPUT. */
Status system_check(const System *system, const double *x);

/* P(x), J.  x [2n] m, in. */
double system_potential(const System *system, const double *x);

/* g += scale * grad P(x); 0 for pinned nodes.  x [2n] m in, g [2n] in/out. */
void system_gradient(const System *system, const double *x, double scale,
                     double *g);

/* g = 0 for pinned nodes.  g [2n] in/out. */
void system_clear_pinned(const System *system, double *g);

/* a = -M^-1 grad P(x), m/s^2.  x [2n] m in, a [2n] out. */
void system_acceleration(const System *system, const double *x, double *a);

/* Whether only springs act: they cannot move the centre of mass. */
bool system_is_free(const System *system);

/* sum m |v|^2 / 2, J.  v [2n] m/s, in. */
double system_kinetic(const System *system, const double *v);

/* |g|_(M^-1) = sqrt(sum |g_i|^2 / m_i).  g [2n] in. */
double system_inverse_mass_norm(const System *system, const double *g);

#endif
