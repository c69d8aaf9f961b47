/* central_field.h - the central field, P(x) = omega2/2 sum m |x|^2: every node
 * is drawn to the origin with the acceleration -omega2 x.
 */
#ifndef ELASTO_CENTRAL_FIELD_H
#define ELASTO_CENTRAL_FIELD_H

#include "model/system.h"

extern const TermKind central_field;

/* Adds the field, changes it, or takes it away where omega2 is 0.
 *   omega2  1/s^2
 * Returns OK, OUT_OF_MEMORY, TOO_LARGE (no room in the list). */
Status central_field_set(System *system, double omega2);

/* omega2 of the system's field, 1/s^2; 0 where it has none. */
double central_field_omega2(const System *system);

#endif
