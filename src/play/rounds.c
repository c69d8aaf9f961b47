/* rounds.c - iterates of one step, kept for the cards and for walking line
 * by line.
 */
#include "play/rounds.h"

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

void rounds_clear(Rounds *rounds)
{
    for (int i = 0; i < rounds->room; i++)
        free_round(&rounds->round[i]);
    free(rounds->x_tilde);
    free(rounds->end);
    rounds->x_tilde = rounds->end = NULL;
    rounds->made.count = rounds->places = 0;
    rounds->bytes = 0;
}

void rounds_free(Rounds *rounds)
{
    rounds_clear(rounds);
    free(rounds->round);
    free(rounds->made.row);
    free(rounds->place);
    *rounds = (Rounds){0};
}

void rounds_begin(Rounds *rounds, const Simulation *simulation, bool all,
                  bool last)
{
    rounds_clear(rounds);
    rounds->all = all;
    rounds->last = last;
    rounds->start = (Trace){.h = simulation->options.timestep,
                            .tolerance = simulation->options.tolerance,
                            .projected = -1};
    rounds->size = 2 * simulation->system.nodes;
}

/* Room for one more round. */
static bool make_room(Rounds *rounds)
{
    int count = rounds->made.count + 1;
    if (count > rounds->room) {
        Round *round =
            realloc(rounds->round, 2 * (size_t)count * sizeof *round);
        if (!round)
            return false;
        memset(round + rounds->room, 0,
               (size_t)(2 * count - rounds->room) * sizeof *round);
        rounds->round = round;
        rounds->room = 2 * count;
    }
    return records_fit(&rounds->made, count);
}

/* ---- what is kept -------------------------------------------------------- */

/* Where E along p is no polynomial. */
static void sample(Round *round, const Iterate *at)
{
    const Along along = {.smooth = round->along, .at = at, .rough = true};
    round->sampled = round->rough && round->x;
    for (int i = 0; i < ROUND_VALUES && round->sampled; i++)
        round->value[i] =
            along_difference(&along, i * round->first / ROUND_PARTS);
}

/* E along p of the newest round, from its x. */
static void keep_line(Rounds *rounds, const Iterate *at)
{
    Round *round = &rounds->round[rounds->made.count];
    const NewtonRecord *record = &rounds->made.row[rounds->made.count];
    Along along = incremental_potential_along(at);
    bool ended = record->status != STATUS_RUNNING;
    round->first = incremental_potential_reach(at);
    round->along = along.smooth;
    round->rough = along.rough;
    if (rounds->all || (ended && (rounds->last || record->alpha == 0)))
        sample(round, at);
}

bool rounds_lack_line(const Rounds *rounds, int place)
{
    int last = rounds->made.count - 1;
    int i = place < 0 ? last : rounds->place[place].round;
    const Round *round = &rounds->round[i < last ? i : last];
    return last >= 0 && round->rough && round->x && !round->sampled;
}

/* The polynomial, or the kept values, joined by straight lines; without them
 * only what the update has told. */
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

/* A copy of an array [size], or NULL. */
static double *copy_of(const Rounds *rounds, const double *from)
{
    size_t bytes = (size_t)rounds->size * sizeof *from;
    double *copy = malloc(bytes);
    return copy ? memcpy(copy, from, bytes) : NULL;
}

/* Copies x, u and p of the newest round, if there is memory.  The update has
 * left the iterate before it in x_trial and u_trial.  Multigrid's update is not
 * a step along p alone: p becomes its whole way, and alpha is 1. */
static void keep_round(Rounds *rounds, const Newton *newton)
{
    Round *round = &rounds->round[rounds->made.count];
    NewtonRecord *record = &rounds->made.row[rounds->made.count];
    Iterate at = newton->at;
    size_t size = (size_t)rounds->size;
    size_t bytes = (4 * size + ROUND_VALUES) * sizeof *round->x;
    free_round(round);
    if (rounds->bytes + bytes <= ROUNDS_BYTES)
        round->x = malloc(bytes);
    if (!round->x)
        return;
    rounds->bytes += bytes;
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
    keep_line(rounds, &at);
    record->slope = round->along.q[0];
    round->alpha = record->alpha;
    round->change = record->change;
}

void rounds_add(Rounds *rounds, const Newton *newton,
                const NewtonRecord *record)
{
    if (!make_room(rounds))
        return;
    rounds->made.row[rounds->made.count] = *record;
    keep_round(rounds, newton);
    rounds->made.count++;
    free(rounds->end);
    rounds->end = copy_of(rounds, newton->at.x);
    if (rounds->x_tilde) /* of the first stage of a method with several */
        return;
    rounds->x_tilde = copy_of(rounds, newton->u_tilde);
    for (int i = 0; i < rounds->size && rounds->x_tilde; i++)
        rounds->x_tilde[i] += newton->at.E.x_n[i];
}

/* ---- the listing --------------------------------------------------------- */

/* One more place. */
static void add_place(Rounds *rounds, int round, Line line, int trials)
{
    rounds->place[rounds->places++] = (Station){round, line, trials};
}

void rounds_end(Rounds *rounds, const Options *options)
{
    int count = rounds->made.count;
    Station *place =
        realloc(rounds->place,
                ((size_t)count + 1) * (TRIALS_WALKED + 8) * sizeof *place);
    rounds->places = 0;
    if (!place)
        return;
    rounds->place = place;
    add_place(rounds, 0, LINE_START, 0);
    for (int i = 0; i < count; i++) {
        const NewtonRecord *record = &rounds->made.row[i];
        bool searches = options->line_search != LINE_SEARCH_NONE;
        bool fails = record->alpha == 0, passes = record->status == STATUS_OK;
        int trials = record->trials;
        add_place(rounds, i, LINE_DO, 0);
        if (options->projection != PROJECTION_NONE)
            add_place(rounds, i, LINE_PROJECT, 0);
        add_place(rounds, i, LINE_SOLVE, 0);
        for (int t = 1; searches && t < trials && trials < TRIALS_WALKED; t++)
            add_place(rounds, i, LINE_SEARCH, t);
        if (searches || fails)
            add_place(rounds, i, LINE_SEARCH, trials);
        if (!fails)
            add_place(rounds, i, LINE_UPDATE, trials);
        if (!fails || passes)
            add_place(rounds, i, LINE_TEST, trials);
    }
    add_place(rounds, count, LINE_END, 0);
}

int rounds_walk(const Rounds *rounds, int fine, int place, int way)
{
    for (int i = place + way; 0 <= i && i < rounds->places; i += way) {
        Line line = rounds->place[i].line;
        if (fine == 2 || line == LINE_START || line == LINE_TEST ||
            line == LINE_END)
            return i;
    }
    return place;
}

int rounds_find(const Rounds *rounds, int round, Line line)
{
    for (int i = rounds->places - 1; i >= 0; i--)
        if (rounds->place[i].round == round && rounds->place[i].line <= line)
            return i;
    return rounds->places - 1;
}

/* The sum of the changes may be off by some units in the last place of the
 * highest E; only whether it is a tenth of that is asked. */
int rounds_peak(const Rounds *rounds)
{
    enum { FAR = 10 };
    double sum = 0, rise = 0;
    int round = -1;
    for (int i = 0; i < rounds->made.count; i++) {
        sum += rounds->made.row[i].change;
        if (sum > rise) {
            rise = sum;
            round = i;
        }
    }
    bool far = round >= 0 && rise > FAR * fabs(sum);
    return far ? rounds_find(rounds, round, LINE_UPDATE) : -1;
}

/* The numbers of a round from the line on at which they are known. */
static void trace_round(const Rounds *rounds, const Station *at, Trace *trace)
{
    const Round *round = &rounds->round[at->round];
    const NewtonRecord *record = &rounds->made.row[at->round];
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
    trace->first = round->first;
    if (!round->p)
        return;
    trace->difference = kept_difference;
    trace->function = round;
}

const double *rounds_trace(const Rounds *rounds, int place, Trace *trace)
{
    int count = rounds->made.count;
    const NewtonRecord *row = rounds->made.row, *last = row + count - 1;
    bool over = place < 0 || place >= rounds->places;
    bool given_up = count > 0 && last->status != STATUS_OK &&
                    last->status != STATUS_RUNNING;
    const Station at =
        over ? (Station){count, LINE_END, 0} : rounds->place[place];
    bool end = at.line == LINE_END;
    Station told = at;
    if (end && count > 0) /* the round that has led there */
        told = (Station){count - 1, LINE_END, last->trials};
    *trace = rounds->start;
    trace->line = over ? LINE_NONE : at.line;
    trace->iteration = told.round;
    trace->updates = at.round;
    trace->record = row;
    trace->x_tilde = rounds->x_tilde;
    if (at.line != LINE_START && told.round < count)
        trace_round(rounds, &told, trace);
    trace->given_up =
        given_up && (end || (at.line == LINE_SEARCH && at.round == count - 1 &&
                             at.trials == last->trials && last->alpha == 0));
    if (end || count == 0)
        return NULL;
    if (at.line != LINE_UPDATE && at.line != LINE_TEST)
        return rounds->round[at.round].x;
    return at.round + 1 < count ? rounds->round[at.round + 1].x : rounds->end;
}
