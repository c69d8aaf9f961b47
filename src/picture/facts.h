/* facts.h - live numbers and words by name, and texts with them.
 *
 * A text is lines of markup with facts: "line 5: {alpha} = {length:/}".  A line
 * with a fact that is not known now is left out; so a fact without words is a
 * switch, and of several lines the first one that is known is often all that is
 * wanted.  Beside those of the markup (text.h) all braces are facts; after a
 * colon stands the number of digits, 3 if nothing does, a / where 1/4 is to be
 * read, a ' where a number with a sign needs parentheses.
 *
 * "#warning " in front of a line is its colour, "#warning* " is bold, too. What
 * stands after a line "@" is said for each run, 1, 2 and 3, with what is known
 * of it; "#run " is its colour.
 */
#ifndef ELASTO_FACTS_H
#define ELASTO_FACTS_H

#include "picture/picture.h"

enum { FACTS_MOST = 160, FACTS_RUNS = 3, FACTS_TEXT = 512 };

typedef struct Fact {
    const char *name;
    int run;           /* 1, 2, 3: it is known of this one alone; 0: of all */
    const char *words; /* NULL: numbers */
    double value[2];
    bool point; /* both: "(1, 0.5)" */
} Fact;

struct Facts {
    int count, run;   /* of those that are added, or looked for, now */
    const char *each; /* where the text of each run begins; or NULL */
    Colour colour[FACTS_RUNS + 1]; /* "#run ": of the present one; "#1 " */
    Fact fact[FACTS_MOST];
};

/* A number, NaN: not known; words, NULL: not known; a switch; a point [2].  Of
 * several facts with one name the first counts. */
void fact(Facts *facts, const char *name, double value);
void fact_words(Facts *facts, const char *name, const char *words);
void fact_when(Facts *facts, const char *name, bool on);
void fact_point(Facts *facts, const char *name, const double point[2]);

/* What is known of a pane, and what its picture knows beside that. */
void facts_of(const Show *show, int pane, Facts *facts);

/* A line as it is written. */
typedef struct TextLine {
    Colour colour;
    Face face;
    char words[FACTS_TEXT];
} TextLine;

/* The next line of a text that is known.  Returns where the text goes on; NULL:
 * there was no such line, and the words are "". */
const char *text_line_of(Facts *facts, const char *text, TextLine *line);

/* The first such line of the active pane; out [size], unless it has words. */
void text_say(const Show *show, const char *text, char *out, size_t size);

/* All its known lines in a card, one below the other, as large as fits but no
 * larger than plain text.  An empty line is half as high. */
void text_in_card(Paper *paper, Box inside, const Show *show, const char *text);

/* Words in a row from the left edge of a box, on the next line where there is
 * no room, `gap` ems apart; without `draw` only their room is measured.
 *   at  [2] in/out, pixels from the corner, where they go; at first 0, 0
 * Returns the pixels that are used up to here, downwards. */
int words_flow(Paper *paper, Box inside, int at[2], double size, double gap,
               const TextLine *line, bool draw);

#endif
