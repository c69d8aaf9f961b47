/* step_trace.c - keeps the iterates of one step for the cards and for a walk
 * line by line.
 */
#include "play/step_trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Trials of a line search that are walked through one by one. */
enum { TRIALS_WALKED = 12 };

bool records_fit(Records *records, int count)
{
    if (count <= records->room)
        return true;
    int room = count < 16 ? 16 : 2 * count;
    NewtonRecord *row = realloc(records->row, (size_t)room * sizeof *row);
    if (!row)
        return false;
    records->row = row;
    records->room = room;
    return true;
}

static void free_round(Round *round)
{
    free(round->x);
    *round = (Round){0};
}

void step_trace_clear(StepTrace *kept)
{
    for (int i = 0; i < kept->room; i++)
        free_round(&kept->round[i]);
    free(kept->x_tilde);
    free(kept->end);
    kept->x_tilde = kept->end = NULL;
    kept->made.count = kept->places = 0;
    kept->bytes = 0;
}

void step_trace_free(StepTrace *kept)
{
    step_trace_clear(kept);
    free(kept->round);
    free(kept->made.row);
    free(kept->place);
    *kept = (StepTrace){0};
}

void step_trace_begin(StepTrace *kept, const Simulation *simulation, bool all,
                      bool last)
{
    step_trace_clear(kept);
    kept->all = all;
    kept->last = last;
    kept->start = (Trace){.h = simulation->options.timestep,
                          .tolerance = simulation->options.tolerance,
                          .projected = -1};
    kept->size = 2 * simulation->system.nodes;
}

/* Reserves memory for one more round. */
static bool reserve_round(StepTrace *kept)
{
    int count = kept->made.count + 1;
    if (count > kept->room) {
        Round *round = realloc(kept->round, 2 * (size_t)count * sizeof *round);
        if (!round)
            return false;
        memset(round + kept->room, 0,
               (size_t)(2 * count - kept->room) * sizeof *round);
        kept->round = round;
        kept->room = 2 * count;
    }
    return records_fit(&kept->made, count);
}

/* ---- what is kept -------------------------------------------------------- */

/* Samples E along p where it is no polynomial. */
static void sample(Round *round, const Iterate *at)
{
    const LineEnergy along = {.smooth = round->along, .at = at, .rough = true};
    round->sampled = round->rough && round->x;
    for (int i = 0; i < ROUND_VALUES && round->sampled; i++)
        round->value[i] =
            line_energy_difference(&along, i * round->first / ROUND_PARTS);
}

/* Keeps E along p of the newest round. */
static void keep_line(StepTrace *kept, const Iterate *at)
{
    Round *round = &kept->round[kept->made.count];
    const NewtonRecord *record = &kept->made.row[kept->made.count];
    LineEnergy along = incremental_potential_on_line(at);
    bool ended = record->status != STATUS_RUNNING;
    round->first = incremental_potential_max_step(at);
    round->along = along.smooth;
    round->rough = along.rough;
    if (kept->all || (ended && (kept->last || record->alpha == 0)))
        sample(round, at);
}

bool step_trace_lacks_line(const StepTrace *kept, int place)
{
    int last = kept->made.count - 1;
    int i = place < 0 ? last : kept->place[place].round;
    if (last < 0)
        return false;
    const Round *round = &kept->round[i < last ? i : last];
    return round->rough && round->x && !round->sampled;
}

/* Returns E(x + alpha p) - E(x): the polynomial, or the samples joined by
 * straight lines; without samples only at the step length that was taken. */
static double kept_difference(const void *function, double alpha)
{
    const Round *round = function;
    if (!round->rough)
        return quartic_value(&round->along, alpha);
    if (!round->sampled && alpha == round->alpha)
        return round->change;
    double place = alpha / round->first * ROUND_PARTS;
    if (!round->sampled || !(place >= 0 && place <= ROUND_VALUES - 1))
        return NAN;
    const double *value = round->value + (int)place;
    double part = place - (int)place;
    return part == 0 ? value[0] : value[0] + part * (value[1] - value[0]);
}

/* Returns a copy of an array [size], or NULL. */
static double *copy_of(const StepTrace *kept, const double *from)
{
    size_t bytes = (size_t)kept->size * sizeof *from;
    double *copy = malloc(bytes);
    return copy ? memcpy(copy, from, bytes) : NULL;
}

/* Copies x, u and p of the newest round, if there is memory.  The update has
 * left the iterate before it in x_trial and u_trial.  Multigrid's update is not
 * a step along p alone: p becomes its whole way, and alpha is 1. */
static void keep_round(StepTrace *kept, const Newton *newton)
{
    Round *round = &kept->round[kept->made.count];
    NewtonRecord *record = &kept->made.row[kept->made.count];
    Iterate at = newton->at;
    size_t size = (size_t)kept->size;
    size_t bytes = (4 * size + ROUND_VALUES) * sizeof *round->x;
    free_round(round);
    if (kept->bytes + bytes <= STEP_TRACE_BYTES)
        round->x = malloc(bytes);
    if (!round->x)
        return;
    kept->bytes += bytes;
    round->p = round->x + size;
    round->u = round->p + size;
    double *g = round->u + size;
    round->value = g + size;
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
    keep_line(kept, &at);
    record->slope = round->along.q[0];
    round->alpha = record->alpha;
    round->change = record->change;
}

void step_trace_add(StepTrace *kept, const Newton *newton,
                    const NewtonRecord *record)
{
    if (!reserve_round(kept))
        return;
    kept->made.row[kept->made.count] = *record;
    keep_round(kept, newton);
    kept->made.count++;
    free(kept->end);
    kept->end = copy_of(kept, newton->at.x);
    if (kept->x_tilde) /* a method with stages keeps that of the first */
        return;
    kept->x_tilde = copy_of(kept, newton->u_tilde);
    for (int i = 0; i < kept->size && kept->x_tilde; i++)
        kept->x_tilde[i] += newton->at.E.x_n[i];
}

/* ---- the listing --------------------------------------------------------- */

/* Adds a place. */
static void add_place(StepTrace *kept, int round, Line line, int trials)
{
    kept->place[kept->places++] = (TracePlace){round, line, trials};
}

void step_trace_end(StepTrace *kept, const Options *options)
{
    int count = kept->made.count;
    TracePlace *place = realloc(
        kept->place, ((size_t)count + 1) * (TRIALS_WALKED + 8) * sizeof *place);
    kept->places = 0;
    if (!place)
        return;
    kept->place = place;
    add_place(kept, 0, LINE_START, 0);
    for (int i = 0; i < count; i++) {
        const NewtonRecord *record = &kept->made.row[i];
        bool searches = options->line_search != LINE_SEARCH_NONE;
        bool fails = record->alpha == 0, passes = record->status == STATUS_OK;
        int trials = record->trials;
        add_place(kept, i, LINE_DO, 0);
        if (options->projection != PROJECTION_NONE)
            add_place(kept, i, LINE_PROJECT, 0);
        add_place(kept, i, LINE_SOLVE, 0);
        for (int t = 1; searches && t < trials && trials < TRIALS_WALKED; t++)
            add_place(kept, i, LINE_SEARCH, t);
        if (searches || fails)
            add_place(kept, i, LINE_SEARCH, trials);
        if (!fails)
            add_place(kept, i, LINE_UPDATE, trials);
        if (!fails || passes)
            add_place(kept, i, LINE_TEST, trials);
    }
    add_place(kept, count, LINE_END, 0);
}

int step_trace_walk(const StepTrace *kept, int fine, int place, int way)
{
    for (int i = place + way; 0 <= i && i < kept->places; i += way) {
        Line line = kept->place[i].line;
        if (fine == 2 || line == LINE_START || line == LINE_TEST ||
            line == LINE_END)
            return i;
    }
    return place;
}

int step_trace_find(const StepTrace *kept, int round, Line line)
{
    for (int i = kept->places - 1; i >= 0; i--)
        if (kept->place[i].round == round && kept->place[i].line <= line)
            return i;
    return kept->places - 1;
}

/* The sum of the changes may be off by some units in the last place of the
 * highest E; only whether it is a tenth of that is asked. */
int step_trace_peak(const StepTrace *kept)
{
    enum { FAR = 10 };
    double sum = 0, rise = 0;
    int round = -1;
    for (int i = 0; i < kept->made.count; i++) {
        sum += kept->made.row[i].change;
        if (sum > rise) {
            rise = sum;
            round = i;
        }
    }
    bool far = round >= 0 && rise > FAR * fabs(sum);
    return far ? step_trace_find(kept, round, LINE_UPDATE) : -1;
}

/* Fills the numbers of a round, each from the line on that computes it. */
static void trace_round(const StepTrace *kept, const TracePlace *at,
                        Trace *trace)
{
    const Round *round = &kept->round[at->round];
    const NewtonRecord *record = &kept->made.row[at->round];
    bool solved = at->line >= LINE_SOLVE;
    trace->x = round->x;
    trace->updates = at->round + solved;
    trace->trials = at->trials;
    trace->accepted = at->trials == record->trials && record->alpha > 0;
    if (at->line >= LINE_PROJECT)
        trace->projected = record->projected;
    if (!solved)
        return;
    trace->residual = record->residual;
    trace->p = round->p;
    trace->slope = record->slope;
    trace->first_alpha = round->first;
    if (!round->p)
        return;
    trace->difference = kept_difference;
    trace->difference_data = round;
}

const double *step_trace_at(const StepTrace *kept, int place, Trace *trace)
{
    int count = kept->made.count;
    const NewtonRecord *row = kept->made.row, *last = row + count - 1;
    bool over = place < 0 || place >= kept->places;
    bool given_up = count > 0 && last->status != STATUS_OK &&
                    last->status != STATUS_RUNNING;
    const TracePlace at =
        over ? (TracePlace){count, LINE_END, 0} : kept->place[place];
    bool end = at.line == LINE_END;
    TracePlace shown = at;
    if (end && count > 0) /* the last round has led there */
        shown = (TracePlace){count - 1, LINE_END, last->trials};
    *trace = kept->start;
    trace->line = over ? LINE_NONE : at.line;
    trace->iteration = shown.round;
    trace->updates = at.round;
    trace->record = row;
    trace->x_tilde = kept->x_tilde;
    if (at.line != LINE_START && shown.round < count)
        trace_round(kept, &shown, trace);
    trace->given_up =
        given_up && (end || (at.line == LINE_SEARCH && at.round == count - 1 &&
                             at.trials == last->trials && last->alpha == 0));
    if (end || count == 0)
        return NULL;
    if (at.line != LINE_UPDATE && at.line != LINE_TEST)
        return kept->round[at.round].x;
    return at.round + 1 < count ? kept->round[at.round + 1].x : kept->end;
}
