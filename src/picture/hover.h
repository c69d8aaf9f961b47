/* hover.h - the small card beside a node or a spring under the mouse.
 */
#ifndef ELASTO_HOVER_H
#define ELASTO_HOVER_H

#include "picture/picture.h"

/* Node: m, x, v, force, x_tilde.  Spring: e, l2, strain, its 4x4 block of the
 * Hessian and the eigenvalues before and after projection. */
void hover_square(Plot *stage, const Show *show);

#endif
