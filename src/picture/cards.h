/* cards.h - the pictures, one source each; the cards of the column; strip, row
 * of settings, time line, last line.
 */
#ifndef ELASTO_CARDS_H
#define ELASTO_CARDS_H

#include "picture/facts.h"
#include "picture/plot.h"

/* A card that is wider is a page's star, ems. */
static const double STAR_WIDE = 40;

/* Springs and nodes of a square, and what a step does to them. */
extern const Picture square_picture;

/* Integrators on the circle: trails around the exact one, radius over time.
 * One mass and the arrows of its next step. */
extern const Picture circle_picture, mass_picture;

/* Newton in one unknown: f, its quadratic models and the iterates; g and its
 * tangents above E and its parabolas. */
extern const Picture curve_picture, tangent_picture;

/* Contours of E over the position of the free node, and Newton's path; the same
 * with the path of the minimiser for every h. */
extern const Picture landscape_picture, dial_picture;

/* One spring: force, eigenvalues, energy over its length.  Error over run time,
 * a curve for each method.  Where the square converges. */
extern const Picture spring_picture, race_picture, envelope_picture;

/* What the lecture's page says; the listing of the method that runs; Algorithm
 * 2 inside line 5; what the slides' program prints of each update; E(x + alpha
 * p) - E(x) with the quadratic model and the trials; the residual of each
 * update; the law that a page is about; energies, and radii in the circle, over
 * time; the pattern of the Hessian and of its factor. */
extern const Card card_page, card_listing, card_search, card_prints, card_line,
    card_residual, card_law, card_energies, card_radius, card_spy;

/* The size of its letters in ems: the same for all pages that fit. */
double page_letters(Paper *paper, Box inside, const Show *show);

/* What a test holds of the page, below its code.  Returns the box above it; the
 * same box outside of the lecture. */
Box page_draw_claim(Paper *paper, Box inside, const Show *show);

/* What a page knows of its law, and where the scene is on it. */
void law_facts(const Simulation *simulation, Facts *facts);

/* A quantity of a history at this time, or at the last point before it, J; what
 * is only rounding beside the others, at that time and at the beginning, is 0;
 * infinite where the present energies are no numbers, NaN where there is no
 * point. */
double energies_value(const Simulation *simulation, const History *history,
                      int series, double time);

/* The axis of the energies: that of the whole run, unless what is shown so far
 * would vanish on it; logarithmic where the energy has grown beyond a million
 * times its start.
 *   last  out, s, the latest time that the curves may reach */
Axis energies_axis(const Show *show, double *last);

/* The newest spring of a page on which springs write the Hessian, from 0. */
int lecture_spring(const Simulation *simulation);

/* What is inside the frame of a card, below its title; em in pixels. */
Box cards_inside(Box card, double em);

/* In the middle of a card that has nothing to show yet: the first line of a
 * text that is known. */
void cards_hint(const Plot *card, const char *text);

/* All cards of the layout, or the page in their place. */
void cards_draw(Paper *paper, const Layout *layout, const Show *show);

/* On a page: what has the colour of the term at the mouse, or of the line of
 * Algorithm 3 that is walked, lights up in all that is drawn. */
void glow_draw(Paper *paper, const Show *show);

/* Strip, row, time line, last line. */
void frame_draw(Paper *paper, const Layout *layout, const Show *show);

/* Steps that the time line has room for: those there are, at least some. */
long frame_span(const Show *show);

/* The last update of a descent; before the first one, the one to come.  The
 * residual is that of the present iterate: at the end the one that passes. */
const Trace *descent_trace(const Simulation *simulation, DescentTrace *space);

/* The step length of trial 1, 2, ... */
double trace_alpha(const Trace *trace, int trial);

#endif
