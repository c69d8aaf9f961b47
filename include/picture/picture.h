/* picture.h - a kind of picture is a row of functions; a card is another row.
 *
 * A scene names the picture that shows it.  A new kind of picture is one source
 * file and one row in cards.txt, from which the tables are generated.  The rest
 * of the program never asks for the kind.
 */
#ifndef ELASTO_PICTURE_H
#define ELASTO_PICTURE_H

#include "picture/paper.h"
#include "picture/frame_content.h"

typedef struct Plot Plot; /* drawing area with its coordinates (plot.h) */

/* A card in the column. */
typedef struct Card {
    const char *name; /* name in tables and scripts: "listing" */
    /* Title: the first known line of this text of live_values.h. */
    const char *title;
    double min_height; /* ems */
    /* Minimum height in ems of a card whose content is `wide` ems wide; an em
     * has `em` pixels.  NULL: min_height. */
    double (*needed_height)(const FrameContent *content, double wide,
                            double em);
    double weight;           /* share of the height that is left over */
    bool half_width;         /* fits into half of a wide column */
    bool half_width_on_page; /* fits into half of it on a page of the lecture,
                                where the page's text needs the room */
    bool starts_closed;
    bool needs_line_energy; /* draws E along p, which play then computes */
    bool below_picture;   /* is below the picture when it is the page's star */
    bool only_in_lecture; /* is hidden outside of the lecture */
    /* Content, one of three: a text of which all known lines are shown, an
     * algorithm line by line (cards.h), or a function that draws it. */
    const char *words;
    const struct ListingRow *rows;
    void (*draw)(const Plot *card);
} Card;

typedef struct Picture {
    int count; /* number of cards */
    const Card *const *cards;
    bool stretched;    /* x and y have different scales */
    bool own_handles;  /* draws and picks the scene's handles itself */
    bool takes_clicks; /* a click on it sets a start or a guess */
    /* Finds the part of the world that fits the stage: left, bottom, right,
     * top. The stage has no camera yet.  NULL: default_bounds. */
    void (*bounds)(const Plot *stage, double bounds[4]);
    double default_bounds[4];
    void (*draw)(Plot *stage);
    /* Adds the live values that texts about a simulation use; may be NULL. */
    void (*add_values)(const Simulation *simulation, LiveValues *values);
    const char *legend; /* text in the upper left corner, or NULL */
    bool shows_scale; /* has a line with its length in the lower left corner */
    /* Finds what is under pixel (x, y); the caller has set pick->point.  NULL:
     * the picture has only handles and places. */
    void (*pick)(const Plot *stage, double x, double y, Pick *pick);
    /* Draws the note about what the mouse is over; may be NULL. */
    void (*hover)(Plot *stage);
    /* Fills the row of the history that belongs to a state; may be NULL. */
    int (*sample)(const Simulation *simulation, Energy *row);
} Picture;

/* The picture of a scene. */
const Picture *picture_of(const struct Scene *scene);

/* Index of the picture's card with this name; -1: the picture has no such card.
 */
int picture_card(const Picture *picture, const char *name);

/* Draws a whole frame: stage, cards, strip, settings, time line, chips. */
void frame_draw(Paper *paper, const FrameContent *content);

/* Draws the inside of one card, without frame and title, over all of a paper of
 * its own.
 *   card  its index in the picture of the active pane's scene */
void frame_draw_card(Paper *paper, const FrameContent *content, int card);

#endif
