/* colour_map.h - the colours of the pictures.
 *
 * Each colour has one meaning.  Colours that appear side by side can be told
 * apart by colour-blind people (Okabe and Ito 2008). */
#pragma once

#include "picture/text.h"

/* Colours of the window and its words. */
#define COLOUR_WHITE     0xffffffffu
#define COLOUR_TEXT      0xff1c1c1cu
#define COLOUR_FAINT     0xff6a6a6au
#define COLOUR_GREY      0xff9c9c9cu /* contours, ticks, inactive words */
#define COLOUR_GRID      0xffe4e4e4u
#define COLOUR_RULE      0xffdcdcdcu /* lines between zones of the window */
#define COLOUR_BORDER    0xffcfcfcfu /* borders of cards and chips */
#define COLOUR_CHIP      0xfff6f6f6u
#define COLOUR_LIT       0xfffff1cdu /* background of the current row or chip */
#define COLOUR_HIGHLIGHT 0xffffe14du /* background of the highlighted term */
#define COLOUR_PANEL     0xd8ffffffu /* background of words on a picture */
#define COLOUR_NOTE      0xfffffff4u /* background of the note at the mouse */
#define COLOUR_WARNING   0xffd00000u
#define COLOUR_VALUE     0xff0044b0u /* numbers that can be changed */
#define COLOUR_BAR       0xffccd6eau /* bar of a step in the time line */

/* Colours of the slides' letters and of their pictures. */
#define COLOUR_X        0xff0000ffu /* positions, springs; as on the slides */
#define COLOUR_FOLDED   0xff0a0a3cu /* faces of cells that have turned over */
#define COLOUR_X_TILDE  0xff8e3fb0u /* x_tilde, end of a step without forces */
#define COLOUR_P        0xffc96a00u /* direction p, the quadratic model */
#define COLOUR_ALPHA    0xff00796bu /* step lengths */
#define COLOUR_PROJECT  0xffd3156bu /* springs with a projected block */
#define COLOUR_GHOST    0xffb08d57u /* ghost: the outcome with other settings */
#define COLOUR_HAND     0xff2e7d32u /* the node or ball that the mouse holds */
#define COLOUR_VELOCITY 0xff117733u /* velocities, displacements */
#define COLOUR_FORCE    0xff9a5b00u /* contact forces */
#define COLOUR_SOLID    0xffe9e6e0u /* walls, balls */
#define COLOUR_EDGE     0xff8b8578u /* outline of walls and balls */

/* Colours of strain. */
#define COLOUR_STRETCH  0xffd55e00u
#define COLOUR_REST     0xffb8b8b8u
#define COLOUR_COMPRESS 0xff0072b2u
#define COLOUR_PLASTIC  0xff7b1fa2u /* plastic strain */

/* Region where E is not convex, and words about the region. */
#define COLOUR_SHADE  0xfffdf0d5u
#define COLOUR_SHADED 0xff8a6100u

/* Half plane of the directions that point downhill. */
#define COLOUR_DOWNHILL 0x2656b4e9u

/* Returns the colour that tells pane or run number `run` from the others. */
Colour colour_of_run(int run);

/* Returns the colour of horizontal (0), vertical (1) and diagonal springs. */
Colour colour_of_spring_kind(int kind);

/* Returns the colour of term 0, 1, ... of the formulas, 0 after the last term.
 * A term is a letter or an energy. */
Colour colour_of_term(int term);

/* Returns the colour of an energy or an integrator by name. */
Colour colour_of_name(const char *name);
