/* exhibits.h - pictures of the lecture's small scenes, one source each, and the
 * card with a page's words.
 */
#ifndef ELASTO_EXHIBITS_H
#define ELASTO_EXHIBITS_H

#include "picture/picture.h"
#include "picture/plot.h"

/* One mass and the arrows of its next step. */
extern const Picture mass_picture;

/* Newton in one dimension: g and its tangents above E and its parabolas. */
extern const Picture tangent_picture;

/* The landscape with the path of the minimiser for every h. */
extern const Picture dial_picture;

/* What dial and landscape share: what fits the stage; the map of the parts of E
 * that are on, springs, pins and x_tilde. */
void landscape_bounds(const Show *show, int pane, double bounds[4]);
Plot landscape_ground(Paper *paper, const Stage *stage, const Show *show);

/* The circle's colour of a run: its own, by its method, whatever else runs. */
Colour circle_colour(const Simulation *simulation, int run);

/* One spring: force, eigenvalues, energy over its length. */
extern const Picture spring_picture;

/* Error over run time, a curve for each method. */
extern const Picture race_picture;

/* Where the square converges, and the cell under the mouse in small. */
extern const Picture envelope_picture;

/* What the lecture's page says; nothing outside of the lecture. */
extern const Card card_page;

/* The size of its letters in ems: the same for all pages that fit. */
double page_letters(Paper *paper, Box inside, const LecturePage *page);

/* What a test holds of the page, above its code.  Returns the box below it; the
 * same box outside of the lecture. */
Box page_draw_claim(Paper *paper, Box inside, const Show *show);

#endif
