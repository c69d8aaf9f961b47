/* step_trace.c - iterates of a step, and the walk through Algorithm 3. */
#include "play/step_trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* From this number of trials on, the walk shows only the last trial. */
enum { MAX_WALK_TRIALS = 12 };

bool newton_records_reserve(NewtonRecords *records, int count)
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

static void free_iterate(TraceIterate *iterate)
{
    free(iterate->x);
    *iterate = (TraceIterate){0};
}

void step_trace_clear(StepTrace *trace)
{
    for (int i = 0; i < trace->iterate_capacity; i++)
        free_iterate(&trace->iterate[i]);
    free(trace->x_tilde);
    free(trace->end_x);
    trace->x_tilde = trace->end_x = NULL;
    trace->records.count = trace->position_count = 0;
    trace->used_bytes = 0;
}

void step_trace_free(StepTrace *trace)
{
    step_trace_clear(trace);
    free(trace->iterate);
    free(trace->records.record);
    free(trace->position);
    *trace = (StepTrace){0};
}

void step_trace_begin(StepTrace *trace, const Simulation *simulation, bool all,
                      bool last)
{
    step_trace_clear(trace);
    trace->samples_each_iterate = all;
    trace->samples_last_iterate = last;
    trace->common_trace =
        (NewtonTrace){.h = simulation->options.timestep,
                      .tolerance = simulation->options.tolerance,
                      .projected_blocks = -1};
    trace->x_length = 2 * simulation->system.nodes;
}

/* Stores E along p of the newest iterate: polynomial, and samples if needed. */
static void store_line_energy(StepTrace *trace, const Iterate *at)
{
    TraceIterate *iterate = &trace->iterate[trace->records.count];
    const NewtonRecord *record = &trace->records.record[trace->records.count];
    const LineEnergy along = make_line_energy(at);
    bool ended = record->status != STATUS_RUNNING;
    bool samples =
        trace->samples_each_iterate ||
        (ended && (trace->samples_last_iterate || record->alpha == 0));
    iterate->first_alpha = incremental_potential_max_alpha(at);
    iterate->polynomial = along.polynomial;
    iterate->has_remainder = along.has_remainder;
    iterate->has_samples = along.has_remainder && samples;
    for (int i = 0; i < SAMPLE_COUNT && iterate->has_samples; i++)
        iterate->energy_samples[i] = line_energy_difference(
            &along, i * iterate->first_alpha / SAMPLE_INTERVALS);
}

bool step_trace_lacks_samples(const StepTrace *trace, int position)
{
    int last = trace->records.count - 1;
    int i = position < 0 ? last : trace->position[position].iterate;
    if (last < 0)
        return false;
    const TraceIterate *iterate = &trace->iterate[i < last ? i : last];
    return iterate->has_remainder && iterate->x && !iterate->has_samples;
}

/* Returns E(x + alpha p) - E(x): the polynomial, or samples joined by lines;
 * without samples, NaN except at the step length that was taken. */
static double evaluate_iterate_energy(const void *function, double alpha)
{
    const TraceIterate *iterate = function;
    if (!iterate->has_remainder)
        return quartic_value(&iterate->polynomial, alpha);
    if (!iterate->has_samples && alpha == iterate->alpha)
        return iterate->energy_change;
    double at = alpha / iterate->first_alpha * SAMPLE_INTERVALS;
    if (!iterate->has_samples || !(at >= 0 && at <= SAMPLE_COUNT - 1))
        return NAN;
    const double *value = iterate->energy_samples + (int)at;
    double part = at - (int)at;
    return part == 0 ? value[0] : value[0] + part * (value[1] - value[0]);
}

/* Returns a copy of an array [size], or NULL. */
static double *copy_array(const StepTrace *trace, const double *from)
{
    size_t bytes = (size_t)trace->x_length * sizeof *from;
    double *copy = malloc(bytes);
    return copy ? memcpy(copy, from, bytes) : NULL;
}

/* Stores x, u and p of the newest iterate, if there is memory.  After an update
 * newton->x_trial is the iterate before the update.  Multigrid's update is not
 * a step along p: p becomes the whole update, and alpha is 1. */
static void store_iteration(StepTrace *trace, const Newton *newton)
{
    TraceIterate *iterate = &trace->iterate[trace->records.count];
    NewtonRecord *record = &trace->records.record[trace->records.count];
    Iterate at = newton->iterate;
    size_t size = (size_t)trace->x_length;
    size_t bytes = (4 * size + SAMPLE_COUNT) * sizeof *iterate->x;
    free_iterate(iterate);
    if (trace->used_bytes + bytes <= STEP_TRACE_BYTES)
        iterate->x = malloc(bytes);
    if (!iterate->x)
        return;
    trace->used_bytes += bytes;
    iterate->p = iterate->x + size;
    iterate->u = iterate->p + size;
    double *g = iterate->u + size;
    iterate->energy_samples = g + size;
    bool moved = record->alpha != 0;
    memcpy(iterate->x, moved ? newton->x_trial : at.x, size * sizeof *at.x);
    memcpy(iterate->u, moved ? newton->u_trial : at.u, size * sizeof *at.u);
    memcpy(iterate->p, at.p, size * sizeof *iterate->p);
    at.x = iterate->x;
    at.u = iterate->u;
    at.p = iterate->p;
    if (record->solver == SOLVER_MULTIGRID) {
        for (size_t i = 0; i < size; i++)
            iterate->p[i] = newton->iterate.u[i] - iterate->u[i];
        record->alpha = record->trials = moved;
    }
    at.g = g;
    incremental_potential_gradient(&at.E, at.u, at.x, g);
    store_line_energy(trace, &at);
    record->slope = iterate->polynomial.q[0];
    iterate->alpha = record->alpha;
    iterate->energy_change = record->energy_change;
}

void step_trace_add_iterate(StepTrace *trace, const Newton *newton,
                            const NewtonRecord *record)
{
    int count = trace->records.count + 1;
    if (count > trace->iterate_capacity) {
        TraceIterate *iterate =
            realloc(trace->iterate, 2 * (size_t)count * sizeof *iterate);
        if (!iterate)
            return;
        memset(iterate + trace->iterate_capacity, 0,
               (size_t)(2 * count - trace->iterate_capacity) * sizeof *iterate);
        trace->iterate = iterate;
        trace->iterate_capacity = 2 * count;
    }
    if (!newton_records_reserve(&trace->records, count))
        return;
    trace->records.record[trace->records.count] = *record;
    store_iteration(trace, newton);
    trace->records.count++;
    free(trace->end_x);
    trace->end_x = copy_array(trace, newton->iterate.x);
    if (trace->x_tilde) /* x_tilde of the step's first minimisation is kept */
        return;
    trace->x_tilde = copy_array(trace, newton->u_tilde);
    for (int i = 0; i < trace->x_length && trace->x_tilde; i++)
        trace->x_tilde[i] += newton->iterate.E.x_n[i];
}

static void append_walk_position(StepTrace *trace, int iterate, AlgoLine line,
                                 int trials)
{
    trace->position[trace->position_count++] =
        (WalkPosition){iterate, line, trials};
}

void step_trace_end(StepTrace *trace, const Options *options)
{
    int count = trace->records.count;
    WalkPosition *grown =
        realloc(trace->position,
                ((size_t)count + 1) * (MAX_WALK_TRIALS + 8) * sizeof *grown);
    trace->position_count = 0;
    if (!grown)
        return;
    trace->position = grown;
    append_walk_position(trace, 0, LINE_START, 0);
    for (int i = 0; i < count; i++) {
        const NewtonRecord *record = &trace->records.record[i];
        bool searches = options->line_search != LINE_SEARCH_NONE;
        bool fails = record->alpha == 0, passes = record->status == STATUS_OK;
        int trials = record->trials;
        append_walk_position(trace, i, LINE_DO, 0);
        if (options->projection != PROJECTION_NONE)
            append_walk_position(trace, i, LINE_PROJECT, 0);
        append_walk_position(trace, i, LINE_SOLVE, 0);
        for (int t = 1; searches && t < trials && trials < MAX_WALK_TRIALS; t++)
            append_walk_position(trace, i, LINE_SEARCH, t);
        if (searches || fails)
            append_walk_position(trace, i, LINE_SEARCH, trials);
        if (!fails)
            append_walk_position(trace, i, LINE_UPDATE, trials);
        if (!fails || passes)
            append_walk_position(trace, i, LINE_TEST, trials);
    }
    append_walk_position(trace, count, LINE_END_STEP, 0);
}

int step_trace_walk(const StepTrace *trace, TimeUnit unit, int position,
                    int way)
{
    for (int i = position + way; 0 <= i && i < trace->position_count;
         i += way) {
        AlgoLine line = trace->position[i].at_line;
        if (unit == UNIT_LINE || line == LINE_START || line == LINE_TEST ||
            line == LINE_END_STEP)
            return i;
    }
    return position;
}

int step_trace_find_position(const StepTrace *trace, int iterate, AlgoLine line)
{
    for (int i = trace->position_count - 1; i >= 0; i--)
        if (trace->position[i].iterate == iterate &&
            trace->position[i].at_line <= line)
            return i;
    return trace->position_count - 1;
}

/* E is the sum of its changes.  The rounding error of the sum is tiny against a
 * tenth of the highest E, the limit for a peak. */
int step_trace_find_peak(const StepTrace *trace)
{
    enum { EXPLOSION_FACTOR = 10 };
    double sum = 0, rise = 0;
    int iterate = -1;
    for (int i = 0; i < trace->records.count; i++) {
        sum += trace->records.record[i].energy_change;
        if (sum > rise) {
            rise = sum;
            iterate = i;
        }
    }
    bool far = iterate >= 0 && rise > EXPLOSION_FACTOR * fabs(sum);
    return far ? step_trace_find_position(trace, iterate, LINE_UPDATE) : -1;
}

/* Fills the values that Algorithm 3 has computed at x^i up to a position. */
static void show_iterate_values(const StepTrace *trace, const WalkPosition *at,
                                NewtonTrace *shown)
{
    const TraceIterate *iterate = &trace->iterate[at->iterate];
    const NewtonRecord *record = &trace->records.record[at->iterate];
    bool solved = at->at_line >= LINE_SOLVE;
    shown->x = iterate->x;
    shown->record_count = at->iterate + solved;
    shown->trials = at->trials;
    shown->is_accepted = at->trials == record->trials && record->alpha > 0;
    if (at->at_line >= LINE_PROJECT)
        shown->projected_blocks = record->projected_blocks;
    if (!solved)
        return;
    shown->residual = record->residual;
    shown->p = iterate->p;
    shown->slope = record->slope;
    shown->first_alpha = iterate->first_alpha;
    if (!iterate->p)
        return;
    shown->energy_difference = evaluate_iterate_energy;
    shown->difference_data = iterate;
}

const double *step_trace_read_position(const StepTrace *trace, int position,
                                       NewtonTrace *shown)
{
    int count = trace->records.count;
    const NewtonRecord *row = trace->records.record;
    const NewtonRecord *last = count > 0 ? row + count - 1 : row;
    bool over = position < 0 || position >= trace->position_count;
    bool given_up = count > 0 && last->status != STATUS_OK &&
                    last->status != STATUS_RUNNING;
    const WalkPosition at = over ? (WalkPosition){count, LINE_END_STEP, 0}
                                 : trace->position[position];
    bool end = at.at_line == LINE_END_STEP;
    WalkPosition source = at;
    if (end && count > 0) /* the end shows the values of the last iterate */
        source = (WalkPosition){count - 1, LINE_END_STEP, last->trials};
    *shown = trace->common_trace;
    shown->at_line = over ? LINE_NONE : at.at_line;
    shown->iteration = source.iterate;
    shown->record_count = at.iterate;
    shown->record = row;
    shown->x_n = count > 0 ? trace->iterate[0].x : NULL;
    shown->x_tilde = trace->x_tilde;
    if (at.at_line != LINE_START && source.iterate < count)
        show_iterate_values(trace, &source, shown);
    shown->has_failed =
        given_up &&
        (end || (at.at_line == LINE_SEARCH && at.iterate == count - 1 &&
                 at.trials == last->trials && last->alpha == 0));
    if (end || count == 0)
        return NULL;
    if (at.at_line != LINE_UPDATE && at.at_line != LINE_TEST)
        return trace->iterate[at.iterate].x;
    return at.iterate + 1 < count ? trace->iterate[at.iterate + 1].x
                                  : trace->end_x;
}
