/* pages.h - the lecture, a page a row of a table, in the slides' order.
 *
 * A page is a scene with settings and what there is to say about it.  The
 * table is made of src/lesson/pages.txt.  To add one: write it there, and a
 * session for its claim in tests/data/claims.txt; a test reminds of it.
 */
#ifndef ELASTO_PAGES_H
#define ELASTO_PAGES_H

#include "run/message.h"
#include "run/options.h"

/* Lines of Algorithm 3 that a page can show; line 1 is the first. */
enum { LINES_WALKED = 9 };

typedef struct LecturePage {
    const char *name;    /* one word, for --lecture */
    const char *topic;   /* of the slide */
    const char *section; /* heading before it in the list of pages; or NULL */
    bool extra;          /* left out of the 80 minutes */
    const char *text;    /* what it is about: one or two sentences */
    const char *formula; /* set large below it, one a line; or NULL */
    const char *line;    /* scene and settings, as on the command line */
    const char *cards;   /* names of those that are open, with blanks between */
    const char *look;    /* what to look at */
    const char *touch;   /* what to change, and how */
    const char *ask;     /* what to guess before the rest is shown; or NULL */
    const char *answer;  /* a fact (live_values.h): the number that is guessed;
                            "click": the place to which the next step leads;
                            NULL: words */
    const char *veils; /* cards that wait for the guess, with blanks between */
    const char *star;  /* the card that is enlarged, or NULL */
    const char *law;   /* that the card of it draws (card_law.c), or NULL */
    const char *notes; /* what to say, for whoever presents it */
    double minutes;    /* that it takes */
    const char *file;  /* where its code is: as from the top folder */
    const char *function;    /* and functions in it, with ',' between */
    const char *const *code; /* their lines, up to NULL */
    const char *lit;         /* those with this text are at work */
    const char *const *walk; /* [LINES_WALKED] text in the lines at work at
                                each line of Algorithm 3; NULL: lit */
    const char *claim;       /* what a test holds */
    unsigned flips;          /* bit s: switch s of the scene is turned over */
    int picture;             /* the step that the printed page shows */
    double speed;            /* steps a frame; 0: the scene's */
    const char *open;        /* commands when it opens, ';' between; or NULL */
    const char *tell;        /* commands when N shows the answer; or NULL */
    int lines;               /* or so many lines on from where the page opens */
    unsigned layers;         /* bits of Layer */
    NextAction next;           /* what N does */
    int pause;               /* step at which playing pauses; 0: none */
} LecturePage;

/* Text, formulas, look and touch are texts of live_values.h: live numbers stand
 * in braces.  The table; it ends with a NULL name. */
extern const LecturePage lecture_pages[];

/* A letter of the pages, in the markup of text.h, and its meaning; the table
 * ends with NULL. */
typedef struct Letter {
    const char *letter, *meaning;
} Letter;

extern const Letter lecture_letters[];

/* How many pages there are. */
int lecture_count(void);

/* The page with this name, or with this number from 1; NULL: there is none. */
const LecturePage *lecture_find(const char *text);

/* Whether the page asks for a click; NULL: no page. */
bool page_wants_click(const LecturePage *page);

/* Puts a page, and what its picture shows, into options with its scene. */
void lecture_enter(const LecturePage *page, Options *options);

/* Returns the options of a page: the defaults changed by its command line.
 * Returns OK, or INVALID_INPUT with a message, which a test rules
 * out. */
Status lecture_options(const LecturePage *page, Options *options,
                       Message message);

#endif
