/* live_values.h - numbers and words of a frame by name, and their texts.
 *
 * A text is lines of markup in which a name in braces stands for a live value:
 * "line 5: {alpha} = {length:/}".
 *   - A line with an unknown value is left out.  A flag adds no words, and is
 *     unknown if false.  Many texts show only their first line of known values.
 *   - {-H} is the negative of H.  After a colon: the number of digits (else 3),
 *     / to write 1/4 instead of 0.25, ' to put a negative number in
 *     parentheses.  Braces of the markup (text.h) stay markup.
 *   - "#warning " before a line sets its colour; "#warning* ": bold, too.
 *   - Lines after a line "@" are repeated with the values of the runs 1, 2, 3;
 *     "#run " is the run's colour. */
#pragma once

#include "picture/picture.h"

enum { LINE_TEXT_SIZE = 512 };

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

/* A line of a text with its values filled in, and the position in the text. */
typedef struct TextLine {
    Colour colour;
    Face face;
    char text[LINE_TEXT_SIZE];
    const LiveValues *values;
    const char *next_text;      /* the text after this line */
    const char *repeated_lines; /* lines to repeat for each run, or NULL */
    int run;                    /* run whose values fill the line */
} TextLine;

/* Walks over the lines of a text that have known values (NULL: no lines):
 *     for (TextLine line = lines_begin(values, text); text_next_line(&line);)
 * After the last line line.text is empty. */
TextLine lines_begin(const LiveValues *values, const char *text);
bool text_next_line(TextLine *line);

/* Returns the first line that has known values; empty if there is none. */
TextLine text_find_known_line(const LiveValues *values, const char *text);
/* Whether a text has a line with known values. */
bool text_has_line_to_show(const LiveValues *values, const char *text);
