/* colour_map.h - colours of the pictures; each means one thing, and those that
 * meet are told apart by colour-blind eyes (Okabe and Ito 2008).
 */
#ifndef ELASTO_COLOUR_MAP_H
#define ELASTO_COLOUR_MAP_H

#include "picture/text.h"

/* Paper and words. */
#define COLOUR_WHITE   0xffffffffu
#define COLOUR_TEXT    0xff1c1c1cu
#define COLOUR_FAINT   0xff6a6a6au
#define COLOUR_GREY    0xff9c9c9cu /* the step before, contours, ticks */
#define COLOUR_GRID    0xffe4e4e4u
#define COLOUR_RULE    0xffdcdcdcu /* between zones */
#define COLOUR_BORDER  0xffcfcfcfu /* of cards and chips */
#define COLOUR_CHIP    0xfff6f6f6u
#define COLOUR_LIT     0xfffff1cdu /* the line, the chip, the setting now */
#define COLOUR_GLOW    0xffffe14du /* around the term at the mouse */
#define COLOUR_PANEL   0xd8ffffffu /* under words on a picture */
#define COLOUR_NOTE    0xfffffff4u /* under words at the mouse */
#define COLOUR_WARNING 0xffd00000u
#define COLOUR_VALUE   0xff0044b0u /* what can be changed */
#define COLOUR_BAR     0xffccd6eau /* a step in the time line */

/* The slides' letters, the same wherever they stand. */
#define COLOUR_X        0xff0000ffu /* positions, springs; as on the slides */
#define COLOUR_FOLDED   0xff0a0a3cu /* faces of cells that have turned over */
#define COLOUR_X_TILDE  0xff8e3fb0u /* where inertia alone leads */
#define COLOUR_P        0xffc96a00u /* the search direction, and its model */
#define COLOUR_ALPHA    0xff00796bu /* step lengths */
#define COLOUR_PROJECT  0xffd3156bu /* springs whose block was changed */
#define COLOUR_GHOST    0xffb08d57u /* the outcome with other settings */
#define COLOUR_HAND     0xff2e7d32u /* what the mouse holds */
#define COLOUR_VELOCITY 0xff117733u /* v of one mass */
#define COLOUR_FORCE    0xff9a5b00u /* contact forces */
#define COLOUR_SOLID    0xffe9e6e0u /* walls, balls */
#define COLOUR_EDGE     0xff8b8578u /* their outline */

/* Strain. */
#define COLOUR_STRETCH  0xffd55e00u
#define COLOUR_REST     0xffb8b8b8u
#define COLOUR_COMPRESS 0xff0072b2u
#define COLOUR_PLASTIC  0xff7b1fa2u /* what has flowed */

/* Where E is not convex, and words about it. */
#define COLOUR_SHADE  0xfffdf0d5u
#define COLOUR_SHADED 0xff8a6100u

/* Where directions point downhill. */
#define COLOUR_DOWNHILL 0x2656b4e9u

/* Panes and integrators side by side. */
Colour colour_of_run(int run);

/* That of a letter or of an energy, the terms of formulas: 0, 1, ...; behind
 * the last one 0. */
Colour colour_of_term(int term);

/* An energy, by the name that the ledger gives it; an integrator, by its name:
 * the same colour alone and among others. */
Colour colour_of(const char *name);

/* From one colour at -range over COLOUR_REST at 0 to another at range > 0;
 * strains outside get the colour of the end, NaN that of rest. */
Colour colour_of_strain(double strain, double range, Colour below,
                        Colour above);

#endif
