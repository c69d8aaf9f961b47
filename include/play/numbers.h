/* numbers.h - the row of numbers and choices below the stage: which ones a
 * scene has, how they are written, and what the next larger one is.
 */
#ifndef ELASTO_NUMBERS_H
#define ELASTO_NUMBERS_H

#include "play/command.h"
#include "scenes/options.h"

typedef struct Number {
    const char *option; /* its name on the command line */
    const char *name;   /* in the row, in the markup of text.h */
    const char *unit;   /* or NULL */
    int letters;        /* the longest value has */
    /* How it goes up and down: by factors, by a step, or through names; or it
     * is not in the row, and only told where runs differ in it. */
    enum { NUMBER_FACTOR, NUMBER_STEP, NUMBER_NAME, NUMBER_LABEL } kind;
    double step; /* of NUMBER_STEP */
} Number;

enum { NUMBERS_MOST = 12 };

/* The numbers that a scene makes use of.
 *   found  [NUMBERS_MOST] out
 * Returns how many. */
int numbers_of(const Options *options, const Number *found[NUMBERS_MOST]);

/* Its value as on the command line.  text [COMMAND_TEXT_SIZE] out */
void number_value(const Number *number, const Options *options, char *text);

/* The value `paces` paces up (or, below 0, down), as text; a factor of 10 is 6
 * paces, and whole paces end on 1, 1.5, 2, 3, 5, 7; names follow one another in
 * a circle.  Parts of a pace are for dragging.
 *   text  [COMMAND_TEXT_SIZE] out */
void number_paced(const Number *number, const Options *options, double paces,
                  char *text);

/* The row for an option, or NULL.  Every option that may have a list of values
 * has one. */
const Number *number_find(const char *option);

/* All rows, one after the other; NULL behind the last. */
const Number *number_row(int i);

#endif
