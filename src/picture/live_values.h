/* live_values.h - numbers and words of a frame by name, and texts that use
 * them.
 *
 * A text is lines of markup in which a name in braces stands for a live value:
 * "line 5: {alpha} = {length:/}".
 *   - A line that names an unknown value is left out.  So a value without words
 *     is a switch, and often only the first known line of a text is shown.
 *   - {-H} is the negative of H.  After a colon: the number of digits (3 if it
 * is missing), / to write 1/4 instead of 0.25, ' to put a negative number in
 *     parentheses.  Braces of the markup (text.h) stay markup.
 *   - "#warning " in front of a line sets its colour, "#warning* " makes it
 * bold, too.
 *   - Lines after a line "@" are repeated for the runs 1, 2 and 3, with the
 * values of that run; "#run " is the run's colour.
 */
#ifndef ELASTO_FACTS_H
#define ELASTO_FACTS_H

#include "picture/picture.h"

enum { VALUES_TEXT = 512 };

/* Adds a value of this name.  If a name is added twice, the first value counts.
 *   number  NaN: the value stays unknown
 *   words   NULL: the value stays unknown
 *   flag    false: the value stays unknown
 *   matrix  H [3] is xx, xy, yy; elements smaller than `tiny` become 0 */
void values_add(LiveValues *values, const char *name, double number);
void values_add_words(LiveValues *values, const char *name, const char *words);
void values_add_flag(LiveValues *values, const char *name, bool flag);
void values_add_point(LiveValues *values, const char *name,
                      const double point[2]);
void values_add_matrix(LiveValues *values, const char *const names[3],
                       const double H[3], double tiny);

/* The number with this name; NaN: unknown. */
double values_find_number(const LiveValues *values, const char *name);

/* A line of a text with its values filled in, and the position in the text. */
typedef struct TextLine {
    Colour colour;
    Face face;
    char words[VALUES_TEXT];
    const LiveValues *values;
    const char *rest; /* lines of the text after this one */
    const char *each; /* lines that are repeated for each run, or NULL */
    int run;          /* run whose values fill these lines */
} TextLine;

/* Walks over the known lines of a text (NULL: no lines):
 *     for (TextLine line = text_begin(values, text); text_next_line(&line);)
 * After the last line `words` is empty. */
TextLine text_begin(const LiveValues *values, const char *text);
bool text_next_line(TextLine *line);

/* The first known line of a text, and whether a text has a known line. */
TextLine text_first_line(const LiveValues *values, const char *text);
bool text_has_line(const LiveValues *values, const char *text);

/* Writes all known lines of a text into a card, as large as they fit but no
 * larger than plain text (1.2 times that on a page).  An empty line has half
 * the height. */
void card_write_text(const Plot *card, const LiveValues *values,
                     const char *text);

/* Writes words behind each other from the left edge of a card, and on the next
 * line if the width is used up.
 *   gap  ems between two texts
 *   at   [2] in/out, pixels from the card's corner to the next text; starts as
 *        0, 0
 * Returns the height in pixels that is used so far. */
int card_flow_words(const Plot *card, int at[2], double size, double gap,
                    const TextLine *line);

#endif
