/* pages.h - the tour: a table with a row for each page, in the slides' order.
 *
 * A page is a scene with settings, and texts about the scene.  The table is
 * generated from src/lesson/pages.txt.  A new page needs a text there, and a
 * session for its claim in tests/data/claims.txt. */
#pragma once

#include "simulation/options.h"

/* Length of line_highlight: lines 1 to 8 of Algorithm 3; [0] is unused. */
enum { PAGE_HIGHLIGHT_COUNT = 9 };

/* A page: a field for each word of pages.txt.  Texts: see live_values.h. */
typedef struct LecturePage {
    const char *name;         /* name for --lecture, one word */
    const char *topic;        /* title of the slide */
    const char *section;      /* heading above the page in the list, or NULL */
    bool is_extra;            /* the lecture of 80 minutes skips the page */
    const char *intro;        /* text: what the page is about */
    const char *formula;      /* text: large formulas, one on a line, or NULL */
    const char *command_line; /* scene and settings, as on the command line */
    const char *open_cards;   /* names of the open cards, separated by blanks */
    const char *answer_text;  /* text: the answer, and what to look at */
    const char *try;          /* text: what to change, and what will happen */
    const char *question;    /* text: the question before the answer, or NULL */
    const char *answer_name; /* name of the live value to guess; "click": the
                                end of the next step; NULL: words */
    const char *covered_cards; /* cards hidden before the answer, or NULL */
    const char *main_card;     /* name of the enlarged card, or NULL */
    const char *law_name;  /* name of the curve in the card `law`, or NULL */
    const char *notes;     /* text for the lecturer */
    const char *file;      /* path of the source that the key K shows */
    const char *functions; /* names of the shown functions, separated by ',' */
    const char *const *code;    /* code lines of `functions`, then NULL */
    const char *highlight_text; /* code lines with this text are highlighted */
    /* [PAGE_HIGHLIGHT_COUNT] text of the code lines that are highlighted at
     * each line of Algorithm 3; NULL: `highlight_text` */
    const char *const *line_highlight;
    const char *claim;     /* statement that a test checks */
    unsigned switch_flips; /* bit s: switch s of the scene is turned over */
    int printed_step;      /* step that the page shows when printed */
    double speed;          /* steps for each frame; 0: as in the scene */
    const char *on_open;   /* commands at the opening, separated by ';' */
    const char *on_answer; /* commands at the answer, separated by ';' */
    int key_presses; /* presses of key N before printing; 0: printed_step */
    unsigned layers; /* bits of PictureLayer: additions to the picture */
    NextAction next_action; /* effect of the key N after the answer */
    int pause_step;         /* step at which a run pauses; 0: none */
} LecturePage;

/* All pages; the table ends with a page whose name is NULL. */
extern const LecturePage lecture_pages[];

/* A letter of the pages, in markup, and its meaning.  NULL ends the table. */
typedef struct SlideLetter {
    const char *letter, *meaning;
} SlideLetter;

extern const SlideLetter lecture_letters[];

int lecture_count_pages(void);

/* Returns the page with this name, or this number from 1; NULL: none. */
const LecturePage *lecture_find_page(const char *text);

/* Return whether the page asks for a click on the picture, and whether for a
 * number.  page may be NULL. */
bool page_wants_click(const LecturePage *page);
bool page_wants_number(const LecturePage *page);

/* Sets options->page, and options from the page's fields, such as layers. */
void lecture_apply_page(const LecturePage *page, Options *options);
