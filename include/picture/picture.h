/* picture.h - a picture of a scene, or a card, is a row of functions.
 *
 * A scene names its picture.  A new picture is one source file, a PictureKind
 * in scene.h, and a row in cards.txt, from which the tables are generated. */
#pragma once

#include "picture/paper.h"
#include "picture/frame_content.h"

typedef struct Plot Plot; /* drawing area with its coordinates (plot.h) */

enum { CARD_COLUMNS = 9, CARD_CELL = 160 }; /* most columns; bytes of a cell */

/* A row of a card's table or legend. */
typedef struct CardTableRow {
    int columns;                        /* number of columns */
    Colour colour;                      /* colour of the first cell */
    char cell[CARD_COLUMNS][CARD_CELL]; /* markup; "": not known yet */
} CardTableRow;

/* A box of the column with numbers or a graph about the active pane. */
typedef struct Card {
    const char *name;  /* name in tables and scripts, such as "listing" */
    const char *title; /* text (live_values.h): first line of known values */
    double min_height; /* ems */
    /* Returns the minimum height in ems of a card whose content is `wide` ems
     * wide; an em has `em` pixels.  NULL: min_height. */
    double (*find_least_height)(const FrameContent *content, double wide,
                                double em);
    double height_weight;   /* weight with which the card shares free height */
    bool fits_half_width;   /* two such cards may share a row */
    bool fits_half_page;    /* on a page, two such cards may share a row */
    bool starts_closed;     /* shows only its title at first */
    bool needs_line_energy; /* draws the graph of E along the direction p */
    /* place of a main card: the picture's, or below or beside the picture */
    enum { SWAPS_PICTURE, BELOW_PICTURE, BESIDE_PICTURE } main_place;
    bool is_only_in_lecture; /* is hidden outside of the lecture */
    const char *words; /* text (live_values.h); unknown lines are left out */
    const struct ListingRow *listing; /* lines of an algorithm (cards.h) */
    const char *column_heads; /* text: heads of the columns, with | between */
    /* Fills a row; rows are numbered from 1 on, as the heads are row 0. Returns
     * false after the last row.  A call for row 0 fills nothing, and returns
     * false if the table is empty.  NULL: the card has no table. */
    bool (*make_row)(const FrameContent *content, int row, CardTableRow *cells);
    const char *legend; /* text: the legend of the graph, or NULL */
    /* Fills a row of a legend with values: a name and a value.  Returns false
     * after the last row.  NULL: the graph has no such legend. */
    bool (*make_legend_row)(const FrameContent *content, int row,
                            CardTableRow *cells);
    /* Draws the content: curves, words, table and legend; on the web page
     * only curves.  NULL: `words` or `listing` is written. */
    void (*draw)(const Plot *card);
    bool is_text_only; /* draws only text, which the web page writes itself */
} Card;

typedef struct Picture {
    int card_count; /* number of cards */
    const Card *const *cards;
    bool is_stretched;  /* scales x and y differently, to fill the stage */
    bool draws_handles; /* draws and picks the scene's handles itself */
    bool takes_clicks;  /* a click sets a start point or the guess */
    /* Finds the part of the world to show: left, bottom, right, top, m.  The
     * stage has no camera yet.  NULL: default_bounds. */
    void (*find_bounds)(const Plot *stage, double bounds[4]);
    double default_bounds[4]; /* left, bottom, right, top (m) */
    void (*draw)(Plot *stage);
    /* Adds the live values that the picture's texts use; may be NULL. */
    void (*add_values)(const Simulation *simulation, LiveValues *values);
    const char *legend;   /* text in the upper left corner, or NULL */
    bool shows_scale_bar; /* draws a scale of metres in the lower left corner */
    /* Finds the part of the picture at pixel (x, y); pick->point is the pixel's
     * place in the world.  NULL: finds only switches, handles and positions. */
    void (*pick)(const Plot *stage, double x, double y, Pick *pick);
    /* Draws a note about the picture's part under the mouse; may be NULL. */
    void (*draw_hover_note)(Plot *stage);
    /* Samples energies for the history; may be NULL. */
    int (*get_energies)(const Simulation *simulation, Energy *row);
} Picture;

const Picture *picture_of_scene(const struct Scene *scene);

static inline const Picture *active_picture(const FrameContent *content)
{
    return picture_of_scene(active_pane(content)->simulation->scene);
}

/* Finds the index of the picture's card with this name; -1: no such card. */
int picture_find_card(const Picture *picture, const char *name);

/* Draws a frame: stage, cards, title bar, settings, time line and chips. */
void frame_draw(Paper *paper, const FrameContent *content);

/* Draws the content of one card, without frame and title, on a whole paper.
 *   card  index in the picture of the active pane's scene */
void frame_draw_card(Paper *paper, const FrameContent *content, int card);
