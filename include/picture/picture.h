/* picture.h - a kind of picture is a row of functions, and so is a card.
 *
 * A scene names the row it wants; to add a kind of picture is one source file
 * and one row in cards.txt, of which the tables are made.  Nothing else in the
 * program asks what kind it is.
 */
#ifndef ELASTO_PICTURE_H
#define ELASTO_PICTURE_H

#include "picture/paper.h"
#include "picture/show.h"

typedef struct Plot Plot; /* plot.h: where it is drawn, of which pane */

/* A card in the column. */
typedef struct Card {
    const char *name;  /* as tables and scripts call it: "listing" */
    const char *title; /* a text of facts.h: its first line that is known */
    double least;      /* ems, the height it needs */
    /* The same for a card that is so many ems wide inside, of so many pixels;
     * NULL: least. */
    double (*needs)(const Show *show, double wide, double em);
    double weight;     /* share of the height that is left */
    bool half;         /* half the width of a wide column is enough */
    bool half_on_page; /* the same, but only on a page of the lecture: its words
                          need the room */
    bool closed;       /* at the start */
    bool along;        /* it draws E along p, which is kept for it */
    bool below;        /* as a page's star it stands below the picture */
    bool lecture;      /* it is nowhere but on pages of the lecture */
    /* What is inside, below the title: a text, all lines that are known; an
     * algorithm line by line (cards.h); or a function draws it. */
    const char *words;
    const struct ListingRow *rows;
    void (*draw)(const Plot *card);
} Card;

typedef struct Picture {
    int count; /* of its cards */
    const Card *const *cards;
    bool stretched;   /* x and y have scales of their own */
    bool own_handles; /* it draws and picks the scene's handles */
    bool places;      /* a click is a place to start from, or a guess */
    /* The part of the world that fits the stage, which has no camera yet: left,
     * bottom, right, top; NULL: always the same. */
    void (*bounds)(const Plot *stage, double bounds[4]);
    double around[4];
    void (*draw)(Plot *stage);
    /* Adds what its texts know of a simulation; may be NULL. */
    void (*facts)(const Simulation *simulation, Facts *facts);
    const char *legend; /* a text, from the upper left corner; or NULL */
    bool scale;         /* a line with its length in the lower left one */
    /* What is under pixel (x, y) into pick, whose point is known; NULL: nothing
     * but handles and places. */
    void (*pick)(const Plot *stage, double x, double y, Pick *pick);
    /* The small card beside what the mouse is over; may be NULL. */
    void (*hover)(Plot *stage);
    /* What is kept of each state for plots; may be NULL. */
    int (*sample)(const Simulation *simulation, Energy *row);
} Picture;

/* The row of a scene. */
const Picture *picture_of(const struct Scene *scene);

/* The index of its card with this name; -1: it has none. */
int picture_card(const Picture *picture, const char *name);

/* Draws all of the paper: stage, cards, strip, row, time line, last line. */
void show_draw(Paper *paper, const Show *show);

/* Draws the inside of one card, without frame and title, over all of a paper of
 * its own.
 *   card  its index in the picture of the active pane's scene */
void show_draw_card(Paper *paper, const Show *show, int card);

#endif
