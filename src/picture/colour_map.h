/* colour_map.h - colours of the pictures, told apart by colour-blind eyes
 * (blue, grey and vermilion of Okabe and Ito 2008).
 */
#ifndef ELASTO_COLOUR_MAP_H
#define ELASTO_COLOUR_MAP_H

#include "picture/canvas.h"

#define COLOUR_WHITE    0xffffffffu
#define COLOUR_SPRING   0xff0000ffu /* as on the slides */
#define COLOUR_TEXT     0xff202020u
#define COLOUR_FAINT    0xff585858u
#define COLOUR_GRID     0xffdcdcdcu
#define COLOUR_PANEL    0xc0ffffffu
#define COLOUR_WARNING  0xffd00000u
#define COLOUR_STRETCH  0xffd55e00u
#define COLOUR_REST     0xffb8b8b8u
#define COLOUR_COMPRESS 0xff0072b2u
#define COLOUR_THIRD    0xff009e73u
#define COLOUR_CONTOUR  0xff9c9c9cu
#define COLOUR_SHADE    0xfffdeecfu /* where E is not convex */
#define COLOUR_SHADED   0xff8a6100u /* words about it */
#define COLOUR_TOTAL    0xff303030u
#define COLOUR_KINETIC  0xffd55e00u
#define COLOUR_ELASTIC  0xff0072b2u

/* The slides' letters, the same wherever they stand; each means one thing. */
#define COLOUR_X        0xff0000ffu /* x: positions, springs */
#define COLOUR_X_TILDE  0xff8e3fb0u /* where inertia alone leads */
#define COLOUR_P        0xffc96a00u /* the search direction */
#define COLOUR_ALPHA    0xff00796bu /* step lengths */
#define COLOUR_PROJECT  0xffd3156bu /* springs whose block was changed */
#define COLOUR_GHOST    0xffb08d57u /* the outcome with other settings */
#define COLOUR_RULE     0xffdadadau /* between zones */

/* From COLOUR_COMPRESS at -range over COLOUR_REST at 0 to COLOUR_STRETCH at
 * range > 0; strains outside get the colour of the end, NaN that of rest. */
Colour colour_map_strain(double strain, double range);

#endif
