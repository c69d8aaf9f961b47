/* exhibits.h - the pictures, one source each, and the card with a page's words.
 */
#ifndef ELASTO_EXHIBITS_H
#define ELASTO_EXHIBITS_H

#include "picture/picture.h"
#include "picture/plot.h"

/* Springs and nodes of a square, and what a step does to them; from the ground
 * up: obstacles, rest shape, ghosts, folded cells, springs, nodes, pins,
 * directions and forces as arrows, what the mouse holds. */
extern const Picture square_picture;

/* Integrators on the circle: trails around the exact one, radius over time.
 * One mass and the arrows of its next step. */
extern const Picture circle_picture, mass_picture;

/* Newton in one unknown: f, its quadratic model where the last update began,
 * its minimum, and the iterates; g and its tangents above E and its parabolas.
 */
extern const Picture curve_picture, tangent_picture;

/* Contours of E over the position of the free node, and Newton's path; the same
 * with the path of the minimiser for every h. */
extern const Picture landscape_picture, dial_picture;

/* One spring: force, eigenvalues, energy over its length.  Error over run time,
 * a curve for each method.  Where the square converges, and the cell under the
 * mouse in small. */
extern const Picture spring_picture, race_picture, envelope_picture;

/* What the lecture's page says; nothing outside of the lecture. */
extern const Card card_page;

/* The size of its letters in ems: the same for all pages that fit. */
double page_letters(Paper *paper, Box inside, const Show *show);

/* What a test holds of the page, above its code.  Returns the box below it; the
 * same box outside of the lecture. */
Box page_draw_claim(Paper *paper, Box inside, const Show *show);

#endif
