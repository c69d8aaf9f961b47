/* step_trace.h - the iterates of one step, a round of Algorithm 3's loop each:
 * for the cards, and for a walk through the step line by line.
 *
 * Newton's observer adds a round after each iteration.
 */
#ifndef ELASTO_STEP_TRACE_H
#define ELASTO_STEP_TRACE_H

#include "picture/frame_content.h"

/* Memory for iterates and directions of one step, bytes.  Rounds beyond it keep
 * their records alone. */
#define STEP_TRACE_BYTES ((size_t)64 << 20)

/* E along p is drawn up to 3/2 of the first trial.  Where E is no polynomial it
 * is sampled, ROUND_PARTS times to the first trial, which hits first/2, ... */
enum { ROUND_PARTS = 32, ROUND_VALUES = ROUND_PARTS * 3 / 2 + 1 };

/* Records of Newton's iterations. */
typedef struct Records {
    NewtonRecord *row; /* [count] */
    int count, room;
    bool lost; /* memory was missing for a record */
} Records;

/* Makes room for this many records.  Returns false if memory is missing. */
bool records_fit(Records *records, int count);

/* A round is one Newton iteration. */
typedef struct Round {
    double *x, *p, *u; /* [size] m, x^i, p^i, x^i - x_n; NULL: not kept */
    double first;      /* alpha, first trial of the line search */
    Quartic along;     /* polynomial part of E(x + alpha p) - E(x), J s^2 */
    bool rough;        /* E along p is more than its polynomial part */
    bool sampled;      /* `value` is filled */
    double alpha;      /* step length that was taken */
    double change;     /* change of E at alpha, J s^2 */
    double *value;     /* [ROUND_VALUES] J s^2, E along p; behind u in memory */
} Round;

/* A line of a round in the listing. */
typedef struct TracePlace {
    int round;
    Line line;
    int trials; /* trials of the line search so far */
} TracePlace;

typedef struct StepTrace {
    Trace start;       /* h and epsilon of the step */
    int size;          /* 2n; 0: no rounds are kept */
    Records made;      /* Newton's record of each iteration */
    Round *round;      /* [made.count] one for each Newton iteration */
    int room;          /* rounds that memory was reserved for */
    bool all;          /* E along p is kept for each Newton iteration */
    bool last;         /* E along p is kept for the last Newton iteration */
    double *x_tilde;   /* [size] m, or NULL */
    double *end;       /* [size] m, x after the last iteration, or NULL */
    size_t bytes;      /* memory of the rounds */
    TracePlace *place; /* [places] in the order of the listing */
    int places;        /* 0 also where memory is missing */
} StepTrace;

/* Begins a step.
 *   all   E along p is kept for each round, for a walk through the step
 *   last  E along p is kept for the last round, since it is drawn */
void step_trace_begin(StepTrace *kept, const Simulation *simulation, bool all,
                      bool last);

/* Whether the samples of the round at a place are missing, but would be there
 * if the step was made again with `all`.  place -1: the last round. */
bool step_trace_lacks_line(const StepTrace *kept, int place);

/* Adds the round of a Newton iteration.  Without memory only its record is
 * kept. */
void step_trace_add(StepTrace *kept, const Newton *newton,
                    const NewtonRecord *record);

/* Ends a step: lists its places. */
void step_trace_end(StepTrace *kept, const Options *options);

/* Empties the trace, but keeps the memory of lists. */
void step_trace_clear(StepTrace *kept);
void step_trace_free(StepTrace *kept);

/* The next place (way 1) or the one before (-1).
 *   fine   1: at the ends of updates, 2: at each line
 *   place  index in kept->place
 * Returns its index, or `place` at the end of the step. */
int step_trace_walk(const StepTrace *kept, int fine, int place, int way);

/* Returns the last place of a round up to a line; the last place of all where
 * there is no such round. */
int step_trace_find(const StepTrace *kept, int round, Line line);

/* Returns the place where E was highest if E rose by ten times what the step
 * has changed it by in the end, an explosion; else -1. */
int step_trace_peak(const StepTrace *kept);

/* Fills what a picture shows at a place, or after the step for place -1.  The
 * pointers lead into the rounds.  Returns the positions to draw, [size] m, or
 * NULL: those of the state after the step. */
const double *step_trace_at(const StepTrace *kept, int place, Trace *trace);

#endif
