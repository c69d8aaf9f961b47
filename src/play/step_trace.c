/* step_trace.c - iterates of a step, and the walk through Algorithm 3. */
#include "play/step_trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* From this number of trials on, the walk shows only the last trial. */
enum { TRIALS_WALKED = 12 };

bool records_reserve(Records *records, int count)
{
    if (count <= records->capacity)
        return true;
    int room = count < 16 ? 16 : 2 * count;
    NewtonRecord *row = realloc(records->record, (size_t)room * sizeof *row);
    if (!row)
        return false;
    records->record = row;
    records->capacity = room;
    return true;
}

static void free_round(Round *round)
{
    free(round->x);
    *round = (Round){0};
}

void step_trace_clear(StepTrace *trace)
{
    for (int i = 0; i < trace->capacity; i++)
        free_round(&trace->round[i]);
    free(trace->x_tilde);
    free(trace->end_x);
    trace->x_tilde = trace->end_x = NULL;
    trace->records.count = trace->place_count = 0;
    trace->used_bytes = 0;
}

void step_trace_free(StepTrace *trace)
{
    step_trace_clear(trace);
    free(trace->round);
    free(trace->records.record);
    free(trace->place);
    *trace = (StepTrace){0};
}

void step_trace_begin(StepTrace *trace, const Simulation *simulation, bool all,
                      bool last)
{
    step_trace_clear(trace);
    trace->samples_all_rounds = all;
    trace->samples_last_round = last;
    trace->start_trace = (Trace){.h = simulation->options.timestep,
                                 .tolerance = simulation->options.tolerance,
                                 .projected = -1};
    trace->x_length = 2 * simulation->system.nodes;
}

/* Stores E along p of the newest round; samples E unless it is polynomial. */
static void store_line_energy(StepTrace *trace, const Iterate *at)
{
    Round *round = &trace->round[trace->records.count];
    const NewtonRecord *record = &trace->records.record[trace->records.count];
    const LineEnergy along = incremental_potential_prepare_line(at);
    bool ended = record->status != STATUS_RUNNING;
    bool samples = trace->samples_all_rounds ||
                   (ended && (trace->samples_last_round || record->alpha == 0));
    round->first_trial = incremental_potential_max_step(at);
    round->polynomial = along.polynomial;
    round->has_remainder = along.has_remainder;
    round->has_samples = along.has_remainder && samples;
    for (int i = 0; i < ROUND_VALUES && round->has_samples; i++)
        round->energy_samples[i] = line_energy_difference(
            &along, i * round->first_trial / ROUND_PARTS);
}

bool step_trace_lacks_samples(const StepTrace *trace, int place)
{
    int last = trace->records.count - 1;
    int i = place < 0 ? last : trace->place[place].round;
    if (last < 0)
        return false;
    const Round *round = &trace->round[i < last ? i : last];
    return round->has_remainder && round->x && !round->has_samples;
}

/* Returns E(x + alpha p) - E(x): the polynomial, or samples joined by lines;
 * without samples, NaN except at the step length that was taken. */
static double evaluate_round_energy(const void *function, double alpha)
{
    const Round *round = function;
    if (!round->has_remainder)
        return quartic_value(&round->polynomial, alpha);
    if (!round->has_samples && alpha == round->alpha)
        return round->energy_change;
    double place = alpha / round->first_trial * ROUND_PARTS;
    if (!round->has_samples || !(place >= 0 && place <= ROUND_VALUES - 1))
        return NAN;
    const double *value = round->energy_samples + (int)place;
    double part = place - (int)place;
    return part == 0 ? value[0] : value[0] + part * (value[1] - value[0]);
}

/* Returns a copy of an array [size], or NULL. */
static double *copy_array(const StepTrace *trace, const double *from)
{
    size_t bytes = (size_t)trace->x_length * sizeof *from;
    double *copy = malloc(bytes);
    return copy ? memcpy(copy, from, bytes) : NULL;
}

/* Stores x, u and p of the newest round, if there is memory.  After an update
 * x_trial and u_trial are the iterate before it.  Multigrid's update is not a
 * step along p: p becomes the whole update, and alpha is 1. */
static void store_iteration(StepTrace *trace, const Newton *newton)
{
    Round *round = &trace->round[trace->records.count];
    NewtonRecord *record = &trace->records.record[trace->records.count];
    Iterate at = newton->at;
    size_t size = (size_t)trace->x_length;
    size_t bytes = (4 * size + ROUND_VALUES) * sizeof *round->x;
    free_round(round);
    if (trace->used_bytes + bytes <= STEP_TRACE_BYTES)
        round->x = malloc(bytes);
    if (!round->x)
        return;
    trace->used_bytes += bytes;
    round->p = round->x + size;
    round->u = round->p + size;
    double *g = round->u + size;
    round->energy_samples = g + size;
    bool moved = record->alpha != 0;
    memcpy(round->x, moved ? newton->x_trial : at.x, size * sizeof *round->x);
    memcpy(round->u, moved ? newton->u_trial : at.u, size * sizeof *round->u);
    memcpy(round->p, at.p, size * sizeof *round->p);
    at.x = round->x;
    at.u = round->u;
    at.p = round->p;
    if (record->solver == SOLVER_MULTIGRID) {
        for (size_t i = 0; i < size; i++)
            round->p[i] = newton->at.u[i] - round->u[i];
        record->alpha = record->trials = moved;
    }
    at.g = g;
    incremental_potential_gradient(&at.E, at.u, at.x, g);
    store_line_energy(trace, &at);
    record->slope = round->polynomial.q[0];
    round->alpha = record->alpha;
    round->energy_change = record->change;
}

void step_trace_add_round(StepTrace *trace, const Newton *newton,
                          const NewtonRecord *record)
{
    int count = trace->records.count + 1;
    if (count > trace->capacity) {
        Round *round = realloc(trace->round, 2 * (size_t)count * sizeof *round);
        if (!round)
            return;
        memset(round + trace->capacity, 0,
               (size_t)(2 * count - trace->capacity) * sizeof *round);
        trace->round = round;
        trace->capacity = 2 * count;
    }
    if (!records_reserve(&trace->records, count))
        return;
    trace->records.record[trace->records.count] = *record;
    store_iteration(trace, newton);
    trace->records.count++;
    free(trace->end_x);
    trace->end_x = copy_array(trace, newton->at.x);
    if (trace->x_tilde) /* x_tilde of the step's first minimisation is kept */
        return;
    trace->x_tilde = copy_array(trace, newton->u_tilde);
    for (int i = 0; i < trace->x_length && trace->x_tilde; i++)
        trace->x_tilde[i] += newton->at.E.x_n[i];
}

static void append_place(StepTrace *trace, int round, StepLine line, int trials)
{
    trace->place[trace->place_count++] = (TracePlace){round, line, trials};
}

void step_trace_end(StepTrace *trace, const Options *options)
{
    int count = trace->records.count;
    TracePlace *place =
        realloc(trace->place,
                ((size_t)count + 1) * (TRIALS_WALKED + 8) * sizeof *place);
    trace->place_count = 0;
    if (!place)
        return;
    trace->place = place;
    append_place(trace, 0, LINE_START, 0);
    for (int i = 0; i < count; i++) {
        const NewtonRecord *record = &trace->records.record[i];
        bool searches = options->line_search != LINE_SEARCH_NONE;
        bool fails = record->alpha == 0, passes = record->status == STATUS_OK;
        int trials = record->trials;
        append_place(trace, i, LINE_DO, 0);
        if (options->projection != PROJECTION_NONE)
            append_place(trace, i, LINE_PROJECT, 0);
        append_place(trace, i, LINE_SOLVE, 0);
        for (int t = 1; searches && t < trials && trials < TRIALS_WALKED; t++)
            append_place(trace, i, LINE_SEARCH, t);
        if (searches || fails)
            append_place(trace, i, LINE_SEARCH, trials);
        if (!fails)
            append_place(trace, i, LINE_UPDATE, trials);
        if (!fails || passes)
            append_place(trace, i, LINE_TEST, trials);
    }
    append_place(trace, count, LINE_END, 0);
}

int step_trace_walk(const StepTrace *trace, TimeUnit unit, int place, int way)
{
    for (int i = place + way; 0 <= i && i < trace->place_count; i += way) {
        StepLine line = trace->place[i].at_line;
        if (unit == UNIT_LINE || line == LINE_START || line == LINE_TEST ||
            line == LINE_END)
            return i;
    }
    return place;
}

int step_trace_find_place(const StepTrace *trace, int round, StepLine line)
{
    for (int i = trace->place_count - 1; i >= 0; i--)
        if (trace->place[i].round == round && trace->place[i].at_line <= line)
            return i;
    return trace->place_count - 1;
}

/* The rounding error of `sum` is some units in the last place of the highest E,
 * far less than a tenth of E, the limit for a peak. */
int step_trace_find_peak(const StepTrace *trace)
{
    enum { FAR = 10 };
    double sum = 0, rise = 0;
    int round = -1;
    for (int i = 0; i < trace->records.count; i++) {
        sum += trace->records.record[i].change;
        if (sum > rise) {
            rise = sum;
            round = i;
        }
    }
    bool far = round >= 0 && rise > FAR * fabs(sum);
    return far ? step_trace_find_place(trace, round, LINE_UPDATE) : -1;
}

/* Fills the values of a round that the lines up to a place have computed. */
static void fill_round_values(const StepTrace *trace, const TracePlace *at,
                              Trace *shown)
{
    const Round *round = &trace->round[at->round];
    const NewtonRecord *record = &trace->records.record[at->round];
    bool solved = at->at_line >= LINE_SOLVE;
    shown->x = round->x;
    shown->records = at->round + solved;
    shown->trials = at->trials;
    shown->is_accepted = at->trials == record->trials && record->alpha > 0;
    if (at->at_line >= LINE_PROJECT)
        shown->projected = record->projected;
    if (!solved)
        return;
    shown->residual = record->residual;
    shown->p = round->p;
    shown->slope = record->slope;
    shown->first_alpha = round->first_trial;
    if (!round->p)
        return;
    shown->energy_difference = evaluate_round_energy;
    shown->difference_data = round;
}

const double *step_trace_fill(const StepTrace *trace, int place, Trace *shown)
{
    int count = trace->records.count;
    const NewtonRecord *row = trace->records.record, *last = row + count - 1;
    bool over = place < 0 || place >= trace->place_count;
    bool given_up = count > 0 && last->status != STATUS_OK &&
                    last->status != STATUS_RUNNING;
    const TracePlace at =
        over ? (TracePlace){count, LINE_END, 0} : trace->place[place];
    bool end = at.at_line == LINE_END;
    TracePlace source = at;
    if (end && count > 0) /* the end shows the values of the last round */
        source = (TracePlace){count - 1, LINE_END, last->trials};
    *shown = trace->start_trace;
    shown->at_line = over ? LINE_NONE : at.at_line;
    shown->iteration = source.round;
    shown->records = at.round;
    shown->record = row;
    shown->x_n = count > 0 ? trace->round[0].x : NULL;
    shown->x_tilde = trace->x_tilde;
    if (at.at_line != LINE_START && source.round < count)
        fill_round_values(trace, &source, shown);
    shown->given_up =
        given_up &&
        (end || (at.at_line == LINE_SEARCH && at.round == count - 1 &&
                 at.trials == last->trials && last->alpha == 0));
    if (end || count == 0)
        return NULL;
    if (at.at_line != LINE_UPDATE && at.at_line != LINE_TEST)
        return trace->round[at.round].x;
    return at.round + 1 < count ? trace->round[at.round + 1].x : trace->end_x;
}
