/* cards.h - what the sources of pictures and cards share with cards.txt and
 * with each other.
 */
#ifndef ELASTO_CARDS_H
#define ELASTO_CARDS_H

#include "picture/live_values.h"
#include "picture/plot.h"

/* ems; a wider card is the star of a page. */
static const double STAR_WIDE = 40;

/* A line of an algorithm; its texts have live values. */
typedef struct ListingRow {
    const char *shown_if; /* text: the row exists if it has a known line; NULL:
                             the end of the listing */
    Line line;            /* its place in the algorithm */
    bool indented;
    const char *struck_if; /* text: the row is struck through if it has a known
                              line; or NULL */
    const char *lit_if; /* the same for the row that is lit; NULL: the row that
                           the run is at */
    const char *text;
    const char *value; /* right of the text, once the run has reached it */
} ListingRow;

/* State of a row of a listing in the present frame. */
typedef struct ShownRow {
    bool lit, struck;
    TextLine text;
    TextLine value; /* no words before the run has reached the row */
} ShownRow;

/* Tables and texts that are generated from cards.txt; only those that sources
 * name are declared. */
extern const Picture pictures[PICTURE_COUNT];
extern const Card card_law, card_listing;
extern const ListingRow rows_listing[], rows_search[];
extern const char text_sentences[], text_methods[], text_states[],
    text_matrix[], text_eigenvalues[], text_update[], text_trials[],
    text_undrawn[], text_newest[], text_node[], text_spring[];

/* Functions that cards.txt names; picture.h describes each kind. */
typedef void StageBounds(const Plot *stage, double bounds[4]);
typedef void StageDraw(Plot *stage);
typedef void StageAddValues(const Simulation *simulation, LiveValues *values);
typedef void StagePick(const Plot *stage, double x, double y, Pick *pick);
typedef int StageSample(const Simulation *simulation, Energy *row);
typedef void CardDraw(const Plot *card);
typedef double CardNeeds(const FrameContent *content, double wide, double em);
extern StageBounds square_bounds, circle_bounds, mass_bounds, tangent_bounds,
    spring_bounds, race_bounds;
extern StageDraw square_draw, circle_draw, curve_draw, landscape_draw,
    mass_draw, tangent_draw, dial_draw, spring_draw, race_draw, envelope_draw,
    square_hover;
extern StageAddValues square_add_values, circle_add_values, scalar_add_values,
    landscape_add_values, mass_add_values, dial_add_values, spring_add_values,
    race_add_values, envelope_add_values;
extern StagePick square_pick, circle_pick, tangent_pick, envelope_pick;
extern StageSample square_sample, mass_sample;
extern CardDraw page_draw, prints_draw, line_draw, residual_draw, values_draw,
    updates_draw, energies_draw, budget_draw, radius_draw, relief_draw,
    matrix_draw, update_draw, law_draw, hessian_pattern_draw, profile_draw,
    table_draw;
extern CardNeeds page_needs, listing_needs, energies_needs;

/* Size of the page text's letters, ems: the same on all pages that fit. */
double page_letters(Paper *paper, Box inside, const FrameContent *content);

/* Writes what a test checks of the page below its code.  Returns the box above
 * that text. */
Box page_draw_claim(Paper *paper, Box inside, const FrameContent *content);

/* Whether the Hessian before projection is positive definite. */
bool landscape_is_convex(const Local *E);

/* Adds the values of the page's law, and the scene's point on its curve. */
void law_add_values(const Simulation *simulation, LiveValues *values);

/* The contact with the largest force.  law_find_gap returns false if no gap is
 * smaller than d_hat. */
typedef struct LawGap {
    double foot[2]; /* m, nearest point of the wall or edge */
    double node[2]; /* m */
    double d;       /* m, the gap */
    double d_hat;   /* m, gap at which the force begins */
} LawGap;
bool law_find_gap(const Simulation *simulation, LawGap *gap);

/* Distance that the last body has slid, and distance that a rigid body would
 * slide.  Returns false if the page is not about sliding.
 *   distance  [2] m, out */
bool law_find_slide(const Simulation *simulation, double distance[2]);

/* An energy of the history at this time, or at the last point before it, J.
 * Values that are only rounding beside the other energies become 0.  Returns
 * infinity if the present energies are not finite, NaN if no point exists. */
double energies_value_at(const Simulation *simulation, const History *history,
                         int series, double time);

/* Axis of the energies.  It covers the whole run unless the part shown so far
 * would be invisible on it, and is logarithmic if the energy has grown a
 * millionfold.
 *   last  out, s, upper limit of the times of the curves */
Axis energies_axis(const FrameContent *content, double *last);

/* Whether the picture has a card of this name, and the page shows it. */
bool frame_has_card(const FrameContent *content, const char *name);

/* Text that marks the lit lines of the page's code: while the run walks through
 * Algorithm 3 that of its line, else the page's own. */
const char *lecture_lit_code(const FrameContent *content);

/* Index of the newest spring, on a page where each step adds one spring to the
 * Hessian. */
int newest_spring(const Simulation *simulation);

/* Box inside the frame of a card, below its title; em in pixels. */
Box card_inner_box(Box card, double em);

/* Writes the first known line of a text into the middle of a card that has
 * nothing to show yet. */
void card_write_hint(const Plot *card, const char *text);

/* Returns what a row of a listing shows. */
ShownRow listing_show_row(const Pane *pane, const ListingRow *row);

/* Writes the known rows of a listing; the row of the current line is lit. */
void card_write_rows(const Plot *card, const ListingRow *row);

/* Width in ems that the code of a page needs. */
double code_needed_width(const LecturePage *page);

/* Draws the content of the picture's card with this index into a box. */
void card_draw(Paper *paper, Box inside, const FrameContent *content, int card);

/* Draws all cards of the layout; or the page that is in the column, and the
 * card on the stage. */
void cards_draw(Paper *paper, const Layout *layout,
                const FrameContent *content);

/* On a page of the lecture: highlights everything that has the colour of the
 * term under the mouse, or else of the line of Algorithm 3 that the run is at.
 */
void highlight_draw(Paper *paper, const FrameContent *content);

/* Draws strip, settings, time line and chips. */
void window_rows_draw(Paper *paper, const Layout *layout,
                      const FrameContent *content);

/* Number of steps that the time line has room for: the steps so far, but at
 * least 60. */
long time_line_steps(const FrameContent *content);

/* Step length alpha of trial 1, 2, ... of the line search. */
double trace_step_length(const Trace *trace, int trial);

#endif
