/* kinds.h - the other kinds of pictures, one source each. */
#ifndef ELASTO_KINDS_H
#define ELASTO_KINDS_H

#include "picture/picture.h"

/* Integrators on the circle: trails around the exact one, radius over time. */
extern const Picture circle_picture;

/* Newton in one variable: f, its quadratic model where the last update began,
 * the minimum of the model, and the iterates. */
extern const Picture curve_picture;

/* Contours of E over the position of the free node, and Newton's path. */
extern const Picture landscape_picture;

/* Nodes and springs as they are, for scenes without a picture of their own. */
extern const Picture plain_picture;

#endif
