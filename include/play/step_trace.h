/* step_trace.h - the iterates of a step, for cards and for a walk through it.
 *
 * A position of a walk is a line of Algorithm 3 at an iterate x^i. */
#pragma once

#include "picture/frame_content.h"

/* Most bytes for a step's iterates; beyond them only records are stored. */
#define STEP_TRACE_BYTES ((size_t)64 << 20)

/* E along p is drawn up to 3/2 of the first trial of the line search.  If E is
 * no polynomial it is sampled SAMPLE_INTERVALS times up to the first trial: the
 * samples are also at the trials first/2, first/4, ... */
enum { SAMPLE_INTERVALS = 32, SAMPLE_COUNT = SAMPLE_INTERVALS * 3 / 2 + 1 };

/* Records of Newton's iterations. */
typedef struct NewtonRecords {
    NewtonRecord *record; /* [count] */
    int count, capacity;  /* number of records; room for records */
    bool is_incomplete;   /* memory was missing for a record */
} NewtonRecords;

/* Reserves memory for `count` records.  Returns false if memory is missing. */
bool newton_records_reserve(NewtonRecords *records, int count);

/* An iterate of Newton's method, with its direction and its line search. */
typedef struct TraceIterate {
    double *x, *p, *u;  /* [x_length] m, iterate x^i, p^i, x^i - x^n; or NULL */
    double first_alpha; /* alpha, first trial of the line search */
    Quartic polynomial; /* polynomial part of E(x + alpha p) - E(x), J s^2 */
    bool has_remainder; /* E along p has a part that is no polynomial */
    bool has_samples;   /* `energy_samples` is filled */
    double alpha;       /* step length that was taken */
    double energy_change;   /* change of E at alpha, J s^2 */
    double *energy_samples; /* [SAMPLE_COUNT] J s^2, samples of E along p */
} TraceIterate;

/* Units in which a user goes through time. */
typedef enum TimeUnit { UNIT_STEP, UNIT_UPDATE, UNIT_LINE, UNITS } TimeUnit;

typedef struct WalkPosition {
    int iterate;      /* index in StepTrace.iterate; at the end their number */
    AlgoLine at_line; /* line of Algorithm 3 */
    int trials;       /* trials of the line search so far */
} WalkPosition;

typedef struct StepTrace {
    NewtonTrace common_trace; /* values shared by all positions: h, tolerance */
    int x_length;             /* 2n; 0: no iterates are stored */
    NewtonRecords records;    /* Newton's record at each iterate */
    TraceIterate *iterate;    /* [records.count] */
    int iterate_capacity;     /* iterates that memory was reserved for */
    bool samples_each_iterate; /* E along p is sampled at each iterate */
    bool samples_last_iterate; /* E along p is sampled at the last iterate */
    double *x_tilde;   /* [x_length] m, first x_tilde of the step; or NULL */
    double *end_x;     /* [x_length] m, x after the last iteration, or NULL */
    size_t used_bytes; /* memory of the iterates */
    WalkPosition *position; /* [position_count] in the order of the walk */
    int position_count;     /* number of positions; 0 if memory is missing */
} StepTrace;

/* Begins the trace of a step.  A last iteration with alpha 0 samples E along p.
 *   all   in, samples at each iteration, for a walk through the step
 *   last  in, the last iteration samples E along p, for a card */
void step_trace_begin(StepTrace *trace, const Simulation *simulation, bool all,
                      bool last);

/* Whether samples of E along p are missing at the iterate of a position.
 *   position  index of the position; -1: the last iterate */
bool step_trace_lacks_samples(const StepTrace *trace, int position);

/* Adds a Newton iteration, or only its record if memory is missing. */
void step_trace_add_iterate(StepTrace *trace, const Newton *newton,
                            const NewtonRecord *record);

/* Ends the trace of a step: lists its positions. */
void step_trace_end(StepTrace *trace, const Options *options);

/* Empties the trace, but keeps the memory of its arrays. */
void step_trace_clear(StepTrace *trace);
void step_trace_free(StepTrace *trace);

/* Finds the next position (way 1) or the position before (-1).
 *   unit  in, UNIT_UPDATE stops at the start and at ends of updates,
 *         UNIT_LINE at each position
 * Returns the index of this position, or `position` if the walk ends there. */
int step_trace_walk(const StepTrace *trace, TimeUnit unit, int position,
                    int way);

/* Returns the index of the last position at iterate i whose line of Algorithm 3
 * is not after `line`; without such a position, the last index of the step. */
int step_trace_find_position(const StepTrace *trace, int i, AlgoLine line);

/* Returns the index of the position where E was highest, if E exploded (rose
 * by more than ten times its change in the whole step); else -1. */
int step_trace_find_peak(const StepTrace *trace);

/* Fills what a picture shows at a position; position -1: after the step.
 * Pointers of `shown` lead into the trace.  Returns positions to draw,
 * [x_length] m; NULL: the positions after the step. */
const double *step_trace_read_position(const StepTrace *trace, int position,
                                       NewtonTrace *shown);
