/* option_values.h - values of options, from what is typed; and what to say
 * where it cannot be read.
 */
#ifndef ELASTO_OPTION_VALUES_H
#define ELASTO_OPTION_VALUES_H

#include "scenes/options.h"

/* Where the one line that explains a refusal goes. */
typedef struct Complaint {
    char *text;
    size_t size;
} Complaint;

/* Something short to be printed inside a line. */
typedef struct Text {
    char text[256];
} Text;

/* Writes the line; returns INVALID_INPUT. */
Status complain(const Complaint *complaint, const char *format, ...);

/* What somebody typed: one line, and short enough to leave room. */
Text typed(const char *word);

/* 1e-30, 4096, 1e15: as people write it. */
Text number_text(double number);

/* Adds to a list: "--a, --b". */
void add_name(Text *list, const char *before, const char *name);

/* How many names the values of a row have; 0: they are numbers. */
int option_names(const OptionRow *row);

/* "--side: '0' is not a number from 1e-30 to 1e30, in m" */
Status refuse_number(const OptionRow *row, int count, const char *text,
                     const Complaint *complaint);

/* What the option is followed by on the command line, into its field; nothing
 * for a page is the first.
 * Returns OK or INVALID_INPUT with the reason. */
Status option_apply(const OptionRow *row, const char *text, Options *options,
                    const Complaint *complaint);

/* The name that is most like a text, of those that were looked at. */
typedef struct Nearest {
    const char *text;
    const char *kind, *name; /* "--", "segments"; name NULL: none is like it */
    int unlike;              /* letters that are wrong */
} Nearest;

/* Looks at one more name: at most a quarter of its letters are wrong,
 * missing, too many or swapped; capitals, '_' and '-' count as what they mean.
 */
void look_at_name(Nearest *nearest, const char *kind, const char *name);

#endif
