/* facts.h - live numbers and words by name, and texts with them.
 *
 * A text is lines of markup with facts: "line 5: {alpha} = {length:/}".  A line
 * with a fact that is not known now is left out; so a fact without words is a
 * switch, and of several lines the first one that is known is often all that is
 * wanted.  Beside those of the markup (text.h) all braces are facts, {-H} is
 * -H; after a colon stands the number of digits, 3 if nothing does, a / where
 * 1/4 is to be read, a ' where a number with a sign needs parentheses.
 *
 * "#warning " in front of a line is its colour, "#warning* " is bold, too. What
 * stands after a line "@" is said for each run, 1, 2 and 3, with what is known
 * of it; "#run " is its colour.
 */
#ifndef ELASTO_FACTS_H
#define ELASTO_FACTS_H

#include "picture/picture.h"

enum { FACTS_TEXT = 512 };

/* A number, NaN: not known, and what it is; words, NULL: not known; a switch; a
 * point [2]; xx, xy and yy of a matrix, 0 where they are less than `none`.  Of
 * several facts with one name the first counts. */
void fact(Facts *facts, const char *name, double value);
void fact_words(Facts *facts, const char *name, const char *words);
void fact_when(Facts *facts, const char *name, bool on);
void fact_point(Facts *facts, const char *name, const double point[2]);
void fact_matrix(Facts *facts, const char *const names[3], const double H[3],
                 double none);

/* The number of this name; NaN: none. */
double fact_number(const Facts *facts, const char *name);

/* A line as it is written, and where in its text. */
typedef struct TextLine {
    Colour colour;
    Face face;
    char words[FACTS_TEXT];
    const Facts *facts;
    const char *rest, *each; /* what follows; what is said of each run */
    int run;
} TextLine;

/* All lines of a text that are known:
 *     for (TextLine line = text_of(facts, text); text_next(&line);)
 * At the end the words are "".  text may be NULL. */
TextLine text_of(const Facts *facts, const char *text);
bool text_next(TextLine *line);

/* The first one, and whether there is one. */
TextLine text_first(const Facts *facts, const char *text);
bool text_is_known(const Facts *facts, const char *text);

/* All known lines in a card, one below the other, as large as fits but no
 * larger than plain text.  An empty line is half as high. */
void text_in_card(const Plot *card, const Facts *facts, const char *text);

/* Words in a row from the left edge of a card, on the next line where there is
 * no room, `gap` ems apart.
 *   at  [2] in/out, pixels from the corner, where they go; at first 0, 0
 * Returns the pixels that are used up to here, downwards. */
int words_flow(const Plot *card, int at[2], double size, double gap,
               const TextLine *line);

#endif
