#include "play/rounds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Trials of a line search that are walked through one by one. */
enum { TRIALS_WALKED = 12 };

static size_t array_bytes(const Rounds *rounds)
{
    return (size_t)rounds->size * sizeof(double);
}

static void free_round(Round *round)
{
    free(round->x);
    free(round->p);
    free(round->value);
    *round = (Round){0};
}

void rounds_clear(Rounds *rounds)
{
    for (int i = 0; i < rounds->room; i++)
        free_round(&rounds->round[i]);
    rounds->count = rounds->before = rounds->places = 0;
    rounds->bytes = 0;
    rounds->ended = rounds->tilde = rounds->passed = false;
}

void rounds_free(Rounds *rounds)
{
    rounds_clear(rounds);
    free(rounds->round);
    free(rounds->record);
    free(rounds->record_before);
    free(rounds->x_tilde);
    free(rounds->place);
    *rounds = (Rounds){0};
}

/* The records of the last step become those before this one. */
static void turn_over(Rounds *rounds)
{
    NewtonRecord *record = rounds->record_before;
    int room = rounds->before_room, count = rounds->count;
    if (!rounds->record)
        return;
    rounds->record_before = rounds->record;
    rounds->before_room = rounds->room;
    rounds->record = record;
    if (room < rounds->room) {
        NewtonRecord *larger =
            realloc(record, (size_t)rounds->room * sizeof *larger);
        if (!larger) { /* the old ones serve; nothing is drawn in grey */
            rounds->record = rounds->record_before;
            rounds->record_before = record;
            rounds->before_room = room;
            count = 0;
        } else {
            rounds->record = larger;
        }
    }
    rounds_clear(rounds);
    rounds->before = count;
}

Status rounds_begin(Rounds *rounds, const Simulation *simulation)
{
    int size = 2 * simulation->system.nodes;
    long step = simulation->steps + 1;
    bool near = rounds->step == step || rounds->step + 1 == step;
    turn_over(rounds);
    if (!near)
        rounds->before = 0;
    rounds->step = step;
    rounds->h = simulation->options.timestep;
    rounds->tolerance = simulation->options.tolerance;
    if (rounds->size == size)
        return STATUS_OK;
    free(rounds->x_tilde);
    rounds->x_tilde = calloc((size_t)size, sizeof(double));
    rounds->size = rounds->x_tilde ? size : 0;
    return rounds->x_tilde ? STATUS_OK : STATUS_OUT_OF_MEMORY;
}

/* Room for a round more and for the last one. */
static bool make_room(Rounds *rounds)
{
    if (rounds->count + 2 <= rounds->room)
        return true;
    int room = rounds->room ? 2 * rounds->room : 16;
    Round *round = realloc(rounds->round, (size_t)room * sizeof *round);
    if (!round)
        return false;
    memset(round + rounds->room, 0,
           (size_t)(room - rounds->room) * sizeof *round);
    rounds->round = round;
    NewtonRecord *record =
        realloc(rounds->record, (size_t)room * sizeof *record);
    if (!record)
        return false;
    rounds->record = record;
    rounds->room = room;
    return true;
}

/* Copies x and p, if there is memory for them. */
static void keep_arrays(Rounds *rounds, Round *round, const double *x,
                        const double *p)
{
    size_t bytes = array_bytes(rounds);
    if (rounds->bytes + 2 * bytes > ROUNDS_BYTES)
        return;
    round->x = malloc(bytes);
    round->p = malloc(bytes);
    if (!round->x || !round->p) {
        free_round(round);
        return;
    }
    rounds->bytes += 2 * bytes;
    memcpy(round->x, x, bytes);
    memcpy(round->p, p, bytes);
}

/* E along p, from the place where `at` is; nothing where memory is missing. */
static void keep_line(Rounds *rounds, Round *round, const Iterate *at)
{
    round->first = incremental_potential_reach(at);
    double pace = round->first / ROUND_PARTS;
    Along along = incremental_potential_along(at);
    round->along = along.smooth;
    round->slope = along.smooth.q[0];
    if (along.rough == 0 || !round->x)
        return;
    free(round->value);
    round->value = malloc(ROUND_VALUES * sizeof *round->value);
    if (!round->value) {
        free_round(round);
        return;
    }
    rounds->bytes += ROUND_VALUES * sizeof *round->value;
    for (int i = 0; i < ROUND_VALUES; i++)
        round->value[i] = along_difference(&along, i * pace);
}

/* The polynomial, or the kept values, joined by straight lines. */
static double kept_difference(const void *function, double alpha)
{
    const Round *round = function;
    if (!round->value)
        return quartic_value(&round->along, alpha);
    double place = alpha / round->first * ROUND_PARTS;
    if (!(place >= 0 && place <= ROUND_VALUES - 1))
        return NAN;
    int i = (int)place;
    double part = place - i;
    return part == 0 ? round->value[i]
                     : round->value[i] +
                           part * (round->value[i + 1] - round->value[i]);
}

/* E along p of a round, if it was kept. */
static void show_line(const Round *round, Trace *trace)
{
    trace->first = round->first;
    if (!round->p)
        return;
    trace->difference = kept_difference;
    trace->function = round;
}

/* The direction of multigrid is the way that it went from x, and E along it. */
static void keep_way(Rounds *rounds, const Newton *newton)
{
    const IncrementalPotential *E = &newton->at.E;
    Round *round = &rounds->round[rounds->count];
    double *u = calloc(2 * (size_t)rounds->size, sizeof *u);
    for (int i = 0; u && round->x && i < rounds->size; i++) {
        u[i] = round->x[i] - E->x_n[i];
        round->p[i] = newton->at.u[i] - u[i];
    }
    if (u && round->x) {
        double *g = u + rounds->size;
        Iterate at = {.E = *E, .u = u, .x = round->x, .g = g, .p = round->p};
        incremental_potential_gradient(E, u, round->x, g);
        keep_line(rounds, round, &at);
    }
    free(u);
}

/* Multigrid goes no line that p alone gives; what it made is shown as one. */
static NewtonRecord as_line(const NewtonRecord *record)
{
    NewtonRecord line = *record;
    if (record->solver == SOLVER_MULTIGRID && record->alpha != 0)
        line.alpha = line.trials = 1;
    return line;
}

/* The round that comes next: where the solver is now.  Where a bound decided
 * the test, no direction was computed, and p is still that of the round before.
 */
static void keep_next(Rounds *rounds, const Newton *newton)
{
    Round *round = &rounds->round[rounds->count];
    free_round(round);
    keep_arrays(rounds, round, newton->at.x, newton->at.p);
    keep_line(rounds, round, &newton->at);
    round->residual = newton->residual;
    round->kind = newton->kind;
    round->projected = newton->record.projected;
}

void rounds_look(Rounds *rounds, const Newton *newton)
{
    if (newton->record.iteration >= 0 || rounds->size == 0 ||
        !make_room(rounds))
        return;
    for (int i = 0; i < rounds->size && !rounds->tilde; i++)
        rounds->x_tilde[i] = newton->at.E.x_n[i] + newton->u_tilde[i];
    rounds->tilde = true;
    keep_next(rounds, newton);
}

void rounds_add(Rounds *rounds, const Newton *newton, const NewtonRecord *made)
{
    bool at_rest = made->iteration < 0 && rounds->count == 0;
    if (at_rest || made->status == STATUS_OK)
        rounds->passed =
            newton->working == SOLVER_MULTIGRID || !newton->record.factorised;
    if (rounds->size == 0 || !make_room(rounds))
        return;
    if (at_rest && made->status == STATUS_OK) {
        keep_next(rounds, newton);
        rounds->ended = true;
    }
    if (made->iteration < 0)
        return;
    const NewtonRecord line = as_line(made), *record = &line;
    Round *round = &rounds->round[rounds->count];
    if (record->solver == SOLVER_MULTIGRID)
        keep_way(rounds, newton);
    round->residual = record->residual;
    round->kind = record->kind;
    if (record->solver == SOLVER_NEWTON)
        round->slope = record->slope;
    round->projected = record->projected;
    rounds->record[rounds->count++] = *record;
    rounds->ended = record->alpha != 0 && (record->status == STATUS_RUNNING ||
                                           record->status == STATUS_OK);
    if (rounds->ended)
        keep_next(rounds, newton);
    else
        free_round(&rounds->round[rounds->count]);
}

/* One more place. */
static void add_place(Rounds *rounds, int round, Line line, int trials)
{
    rounds->place[rounds->places++] = (Station){round, line, trials};
}

/* The lines of a round that has a record. */
static void add_round(Rounds *rounds, const Options *options, int i)
{
    const NewtonRecord *record = &rounds->record[i];
    bool searches = options->line_search != LINE_SEARCH_NONE;
    int trials =
        searches && record->trials < TRIALS_WALKED ? record->trials : 1;
    add_place(rounds, i, LINE_DO, 0);
    if (options->filter != FILTER_NONE)
        add_place(rounds, i, LINE_PROJECT, 0);
    add_place(rounds, i, LINE_SOLVE, 0);
    for (int t = 1; t < trials; t++)
        add_place(rounds, i, LINE_SEARCH, t);
    if (searches || record->alpha == 0)
        add_place(rounds, i, LINE_SEARCH, record->trials);
    if (record->alpha == 0)
        return;
    add_place(rounds, i, LINE_UPDATE, record->trials);
    add_place(rounds, i, LINE_TEST, record->trials);
}

Status rounds_end(Rounds *rounds, const Options *options)
{
    int count = rounds->count + 1;
    Station *place = realloc(
        rounds->place, (size_t)count * (TRIALS_WALKED + 8) * sizeof *place);
    rounds->places = 0;
    if (!place)
        return STATUS_OUT_OF_MEMORY;
    rounds->place = place;
    add_place(rounds, 0, LINE_START, 0);
    for (int i = 0; i < rounds->count; i++)
        add_round(rounds, options, i);
    if (rounds->ended) {
        add_place(rounds, rounds->count, LINE_DO, 0);
        if (options->filter != FILTER_NONE && !rounds->passed)
            add_place(rounds, rounds->count, LINE_PROJECT, 0);
        if (!rounds->passed)
            add_place(rounds, rounds->count, LINE_SOLVE, 0);
        add_place(rounds, rounds->count, LINE_TEST, 0);
    }
    add_place(rounds, rounds->count, LINE_END, 0);
    return STATUS_OK;
}

/* Whether an update ends here. */
static bool is_milestone(const Rounds *rounds, int place)
{
    Line line = rounds->place[place].line;
    return line == LINE_START || line == LINE_TEST || line == LINE_END;
}

int rounds_walk(const Rounds *rounds, int fine, int place, int way)
{
    place += way;
    while (fine < 2 && place >= 0 && place < rounds->places &&
           !is_milestone(rounds, place))
        place += way;
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
int rounds_peak(const Rounds *rounds, double *rise)
{
    enum { FAR = 10 };
    double sum = 0;
    int round = -1;
    *rise = 0;
    for (int i = 0; i < rounds->count; i++) {
        sum += rounds->record[i].change;
        if (sum > *rise) {
            *rise = sum;
            round = i;
        }
    }
    if (round < 0 || !(*rise > FAR * fabs(sum)))
        return -1;
    for (int i = 0; i < rounds->places; i++)
        if (rounds->place[i].round == round &&
            rounds->place[i].line == LINE_UPDATE)
            return i;
    return -1;
}

double rounds_extent(const Rounds *rounds)
{
    double extent = 0;
    for (int i = 0; i <= rounds->count && i < rounds->room; i++)
        for (int k = 0; rounds->round[i].x && k < rounds->size; k++)
            extent = fmax(extent, fabs(rounds->round[i].x[k]));
    return extent;
}

/* The whole step is over: its last update, and the test that ended it. */
static void trace_last(const Rounds *rounds, Trace *trace)
{
    trace->iteration = rounds->count - 1;
    trace->passed = rounds->passed;
    if (rounds->ended) {
        trace->residual = rounds->round[rounds->count].residual;
        trace->kind = rounds->round[rounds->count].kind;
    }
    if (rounds->count == 0)
        return;
    const Round *round = &rounds->round[rounds->count - 1];
    const NewtonRecord *record = &rounds->record[rounds->count - 1];
    trace->x = round->x;
    trace->p = round->p;
    trace->given_up = !rounds->ended;
    if (trace->given_up) {
        trace->residual = round->residual;
        trace->kind = round->kind;
    }
    trace->slope = round->slope;
    trace->projected = round->projected;
    trace->trials = record->trials;
    trace->accepted = record->alpha > 0;
    show_line(round, trace);
}

/* The numbers of a round from the line on at which they are known. */
static void trace_round(const Rounds *rounds, const Station *at, Trace *trace)
{
    const Round *round = &rounds->round[at->round];
    bool made = at->round < rounds->count;
    bool passed = !made && rounds->passed;
    const NewtonRecord *record = made ? &rounds->record[at->round] : NULL;
    bool solved = at->line >= LINE_SOLVE;
    trace->x = round->x;
    trace->passed = passed && solved;
    trace->updates = at->round + (made && solved);
    trace->trials = at->trials;
    trace->accepted = made && at->trials == record->trials && record->alpha > 0;
    if (solved) {
        trace->residual = round->residual;
        trace->kind = round->kind;
    }
    if (passed)
        return;
    trace->projected = at->line >= LINE_PROJECT ? round->projected : -1;
    if (!solved)
        return;
    trace->p = round->p;
    trace->slope = round->slope;
    show_line(round, trace);
}

const double *rounds_trace(const Rounds *rounds, int place, Trace *trace)
{
    *trace = (Trace){.h = rounds->h,
                     .tolerance = rounds->tolerance,
                     .updates = rounds->count,
                     .record = rounds->record,
                     .updates_before = rounds->before,
                     .record_before = rounds->record_before,
                     .projected = -1,
                     .x_tilde = rounds->tilde ? rounds->x_tilde : NULL};
    if (place < 0 || place >= rounds->places) {
        trace_last(rounds, trace);
        return NULL;
    }
    const Station *at = &rounds->place[place];
    trace->line = at->line;
    trace->iteration = trace->updates = at->round;
    if (rounds->room == 0)
        return NULL;
    const Round *round = &rounds->round[at->round];
    if (at->line == LINE_START)
        return round->x;
    bool given_up = !rounds->ended && rounds->count > 0;
    if (at->line == LINE_END && given_up) { /* as the last round left it */
        const Station last = {rounds->count - 1, LINE_END,
                              rounds->record[rounds->count - 1].trials};
        trace_round(rounds, &last, trace);
    } else if (at->line != LINE_END || rounds->ended) {
        trace_round(rounds, at, trace);
    }
    trace->given_up =
        given_up &&
        (at->line == LINE_END ||
         (at->round == rounds->count - 1 && at->line == LINE_SEARCH &&
          at->trials == rounds->record[at->round].trials &&
          rounds->record[at->round].alpha == 0));
    bool moved = at->round < rounds->count &&
                 (at->line == LINE_UPDATE || at->line == LINE_TEST);
    if (moved && (at->round + 1 < rounds->count || rounds->ended))
        return rounds->round[at->round + 1].x;
    return moved || at->line == LINE_END ? NULL : round->x;
}
