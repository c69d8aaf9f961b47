/* live_values.h - numbers and words of a frame by name, and their texts.
 *
 * A text is lines of markup in which a name in braces stands for a live value:
 * "line 5: {alpha} = {length:/}".
 *   - A line that names an unknown value is left out: a flag is a value without
 *     words.  Many texts show only their first known line.
 *   - {-H} is the negative of H.  After a colon: the number of digits (else 3),
 *     / to write 1/4 instead of 0.25, ' to put a negative number in
 *     parentheses.  Braces of the markup (text.h) stay markup.
 *   - "#warning " before a line sets its colour, "#warning* " makes it bold,
 *     too.
 *   - Lines after a line "@" are repeated with the values of the runs 1, 2, 3;
 *     "#run " is the run's colour.
 */
#ifndef ELASTO_LIVE_VALUES_H
#define ELASTO_LIVE_VALUES_H

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

/* Returns the number with this name; NaN: unknown. */
double values_find_number(const LiveValues *values, const char *name);

/* A line of a text with its values, and the position in the text. */
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

/* Returns the first known line of a text, empty if no line is known. */
TextLine text_first_line(const LiveValues *values, const char *text);
/* Whether a text has a known line. */
bool text_has_line(const LiveValues *values, const char *text);

/* Writes all known lines of a text into a card, as large as they fit: at most
 * as plain text, 1.2 times that on a page, 1.6 times in its enlarged card. */
void card_write_text(const Plot *card, const LiveValues *values,
                     const char *text);

/* Writes a text behind the last one, from the left edge of a card, or on the
 * next line if the width is used up.  Returns the height used so far, pixels.
 *   gap  ems between two texts
 *   at   [2] in/out, pixels from the card's corner to the next text; at first
 *        0, 0 */
int card_flow_words(const Plot *card, int at[2], double size, double gap,
                    const TextLine *line);

#endif
