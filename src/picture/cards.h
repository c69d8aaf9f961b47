/* cards.h - the pictures, one source each; the cards of the column; strip, row
 * of settings, time line, last line.
 */
#ifndef ELASTO_CARDS_H
#define ELASTO_CARDS_H

#include "picture/facts.h"
#include "picture/plot.h"

/* A card that is wider is a page's star, ems. */
static const double STAR_WIDE = 40;

/* A line of a listing; its texts have facts. */
typedef struct ListingRow {
    const char *of; /* it is shown where this is known; NULL: the end */
    Line line;      /* its place in the run */
    bool indented;
    const char *off; /* strikes it through where it is known, or NULL */
    const char *lit; /* lights it, or NULL: its place does */
    const char *shows, *value; /* value: at its right, once it is reached */
} ListingRow;

/* What cards.txt has: a row for each kind of picture, those cards that sources
 * name, listings, texts. */
extern const Picture pictures[PICTURE_COUNT];
extern const Card card_law, card_listing;
extern const ListingRow rows_listing[], rows_search[];
extern const char text_sentences[], text_methods[], text_states[],
    text_matrix[], text_eigenvalues[], text_update[], text_trials[],
    text_undrawn[], text_newest[], text_node[], text_spring[];

/* The functions that its rows name; picture.h says what they do. */
typedef void StageBounds(const Plot *stage, double bounds[4]);
typedef void StageDraw(Plot *stage);
typedef void StageFacts(const Simulation *simulation, Facts *facts);
typedef void StagePick(const Plot *stage, double x, double y, Pick *pick);
typedef int StageSample(const Simulation *simulation, Energy *row);
typedef void CardDraw(const Plot *card);
typedef double CardNeeds(const Show *show, double wide, double em);
extern StageBounds square_bounds, circle_bounds, mass_bounds, tangent_bounds,
    spring_bounds, race_bounds;
extern StageDraw square_draw, circle_draw, curve_draw, landscape_draw,
    mass_draw, tangent_draw, dial_draw, spring_draw, race_draw, envelope_draw,
    square_hover;
extern StageFacts square_facts, circle_facts, scalar_facts, landscape_facts,
    mass_facts, dial_facts, length_facts, race_facts, envelope_facts;
extern StagePick square_pick, circle_pick, tangent_pick, envelope_pick;
extern StageSample square_sample, mass_sample;
extern CardDraw page_draw, prints_draw, line_draw, residual_draw, values_draw,
    updates_draw, energies_draw, budget_draw, radius_draw, relief_draw,
    matrix_draw, update_draw, law_draw, spy_draw, profile_draw, table_draw;
extern CardNeeds page_needs, listing_needs, energies_needs;

/* The size of its letters in ems: the same for all pages that fit. */
double page_letters(Paper *paper, Box inside, const Show *show);

/* What a test holds of the page, below its code.  Returns the box above it. */
Box page_draw_claim(Paper *paper, Box inside, const Show *show);

/* Whether the Hessian, not projected, is positive definite. */
bool landscape_is_convex(const Local *E);

/* What a page knows of its law, and where the scene is on it. */
void law_facts(const Simulation *simulation, Facts *facts);

/* The gap, m, where the law is felt most: from foot, on a wall or an edge, to a
 * node.  Returns false where there is none that is below d_hat. */
typedef struct LawGap {
    double foot[2], node[2], d, d_hat;
    int pair[3]; /* of two bodies: the node, the edge's ends; else -1 */
} LawGap;
bool law_gap(const Simulation *simulation, LawGap *gap);

/* How far the last body has slid, m, and how far a rigid one would; false: the
 * page is not about that. */
bool law_way(const Simulation *simulation, double way[2]);

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

/* Whether the picture has a card of this name, and the page shows it. */
bool show_has_card(const Show *show, const char *name);

/* The text whose lines are lit in the page's code: that of Algorithm 3's line
 * while it is gone through, else the page's. */
const char *lecture_lit(const Show *show);

/* The newest spring of a page on which springs write the Hessian, from 0. */
int lecture_spring(const Simulation *simulation);

/* What is inside the frame of a card, below its title; em in pixels. */
Box cards_inside(Box card, double em);

/* In the middle of a card that has nothing to show yet: the first line of a
 * text that is known. */
void cards_hint(const Plot *card, const char *text);

/* The rows that are known now; that of the present line is lit. */
void rows_in_card(const Plot *card, const ListingRow *row);

/* How wide the code of a page wants to be, ems. */
double cards_code_needs(const LecturePage *page);

/* The inside of a card, with its index in the picture, in this box. */
void card_draw(Paper *paper, Box inside, const Show *show, int card);

/* All cards of the layout, or the page in their place and one on the stage. */
void cards_draw(Paper *paper, const Layout *layout, const Show *show);

/* On a page: what has the colour of the term at the mouse, or of the line of
 * Algorithm 3 that is walked, lights up in all that is drawn. */
void glow_draw(Paper *paper, const Show *show);

/* Strip, row, time line, last line. */
void frame_draw(Paper *paper, const Layout *layout, const Show *show);

/* Steps that the time line has room for: those there are, at least some. */
long frame_span(const Show *show);

/* The step length of trial 1, 2, ... */
double trace_alpha(const Trace *trace, int trial);

#endif
