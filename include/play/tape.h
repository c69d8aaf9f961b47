/* tape.h - the minimisation of one step, as it happened, to be walked through
 * line by line in both directions.
 *
 * The solver is only listened to: after each update the next iterate and
 * direction are there to be copied.  Rounds 0 ... count-1 made an update; round
 * `count` is the one whose direction passed the test.
 */
#ifndef ELASTO_TAPE_H
#define ELASTO_TAPE_H

#include "picture/show.h"

/* Bytes of iterates and directions that one tape keeps; later updates of a
 * longer minimisation leave their records alone. */
#define TAPE_BYTES ((size_t)64 << 20)

/* E along p is drawn to 3/2 of the first trial.  Where it is no polynomial it
 * is kept at parts of that, 1/32 of the trial apart: first, first/2, ... are
 * among them. */
enum { TAPE_PARTS = 32, TAPE_VALUES = TAPE_PARTS * 3 / 2 + 1 };

typedef struct TapeRound {
    double *x, *p; /* [size] m; NULL: not kept */
    double first;  /* alpha that the line search begins with */
    Quartic along; /* E(x + alpha p) - E(x), J s^2, where it is this alone */
    double *value; /* [TAPE_VALUES] J s^2, where it is not; NULL: it is */
    double residual, slope;
    ResidualKind kind; /* of the residual */
    int projected;
} TapeRound;

/* A place in the listing: which line of which round; in the line search, how
 * many trials have been made. */
typedef struct TapePlace {
    int round;
    Line line;
    int trials;
} TapePlace;

typedef struct Tape {
    bool open; /* between tape_begin and tape_end: all else is not of this step
                */
    long step; /* the one that it is of */
    double h, tolerance; /* s, m/s, that it was made with */
    int size;            /* 2n */
    int count;           /* updates of this step */
    int room;            /* of the arrays, one more */
    TapeRound *round;
    NewtonRecord *record; /* [count] */
    int before;           /* updates of the step before, or of this step with */
                          /* other settings; 0: not known */
    int before_room;
    NewtonRecord *record_before;
    bool ended;      /* round [count] is there */
    bool passed;     /* its test was passed without a direction */
    double *x_tilde; /* [size] m */
    bool tilde;      /* it is known */
    double *scratch; /* [2 size] */
    size_t bytes;
    TapePlace *place; /* [places] in the order of the listing */
    int places;
} Tape;

/* Before a step: the tape is then that of the next one.  What it was is kept as
 * the step before it where it was that one, or this one with other settings.
 * Returns OK, OUT_OF_MEMORY. */
Status tape_begin(Tape *tape, const Simulation *simulation);

/* After a Newton iteration.  Nothing is kept where memory is missing. */
void tape_add(Tape *tape, const Newton *newton, const NewtonRecord *record);

/* After the step: the places to walk through, filled in for these settings.
 * Returns OK, OUT_OF_MEMORY. */
Status tape_end(Tape *tape, const Options *options);

/* Forgets all but the memory. */
void tape_clear(Tape *tape);
void tape_free(Tape *tape);

/* From one place to the next or the one before.
 *   fine   how small a pace: 1 whole updates, 2 lines
 *   place  index in tape->place
 * Returns the index; -1 or tape->places where it leaves the step. */
int tape_next(const Tape *tape, int fine, int place);
int tape_back(const Tape *tape, int fine, int place);

/* What the picture shows at a place; -1: the whole step is over.  All pointers
 * stay the tape's.  Returns the positions to draw, [size] m, or NULL: those of
 * the state after the step. */
const double *tape_trace(const Tape *tape, int place, Trace *trace);

#endif
