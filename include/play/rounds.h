/* rounds.h - the minimisation of one step, round by round of the loop of
 * Algorithm 3: for the cards, and to be walked through line by line.
 *
 * Newton's observer adds a round after each iteration.
 */
#ifndef ELASTO_ROUNDS_H
#define ELASTO_ROUNDS_H

#include "picture/show.h"

/* Bytes of iterates and directions that are kept of one step; later updates of
 * a longer minimisation leave their records alone. */
#define ROUNDS_BYTES ((size_t)64 << 20)

/* E along p is drawn to 3/2 of the first trial.  Where it is no polynomial it
 * is kept at parts of that, 1/32 of the trial apart: first, first/2, ... are
 * among them. */
enum { ROUND_PARTS = 32, ROUND_VALUES = ROUND_PARTS * 3 / 2 + 1 };

/* A list that grows. */
typedef struct Records {
    NewtonRecord *row; /* [count] */
    int count, room;
    bool lost; /* there was no memory for more */
} Records;

/* Makes room for so many.  Returns false where memory is missing. */
bool records_fit(Records *records, int count);

typedef struct Round {
    double *x, *p, *u; /* [size] m, x^i, p^i, x^i - x_n; NULL: not kept */
    double first;      /* alpha that the line search begins with */
    Quartic along; /* E(x + alpha p) - E(x), J s^2, where it is this alone */
    bool rough;    /* it is not: */
    double alpha, change; /* the one that was taken, and what E did, J s^2 */
    bool sampled;         /* and these are kept: */
    double *value;        /* [ROUND_VALUES] J s^2, behind u */
} Round;

/* A place in the listing: which line of which round; in the line search, how
 * many trials have been made. */
typedef struct Station {
    int round;
    Line line;
    int trials;
} Station;

typedef struct Rounds {
    Trace start;     /* h and epsilon that the step is made with */
    int size;        /* 2n; 0: nobody asks for them */
    Records made;    /* record of each round */
    Round *round;    /* [made.count] */
    int room;        /* rounds that have memory */
    bool all;        /* E along p is kept of every round */
    bool last;       /* E along p is kept of the last round */
    double *x_tilde; /* [size] m; NULL: not known */
    double *end;     /* [size] m, iterate after the last round; or NULL */
    size_t bytes;
    Station *place; /* [places] in the order of the listing; none where memory
                       is missing */
    int places;
} Rounds;

/* Before a step.
 *   all   E along p is kept of each round, for a walk through the step
 *   last  E along p is kept of the last round, which is drawn */
void rounds_begin(Rounds *rounds, const Simulation *simulation, bool all,
                  bool last);

/* Whether E along p is not kept of the round at a place, or of the last one for
 * place -1, and would be if the step was made once more with `all`. */
bool rounds_lack_line(const Rounds *rounds, int place);

/* After a Newton iteration.  Nothing is kept where memory is missing. */
void rounds_add(Rounds *rounds, const Newton *newton,
                const NewtonRecord *record);

/* After the step: the places to walk through, filled in for these settings. */
void rounds_end(Rounds *rounds, const Options *options);

/* Forgets all but the memory. */
void rounds_clear(Rounds *rounds);
void rounds_free(Rounds *rounds);

/* From one place to the next (way 1) or to the one before (-1).
 *   fine   how small a pace: 1 whole updates, 2 lines
 *   place  index in rounds->place
 * Returns the index; the same one where there is no other in this step. */
int rounds_walk(const Rounds *rounds, int fine, int place, int way);

/* The last place of this round that is not behind this line; where there is no
 * such round, the last place of all. */
int rounds_find(const Rounds *rounds, int round, Line line);

/* The place where E was highest, if the step has raised it by far more than it
 * has changed it in the end: an explosion that is over; -1: there was none. */
int rounds_peak(const Rounds *rounds);

/* What the picture shows at a place; -1: the whole step is over.  All pointers
 * stay those of the rounds.  Returns the positions to draw, [size] m, or NULL:
 * those of the state after the step. */
const double *rounds_trace(const Rounds *rounds, int place, Trace *trace);

#endif
