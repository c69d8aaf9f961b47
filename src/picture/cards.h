/* cards.h - functions and tables that pictures, cards and cards.txt share. */
#pragma once

#include "picture/colour_map.h"
#include "picture/live_values.h"
#include "picture/plot.h"

static const double MAIN_CARD_WIDTH = 40; /* ems, least width of a main card */
static const double TITLE_BAR = 2.0;      /* ems, height of a card's title */
static const double CARD_ROW = 1.45; /* ems, least height of a table's row */

/* A line of an algorithm.  The strings are in the markup of live_values.h. */
typedef struct ListingRow {
    /* Conditions for showing and crossing out the row: texts, fulfilled if all
     * values in a line are known.  shown_if NULL: end of the rows. */
    const char *shown_if, *crossed_out_if;
    AlgoLine at_line; /* line of Algorithm 3 in this row */
    bool is_indented;
    const char *text;
    const char *value; /* text at the right, once the line is executed */
} ListingRow;

/* A row of a listing as the present frame shows it. */
typedef struct ShownRow {
    bool is_highlighted, is_crossed_out;
    TextLine text;
    TextLine value; /* empty until the step has reached the line */
} ShownRow;

/* Tables and texts that cards.awk generates from cards.txt. */
extern const Picture pictures[PICTURE_COUNT];
extern const Card card_law, card_line, card_eigenvalues, card_prints,
    card_race_table, card_tangent_numbers, card_updates;
extern const ListingRow rows_listing[];
extern const char text_sentences[], text_methods[], text_states[],
    text_triplets[], text_undrawn[], text_node[], text_spring[];

/* Functions of a type have the same parameters, even unused ones. */
#pragma GCC diagnostic ignored "-Wunused-parameter"

/* Functions that cards.txt names; picture.h describes each kind. */
typedef void StageFindBounds(const Plot *stage, double bounds[4]);
typedef void StageDraw(Plot *stage);
typedef void StageAddValues(const Simulation *simulation, LiveValues *values);
typedef void StageFindPick(const Plot *stage, double x, double y, Pick *pick);
typedef int StageGetEnergies(const Simulation *simulation, Energy *row);
typedef void CardDraw(const Plot *card);
typedef bool CardMakeRow(const FrameContent *content, int row,
                         CardTableRow *cells);
typedef double CardFindHeight(const FrameContent *content, double wide,
                              double em);
extern StageFindBounds find_square_bounds, find_circle_bounds, find_mass_bounds,
    find_tangent_bounds, find_spring_bounds, find_race_bounds;
extern StageDraw draw_square_picture, draw_circle_picture, draw_scalar_picture,
    draw_landscape_picture, draw_mass_picture, draw_tangent_picture,
    draw_dial_picture, draw_spring_picture, draw_race_picture,
    draw_envelope_picture, draw_square_hover;
extern StageAddValues list_square_values, list_circle_values,
    list_scalar_values, list_landscape_values, list_mass_values,
    list_dial_values, list_spring_values, list_race_values,
    list_envelope_values;
extern StageFindPick square_pick, circle_pick, tangent_pick, envelope_pick;
extern StageGetEnergies square_sample_energies, mass_sample_energies;
extern CardDraw draw_page_card, draw_residual_table_card, draw_line_search_card,
    draw_residual_card, draw_energy_parts_card, draw_updates_card,
    draw_energies_card, draw_energy_budget_card, draw_orbit_radius_card,
    draw_relief_card, draw_eigenvalues_card, draw_tangent_numbers_card,
    draw_law_card, draw_hessian_pattern_card, draw_spring_profile_card,
    draw_race_table_card;
extern CardMakeRow residuals_make_row, updates_make_row, iterates_make_row,
    race_make_row, energies_make_legend_row;
extern CardFindHeight page_find_height, listing_find_height,
    energies_find_height, updates_find_height;

/* Returns the height of the page's card in the smallest letters, ems. */
CardFindHeight page_find_least_height;

/* Writes the page's claim, which a test checks, at the bottom of the box.
 * Returns the box above the claim. */
Box page_draw_claim(Paper *paper, Box inside, const FrameContent *content);

/* Whether the Hessian before projection is positive definite. */
bool local_model_is_convex(const TaylorModel *E);

/* Adds the values of the scene's law, for the element with the largest load. */
void list_law_values(const Simulation *simulation, LiveValues *values);

/* A contact between a node and a wall or an edge. */
typedef struct NodeContact {
    double nearest_point[2]; /* m, nearest point of the wall or edge */
    double node_position[2]; /* m */
    double d;                /* m, the gap */
    double d_hat;            /* m, distance at which the force begins */
} NodeContact;

/* Finds the contact with the largest force.  Returns false if all distances are
 * above d_hat, or the scene has another law. */
bool law_find_contact(const Simulation *simulation, NodeContact *gap);

/* Finds how far a body has slid, and how far a rigid body would slide, m.
 * Returns false if the scene does not draw the law of friction. */
bool law_find_slip(const Simulation *simulation, int body, double distance[2]);

/* Whether the picture has a card of this name that is not hidden. */
bool frame_has_card(const FrameContent *content, const char *name);

/* Returns a text: lines of the page's code that contain the text are lit.
 * During Algorithm 3 the text depends on the present line of the algorithm. */
const char *lecture_find_highlight(const FrameContent *content);

/* Returns the newest spring: each step adds a spring to the Hessian. */
int find_added_spring(const Simulation *simulation);

/* Returns the box inside a card, below the title; em in pixels. */
Box card_find_inner_box(Box card, double em);

/* Writes all lines with known values into a card, in letters as large as fit:
 * up to 1 em; on pages up to 1.2 ems, in main cards of pages up to 1.6 ems. */
void card_write_text(const Plot *card, const LiveValues *values,
                     const char *text);

/* Writes a line to the right of the last line, or in a new row if the card is
 * too narrow.  Returns the height of all rows, pixels.
 *   at    [2] in/out, pixels, place of the next line in the card; at first 0, 0
 *   gap   ems between two lines
 *   draw  false: the line is only measured */
int card_write_lines(const Plot *card, int at[2], double size, double gap,
                     const TextLine *line, bool draw);

/* Writes the first known line of a text in the middle of an empty card. */
void card_write_hint(const Plot *card, const char *text);

/* Draws a table.  A column is as wide as its widest cell; rows with an empty
 * first cell do not count.  If the card has not enough room, leaves out the
 * last columns in `order`, and rows after row 1.
 *   order  [CARD_COLUMNS] in, numbers of the columns; -1 ends them */
void card_draw_table(const Plot *card, const Card *table, const int *order);

/* Returns what a row of a listing shows. */
ShownRow listing_make_row(const Pane *pane, const ListingRow *row);

/* Writes the rows of a listing that are shown now; the present line is lit. */
void card_write_listing(const Plot *card, const ListingRow *row);

/* Returns the width that the code of a page needs, ems. */
double code_find_width(const LecturePage *page);

/* Fills a table's row, headings in row 0.  Returns false after the last row. */
bool card_make_row(const FrameContent *content, const Card *card, int row,
                   CardTableRow *cells);

/* Draws the content of the picture's card with this index into a box. */
void card_draw(Paper *paper, Box inside, const FrameContent *content, int card);

/* Draws the layout's cards, and the code or list that the column may show. */
void cards_draw(Paper *paper, const Layout *layout,
                const FrameContent *content);

/* On a page of the lecture, highlights all pixels in the colour of the term
 * under the mouse, or else of the term that the present line computes. */
void draw_term_highlight(Paper *paper, const FrameContent *content);

/* Draws title bar, settings, time line and chips. */
void window_rows_draw(Paper *paper, const Layout *layout,
                      const FrameContent *content);

/* Returns the step length alpha of trial 1, 2, ... of the line search. */
double find_trial_step_length(const NewtonTrace *trace, int trial);
